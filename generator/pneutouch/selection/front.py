"""The trade-off: for each resin the greatest force range that goes with each sensitivity, at one driving pressure."""

from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array, Index
from pneutouch.selection.pool import CandidatePool, evaluated, joined, margins
from pneutouch.selection.problem import CandidateResin, SelectionProblem

_RATIOS, _RADII = 36, 20
_LEVELS = 64
_STEPS = (0.8, 0.5, 0.3, 0.15, 0.07)
"""How far each closer look goes from the best so far, in steps of the scan."""
_REQUIREMENTS = ("sensitivity", "force range", "stiffness")


class TradeOffFront(NamedTuple):
    """One resin's trade-off in order of sensitivity: kPa/N, N, and the dome it takes, mm; (n,) each, maybe none."""

    resin: CandidateResin
    sensitivity_kPa_per_N: Array
    force: Array
    radius: Array
    wall: Array


def front(problem: SelectionProblem) -> list[TradeOffFront]:
    """Fronts of all resins at the problem's driving pressure (none given: no pressure), inside every limit.

    No point of a front has both more sensitivity and more force than another. A scan over wall ratio and radius; then,
    at each of many levels, closer and closer looks around the candidate of most force that is at least so sensitive.
    Ends of ranges jump with the dimensions, so that no slope could be followed.
    """
    return [_of(problem, number) for number in range(len(problem.resins))]


def _of(problem: SelectionProblem, number: int) -> TradeOffFront:
    u, v = np.meshgrid(np.linspace(0.0, 1.0, _RATIOS), np.linspace(0.0, 1.0, _RADII), indexing="ij")
    places = np.stack([u.ravel(), v.ravel()])
    pool = _pool(problem, number, places)
    around = np.array([(i, k) for i in (-1, 0, 1) for k in (-1, 0, 1) if (i, k) != (0, 0)], float).T
    for step in _STEPS:
        best = _best(problem, pool)
        if best.size == 0:
            break
        move = around * np.array([[step / (_RATIOS - 1)], [step / (_RADII - 1)]])
        near = np.clip(places[:, best, None] + move[:, None, :], 0.0, 1.0).reshape(2, -1)
        near = np.unique(near.round(6), axis=1)
        places, pool = np.concatenate([places, near], axis=1), joined([pool, _pool(problem, number, near)])
    return _hull(problem, number, pool)


def _pool(problem: SelectionProblem, number: int, places: Array) -> CandidatePool:
    """Candidates at places from 0 to 1 of the wall ratio and of the radius between their bounds, (2, n)."""
    box = problem.recipe
    ratio = box.thinnest * (box.thickest / box.thinnest) ** places[0]
    low, high = problem.radii(ratio)
    # Where the size limit is smaller than the least wall needs, the candidate breaks a limit and is dropped as such.
    radius = low * (np.maximum(high, low) / low) ** places[1]
    ones = np.ones_like(ratio)
    return evaluated(problem, number * ones, radius, ratio * radius, (problem.driving_pressure or 0.0) * ones)


def _least_margin(problem: SelectionProblem, pool: CandidatePool) -> Array:
    """Least margin to a limit, up to the rounding of the bound's own computation."""
    rest = [margin for name, margin in margins(problem, pool).items() if name not in _REQUIREMENTS]
    return np.asarray(np.min(rest, axis=0) + 1e-9)


def _best(problem: SelectionProblem, pool: CandidatePool) -> Index:
    """At each level the candidate of most force that is at least so sensitive and keeps every limit, (few,)."""
    good = np.flatnonzero(_least_margin(problem, pool) >= 0.0)
    if good.size == 0:
        return good
    good = good[np.argsort(-pool.response.lines.sensitivity_kPa_per_N[good], kind="stable")]
    logs, force = np.log(pool.response.lines.sensitivity_kPa_per_N[good]), pool.force[good]
    last = np.searchsorted(-logs, -np.linspace(logs[0], logs[-1], _LEVELS), side="right") - 1
    leader = np.maximum.accumulate(force)
    return np.unique(good[np.searchsorted(leader, leader)[last]])


def _hull(problem: SelectionProblem, number: int, pool: CandidatePool) -> TradeOffFront:
    """Candidates that meet every limit, without those that another beats in both."""
    rows = np.flatnonzero(_least_margin(problem, pool) >= 0.0)
    rows = rows[np.argsort(-pool.response.lines.sensitivity_kPa_per_N[rows], kind="stable")]
    force = pool.force[rows]
    rows = rows[force > np.maximum.accumulate(np.concatenate([[-np.inf], force[:-1]]))][::-1] if rows.size else rows
    lines = pool.response.lines
    return TradeOffFront(
        problem.resins[number], lines.sensitivity_kPa_per_N[rows], pool.force[rows], pool.radius[rows], pool.wall[rows]
    )
