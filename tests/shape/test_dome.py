"""Geometry of shapes: faces, volumes, normals, and the mesh of the solid on the meridian that is printed."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from pneutouch.body.shapes import sample
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.solid.elements import Cavity
from pneutouch.mechanics.solid.flange import printed_dome
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.mechanics.solid.mesh import dome, nodes_along
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.shape.dome import DomeShape
from pneutouch.shape.hemisphere import Hemisphere, no_hemisphere
from pneutouch.shape.meridian import Line, Meridian
from tests.shape.shapes import HalfBall, HalfHighCap, shipped

SIZE = 9.25, 1.5
EVERY = [*shipped(*SIZE), HalfBall(*SIZE), HalfHighCap(*SIZE)]
every = pytest.mark.parametrize("shape", EVERY, ids=lambda shape: shape.key)


def wall_of(shape):
    """The wall alone, closed where it is clamped."""
    foot = Line(shape.inner[0].start, shape.outer[0].start, "base")
    return Meridian((*(piece.reverse() for piece in reversed(shape.inner)), foot, *shape.outer))


def off(face, points):
    return np.min([piece.distance(points) for piece in face], axis=0).max()


@every
def test_faces_lead_from_the_base_plane_to_the_axis_and_are_smooth(shape):
    # A wall that varies turns a little where the curvature of the inner face jumps.
    turn = 0.05 if getattr(shape, "wall_stations", ()) else 1e-12
    for face, radius in ((shape.inner, shape.inner_radius), (shape.outer, shape.outer_radius)):
        assert face[0].start[0] == pytest.approx(radius, abs=1e-12)
        assert face[-1].end[0] == pytest.approx(0.0, abs=1e-12)
        for one, other in pairwise(face):
            assert one.end == pytest.approx(other.start, abs=1e-12)
            if not getattr(shape, "boss_height", 0.0):
                assert one.normals(np.ones(1))[0] == pytest.approx(other.normals(np.zeros(1))[0], abs=turn)
    assert shape.outer[0].start[1] == pytest.approx(0.0, abs=1e-12)
    assert shape.floor <= shape.inner[0].start[1] <= 1e-12
    assert wall_of(shape).volume() > 0.0


@every
@pytest.mark.parametrize(("arc", "through", "order"), [(None, None, 2), (30, 2, 8), (17, 3, 1)])
def test_nodes_of_the_solid_lie_on_the_faces_of_the_meridian(shape, arc, through, order):
    mesh = dome(shape, arc, through, order)
    for face, edges in ((shape.inner, mesh.inner), (shape.outer, mesh.outer)):
        assert off(face, mesh.nodes[np.unique(edges)]) < 1e-12
    edge = Line(shape.inner[0].start, shape.outer[0].start, "")
    assert edge.distance(mesh.nodes[mesh.clamped]).max() < 1e-12 and mesh.nodes[mesh.axis, 0].max() == 0.0


@pytest.mark.parametrize("shape", [one for one in EVERY if one.floor == 0.0], ids=lambda shape: shape.key)
def test_the_wall_goes_on_as_the_flange_that_is_printed(shape):
    mesh = printed_dome(shape, 2.25, 2.25)
    assert off(shape.inner, mesh.nodes[nodes_along(mesh.inner)]) < 1e-12
    assert off(shape.outer, mesh.nodes[nodes_along(mesh.outer)]) < 1e-12
    assert mesh.nodes[:, 0].max() == pytest.approx(shape.outer_radius + 2.25)
    assert mesh.nodes[:, 1].min() == pytest.approx(-2.25)


@every
def test_volume_by_pappus_is_that_of_print_mesh_and_solid(shape):
    """The print mesh keeps the area of every arc, so the volume converges faster than its chords; 1e-3 mm are given."""
    wall = wall_of(shape)
    assert wall.volume() == pytest.approx(shape.wall_volume, rel=1e-12)
    rings = sample(wall, 1e-3)
    chain = [(ring.radius, ring.height) for ring in rings]
    printed = sum(Line(a, b, "").swept() for a, b in zip(chain, [*chain[1:], chain[0]], strict=True))
    assert printed == pytest.approx(wall.volume(), rel=2e-4)
    mesh = dome(shape, 96, 1)
    assert Cavity(mesh.inner, mesh.pocket).volume(mesh.nodes) == pytest.approx(shape.cavity_volume, rel=2e-6)


@pytest.mark.parametrize("kind", [Hemisphere, HalfBall])
def test_a_hemisphere_has_its_textbook_sizes(kind):
    shape = kind(*SIZE)
    assert shape.cavity_volume == pytest.approx(2 / 3 * math.pi * 9.25**3, rel=1e-14)
    assert (shape.outer_radius, shape.height, shape.outer_height) == (10.75, 9.25, 10.75)
    assert shape.arcs == pytest.approx((0.5 * math.pi * 9.25, 0.5 * math.pi * 10.75), rel=1e-14)


def test_a_cap_has_its_textbook_volume():
    shape = HalfHighCap(*SIZE)
    assert shape.height == pytest.approx(0.5 * 9.25, rel=1e-14)
    assert shape.cavity_volume == pytest.approx(math.pi * shape.height / 6 * (3 * 9.25**2 + shape.height**2), rel=1e-12)


@pytest.mark.parametrize("shape", [one for one in EVERY if one.floor == 0.0], ids=lambda shape: shape.key)
@pytest.mark.parametrize("lean", [0.0, 0.3, 0.9])
def test_the_leaning_point_has_that_normal(shape, lean):
    share = np.linspace(0.0, 1.0, 400_001)
    near = np.argmin(np.hypot(*(shape.points(share, np.ones(1))[:, 0] - shape.leaning(lean)).T))
    assert shape.normals(share[[near]])[0] == pytest.approx((math.sin(lean), math.cos(lean)), abs=1e-4)
    assert off(shape.outer, np.array([shape.leaning(lean)])) < 1e-12


@every
def test_arc_positions_run_from_the_pole_to_the_rim_and_stay_there_below(shape):
    share = np.linspace(0.0, 1.0, 201)
    r, z = shape.points(share, np.ones(1))[:, 0].T
    assert shape.arc_share(r, z) == pytest.approx(1.0 - share, abs=1e-12)
    assert shape.arc_share(np.array([[10.0, 11.0]]), np.array([[-1.0, -2.0]])) == pytest.approx(1.0, abs=0.2)
    assert shape.arc_share(np.zeros(1), np.array([shape.height])) == pytest.approx(0.0, abs=1e-9)


def test_the_wall_of_a_hemisphere_in_polar_form_is_that_between_its_faces():
    shape, share, depth = Hemisphere(*SIZE), np.linspace(0.0, 1.0, 31), np.linspace(0.0, 1.0, 5)
    assert shape.points(share, depth) == pytest.approx(DomeShape.points(shape, share, depth), abs=1e-14)
    r, z = np.moveaxis(shape.points(share, depth), -1, 0)
    assert shape.arc_share(r, z) == pytest.approx(DomeShape.arc_share(shape, r, z), abs=1e-14)


def test_only_the_hemisphere_itself_is_one():
    assert no_hemisphere(Hemisphere(*SIZE)) is None
    assert "half-ball" in no_hemisphere(HalfBall(*SIZE))
    assert Hemisphere(*SIZE) != HalfBall(*SIZE)


def test_a_thin_cap_swells_as_the_sphere_that_it_is_part_of():
    """The pole rises by p r^2 (1 - nu) / (2 E t) as the wall grows thin; the layer at the clamp adds a root of t."""
    modulus, nu = 1.0, 0.49
    young = 2.0 * modulus * (1.0 + nu)

    def rise(wall):
        shape, pressure = HalfHighCap(10.0, wall), 1e-5 * wall
        state = state_at(SolidModel(dome(shape, 192, 1), neo_hookean(modulus, nu)), pressure)
        free = pressure * (shape.sphere + 0.5 * wall) ** 2 * (1.0 - nu) / (2.0 * young * wall)
        return (state.outer_apex - shape.outer_height) / free

    thick, thin = 0.1, 0.05
    layer = (rise(thick) - rise(thin)) / (thick**0.5 - thin**0.5)
    assert rise(thin) - layer * thin**0.5 == pytest.approx(1.0, abs=0.01)
