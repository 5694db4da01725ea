"""The meridian's closed forms against quadrature and known solids."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.body.shapes import chords, sample
from pneutouch.shape.meridian import Arc, Line, Meridian

coordinate = st.floats(-20, 20)
positive = st.floats(0.5, 20)


def arc_points(arc: Arc, count: int = 4001) -> np.ndarray:
    angle = np.linspace(arc.first, arc.last, count)
    return np.column_stack([arc.centre[0] + arc.radius * np.cos(angle), arc.centre[1] + arc.radius * np.sin(angle)])


@given(coordinate, coordinate, positive, st.floats(-3, 3), st.floats(0.1, 3))
def test_arc_sweeps_the_volume_and_area_that_quadrature_finds(cr, cz, radius, first, turn):
    arc = Arc((cr + 45, cz), radius, first, first + turn, "x")
    points = arc_points(arc)
    r, z = points.T
    volume = np.trapezoid(np.pi * r**2, z)
    steps = np.hypot(np.diff(r), np.diff(z))
    area = np.sum(np.pi * (r[1:] + r[:-1]) * steps)
    assert arc.swept() == pytest.approx(volume, rel=1e-5, abs=1e-3 * radius)
    assert arc.area() == pytest.approx(area, rel=1e-5)


@given(positive, coordinate, positive, coordinate)
def test_line_sweeps_a_truncated_cone(r0, z0, r1, z1):
    line = Line((r0, z0), (r1, z1), "x")
    share = np.linspace(0, 1, 2001)
    r = r0 + share * (r1 - r0)
    assert line.swept() == pytest.approx((z1 - z0) * np.trapezoid(np.pi * r**2, share), rel=1e-6, abs=1e-9)


@given(st.floats(0.1, 6.0), st.floats(-4, 4), st.floats(-30, 30), st.floats(-30, 30))
def test_distance_from_an_arc_is_the_least_distance_from_its_points(turn, first, x, y):
    arc = Arc((3.0, -2.0), 5.0, first, first + turn, "x")
    brute = np.min(np.hypot(*(arc_points(arc) - (x, y)).T))
    assert arc.distance(np.array([[x, y]]))[0] == pytest.approx(brute, abs=1e-2)


def test_arc_bounds_reach_the_quarter_points():
    assert Arc((1.0, 2.0), 3.0, -0.1, math.pi + 0.1, "x").bounds() == pytest.approx((-2, 4, 2 - 3 * math.sin(0.1), 5))


def hollow_hemisphere(inner: float, outer: float) -> Meridian:
    return Meridian(
        (
            Arc((0, 0), inner, math.pi / 2, 0, "inner"),
            Line((inner, 0), (outer, 0), "base"),
            Arc((0, 0), outer, 0, math.pi / 2, "outer"),
        )
    )


def test_hollow_hemisphere_has_its_textbook_volume():
    shell = hollow_hemisphere(9.25, 10.75)
    assert shell.volume() == pytest.approx(2 / 3 * math.pi * (10.75**3 - 9.25**3), rel=1e-14)
    assert -sum(piece.swept() for piece in shell.tagged("inner")) == pytest.approx(2 / 3 * math.pi * 9.25**3, rel=1e-14)


@pytest.mark.parametrize(
    "pieces",
    [
        (Line((1, 0), (2, 0), "a"), Line((2, 1), (1, 0), "b")),
        (Line((1, 0), (2, 0), "a"), Line((2, 0), (2, 1), "b")),
        (Line((2, 1), (2, 0), "a"), Line((2, 0), (1, 0), "b"), Line((1, 0), (1, 1), "c"), Line((1, 1), (2, 1), "d")),
    ],
    ids=["open between pieces", "open at the ends", "clockwise"],
)
def test_a_meridian_that_bounds_no_solid_is_refused(pieces):
    with pytest.raises(ValueError, match="meridian"):
        Meridian(pieces)


@given(st.floats(0.5, 100), st.floats(1e-3, 0.2))
def test_sampling_keeps_the_error_and_the_area_under_the_arc(radius, error):
    shell = hollow_hemisphere(radius, 1.2 * radius)
    rings = sample(shell, error)
    plane = np.array([(ring.radius, ring.height) for ring in rings])
    closed = np.vstack([plane, plane[:1]])
    share = np.linspace(0, 1, 9)[:, None, None]
    points = (closed[:-1] + share * (closed[1:] - closed[:-1])).reshape(-1, 2)
    off_axis = points[points[:, 0] > 1e-9]
    gap = np.min([piece.distance(off_axis) for piece in shell.pieces], axis=0)
    assert gap.max() <= error * (1 + 1e-9)
    area = 0.5 * np.sum(closed[:-1, 0] * closed[1:, 1] - closed[1:, 0] * closed[:-1, 1])
    exact = math.pi / 4 * (1.44 - 1) * radius**2
    lost = 2 / 3 * error * math.pi / 2 * 2.2 * radius  # what inscribed chords of the same sagitta would lose
    assert abs(area - exact) <= 0.05 * lost


def test_fewer_chords_are_needed_than_an_inscribed_polygon_takes():
    arc = Arc((0, 0), 10.0, 0, math.pi / 2, "x")
    inscribed = math.ceil((math.pi / 2) / (2 * math.acos(1 - 0.008 / 10)))
    assert chords(arc, 0.008) <= 0.85 * inscribed
