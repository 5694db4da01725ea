"""The trade-off: for each resin the greatest force range that is possible at each sensitivity, at one driving pressure.

The trade-off under a contact that the atlas does not cover: the atlas's fronts corrected by the solid along them.

Each round draws the fronts with the factors found so far (`ContactFactors`) and solves a few places of each front.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array, Index
from pneutouch.mechanics.corrected.designs import ContactFactors
from pneutouch.selection.candidates import CandidatePool, evaluated, joined, margins
from pneutouch.selection.contact_search import ContactTrial, SolveCandidate, tried
from pneutouch.selection.problem import CandidateResin, SelectionProblem

_RATIOS, _RADII = 46, 8
"""Numbers of wall ratios and radii in the scan. For the README's target the fronts are then at most 1.0 % below a
brute-force grid in force; with 44 wall ratios 1.2 %."""
_FINER = (6, 24)
"""Parts that each cell of the scan is cut into, along wall ratio and radius, to interpolate in it."""
_LEVELS = 48
_STEPS = (0.35, 0.12)
"""Width of each closer look around the best so far, in steps of the scan along the wall ratio."""
_ALONG_RADIUS = 0.5
"""Width of each closer look along the radius, over that along the wall ratio."""
_REQUIREMENTS = ("sensitivity", "force range", "stiffness")


class TradeOffFront(NamedTuple):
    """One resin's front in order of sensitivity: kPa/N, N, radius and wall of the dome, mm; (n,) each, may be empty."""

    resin: CandidateResin
    sensitivity: Array
    force: Array
    radius: Array
    wall: Array


def front(problem: SelectionProblem) -> list[TradeOffFront]:
    """Fronts of all resins at the problem's driving pressure (zero if none is given), inside every limit.

    No point of a front has both more sensitivity and more force than another. First a scan over wall ratio and radius
    on a plate without edge, where the figures are smooth. Interpolated in it, for many levels of sensitivity, the place
    of most force that is at least so sensitive and stays on the plate. Then closer looks around the best. Ends of
    ranges jump with the dimensions, so that no slope could be followed; each candidate of a front is evaluated.
    """
    u, v = np.meshgrid(np.linspace(0.0, 1.0, _RATIOS), np.linspace(0.0, 1.0, _RADII), indexing="ij")
    scan = np.stack([u.ravel(), v.ravel()])
    places, pools, near = [], [], []
    for pool in _pools(replace(problem, plate_radius=np.inf), [scan] * len(problem.resins)):
        on_plate = _plate_margin(problem, pool)
        near.append(_between(problem, pool, on_plate))
        places.append(scan[:, on_plate >= 0.0])
        pools.append(pool.take(on_plate >= 0.0))
    for step in (*_STEPS, None):
        if not any(where.size for where in near):
            break
        places = [np.concatenate(both, axis=1) for both in zip(places, near, strict=True)]
        pools = [joined(list(both)) for both in zip(pools, _pools(problem, near), strict=True)]
        if step is not None:
            near = [_near(problem, where, pool, step) for where, pool in zip(places, pools, strict=True)]
    return [_hull(problem, number, pool) for number, pool in enumerate(pools)]


def _plate_margin(problem: SelectionProblem, pool: CandidatePool) -> Array:
    """Logarithm of the radius at which the plate ends over the contact's at the end of the range, -1 to 1; (n,)."""
    flat = problem.batch(pool.resin, pool.radius, pool.wall, pool.pressure).flat_radius * pool.radius
    with np.errstate(divide="ignore"):
        margin = np.log(flat / pool.response.contact_radius)
    return np.asarray(np.clip(np.nan_to_num(margin, nan=-1.0), -1.0, 1.0))


def _between(problem: SelectionProblem, pool: CandidatePool, on_plate: Array) -> Array:
    """Places (2, n) of most force at each level of sensitivity, by linear interpolation in the scan of one resin."""
    with np.errstate(divide="ignore", invalid="ignore"):
        logs, forces = np.log(pool.response.lines.sensitivity), np.log(pool.force)
    logs, forces, limits, plate = (
        _finer(values.reshape(_RATIOS, _RADII))
        for values in (logs, forces, np.clip(_least_margin(problem, pool), -1.0, 1.0), on_plate)
    )
    u, v = np.meshgrid(*(np.linspace(0.0, 1.0, n) for n in logs.shape), indexing="ij")
    good = np.isfinite(logs) & np.isfinite(forces) & (limits >= 0.0) & (plate >= 0.0)
    best = np.unique(_best(logs[good], forces[good])[0])
    return np.stack([u[good][best], v[good][best]]).round(6)


