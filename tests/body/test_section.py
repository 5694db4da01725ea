"""Inside and outside from the exact shapes: against winding numbers of a mesh, exact volumes, and one another."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.body.section import SolidSection, Window, crossings, encloses, rises
from pneutouch.catalogue import load_scene
from pneutouch.parts import assemble
from pneutouch.shape.meridian import Arc, Line
from pneutouch.spec.read import parse_changes

CASES = {
    "paper-dome": [],
    "graded-dome": [],
    "fingertip-dome": [],
    "stiff-dome": ["connector.port=thread-M5", "connector.mount=robot-50-4-M6"],
    "soft-pad": ["connector.port=luer-female"],
}


def winding(points, triangles):
    """Solid angle of a mesh over that of a sphere, from every point (van Oosterom and Strackee 1983)."""
    a, b, c = np.moveaxis(triangles[None] - points[:, None, None], 2, 0)
    la, lb, lc = (np.linalg.norm(v, axis=-1) for v in (a, b, c))
    top = np.einsum("nti,nti->nt", a, np.cross(b, c))
    ab, bc, ca = (np.einsum("nti,nti->nt", *pair) for pair in ((a, b), (b, c), (c, a)))
    return 2 * np.arctan2(top, la * lb * lc + ab * lc + bc * la + ca * lb).sum(axis=1) / (4 * np.pi)


def solids(name, library):
    return assemble(load_scene(name, parse_changes(CASES[name]), library)).solids


@pytest.mark.parametrize("name", CASES)
def test_points_are_inside_where_the_mesh_winds_round_them(name, library):
    rng = np.random.default_rng(0)
    for solid in solids(name, library):
        inside, body = SolidSection(solid), solid.mesh(0.05)
        points = rng.uniform(inside.low - 0.5, inside.high + 0.5, (150, 3))
        points = points[solid.distance(points) > 0.06]
        found = inside.contains(points)
        assert np.array_equal(found, winding(points, body.corners) > 0.5)
        assert 0.03 < found.mean() < 0.97


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_sections_add_up_to_the_exact_volume_and_agree_with_points(name, library):
    """An even sum over shifted pixels errs far less than a pixel's share of the surface."""
    step = 0.06
    rng = np.random.default_rng(1)
    for solid in solids(name, library):
        inside = SolidSection(solid)
        (left, front, low), (right, back, high) = inside.low, inside.high
        heights = low + (np.arange(600) + 0.5) / 600 * (high - low)
        axes = [
            np.arange(left - step * rng.random(), right, step),
            np.arange(front - step * rng.random(), back, step),
            heights,
        ]
        window = Window(axes[0], axes[1])
        volume = step**2 * np.mean([inside.section(window, z).sum() for z in heights]) * (high - low)
        assert volume == pytest.approx(solid.volume, rel=0.004)
        z = float(heights[200])
        row, column = rng.integers(0, len(axes[1]), 4000), rng.integers(0, len(axes[0]), 4000)
        points = np.column_stack([axes[0][column], axes[1][row], np.full(4000, z)])
        assert np.array_equal(inside.section(window, z)[row, column], inside.contains(points))


@pytest.mark.parametrize("name", ["paper-dome", "graded-dome"])
def test_bodies_that_meet_share_no_point_and_leave_no_gap(name, library):
    """On the seat's own faces: z exactly on the shared plane, and pixels all round the shared cylinders."""
    membrane, connector = solids(name, library)[:2]
    one, other = SolidSection(membrane), SolidSection(connector)
    seat = connector.meridian.tagged("seat")
    for piece in seat:
        (r0, z0), (r1, z1) = piece.start, piece.end
        share, turn = np.meshgrid(np.linspace(0.02, 0.98, 25), np.linspace(0, 2 * np.pi, 40))
        r, z = r0 + share * (r1 - r0), z0 + share * (z1 - z0)
        points = np.stack([r * np.cos(turn), r * np.sin(turn), z], axis=-1).reshape(-1, 3)
        assert np.array_equal(one.contains(points), ~other.contains(points))


radius = st.floats(0.5, 50)


@given(radius, st.floats(-10, 10), st.floats(-1, 1))
def test_a_ball_is_cut_where_pythagoras_says(radius, centre, share):
    parts = rises((Arc((0.0, centre), radius, -np.pi / 2, np.pi / 2, ""),))
    level = centre + share * radius
    found = crossings(parts, level)
    if abs(share) < 1 - 1e-9:
        assert found == pytest.approx([0.0, radius * np.sqrt(1 - share**2)], abs=1e-6 * radius)


@given(st.floats(-3, 3), st.floats(-3, 3))
def test_a_full_circle_off_the_axis_turns_twice(x, y):
    """Arcs are cut where they turn: a torus's section counted by crossings is its disc."""
    parts = rises((Arc((0.0, 0.0), 2.0, -0.3, 2 * np.pi - 0.3, ""),))
    if abs(np.hypot(x, y) - 2) > 1e-6:
        assert encloses(parts, np.array([x]), np.array([y]))[0] == (np.hypot(x, y) < 2)


@given(st.integers(-8, 8), st.integers(-8, 8))
def test_squares_side_by_side_tile_the_plane(i, j):
    """Corners and edges on whole numbers belong to exactly one of four squares."""
    x, y = 0.25 * i, 0.25 * j
    held = 0
    for dx in (-2, 0):
        for dy in (-2, 0):
            corners = [(dx, dy), (dx + 2, dy), (dx + 2, dy + 2), (dx, dy + 2)]
            sides = tuple(Line(corners[k], corners[(k + 1) % 4], "") for k in range(4))
            held += encloses(rises(sides), np.array([x]), np.array([y]))[0]
    assert held == (-2 <= x < 2 and -2 <= y < 2)
