"""How sure the estimates are: runs differ by gain and zero, so the run is the unit that repeats, not the point.

What many values share (`discrepancy`) is carried along as unknowns beside the parameters: given them, runs are independent.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array, Flags, Index
from pneutouch.bench.calibrate.solve import LeastSquaresProblem, LeastSquaresSolution

LEAST_RUNS = 3
"""Fewer runs say nothing of how runs scatter."""

LEVEL = 0.95

_LEVERAGE = 0.9
"""A run that alone holds more of what is known in a direction shows no scatter there: our choice."""


@dataclass(frozen=True, slots=True)
class Covariance:
    """How sure the fitted parameters are.

    Attributes:
        matrix: Covariance, beliefs included, (k, k); NaN on a bound, and where neither data nor belief speak.
        information: What the data alone say of all, at the average scatter of the runs, (k, k).
        freedom: Degrees of freedom of the scatter between runs, infinite where points or instruments alone are known.
        share: Share of the data in each parameter's variance, (k,).
        considered: Standard deviations that the parameters not fitted add, by those, (k, 4); they are in ``matrix``.
        even: Which of those are believed evenly within bounds, (4,).
        runs: Runs with a point in the fit.
        alone: For each parameter the number of the one run that it rests on, -1 where there are several, (k,).
    """

    matrix: Array
    information: Array
    freedom: float
    share: Array
    considered: Array
    even: Flags
    runs: int
    alone: Array

    @property
    def clustered(self) -> bool:
        """Whether the scatter between runs is in it."""
        return bool(np.isfinite(self.freedom))


class WeightedRows(NamedTuple):
    """Values used, (N,), with derivatives (N, j) by free parameters and shared unknowns, what is left of each, and what is believed of
    the unknowns, weights (j,); all in units of ``scale`` (j,), in which data and beliefs together say one of each."""

    own: Array
    jacobian: Array
    use: Flags
    weight: Array
    scale: Array

    @property
    def normal(self) -> Array:
        """What data and beliefs say, (j, j); a tiny weight keeps it invertible."""
        return np.asarray(information(self.jacobian) + np.diag(self.weight + 1e-12))


class RunScatter(NamedTuple):
    """Scatter between runs: ``meat`` the variance of the slopes (k, k); ``held`` the directions that one run alone holds, a
    projection in coordinates of unit information (k, k); ``alone`` that run by parameter, -1 without one (k,)."""

    meat: Array
    held: Array
    alone: Array


def information(jacobian: Array) -> Array:
    """What points of unit error say, (k, k)."""
    return np.asarray(jacobian.T @ jacobian)


def scatter(clusters: Array, part: WeightedRows, normal: Array) -> RunScatter:
    """How the slopes scatter between runs whose points move together.

    Cluster-robust with the leverage correction of Bell and McCaffrey (Survey Methodology 28, 2002, 169-181): a run's residuals
    are too small by what it pulls the fit towards itself. ``normal``, (j, j), is what all runs and beliefs say.
    """
    root = _root(normal)
    total, held = np.zeros_like(normal), np.zeros_like(normal)
    alone = np.full(len(normal), -1)
    for run in range(clusters.max() + 1):
        rows = part.use & (clusters == run)
        if not rows.any():
            continue
        j = part.jacobian[rows] @ root
        share, axes = np.linalg.eigh(j.T @ j)
        grown = (axes / np.sqrt(1.0 - np.clip(share, 0.0, _LEVERAGE))) @ axes.T
        slope = grown @ (j.T @ part.own[rows])
        total += np.outer(slope, slope)
        over = axes[:, share > _LEVERAGE]
        held += over @ over.T
        # In the coordinates' own directions: which parameters would be lost with this run.
        alone[np.diag(information(part.jacobian[rows])) > _LEVERAGE * np.diag(normal)] = run
    back = np.linalg.inv(root)
    return RunScatter(back @ total @ back, held, alone)


def factor(problem: LeastSquaresProblem, found: LeastSquaresSolution) -> float:
    """By how much more than of independent points the variance of the data's slopes is, on average over directions; at least 1."""
    free = np.flatnonzero(~found.bound & (np.abs(found.jacobian).max(axis=0) > 0))
    if not free.size or _freedom(problem, found) < 1:
        return 1.0
    part = _rows(problem, found, free)
    normal = part.normal
    seen = np.linalg.solve(normal, scatter(problem.model.points.clusters, part, normal).meat)
    return max(1.0, float(np.trace(seen) / np.trace(np.linalg.solve(normal, information(part.jacobian)))))


