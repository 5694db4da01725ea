"""Uncertainty of the estimates: runs differ by gain and zero, so the run is the unit of repetition, not the point.

Errors that many values share (`SharedUnknowns`) are unknowns next to the parameters: given these, runs are independent.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array, Flags, Index
from pneutouch.bench.calibrate.solve import LeastSquaresProblem, LeastSquaresSolution

LEAST_RUNS = 3
"""Least number of runs that give a scatter between runs."""

LEVEL = 0.95

_LEVERAGE = 0.9
"""Share of a direction's information that one run gives, above which the scatter there is unknown: our choice."""


@dataclass(frozen=True, slots=True)
class Covariance:
    """Uncertainty of the fitted parameters.

    Attributes:
        matrix: Covariance, priors included, (k, k); NaN on a bound, and where neither data nor prior determine it.
        information: Information of the data alone, at the average scatter of the runs, (k, k).
        freedom: Degrees of freedom of the scatter between runs, infinite where too few runs are repeated to show it.
        share: Share of the data in each parameter's variance, (k,).
        considered: Shift of each estimate by one standard deviation of each uncertain parameter not fitted, (k, 5); in
            ``matrix``.
        even: Parameters that have a uniform prior, (5,).
        runs: Number of runs and injections with a point in the fit.
        alone: Number of the only run that determines each parameter, -1 where several do, (k,)."""

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
        """True if ``matrix`` includes the scatter between runs."""
        return bool(np.isfinite(self.freedom))


class WeightedRows(NamedTuple):
    """Rows of a fit, scaled so that data and priors together have an information of 1 for each of the j unknowns.

    residual: local residuals, (N,). jacobian: derivatives by free parameters and shared unknowns, over ``scale``,
    (N, j). use: True for values that count, (N,). weight: prior weights over ``scale``², (j,). scale: root of each
    information, (j,)."""

    residual: Array
    jacobian: Array
    use: Flags
    weight: Array
    scale: Array

    @property
    def normal(self) -> Array:
        """Information of data and priors, (j, j); a tiny weight keeps it invertible."""
        return np.asarray(information(self.jacobian) + np.diag(self.weight + 1e-12))


class RunScatter(NamedTuple):
    """Scatter between runs: ``score`` the covariance of the gradient (j, j); ``held`` the projection on what a single
    run determines, in coordinates of unit information (j, j); ``alone`` that run for each unknown, else -1 (j,)."""

    score: Array
    held: Array
    alone: Array


def information(jacobian: Array) -> Array:
    """Information matrix, (k, k), from derivatives (N, k) of values over their errors."""
    return np.asarray(jacobian.T @ jacobian)


def scatter(clusters: Array, part: WeightedRows, normal: Array) -> RunScatter:
    """Scatter of the gradient between runs; ``clusters`` (N,) is the run of each value.

    Cluster-robust with the leverage correction of Bell and McCaffrey (Survey Methodology 28, 2002, 169-181): a run's
    residuals are too small because it pulls the fit towards itself. ``normal``, (j, j), is the information of all runs
    and priors."""
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
        slope = grown @ (j.T @ part.residual[rows])
        total += np.outer(slope, slope)
        over = axes[:, share > _LEVERAGE]
        held += over @ over.T
        # In the coordinates' own directions: which parameters would be lost with this run.
        alone[np.diag(information(part.jacobian[rows])) > _LEVERAGE * np.diag(normal)] = run
    back = np.linalg.inv(root)
    return RunScatter(back @ total @ back, held, alone)


def factor(problem: LeastSquaresProblem, solution: LeastSquaresSolution) -> float:
    """Variance of the gradient between runs over that of independent points, mean over directions, at least 1."""
    free = np.flatnonzero(~solution.bound & (np.abs(solution.jacobian).max(axis=0) > 0))
    if not free.size or _freedom(problem, solution) < 1:
        return 1.0
    part = _rows(problem, solution, free)
    normal = part.normal
    seen = np.linalg.solve(normal, scatter(problem.model.points.clusters, part, normal).score)
    return max(1.0, float(np.trace(seen) / np.trace(np.linalg.solve(normal, information(part.jacobian)))))


