"""Where a quantity of a path passes a level between two of its points."""

from __future__ import annotations

import pytest

from pneutouch.mechanics.events import PathPoint, crossing


def cubic(x):
    return x**3 - 0.5 * x


def point(x):
    return PathPoint(x, cubic(x), 3 * x**2 - 0.5)


def test_with_slopes_the_crossing_is_that_of_the_cubic():
    found = crossing(point(0.6), point(1.4), cubic(1.1))
    assert found == pytest.approx(1.1, abs=1e-3 * 0.8)


def test_without_slopes_it_is_that_of_a_line():
    assert crossing(PathPoint(1.0, 2.0), PathPoint(3.0, 6.0), 3.0) == pytest.approx(1.5, abs=2e-3)


def test_a_level_that_is_not_passed_upwards_is_no_crossing():
    assert crossing(PathPoint(0.0, 2.0), PathPoint(1.0, 3.0), 3.5) is None
    assert crossing(PathPoint(0.0, 3.0), PathPoint(1.0, 2.0), 2.5) is None
    assert crossing(PathPoint(0.0, 3.0), PathPoint(0.0, 3.0), 2.5) == 0.0
