"""Object and force by readings at several driving pressures: posterior, region and intervals."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pneutouch.arrays import Array
from pneutouch.evaluation.object_table import ObjectTable

_HELD = 0.95


@dataclass(frozen=True)
class Posterior:
    """Probabilities (objects, forces) of the nodes of a table, by some of its readings.

    Attributes:
        noise: Standard deviation of a rise, MPa.
        error: Standard deviation of errors that readings do not share, over the reading.
        travel_noise: Standard deviation of a travel, mm, where the table has travels.
    """

    table: ObjectTable
    noise: float
    error: float
    travel_noise: float = 0.0

    @cached_property
    def _noise(self) -> Array:
        """Noise of every reading (c,): of the rises, then of the travels."""
        count = len(self.table.pressures_kPa)
        return np.where(np.arange(len(self.table.readings)) < count, self.noise, self.travel_noise)

    @cached_property
    def _deviation(self) -> Array:
        return np.asarray(np.hypot(self._noise[:, None, None], self.error * self.table.readings))

    @cached_property
    def _log_deviation(self) -> Array:
        return np.log(self._deviation)

    def logs(self, readings: Array) -> Array:
        """Logarithms of the likelihood of the readings (c,) at each driving pressure, at the nodes (k, m, n)."""
        misfit = (np.asarray(readings)[:, None, None] - self.table.readings) / self._deviation
        logs = -0.5 * misfit**2 - self._log_deviation
        return np.asarray(logs.reshape(-1, len(self.table.pressures_kPa), *logs.shape[1:]).sum(axis=0))

    def of(self, readings: Array, chosen: Sequence[int]) -> Array:
        """The posterior of readings (c,), of which those at the pressures numbered ``chosen`` count; all objects and
        logarithms of forces are as likely before."""
        return weights_of(self.logs(readings), chosen)

    def drawn(self, exact: Array, random: np.random.Generator) -> Array:
        """Readings (c,) of an object, with their errors, from those without."""
        return np.asarray(exact + np.hypot(self._noise, self.error * exact) * random.standard_normal(len(exact)))


def weights_of(logs: Array, chosen: Sequence[int]) -> Array:
    """Probabilities of nodes by the readings numbered ``chosen``, from the logarithms of each."""
    log = logs[list(chosen)].sum(axis=0)
    weights = np.where(np.isfinite(log), np.exp(log - np.nanmax(log)), 0.0)
    return np.asarray(weights / weights.sum())


def region(weights: Array) -> float:
    """Smallest share of the nodes that holds `_HELD` of a probability; of a node that is not whole, its share."""
    ordered = np.sort(weights.ravel())[::-1]
    sums = np.cumsum(ordered)
    k = int(np.searchsorted(sums, _HELD))
    before = sums[k - 1] if k else 0.0
    return float((k + (_HELD - before) / ordered[k]) / weights.size)


def interval(values: Array, weights: Array) -> tuple[float, float]:
    """Values between which `_HELD` of the probability of nodes lies, with as much beyond either; from the end of the
    values where it is greatest there, as for a plate, than which nothing is flatter."""
    sums = np.concatenate([[0.0], np.cumsum(weights)])
    edges = np.concatenate([[values[0]], 0.5 * (values[1:] + values[:-1]), [values[-1]]])
    place = int(np.argmax(weights))
    below = 0.0 if place == 0 else 1.0 - _HELD if place == len(weights) - 1 else 0.5 - 0.5 * _HELD
    low, high = (float(np.interp(share, sums, edges)) for share in (below, below + _HELD))
    return low, high
