"""The trade-off: for each resin the greatest force range that goes with each sensitivity, at one driving pressure."""

from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array, Index
from pneutouch.selection.pool import CandidatePool, evaluated, joined, margins
from pneutouch.selection.problem import CandidateResin, SelectionProblem

_RATIOS, _RADII = 30, 18
_LEVELS = 64
_STEPS = (0.8, 0.4, 0.2, 0.1)
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
    u, v = np.meshgrid(np.linspace(0.0, 1.0, _RATIOS), np.linspace(0.0, 1.0, _RADII), indexing="ij")
    scan, count = np.stack([u.ravel(), v.ravel()]), len(problem.resins)
    places = [scan] * count
    pools = _pools(problem, places)
    around = np.array([(i, k) for i in (-1, 0, 1) for k in (-1, 0, 1) if (i, k) != (0, 0)], float).T
    for step in _STEPS:
        move = around * np.array([[step / (_RATIOS - 1)], [step / (_RADII - 1)]])
        near = [_near(where[:, _best(problem, pool)], move) for where, pool in zip(places, pools, strict=True)]
        if not any(where.size for where in near):
            break
        places = [np.concatenate(both, axis=1) for both in zip(places, near, strict=True)]
        pools = [joined(list(both)) for both in zip(pools, _pools(problem, near), strict=True)]
    return [_hull(problem, number, pool) for number, pool in enumerate(pools)]


def _near(best: Array, move: Array) -> Array:
    """Places around the best ones, (2, n), each once."""
    near = np.clip(best[:, :, None] + move[:, None, :], 0.0, 1.0).reshape(2, -1)
    return np.unique(near.round(6), axis=1)


def _pools(problem: SelectionProblem, places: list[Array]) -> list[CandidatePool]:
    """Each resin's candidates at its places from 0 to 1 of wall ratio and radius between their bounds, (2, n).

    All resins are pressed in one batch: a seventh of the calls of the atlas.
    """
    box, counts = problem.recipe, [where.shape[1] for where in places]
    along, across = np.concatenate(places, axis=1)
    ratio = box.thinnest * (box.thickest / box.thinnest) ** along
    low, high = problem.radii(ratio)
    # Where the size limit is smaller than the least wall needs, the candidate breaks a limit and is dropped as such.
    radius = low * (np.maximum(high, low) / low) ** across
    resin = np.repeat(np.arange(len(places), dtype=float), counts)
    pressure = np.full_like(ratio, problem.driving_pressure or 0.0)
    pool = evaluated(problem, resin, radius, ratio * radius, pressure)
    ends = np.cumsum(counts)
    return [pool.take(np.arange(end - count, end)) for end, count in zip(ends, counts, strict=True)]


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
