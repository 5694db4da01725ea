"""Model discrepancy, common to all runs, and the error of the first contact of each run.

Both are unknowns with a standard deviation, estimated with the parameters. The first is the model discrepancy of
Kennedy and O'Hagan (J. R. Stat. Soc. B 63, 2001, 425-464, DOI 10.1111/1467-9868.00294): without it a calibrated
parameter has too small an interval around a wrong value (Brynjarsdottir and O'Hagan, Inverse Problems 30, 2014,
114007)."""

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.calibrate.observations import ObservationPoints

FLOOR = np.array([0.01, 0.005, 0.005])
"""Least standard deviation of the model discrepancy, as a share of force, of pressure rise and of an injection's
pressure.

A share that is the same everywhere is a modulus to the model, so no residual shows it. Our choice: a wall that relaxes
carries more at the end of a 4 s hold than at rest; no Prony data of these resins are published, the paper's Fig. S1
calls relaxation low, and what the air reads of it is less than what the plate does."""

LARGEST = 0.3
"""Greatest size considered: our choice, no longer a model of the sensor."""

_LENGTH = 0.5
"""Length, as a share of a run's travel, over which the discrepancy stays correlated: our choice."""

_NODES = 4
"""Nodes of the discrepancy along a travel: two thirds of its correlation length apart."""

_GRID = 12
TRAVEL = 3
"""Number of the columns of travel, after those of force 0, rise 1, injection 2."""


@dataclass(frozen=True, slots=True)
class SharedUnknowns:
    """Unknowns that move many values together: ``columns`` (N, q) for size one, in N and MPa; ``kind`` (q,) of each, as
    `FLOOR`, or `TRAVEL`, whose size is one already."""

    columns: Array
    kind: Array

    def sized(self, sizes: Array) -> Array:
        """Columns for sizes (3,) of the kinds."""
        return np.asarray(self.columns * np.append(sizes, 1.0)[self.kind])


def shared_of(points: ObservationPoints) -> SharedUnknowns:
    """Columns for points.

    Of each channel one share of all its readings, whatever the pressure, and at each pressure a smooth share along the
    travel; of each curve one error of its travel, which moves force and rise together."""
    m, values, channels = points.travel.shape[1], points.values, points.channels
    travel = points.travel / points.travel.max(axis=1, initial=1e-9)[:, None]
    shape = _shape(
        np.concatenate([np.tile(travel.ravel(), 2), (points.volume / points.volume.max(initial=1e-9)).ravel()])
    )
    groups = np.concatenate([np.tile(np.repeat(points.group, m), 2), np.zeros(points.volume.size)])
    columns, kind = [np.zeros((values.size, 0))], np.zeros(0, dtype=int)
    for channel in np.unique(channels):
        read = np.where(channels == channel, values, 0.0)[:, None]
        parts = [
            read,
            *(np.where(groups == g, 1.0, 0.0)[:, None] * read * shape for g in np.unique(groups[channels == channel])),
        ]
        columns += parts
        kind = np.append(kind, np.full(sum(part.shape[1] for part in parts), channel))
    error = np.tile(np.repeat(points.travel_error, m), 2)
    slope = np.zeros(values.size)
    slope[: error.size] = error * np.concatenate([points.force_slope.ravel(), points.rise_slope.ravel()])
    for curve in np.flatnonzero(points.travel_error > 0):
        columns.append(np.where(points.clusters == curve, slope, 0.0)[:, None])
        kind = np.append(kind, TRAVEL)
    return SharedUnknowns(np.hstack(columns), kind)


def sizes_of(
    shared: SharedUnknowns, jacobian: Array, residual: Array, prior_weight: Array, pull: Array, floor: Array
) -> Array:
    """Sizes (3,) that the residuals make most likely, the parameters taken out (restricted likelihood: Patterson and
    Thompson, Biometrika 58, 1971, 545-554); at least ``floor``.

    Rows are those used, over their standard deviations: ``shared`` (n, q), ``jacobian`` (n, k), ``residual`` (n,);
    ``prior_weight`` (k,) are the weights of the parameters, ``pull`` (k,) how many standard deviations each is off it.
    Where the likelihood is greatest is sought kind by kind on a grid, twice round."""
    k, q = jacobian.shape[1], shared.kind.size
    rows = np.hstack([jacobian, shared.columns, residual[:, None]])
    gram = rows.T @ rows
    # The priors are data too, one row each.
    gram[:k, -1] += np.sqrt(prior_weight) * pull
    gram[-1, :k] = gram[:k, -1]
    gram[-1, -1] += float(pull @ pull)
    tiny = 1e-12 * np.maximum(np.diag(gram)[:k], 1e-30)
    sizes = np.maximum(floor, 1e-6)
    for _ in range(2):
        for kind in np.unique(shared.kind[shared.kind < TRAVEL]):
            tried = np.geomspace(max(floor[kind], 1e-4), LARGEST, _GRID)
            costs = []
            for size in tried:
                sizes[kind] = size
                scale = np.concatenate([np.ones(k), np.append(sizes, 1.0)[shared.kind], [1.0]])
                costs.append(
                    _unlikely(gram * np.outer(scale, scale), np.concatenate([prior_weight + tiny, np.ones(q)]))
                )
            sizes[kind] = tried[int(np.argmin(costs))]
    return np.maximum(sizes, floor)


def _unlikely(gram: Array, weight: Array) -> float:
    """Minus twice the restricted log likelihood up to a constant; the last row of ``gram`` is the residuals'."""
    normal = gram[:-1, :-1] + np.diag(weight)
    right = gram[:-1, -1]
    return float(np.linalg.slogdet(normal)[1] + gram[-1, -1] - right @ np.linalg.solve(normal, right))


def _shape(depth: Array) -> Array:
    """A smooth share along a unit length with unit variance, as weights (N, nodes) of independent unknowns."""
    nodes = np.linspace(0.0, 1.0, _NODES)

    def alike(a: Array, b: Array) -> Array:
        return np.asarray(np.exp(-0.5 * ((a[:, None] - b[None]) / _LENGTH) ** 2))

    root = np.linalg.cholesky(alike(nodes, nodes) + 1e-9 * np.eye(_NODES))
    return np.asarray(np.linalg.solve(root, alike(nodes, depth)).T)
