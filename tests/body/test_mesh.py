"""Print meshes: closed, within the stated tolerance both ways, fewer triangles than a plain grid, right volume."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.body import Bore, Solid
from pneutouch.body.shapes import circle_count, revolve, widen
from pneutouch.shape.meridian import Arc, Line, Meridian
from pneutouch.spec.material import Material

TOLERANCES = (0.1, 0.05, 0.016, 0.005)


def plain_grid_count(meridian: Meridian, tolerance: float) -> int:
    """Triangles of a plain revolved grid: inscribed, half the tolerance for chords and half for circles."""
    half = 0.5 * tolerance
    largest = meridian.bounds()[0]
    around = math.ceil(math.pi / math.acos(1 - half / largest))
    triangles = 0
    for piece in meridian.pieces:
        cuts = 1
        if isinstance(piece, Arc):
            cuts = math.ceil(abs(piece.last - piece.first) / (2 * math.acos(1 - half / piece.radius)))
        poles = sum(abs(end[0]) < 1e-9 for end in (piece.start, piece.end))
        triangles += around * (2 * cuts - poles)
    return triangles


def distance_from_mesh(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Distances of points from the nearest of many triangles, by brute force (points x triangles)."""
    a, b, c = np.moveaxis(corners, 1, 0)
    nearest = np.full(len(points), np.inf)
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    for k, p in enumerate(points):
        height = np.einsum("ij,ij->i", p - a, normal)
        foot = p - height[:, None] * normal
        inside = np.ones(len(a), bool)
        for u, v in ((a, b), (b, c), (c, a)):
            inside &= np.einsum("ij,ij->i", np.cross(v - u, foot - u), normal) >= -1e-12
        best = np.min(np.abs(height[inside]), initial=np.inf)
        for u, v in ((a, b), (b, c), (c, a)):
            along = v - u
            share = np.clip(np.einsum("ij,ij->i", p - u, along) / np.einsum("ij,ij->i", along, along), 0, 1)
            best = min(best, np.min(np.linalg.norm(p - u - share[:, None] * along, axis=1)))
        nearest[k] = best
    return nearest


@pytest.fixture(scope="module")
def membrane(evaluated) -> Solid:
    return evaluated("paper-dome").assembly.solids[0]


@pytest.fixture(scope="module")
def connector(evaluated) -> Solid:
    return evaluated("paper-dome").assembly.solids[1]


@pytest.mark.parametrize("tolerance", TOLERANCES)
@pytest.mark.parametrize("which", ["membrane", "connector"])
def test_mesh_stays_within_its_tolerance_of_the_exact_surface(which, tolerance, request):
    solid = request.getfixturevalue(which)
    body = solid.mesh(tolerance)
    gap = solid.distance(body.surface_points(parts=8)).max()
    assert gap <= tolerance
    assert gap >= 0.4 * tolerance, "finer than asked for: triangles are wasted"


@pytest.mark.parametrize("tolerance", [0.1, 0.05])
def test_exact_surface_stays_within_the_tolerance_of_the_mesh(membrane, tolerance):
    corners = membrane.mesh(tolerance).corners
    rng = np.random.default_rng(1)
    turn, polar = rng.uniform(0, 2 * np.pi, 400), np.arccos(rng.uniform(0, 1, 400))
    for radius in (9.25, 10.75):
        sphere = radius * np.column_stack([np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar)])
        assert distance_from_mesh(sphere, corners).max() <= tolerance


@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_mesh_takes_fewer_triangles_than_a_plain_grid(membrane, tolerance):
    assert len(membrane.mesh(tolerance).triangles) <= plain_grid_count(membrane.meridian, tolerance)


@pytest.mark.parametrize("tolerance", TOLERANCES)
@pytest.mark.parametrize("which", ["membrane", "connector"])
def test_mesh_is_closed_also_after_rounding_and_keeps_the_volume(which, tolerance, request):
    solid = request.getfixturevalue(which)
    body = solid.mesh(tolerance)
    assert body.is_closed()
    assert body.welded().is_closed()
    assert body.volume == pytest.approx(solid.volume, rel=1e-3)


def test_volume_error_falls_with_the_square_of_the_cut_length_not_with_the_tolerance_alone(membrane):
    """Inscribed polygons lose volume in proportion to the tolerance; these lose at most a tenth of that."""
    for tolerance in TOLERANCES:
        area = sum(piece.area() for piece in membrane.meridian.pieces)
        lost_inscribed = 2 / 3 * tolerance * area
        assert abs(membrane.mesh(tolerance).volume - membrane.volume) < 0.1 * lost_inscribed


@given(st.floats(1, 60), st.floats(0.05, 0.6), st.sampled_from([0.1, 0.03]))
def test_any_dome_meshes_closed_and_within_tolerance(radius, share, tolerance):
    outer = radius * (1 + share)
    dome = Meridian(
        (
            Arc((0, 0), radius, math.pi / 2, 0, "inner"),
            Line((radius, 0), (outer, 0), "base"),
            Arc((0, 0), outer, 0, math.pi / 2, "outer"),
        )
    )
    vertices, triangles = revolve(dome, tolerance)
    from pneutouch.body import Body

    body = Body("dome", "membrane", None, vertices, triangles)
    assert body.is_closed()
    assert dome.distance(body.surface_points(parts=3)).max() <= tolerance


def test_an_open_or_flipped_mesh_is_not_called_closed(membrane):
    from dataclasses import replace

    body = membrane.mesh(0.1)
    assert not replace(body, triangles=body.triangles[1:]).is_closed()
    flipped = body.triangles.copy()
    flipped[0] = flipped[0, ::-1]
    assert not replace(body, triangles=flipped).is_closed()


@given(st.floats(0.1, 100), st.floats(1e-3, 0.1))
def test_widened_polygon_keeps_the_circle_area_within_the_error(radius, error):
    count = circle_count(radius, error)
    wide = radius * widen(count)
    area = 0.5 * count * wide**2 * math.sin(2 * math.pi / count)
    assert area == pytest.approx(math.pi * radius**2, rel=1e-12)
    assert count % 4 == 0
    if count > 8:
        assert max(wide - radius, radius - wide * math.cos(math.pi / count)) <= error * 1.001


def test_blind_and_through_bores_take_out_their_volume(library):
    material: Material = library.load("materials", "ABS")
    plate = Meridian((Line((0, 0), (20, 0), "low"), Line((20, 0), (20, 6), "edge"), Line((20, 6), (0, 6), "high")))
    bores = (Bore(10, 0, 1.7, 0, 6), Bore(-10, 0, 1.0, 0, 4, closed="high"))
    solid = Solid("plate", "connector", material, plate, bores)
    body = solid.mesh(0.02)
    assert body.is_closed()
    assert body.volume == pytest.approx(math.pi * (400 * 6 - 1.7**2 * 6 - 4), rel=1e-5)
    assert solid.distance(body.surface_points(parts=6)).max() <= 0.02
    assert solid.distance(np.array([[-10.0, 0.0, 4.0], [10.0, 0.0, 3.0]])) == pytest.approx([0.0, 1.7])
