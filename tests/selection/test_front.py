"""The trade-off against a brute-force grid, and what a front is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from pneutouch.selection.candidates import evaluated, margins
from pneutouch.selection.front import front
from pneutouch.selection.problem import SelectionProblem
from tests.selection.targets import FINGERTIP, answer

WISHES = ("sensitivity", "force range", "stiffness")


@pytest.fixture(scope="module")
def problem() -> SelectionProblem:
    return answer(FINGERTIP).problem


def brute_force(problem: SelectionProblem, number: int, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Sensitivity and force of every allowed point of a grid over wall ratio and radius."""
    ratio = np.geomspace(problem.recipe.thinnest, problem.recipe.thickest, count)
    low, high = problem.radii(ratio)
    ratio, low, high = ratio[low <= high], low[low <= high], high[low <= high]
    radius = (low[:, None] * (high / low)[:, None] ** np.linspace(0, 1, count)).ravel()
    wall = np.repeat(ratio, count) * radius
    ones = np.ones_like(radius)
    pool = evaluated(problem, number * ones, radius, wall, problem.driving_pressure * ones)
    room = [margin for name, margin in margins(problem, pool).items() if name not in WISHES]
    good = np.min(room, axis=0) >= -1e-9
    return pool.response.lines.sensitivity[good], pool.force[good]


def shortfall(problem: SelectionProblem, number: int, count: int) -> float:
    """Greatest share of force that the grid has and the front lacks, at sensitivities over the whole front."""
    found = front(replace(problem, resins=problem.resins[number : number + 1]))[0]
    sensitivity, force = brute_force(problem, number, count)
    levels = np.geomspace(found.sensitivity[0], min(found.sensitivity[-1], sensitivity.max()) * 0.999, 25)
    reached = np.interp(np.log(levels), np.log(found.sensitivity), found.force)
    grid = np.array([force[sensitivity >= level].max() for level in levels])
    return float((1 - reached / grid).max())


def test_the_front_reaches_a_brute_force_grid(problem):
    number = next(i for i, resin in enumerate(problem.resins) if resin.name == "FLX9950")
    assert shortfall(problem, number, 60) < 0.01


@pytest.mark.slow
def test_every_resin_s_front_reaches_a_finer_grid(problem):
    short = {resin.name: shortfall(problem, i, 100) for i, resin in enumerate(problem.resins)}
    assert max(short.values()) < 0.015, short
    assert np.median(list(short.values())) < 0.01, short


def test_no_point_of_a_front_is_beaten_by_another(problem):
    for found in front(replace(problem, resins=problem.resins[:2])):
        assert np.all(np.diff(found.sensitivity) >= 0)
        assert np.all(np.diff(found.force) <= 0)
        assert np.all(2 * (found.radius + found.wall) <= 25.0 + 1e-6)
        assert np.all(found.wall >= problem.least_wall - 1e-9)


@pytest.mark.slow
def test_designs_lie_on_or_under_their_front(problem):
    found = answer(FINGERTIP).answer.designs
    fronts = {one.resin.name: one for one in front(problem)}
    for choice in found:
        one = fronts[choice.resin.name]
        sensitivity = float(choice.pool.response.lines.sensitivity[0])
        most = np.interp(np.log(sensitivity), np.log(one.sensitivity), one.force)
        assert float(choice.pool.force[0]) <= 1.01 * most


def test_a_room_too_small_for_the_least_wall_has_no_front(problem):
    assert all(one.sensitivity.size == 0 for one in front(replace(problem, max_diameter=3.0)))
