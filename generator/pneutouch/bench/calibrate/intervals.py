"""How sure the estimates are: runs differ by gain and zero, so the run is the unit that repeats, not the point."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pneutouch.bench.calibrate.solve import Problem, Solution
from pneutouch.meridian.segments import Array

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
        runs: Runs with a point in the fit.
        alone: For each parameter the number of the one run that it rests on, -1 where there are several, (k,).
    """

    matrix: Array
    information: Array
    freedom: float
    share: Array
    runs: int
    alone: Array

    @property
    def clustered(self) -> bool:
        """Whether the scatter between runs is in it."""
        return bool(np.isfinite(self.freedom))


class Scatter(NamedTuple):
    """Scatter between runs: ``meat`` the variance of the slopes (k, k); ``held`` the directions that one run alone holds, a
    projection in coordinates of unit information (k, k); ``alone`` that run by parameter, -1 without one (k,)."""

    meat: Array
    held: Array
    alone: Array


def information(jacobian: Array) -> Array:
    """What points of unit error say, (k, k)."""
    return np.asarray(jacobian.T @ jacobian)


def scatter(problem: Problem, found: Solution, normal: Array) -> Scatter:
    """How the slopes scatter between runs whose points move together.

    Cluster-robust with the leverage correction of Bell and McCaffrey (Survey Methodology 28, 2002, 169-181): a run's residuals
    are too small by what it pulls the fit towards itself. ``normal``, (k, k), is what all runs and beliefs say.
    """
    values, vectors = np.linalg.eigh(normal)
    root = (vectors / np.sqrt(values)) @ vectors.T
    clusters = problem.model.points.clusters
    total, held = np.zeros_like(normal), np.zeros_like(normal)
    alone = np.full(len(normal), -1)
    for run in range(clusters.max() + 1):
        rows = found.use & (clusters == run)
        if not rows.any():
            continue
        j = found.jacobian[rows] @ root
        share, axes = np.linalg.eigh(j.T @ j)
        grown = (axes / np.sqrt(1.0 - np.clip(share, 0.0, _LEVERAGE))) @ axes.T
        slope = grown @ (j.T @ found.residual[rows])
        total += np.outer(slope, slope)
        over = axes[:, share > _LEVERAGE]
        held += over @ over.T
        # In the coordinates' own directions: which parameters would be lost with this run.
        alone[np.diag(information(found.jacobian[rows])) > _LEVERAGE * np.diag(normal)] = run
    back = np.linalg.inv(root)
    return Scatter(back @ total @ back, held, alone)


def factor(problem: Problem, found: Solution) -> float:
    """By how much more than of independent points the variance of the data's slopes is, on average over directions; at least 1."""
    free = np.flatnonzero(~found.bound & (np.abs(found.jacobian).max(axis=0) > 0))
    if not free.size or _runs(problem, found) < LEAST_RUNS:
        return 1.0
    part = _part(found, free)
    normal = information(part.jacobian)
    scale = np.sqrt(np.diag(normal))
    normal += np.diag(problem.weight[free]) + 1e-9 * np.diag(scale**2)
    meat = scatter(problem, part, normal).meat
    return max(1.0, float(np.trace(np.linalg.solve(normal, meat))) / free.size)


def covariance(problem: Problem, found: Solution, run_factor: float) -> Covariance:
    """Covariances at a solution whose weights hold ``run_factor`` (`factor`)."""
    k, runs = found.at.size, _runs(problem, found)
    free = np.flatnonzero(~found.bound)
    part = _part(found, free)
    data, weight = information(part.jacobian), problem.weight[free]
    scale = np.sqrt(np.maximum(np.diag(data) + weight, 1e-30))
    normal = data + np.diag(weight) + 1e-12 * np.diag(scale**2)
    blank = (np.diag(data) + weight) <= 0
    freedom = runs - free.size
    clustered = runs >= LEAST_RUNS and freedom >= 1
    seen = scatter(problem, part, normal)
    meat = _at_least(seen.meat, data, normal, seen.held, run_factor) if clustered else data
    inverse = np.linalg.inv(normal)
    of_data = inverse @ meat @ inverse
    whole = of_data + inverse @ np.diag(weight) @ inverse
    # What neither data nor belief speak of has no interval; the tiny weight above only keeps the inverse.
    whole[blank, :] = whole[:, blank] = np.nan
    return Covariance(
        _placed(whole, free, k), information(found.jacobian), float(freedom) if clustered else np.inf,
        _spread(np.diag(of_data) / np.diag(whole), free, k), runs, _spread(seen.alone, free, k, -1.0).astype(int),
    )  # fmt: skip


def half_widths(found: Covariance) -> Array:
    """Half widths of the 95 % intervals in the coordinates, (k,); NaN where there is none.

    Student's t with the degrees of freedom of Welch and Satterthwaite: of beliefs they are infinite (JCGM 100, G.4).
    """
    from scipy.stats import t

    with np.errstate(divide="ignore", invalid="ignore"):
        freedom = found.freedom / found.share**2 if found.clustered else np.full(found.share.size, np.inf)
    quantile = t.ppf(0.5 + 0.5 * LEVEL, np.where(np.isnan(freedom), np.inf, freedom))
    return np.asarray(quantile * np.sqrt(np.diag(found.matrix)))


def _runs(problem: Problem, found: Solution) -> int:
    return int(np.unique(problem.model.points.clusters[found.use]).size)


def _part(found: Solution, free: NDArray[np.intp]) -> Solution:
    return Solution(
        found.at[free], found.residual, found.jacobian[:, free], found.model, found.use, found.bound[free], found.rounds
    )


def _at_least(meat: Array, data: Array, normal: Array, held: Array, run_factor: float) -> Array:
    """The scatter, nowhere less than that of independent points.

    Where one run alone speaks it shows none; it is taken to scatter as the others do on average.
    """
    values, vectors = np.linalg.eigh(normal)
    root = (vectors / np.sqrt(values)) @ vectors.T
    least = root @ data @ root / run_factor + (1.0 - 1.0 / run_factor) * held
    seen, axes = np.linalg.eigh(root @ meat @ root - least)
    back = np.linalg.inv(root)
    return np.asarray(back @ (least + (axes * np.maximum(seen, 0.0)) @ axes.T) @ back)


def _placed(part: Array, free: NDArray[np.intp], k: int) -> Array:
    whole = np.full((k, k), np.nan)
    whole[np.ix_(free, free)] = part
    return whole


def _spread(part: Array, free: NDArray[np.intp], k: int, missing: float = np.nan) -> Array:
    whole = np.full(k, missing)
    whole[free] = part
    return whole
