"""Candidates over all resins: a coarse scan, figures and rated pressures, and the margin to every limit."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array, Flags, Index, distinct
from pneutouch.mechanics.atlas.respond import BREAK, EDGE, OUTSIDE, AtlasResponse, respond
from pneutouch.mechanics.rating import RATED_SHARE, rated_pressure
from pneutouch.mechanics.response import Figures
from pneutouch.selection.problem import SelectionProblem, least_limit
from pneutouch.spec.fields import declaration
from pneutouch.spec.membrane_table import Membrane


def rated(problem: SelectionProblem, resin: Array, radius: Array, wall: Array) -> Array:
    """Rated pressures (n,) of candidates, MPa, by number of the resin in the problem, radius and wall, mm, (n,) each.

    Without a known spread the limits count as designed.
    """
    batch = problem.batch(resin, radius, wall, np.zeros_like(radius))
    limit = batch.shear_modulus * least_limit(batch.wall_ratio, batch.break_stretch)
    spread = np.zeros_like(limit)
    if problem.limit_spread is not None:
        for number in distinct(resin):
            rows = resin == number
            spread[rows] = problem.limit_spread(problem.resins[int(number)], batch.take(rows))
    return rated_pressure(limit, spread, batch.gauge_limit)


REQUIREMENTS = ("sensitivity", "force range", "stiffness", "outer diameter", "footprint", "rated pressure")
"""Requirements of a user, who may drop any; the rated pressure bounds the driving pressure."""


class CandidatePool(NamedTuple):
    """Candidates, (n,) each: number of the resin, radius and wall in mm, driving pressure in MPa, and response."""

    resin: Array
    radius: Array
    wall: Array
    pressure: Array
    response: AtlasResponse

    def take(self, rows: Index | Flags) -> "CandidatePool":
        """The candidates in these rows."""
        return CandidatePool(
            self.resin[rows], self.radius[rows], self.wall[rows], self.pressure[rows], self.response.take(rows)
        )

    @property
    def figures(self) -> Figures[float]:
        """Figures of the first, often the only, candidate of the pool."""
        return Figures(*(float(column[0]) for column in self.response.lines))

    @property
    def force(self) -> Array:
        """Force (n,) that the range reaches, N: at its end, or where the slope has halved before."""
        return self.response.lines.reach


def evaluated(problem: SelectionProblem, resin: Array, radius: Array, wall: Array, pressure: Array) -> CandidatePool:
    """Candidates with their responses from the atlas, corrected by the factors of the problem if it has any."""
    batch = problem.batch(resin, radius, wall, pressure)
    response = respond(batch, problem.steps, problem.atlas)
    if problem.factors is not None:
        response = problem.factors.corrected(batch, response)
    return CandidatePool(resin, radius, wall, pressure, response)


def joined(pools: list[CandidatePool]) -> CandidatePool:
    """Several pools as one."""
    resin, radius, wall, pressure = (
        np.concatenate(column) for column in zip(*((p.resin, p.radius, p.wall, p.pressure) for p in pools), strict=True)
    )
    return CandidatePool(resin, radius, wall, pressure, AtlasResponse.join([pool.response for pool in pools]))


def margins(problem: SelectionProblem, pool: CandidatePool) -> dict[str, Array]:
    """Relative margin to each limit, (n,) each: negative where it is broken, -inf where it is unknown.

    Requirements: sensitivity (1 on the spot, 0 at the tolerance), force range, stiffness, outer diameter, footprint.
    Limits: limit point (to RATED_SHARE of it), rated pressure, break strain, gauge range (at the required force),
    printable wall, plate (the contact stays off its edge), connector (space for its parts).
    """
    lines, margin_of = pool.response.lines, {}
    if problem.sensitivity is not None:
        margin_of["sensitivity"] = 1.0 - np.abs(lines.sensitivity / problem.sensitivity - 1.0) / problem.tolerance
    if problem.force_range is not None:
        margin_of["force range"] = pool.force / problem.force_range - 1.0
    least, most = problem.stiffness
    if least is not None or most is not None:
        stiffness = lines.stiffness_at(problem.stiffness_depth)
        with np.errstate(divide="ignore"):
            margin_of["stiffness"] = np.minimum(
                np.inf if least is None else stiffness / least - 1.0, np.inf if most is None else most / stiffness - 1.0
            )
    if problem.max_diameter is not None:
        margin_of["outer diameter"] = problem.max_diameter / (2.0 * (pool.radius + pool.wall)) - 1.0
    margin_of |= _limits(problem, pool)
    if problem.limit_spread is not None:
        with np.errstate(divide="ignore"):
            margin_of["rated pressure"] = rated(problem, pool.resin, pool.radius, pool.wall) / pool.pressure - 1.0
    margin_of |= _connector(problem, pool)
    known = np.isfinite(lines.sensitivity) & (pool.response.ends != OUTSIDE)
    return {
        name: np.where(known & np.isfinite(margin) | (known & (margin > 0)), margin, -np.inf)
        for name, margin in margin_of.items()
    }


def _limits(problem: SelectionProblem, pool: CandidatePool) -> dict[str, Array]:
    strain = np.array([resin.break_stretch for resin in problem.resins])[pool.resin.astype(np.intp)] - 1.0
    with np.errstate(divide="ignore", invalid="ignore"):
        break_margin = strain / (pool.response.max_stretch - 1.0) - 1.0
        return {
            "limit point": RATED_SHARE * pool.response.limit_pressure / pool.pressure - 1.0,
            # A range that ends by the break strain ends on it, to the rounding of that end.
            "break strain": np.where(pool.response.ends == BREAK, np.maximum(break_margin, 0.0), break_margin),
            "gauge range": (problem.gauge_limit - pool.pressure) / _rise(problem, pool) - 1.0,
            "printable wall": pool.wall / problem.least_wall - 1.0 + 1e-9,
            "plate": np.where(
                pool.response.ends == EDGE, pool.response.range_end / (problem.depth_share * pool.radius) - 1.0, np.inf
            ),
        }


def _connector(problem: SelectionProblem, pool: CandidatePool) -> dict[str, Array]:
    """Margins of the connector, which is drawn once for each size of the dome; empty if the problem has none."""
    if problem.connector is None:
        return {}
    sizes, number = np.unique(np.stack([pool.radius, pool.wall]), axis=1, return_inverse=True)
    fit = problem.connector(sizes[0], sizes[1])
    # Space that is there is enough: more of it makes no better sensor.
    margin_of = {"connector": np.where(fit.margin < 0.0, fit.margin, np.inf)[number]}
    if problem.max_footprint is not None:
        margin_of["footprint"] = (problem.max_footprint / fit.diameter - 1.0 + 1e-9)[number]
    return margin_of


def _rise(problem: SelectionProblem, pool: CandidatePool) -> Array:
    """Pressure rise (n,) at the required force, or at the end of a shorter range; zero without a required force."""
    force, rise = pool.response.force, pool.response.rise
    if problem.force_range is None:
        return np.zeros(force.shape[0])
    after = np.clip((force < problem.force_range).sum(axis=1), 1, force.shape[1] - 1)
    rows = np.arange(force.shape[0])
    low, high = force[rows, after - 1], force[rows, after]
    share = np.clip((problem.force_range - low) / (high - low), 0.0, 1.0)
    return np.asarray(rise[rows, after - 1] + share * (rise[rows, after] - rise[rows, after - 1]))


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
    """Every candidate evaluated: the scan, and the points between its points where the sensitivity is the target.

    None if no size is inside the bounds.
    """
    grid = scan(problem)
    if grid.radius.size == 0:
        return None
    coarse = evaluated(problem, *(part.ravel() for part in (grid.resin, grid.radius, grid.wall, grid.pressure)))
    if problem.sensitivity is None or grid.radius.shape[-1] < 2:
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


_STARTS, _HALVINGS, _FIRST_STEP = 6, 12, 0.15
"""Number of candidates of each resin to start from, number of times the step is halved, and the first step: in the
logarithms of radius and wall, and in rated pressures."""


_RADIUS = declaration(Membrane, "inner_radius_mm")
_ENOUGH = 0.02
"""Margin kept for the rounding to a hundredth of a millimetre, if there is as much."""


def nearer(problem: SelectionProblem, pool: CandidatePool) -> CandidatePool:
    """Candidates of a scan improved by steps to the best neighbour: they meet the limits, or break them less.

    A scan has no point in every corner of what is possible, such as the least wall at the greatest diameter. The steps
    start at several candidates of each resin, and are halved where no neighbour is better.
    """
    rows = _best_of_each(problem, pool)
    if not rows.size:
        return pool
    here = pool.take(rows)
    moves = _moves(problem)
    step = np.full(rows.size, _FIRST_STEP)
    top = rated(problem, here.resin, here.radius, here.wall)
    for _ in range(2 * _HALVINGS):
        by = step[:, None, None] * moves
        radius, wall = here.radius[:, None] * np.exp(by[..., 0]), here.wall[:, None] * np.exp(by[..., 1])
        pressure = np.maximum(here.pressure[:, None] + by[..., 2] * top[:, None], 0.0)
        # Onto the limits, on which the best lies more often than not.
        if problem.wall_thickness is None:
            wall = np.maximum(wall, problem.least_wall)
        if problem.inner_radius is None:
            largest = np.inf if problem.max_diameter is None else np.maximum(0.5 * problem.max_diameter - wall, wall)
            radius = np.minimum(np.clip(radius, _RADIUS.low, _RADIUS.high), largest)
        resin = np.broadcast_to(here.resin[:, None], radius.shape)
        around = evaluated(problem, *(part.ravel() for part in (resin, radius, wall, pressure)))
        worst = _worst(problem, around).reshape(radius.shape)
        best = worst.argmax(axis=1)
        here = around.take(np.arange(rows.size) * len(moves) + best)
        if (worst.max(axis=1) >= _ENOUGH).any():
            break
        step = np.where(best == 0, 0.5 * step, step)
    return _round_sizes(problem, here)


def _round_sizes(problem: SelectionProblem, pool: CandidatePool) -> CandidatePool:
    """Candidates, and with each the 25 sizes around it in hundredths of a millimetre."""
    by = 0.01 * np.arange(-2.0, 3.0)
    radius, wall = (
        np.clip(np.round(pool.radius, 2)[:, None, None] + by, _RADIUS.low, _RADIUS.high),
        np.round(pool.wall, 2)[:, None, None] + by[:, None],
    )
    if problem.wall_thickness is not None:
        wall = np.full((1, 1, 1), problem.wall_thickness)
    if problem.inner_radius is not None:
        radius = np.full((1, 1, 1), problem.inner_radius)
    elif problem.max_diameter is not None:
        radius = np.minimum(radius, 0.01 * np.floor(50.0 * problem.max_diameter - 100.0 * wall + 1e-6))
    parts = np.broadcast_arrays(pool.resin[:, None, None], radius, wall, pool.pressure[:, None, None])
    return joined([pool, evaluated(problem, *(part.ravel() for part in parts))])


def _moves(problem: SelectionProblem) -> Array:
    """Steps (m, 3) to all neighbours in radius, wall and pressure, as far as these are free, after none at all."""
    fixed = (problem.inner_radius, problem.wall_thickness, problem.driving_pressure)
    sides = [(0.0,) if value is not None else (0.0, -1.0, 1.0) for value in fixed]
    return np.array(np.meshgrid(*sides, indexing="ij")).reshape(3, -1).T


def _worst(problem: SelectionProblem, pool: CandidatePool) -> Array:
    """The least margin of each candidate, (n,)."""
    return np.asarray(np.min(list(margins(problem, pool).values()), axis=0))


def _best_of_each(problem: SelectionProblem, pool: CandidatePool) -> Index:
    worst = _worst(problem, pool)
    order = np.argsort(-worst, kind="stable")
    order = order[np.isfinite(worst[order])]
    return np.concatenate([order[pool.resin[order] == resin][:_STARTS] for resin in distinct(pool.resin)])


def _ratios(problem: SelectionProblem, count: int) -> Array:
    box = problem.recipe
    if problem.inner_radius is not None and problem.wall_thickness is not None:
        return np.array([problem.wall_thickness / problem.inner_radius])
    low, high = box.thinnest, box.thickest
    if problem.max_diameter is not None and problem.inner_radius is None and problem.wall_thickness is None:
        # The least wall at the greatest diameter: no smaller ratio has a size.
        low = max(low, problem.least_wall / max(0.5 * problem.max_diameter - problem.least_wall, 1e-9))
    if problem.inner_radius is not None:
        low = max(low, problem.least_wall / problem.inner_radius)
        if problem.max_diameter is not None:
            high = min(high, 0.5 * problem.max_diameter / problem.inner_radius - 1.0)
    if problem.wall_thickness is not None and problem.max_diameter is not None:
        low = max(low, problem.wall_thickness / (0.5 * problem.max_diameter - problem.wall_thickness))
    return np.geomspace(low, high, count) if low < high else np.zeros(0)


def _pressures(problem: SelectionProblem, resins: Array, ratio: Array, radius: Array) -> Array:
    """Driving pressures with axes resin, pressure, wall, radius: the one given, or shares of each rated pressure."""
    if problem.driving_pressure is not None:
        return np.full((resins.size, 1, *ratio.shape), problem.driving_pressure)
    alone = problem.inner_radius is not None and problem.wall_thickness is not None
    shares = np.linspace(0.0, 1.0, _LINE if alone else _PRESSURES)
    flat, wall = radius.ravel(), (ratio * radius).ravel()
    top = np.array([rated(problem, np.full(flat.size, number), flat, wall).reshape(ratio.shape) for number in resins])
    return np.asarray(shares[:, None, None] * top[:, None])


def _met(problem: SelectionProblem, grid: CandidateGrid, coarse: CandidatePool) -> CandidatePool | None:
    """Points between neighbours of the scan where the sensitivity passes the target; None if it never does."""
    assert problem.sensitivity is not None
    off = _log_ratio(problem.sensitivity, coarse).reshape(grid.radius.shape)
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
        here = np.nan_to_num(_log_ratio(problem.sensitivity, pool))
        same = here * low > 0.0
        left, right = np.where(same, share, left), np.where(same, right, share)
        low, high = np.where(same, here, 0.5 * low), np.where(same, 0.5 * high, here)
    return pool


def _log_ratio(target_kPa_per_N: float, pool: CandidatePool) -> Array:
    """Logarithm of the sensitivity over the target; NaN without a sensitivity."""
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.log(pool.response.lines.sensitivity / target_kPa_per_N))


def _between(a: Array, b: Array, share: Array) -> Array:
    """Geometric interpolation where both ends are positive (sizes), else linear (pressures that start at zero)."""
    if np.all(a > 0) and np.all(b > 0):
        return np.asarray(a * (b / a) ** share)
    return np.asarray(a + share * (b - a))