def _finer(values: Array) -> Array:
    """Values on a grid, interpolated in its cells; NaN in a cell with a NaN corner, except on the grid's points."""
    for finer in _FINER:
        x = np.linspace(0.0, len(values) - 1, (len(values) - 1) * finer + 1)
        at = np.minimum(x.astype(np.intp), len(values) - 2)
        share = (x - at)[:, None]
        with np.errstate(invalid="ignore"):
            between = (1.0 - share) * values[at] + share * values[at + 1]
        values = np.where(share == 0.0, values[at], between).T
    return values


def _near(problem: SelectionProblem, places: Array, pool: CandidatePool, step: float) -> Array:
    """Places (2, n) around the best candidates of one resin, each once; ``step`` in steps of the scan."""
    good = np.flatnonzero(_least_margin(problem, pool) >= 0.0)
    logs = np.log(pool.response.lines.sensitivity[good])
    rows, levels = _best(logs, np.log(pool.force[good]))
    u, v = places[:, good[rows]]
    across, along = step / (_RATIOS - 1), step * _ALONG_RADIUS / (_RADII - 1)
    moved = [(u + a * across, v + b * along) for a, b in ((-1, 0), (1, 0), (0, -1), (0, 1))]
    # Of one wall ratio the sensitivity falls nearly with the square of the radius: so the level is met.
    radius = pool.radius[good[rows]] * np.exp(0.5 * (logs[rows] - levels))
    for ratio_at in (u - across, u, u + across):
        low, high = _bounds(problem, _ratio(problem, np.clip(ratio_at, 0.0, 1.0)))
        share = np.log(radius / low) / np.log(np.maximum(high / low, 1.0 + 1e-12))
        moved.append((ratio_at, share))
    near: Array = np.clip(np.concatenate(moved, axis=1), 0.0, 1.0).round(6)
    return np.unique(near, axis=1)


def _pools(problem: SelectionProblem, places: list[Array]) -> list[CandidatePool]:
    """Candidates of each resin at its ``places`` (2, n): shares, 0 to 1, of the spans of wall ratio and radius.

    All resins are pressed in one batch: a seventh of the calls of the atlas.
    """
    counts = [where.shape[1] for where in places]
    along, across = np.concatenate(places, axis=1)
    ratio = _ratio(problem, along)
    low, high = _bounds(problem, ratio)
    radius = low * (high / low) ** across
    resin = np.repeat(np.arange(len(places), dtype=float), counts)
    pressure = np.full_like(ratio, problem.driving_pressure or 0.0)
    pool = evaluated(problem, resin, radius, ratio * radius, pressure)
    ends = np.cumsum(counts)
    return [pool.take(np.arange(end - count, end)) for end, count in zip(ends, counts, strict=True)]


def _ratio(problem: SelectionProblem, along: Array) -> Array:
    """Wall ratios (n,) at shares (n,), 0 to 1, of the atlas's span."""
    box = problem.recipe
    return np.asarray(box.thinnest * (box.thickest / box.thinnest) ** along)


def _bounds(problem: SelectionProblem, ratio: Array) -> tuple[Array, Array]:
    """Least and greatest radius (n,) for wall ratios (n,), mm."""
    low, high = problem.radii(ratio)
    # Where the size limit is smaller than the least wall needs, the candidate breaks a limit and is dropped as such.
    return low, np.maximum(high, low)


def _least_margin(problem: SelectionProblem, pool: CandidatePool) -> Array:
    """Least margin (n,) to a limit, requirements left out, with an allowance for the rounding of the bounds."""
    rest = [margin for name, margin in margins(problem, pool).items() if name not in _REQUIREMENTS]
    return np.asarray(np.min(rest, axis=0) + 1e-9)


def _best(logs: Array, forces: Array) -> tuple[Index, Array]:
    """Rows in even steps along the front of points, and the level that each stands for.

    ``logs`` and ``forces`` are the logarithms of sensitivities and forces. A row has the most force of those at least
    as sensitive as its level. Returns (few,) each; empty without points.
    """
    rows = _unbeaten(np.stack([logs, forces]))
    if rows.size == 0:
        return rows, logs
    length = logs[rows[0]] - logs[rows] + forces[rows] - forces[rows[0]]
    steps = np.linspace(0.0, length[-1], _LEVELS)
    last = np.searchsorted(length, steps, side="right") - 1
    return rows[last], np.interp(steps, length, logs[rows])