def covariance(
    problem: LeastSquaresProblem, found: LeastSquaresSolution, run_factor: float, others: Array
) -> Covariance:
    """Covariances at a solution whose weights hold ``run_factor`` (`factor`).

    ``others``, (N, 4), are derivatives by the parameters that are not fitted but uncertain, times their standard deviations: they
    move the estimates although they are not estimated (consider covariance: Schmidt, in Advances in Control Systems 3, 1966).
    """
    k, runs = found.at.size, _runs(problem, found)
    free = np.flatnonzero(~found.bound)
    part, freedom = _rows(problem, found, free), _freedom(problem, found)
    data, normal = information(part.jacobian), part.normal
    own = slice(0, free.size)
    blank = (np.diag(data) + part.weight)[own] <= 0
    seen = scatter(problem.model.points.clusters, part, normal)
    meat = _at_least(seen.meat, data, normal, seen.held, run_factor) if freedom >= 1 else data
    inverse, unit = np.linalg.inv(normal), np.outer(part.scale[own], part.scale[own])
    of_data = (inverse @ meat @ inverse)[own, own] / unit
    moved = -(inverse[own] @ part.jacobian.T @ others) / part.scale[own, None]
    whole = of_data + (inverse @ np.diag(part.weight) @ inverse)[own, own] / unit + moved @ moved.T
    # What neither data nor belief speak of has no interval; the tiny weight above only keeps the inverse.
    whole[blank, :] = whole[:, blank] = np.nan
    considered = np.zeros((k, others.shape[1]))
    considered[free] = moved
    known = problem.whitened(found.jacobian, found.use)
    return Covariance(
        _placed(whole, free, k), information(known), float(freedom) if freedom >= 1 else np.inf,
        _spread(np.diag(of_data) / np.diag(whole), free, k), considered, problem.chosen.even, runs,
        _spread(seen.alone[own], free, k, -1.0).astype(int),
    )  # fmt: skip


def half_widths(found: Covariance) -> Array:
    """Half widths of the 95 % intervals in the coordinates, (k,); NaN where there is none.

    Student's t with the degrees of freedom of Welch and Satterthwaite: of beliefs they are infinite (JCGM 100, G.4). What a
    parameter adds that lies evenly within bounds is not normal: there the interval is that of the sum (JCGM 101, 5.3).
    """
    from scipy.stats import t

    with np.errstate(divide="ignore", invalid="ignore"):
        freedom = found.freedom / found.share**2 if found.clustered else np.full(found.share.size, np.inf)
    grown = t.ppf(0.5 + 0.5 * LEVEL, np.where(np.isnan(freedom), np.inf, freedom)) / t.ppf(0.5 + 0.5 * LEVEL, np.inf)
    variance = np.diag(found.matrix)
    # Of several even ones the widest counts as even, and the rest as normal.
    even = np.sqrt((found.considered**2 * found.even).max(axis=1, initial=0.0))
    rest = grown * np.sqrt(np.maximum(variance - even**2, 0.0))
    return np.array([_half(float(s), float(np.sqrt(3.0) * a)) for s, a in zip(rest, even, strict=True)])


def _half(deviation: float, bound: float) -> float:
    """Half width of the 95 % interval of a normal error and one even within +-``bound``."""
    from scipy.optimize import brentq
    from scipy.stats import norm

    if not np.isfinite(deviation):
        return float("nan")
    wide = float(norm.ppf(0.5 + 0.5 * LEVEL)) * deviation
    if bound <= 1e-6 * deviation:
        return wide
    if deviation <= 1e-6 * bound:
        return LEVEL * bound

    def under(z: float) -> float:
        return float(z * norm.cdf(z) + norm.pdf(z))

    def missing(half: float) -> float:
        up, down = under((half + bound) / deviation), under((half - bound) / deviation)
        return float(deviation / bound * (up - down) - 1.0 - LEVEL)

    return float(brentq(missing, 0.0, wide + bound))


def _runs(problem: LeastSquaresProblem, found: LeastSquaresSolution) -> int:
    return int(np.unique(problem.model.points.clusters[found.use]).size)


def _freedom(problem: LeastSquaresProblem, found: LeastSquaresSolution) -> int:
    """Runs beyond the first of each driving pressure: what all runs of one share says nothing of how runs differ."""
    points = problem.model.points
    clusters = np.unique(points.clusters[found.use])
    curves = clusters[clusters < points.group.size].astype(int)
    groups = np.unique(points.group[curves]).size + int(curves.size < clusters.size)
    return int(clusters.size - groups) if clusters.size >= LEAST_RUNS else 0


def _rows(problem: LeastSquaresProblem, found: LeastSquaresSolution, free: Index) -> WeightedRows:
    shared = np.where(found.use[:, None], problem.shared, 0.0)
    weight = np.concatenate([problem.weight[free], np.ones(shared.shape[1])])
    jacobian = np.hstack([found.jacobian[:, free], shared])
    said = (jacobian**2).sum(axis=0) + weight
    scale = np.sqrt(np.where(said > 0, said, 1.0))
    return WeightedRows(found.own, jacobian / scale, found.use, weight / scale**2, scale)


def _root(normal: Array) -> Array:
    """The inverse's symmetric root."""
    values, vectors = np.linalg.eigh(normal)
    return np.asarray((vectors / np.sqrt(values)) @ vectors.T)


def _at_least(meat: Array, data: Array, normal: Array, held: Array, run_factor: float) -> Array:
    """The scatter, nowhere less than that of independent points.

    Where one run alone speaks it shows none; it is taken to scatter as the others do on average.
    """
    root = _root(normal)
    least = root @ data @ root / run_factor + (1.0 - 1.0 / run_factor) * held
    seen, axes = np.linalg.eigh(root @ meat @ root - least)
    back = np.linalg.inv(root)
    return np.asarray(back @ (least + (axes * np.maximum(seen, 0.0)) @ axes.T) @ back)


def _placed(part: Array, free: Index, k: int) -> Array:
    whole = np.full((k, k), np.nan)
    whole[np.ix_(free, free)] = part
    return whole


def _spread(part: Array, free: Index, k: int, missing: float = np.nan) -> Array:
    whole = np.full(k, missing)
    whole[free] = part
    return whole
