"""Candidates with their predicted figures, and how far each is inside or outside every limit."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array, Flags, Index
from pneutouch.mechanics.atlas.respond import BREAK, EDGE, OUTSIDE, AtlasResponse, respond
from pneutouch.mechanics.limits import RATED_SHARE
from pneutouch.selection.problem import SelectionProblem
from pneutouch.selection.rated import rated

REQUIREMENTS = ("sensitivity", "force range", "stiffness", "outer diameter", "footprint", "rated pressure")
"""Requirements of a user, who may drop any; the rated pressure stands for the driving pressure that must not be above
it."""


class CandidatePool(NamedTuple):
    """Candidates, (n,) each: number of the resin, mm, MPa, and the response."""

    resin: Array
    radius: Array
    wall: Array
    pressure: Array
    response: AtlasResponse

    def take(self, rows: Index | Flags) -> CandidatePool:
        """Some of the candidates."""
        return CandidatePool(
            self.resin[rows], self.radius[rows], self.wall[rows], self.pressure[rows], self.response.take(rows)
        )

    @property
    def force(self) -> Array:
        """Force that the range reaches: at its end, or where the slope has halved before."""
        lines = self.response.lines
        return np.fmin(lines.force_high, lines.saturation_force)


def evaluated(problem: SelectionProblem, resin: Array, radius: Array, wall: Array, pressure: Array) -> CandidatePool:
    """Candidates with their responses from the atlas, times the factors of the problem where there are any."""
    batch = problem.batch(resin, radius, wall, pressure)
    response = respond(batch, problem.steps)
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
    if problem.sensitivity_kPa_per_N is not None:
        margin_of["sensitivity"] = (
            1.0 - np.abs(lines.sensitivity_kPa_per_N / problem.sensitivity_kPa_per_N - 1.0) / problem.tolerance
        )
    if problem.force_range is not None:
        margin_of["force range"] = pool.force / problem.force_range - 1.0
    least, most = problem.stiffness
    if least is not None or most is not None:
        with np.errstate(divide="ignore"):
            margin_of["stiffness"] = np.minimum(
                np.inf if least is None else lines.stiffness / least - 1.0,
                np.inf if most is None else most / lines.stiffness - 1.0,
            )
    if problem.max_diameter is not None:
        margin_of["outer diameter"] = problem.max_diameter / (2.0 * (pool.radius + pool.wall)) - 1.0
    margin_of |= _limits(problem, pool)
    if problem.limit_spread is not None:
        with np.errstate(divide="ignore"):
            margin_of["rated pressure"] = rated(problem, pool.resin, pool.radius, pool.wall) / pool.pressure - 1.0
    margin_of |= _connector(problem, pool)
    known = np.isfinite(lines.sensitivity_kPa_per_N) & (pool.response.ends != OUTSIDE)
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
    """Margins of the connector, drawn once for each size of the dome."""
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
    """Pressure rise at the required force, or at the end of a shorter range; none without a requirement."""
    force, rise = pool.response.force, pool.response.rise
    if problem.force_range is None:
        return np.zeros(force.shape[0])
    after = np.clip((force < problem.force_range).sum(axis=1), 1, force.shape[1] - 1)
    rows = np.arange(force.shape[0])
    low, high = force[rows, after - 1], force[rows, after]
    share = np.clip((problem.force_range - low) / (high - low), 0.0, 1.0)
    return np.asarray(rise[rows, after - 1] + share * (rise[rows, after] - rise[rows, after - 1]))