def _unbeaten(points: Array) -> Index:
    """Indices of the points (2, n) that no other exceeds in both coordinates, in falling order of the first."""
    first, second = points
    rows = np.argsort(-first, kind="stable")
    before = np.maximum.accumulate(np.concatenate([[-np.inf], second[rows]]))[:-1]
    return np.asarray(rows[second[rows] > before])


def _hull(problem: SelectionProblem, number: int, pool: CandidatePool) -> TradeOffFront:
    """Front of the candidates of resin ``number`` that meet every limit and that no other beats in both figures."""
    good = np.flatnonzero(_least_margin(problem, pool) >= 0.0)
    sensitivity = pool.response.lines.sensitivity
    rows = good[_unbeaten(np.stack([sensitivity, pool.force])[:, good])][::-1]
    return TradeOffFront(
        problem.resins[number], sensitivity[rows], pool.force[rows], pool.radius[rows], pool.wall[rows]
    )


_SHARES = ((0.0, 0.5, 1.0), (0.25, 0.75), (0.125, 0.375, 0.625, 0.875))
"""Places that each round solves on the front of each resin, from the least sensitive to the most, in even steps of the
logarithms of sensitivity and force."""

_NEAR = 0.01
"""A front that was nearer to the solid than this at all places of a round is not solved in the next one."""


class ContactFronts(NamedTuple):
    """Fronts, and errors of the fronts of the round before at the places that the solid solves next, from round two on.

    For each place the larger relative difference of sensitivity and force counts: the median and the greatest of all,
    NaN if there is none. ``presses`` is the number of places solved.
    """

    fronts: list[TradeOffFront]
    median_error: float
    greatest_error: float
    presses: int


def contact_front(problem: SelectionProblem, solve: SolveCandidate) -> ContactFronts:
    """`front` corrected by the solid for its contact; a place that the solid cannot answer corrects nothing."""
    factors, fronts = ContactFactors.none(), _fronts(problem, ContactFactors.none())
    open_, errors, presses = list(range(len(fronts))), [], 0
    for count, shares in enumerate(_SHARES):
        trials, far = [], []
        for number in open_:
            one = fronts[number]
            solved = [(row, tried(problem, place(problem, number, one, row), solve)) for row in _spread(one, shares)]
            off = [_off(one, row, trial) for row, trial in solved if not trial.why]
            trials += [trial for _, trial in solved]
            errors += off if count else []
            if count == 0 or max(off, default=0.0) > _NEAR:
                far.append(number)
        presses += len(trials)
        for trial in trials:
            factors = trial.added_to(factors)
        open_, fronts = far, _fronts(problem, factors)
    median, greatest = (float(np.median(errors)), max(errors)) if errors else (np.nan, np.nan)
    return ContactFronts(fronts, median, greatest, presses)


def _off(one: TradeOffFront, row: int, trial: ContactTrial) -> float:
    """The larger relative difference of sensitivity and force between a place of a front and the solid there."""
    exact = trial.pool.figures
    return float(max(abs(one.sensitivity[row] / exact.sensitivity - 1.0), abs(one.force[row] / exact.reach - 1.0)))


def _fronts(problem: SelectionProblem, factors: ContactFactors) -> list[TradeOffFront]:
    return front(replace(problem, factors=factors if len(factors.places) else None))


def _spread(one: TradeOffFront, shares: tuple[float, ...]) -> Index:
    """Rows at these shares of a front's length, each once; empty for an empty front."""
    if one.force.size == 0:
        return np.zeros(0, dtype=np.intp)
    steps = np.hypot(np.diff(np.log(one.sensitivity)), np.diff(np.log(one.force)))
    along = np.concatenate([[0.0], np.cumsum(steps)])
    return np.unique([np.abs(along - share * along[-1]).argmin() for share in shares])


def place(problem: SelectionProblem, number: int, one: TradeOffFront, row: int) -> CandidatePool:
    """The point in ``row`` of a front as a candidate, by the atlas only; ``number`` is that of its resin."""
    pressure = np.array([problem.driving_pressure or 0.0])
    radius, wall = one.radius[[row]], one.wall[[row]]
    return evaluated(replace(problem, factors=None), np.array([float(number)]), radius, wall, pressure)