def covariance(
    problem: LeastSquaresProblem, solution: LeastSquaresSolution, run_factor: float, others: Array
) -> Covariance:
    """Covariances at a solution whose weights include ``run_factor`` (`factor`).

    ``others``, (N, 5), are derivatives by the parameters that are not fitted but uncertain, times their standard
    deviations: they move the estimates although they are not estimated (consider covariance: Schmidt, in Advances in
    Control Systems 3, 1966)."""
    k, runs = solution.at.size, int(np.unique(problem.model.points.clusters[solution.use]).size)
    free = np.flatnonzero(~solution.bound)
    part, freedom = _rows(problem, solution, free), _freedom(problem, solution)
    data, normal = information(part.jacobian), part.normal
    parameters = slice(0, free.size)
    blank = (np.diag(data) + part.weight)[parameters] <= 0
    seen = scatter(problem.model.points.clusters, part, normal)
    score = _at_least(seen.score, data, normal, seen.held, run_factor) if freedom >= 1 else data
    inverse, unit = np.linalg.inv(normal), np.outer(part.scale[parameters], part.scale[parameters])
    of_data = (inverse @ score @ inverse)[parameters, parameters] / unit
    moved = -(inverse[parameters] @ part.jacobian.T @ others) / part.scale[parameters, None]
    whole = of_data + (inverse @ np.diag(part.weight) @ inverse)[parameters, parameters] / unit + moved @ moved.T
    # A parameter without data and prior has no interval; the tiny weight above only keeps the inverse.
    whole[blank, :] = whole[:, blank] = np.nan
    considered = np.zeros((k, others.shape[1]))
    considered[free] = moved
    known = information(problem.whitened(solution.jacobian, solution.use))
    share = _spread(np.diag(of_data) / np.diag(whole), free, k)
    alone = _spread(seen.alone[parameters], free, k, -1.0).astype(int)
    between = float(freedom) if freedom >= 1 else np.inf
    matrix = np.full((k, k), np.nan)
    matrix[np.ix_(free, free)] = whole
    return Covariance(matrix, known, between, share, considered, problem.chosen.even, runs, alone)


def half_widths(estimate: Covariance) -> Array:
    """Half widths of the 95 % intervals in the coordinates, (k,); NaN for a coordinate without an interval.

    Student's t with the degrees of freedom of Welch and Satterthwaite: of priors they are infinite (JCGM 100, G.4). The
    contribution of a parameter with a uniform prior is not normal: there the interval is that of the sum (JCGM 101,
    5.3)."""
    from scipy.stats import t

    with np.errstate(divide="ignore", invalid="ignore"):
        freedom = estimate.freedom / estimate.share**2 if estimate.clustered else np.full(estimate.share.size, np.inf)
    grown = t.ppf(0.5 + 0.5 * LEVEL, np.where(np.isnan(freedom), np.inf, freedom)) / t.ppf(0.5 + 0.5 * LEVEL, np.inf)
    variance = np.diag(estimate.matrix)
    # Of several uniform ones the widest counts as uniform, the others as normal.
    even = np.sqrt((estimate.considered**2 * estimate.even).max(axis=1, initial=0.0))
    rest = grown * np.sqrt(np.maximum(variance - even**2, 0.0))
    return np.array([_half(float(s), float(np.sqrt(3.0) * a)) for s, a in zip(rest, even, strict=True)])


def _half(deviation: float, bound: float) -> float:
    """Half width of the 95 % interval of a normal error of ``deviation`` plus a uniform one within +-``bound``."""
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


def _freedom(problem: LeastSquaresProblem, solution: LeastSquaresSolution) -> int:
    """Runs beyond the first at each driving pressure and beyond the first injection; 0 below `LEAST_RUNS`."""
    points = problem.model.points
    clusters = np.unique(points.clusters[solution.use])
    curves = clusters[clusters < points.group.size].astype(int)
    groups = np.unique(points.group[curves]).size + int(curves.size < clusters.size)
    return int(clusters.size - groups) if clusters.size >= LEAST_RUNS else 0


def _rows(problem: LeastSquaresProblem, solution: LeastSquaresSolution, free: Index) -> WeightedRows:
    shared = np.where(solution.use[:, None], problem.shared, 0.0)
    weight = np.concatenate([problem.weight[free], np.ones(shared.shape[1])])
    jacobian = np.hstack([solution.jacobian[:, free], shared])
    total = (jacobian**2).sum(axis=0) + weight
    scale = np.sqrt(np.where(total > 0, total, 1.0))
    return WeightedRows(solution.local, jacobian / scale, solution.use, weight / scale**2, scale)


def _root(normal: Array) -> Array:
    """Symmetric square root of the inverse of ``normal``."""
    values, vectors = np.linalg.eigh(normal)
    return np.asarray((vectors / np.sqrt(values)) @ vectors.T)


def _at_least(score: Array, data: Array, normal: Array, held: Array, run_factor: float) -> Array:
    """Scatter ``score``, raised where it is less than that of independent points.

    A direction that one run alone determines (``held``) shows no scatter; the others' average is assumed there."""
    root = _root(normal)
    least = root @ data @ root / run_factor + (1.0 - 1.0 / run_factor) * held
    seen, axes = np.linalg.eigh(root @ score @ root - least)
    back = np.linalg.inv(root)
    return np.asarray(back @ (least + (axes * np.maximum(seen, 0.0)) @ axes.T) @ back)


def _spread(part: Array, free: Index, k: int, missing: float = np.nan) -> Array:
    whole = np.full(k, missing)
    whole[free] = part
    return whole
