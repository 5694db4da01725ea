"""Candidates over all resins and all that is free: a coarse scan; the sensitivity met exactly along one direction."""

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.selection.pool import CandidatePool, evaluated, joined
from pneutouch.selection.problem import SelectionProblem
from pneutouch.selection.rated import rated

_RADII, _RATIOS, _PRESSURES = 8, 14, 6
"""Points of the scan in each free direction; the last free one, along which the sensitivity is met, gets `_LINE`."""
_LINE = 16
_POLISH = 4


@dataclass(frozen=True)
class CandidateGrid:
    """Candidates as a block, the last axis being the direction along which the sensitivity is met; (..., n) each."""

    resin: Array
    radius: Array
    wall: Array
    pressure: Array


def search(problem: SelectionProblem) -> CandidatePool | None:
    """Every candidate evaluated: the scan, and the points on it where the sensitivity is the target.

    None if no size is inside the bounds.
    """
    grid = scan(problem)
    if grid.radius.size == 0:
        return None
    coarse = evaluated(problem, *(part.ravel() for part in (grid.resin, grid.radius, grid.wall, grid.pressure)))
    if problem.sensitivity_kPa_per_N is None or grid.radius.shape[-1] < 2:
        return coarse
    exact = _met(problem, grid, coarse)
    return coarse if exact is None else joined([exact, coarse])


def scan(problem: SelectionProblem) -> CandidateGrid:
    """A coarse grid over resin and the free parameters, inside atlas range, size limit and the printer's least wall."""
    resins = np.arange(len(problem.resins), dtype=float)
    line = _RADII if problem.inner_radius is None else _LINE
    ratios = _ratios(problem, _RATIOS if problem.inner_radius is None else line)
    # axes: resin, pressure, wall, radius
    low, high = problem.radii(ratios)
    share = np.linspace(0.0, 1.0, _RADII if problem.inner_radius is None else 1)
    if problem.wall_thickness is not None and problem.inner_radius is None:
        radius = problem.wall_thickness / ratios[:, None]
    else:
        radius = low[:, None] * (np.maximum(high, low) / low)[:, None] ** share
        radius[high < low] = np.nan
    ratio = np.broadcast_to(ratios[:, None], radius.shape)
    keep = np.isfinite(radius).all(axis=1)
    radius, ratio = radius[keep], ratio[keep]
    if problem.wall_thickness is not None and problem.inner_radius is None:
        radius, ratio = radius.T, ratio.T
    pressures = _pressures(problem, resins, ratio, radius)
    shape = (resins.size, pressures.shape[1], *ratio.shape)
    resin = np.broadcast_to(resins[:, None, None, None], shape)
    radius, ratio = np.broadcast_to(radius, shape), np.broadcast_to(ratio, shape)
    blocks = [resin, radius, ratio * radius, np.broadcast_to(pressures, shape)]
    if ratio.shape[-1] == 1:
        # Nothing is free along the radius: the line runs along the wall, else along the pressure.
        axis = 2 if ratio.shape[2] > 1 else 1
        blocks = [np.moveaxis(block, axis, -1) for block in blocks]
    return CandidateGrid(*blocks)


def _ratios(problem: SelectionProblem, count: int) -> Array:
    box = problem.recipe
    if problem.inner_radius is not None and problem.wall_thickness is not None:
        return np.array([problem.wall_thickness / problem.inner_radius])
    low, high = box.thinnest, box.thickest
    if problem.inner_radius is not None:
        low = max(low, problem.least_wall / problem.inner_radius)
        if problem.max_diameter is not None:
            high = min(high, 0.5 * problem.max_diameter / problem.inner_radius - 1.0)
    if problem.wall_thickness is not None and problem.max_diameter is not None:
        low = max(low, problem.wall_thickness / (0.5 * problem.max_diameter - problem.wall_thickness))
    return np.geomspace(low, high, count) if low < high else np.zeros(0)


def _pressures(problem: SelectionProblem, resins: Array, ratio: Array, radius: Array) -> Array:
    """Driving pressures over (resin, pressure, wall, radius): the one given, or shares of each rated pressure."""
    if problem.driving_pressure is not None:
        return np.full((resins.size, 1, *ratio.shape), problem.driving_pressure)
    alone = problem.inner_radius is not None and problem.wall_thickness is not None
    shares = np.linspace(0.0, 1.0, _LINE if alone else _PRESSURES)
    flat, wall = radius.ravel(), (ratio * radius).ravel()
    top = np.array([rated(problem, np.full(flat.size, number), flat, wall).reshape(ratio.shape) for number in resins])
    return np.asarray(shares[:, None, None] * top[:, None])


def _met(problem: SelectionProblem, grid: CandidateGrid, coarse: CandidatePool) -> CandidatePool | None:
    """Points between neighbours of the scan where the sensitivity passes the target; None if it never does."""
    assert problem.sensitivity_kPa_per_N is not None
    off = _log_ratio(problem.sensitivity_kPa_per_N, coarse).reshape(grid.radius.shape)
    with np.errstate(invalid="ignore"):
        passes = off[..., :-1] * off[..., 1:] <= 0.0
    where = np.nonzero(passes)
    if where[0].size == 0:
        return None
    after = (*where[:-1], where[-1] + 1)
    ends = [(part[where], part[after]) for part in (grid.radius, grid.wall, grid.pressure)]
    resin, low, high = grid.resin[where], off[where], off[after]
    left, right = np.zeros(low.size), np.ones(low.size)
    share = left
    for _ in range(_POLISH):
        share = left + (right - left) * np.clip(low / np.where(low == high, 1.0, low - high), 0.02, 0.98)
        radius, wall, pressure = (_between(a, b, share) for a, b in ends)
        pool = evaluated(problem, resin, radius, wall, pressure)
        here = np.nan_to_num(_log_ratio(problem.sensitivity_kPa_per_N, pool))
        same = here * low > 0.0
        left, right = np.where(same, share, left), np.where(same, right, share)
        low, high = np.where(same, here, 0.5 * low), np.where(same, 0.5 * high, here)
    return pool


def _log_ratio(target_kPa_per_N: float, pool: CandidatePool) -> Array:
    """Logarithm of the sensitivity over the target; NaN without a sensitivity."""
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.log(pool.response.lines.sensitivity_kPa_per_N / target_kPa_per_N))


def _between(a: Array, b: Array, share: Array) -> Array:
    """Geometric where both are positive, for sizes; straight for pressures that start at zero."""
    if np.all(a > 0) and np.all(b > 0):
        return np.asarray(a * (b / a) ** share)
    return np.asarray(a + share * (b - a))
