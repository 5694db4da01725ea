"""The fit: parameters of the sensor in hand from what was measured on it, with intervals."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pneutouch.bench.calibrate.intervals import Covariance, covariance, factor, half_widths
from pneutouch.bench.calibrate.model import Model
from pneutouch.bench.calibrate.observations import Observations, Points, points_of
from pneutouch.bench.calibrate.parameters import MODULUS, Parameters
from pneutouch.bench.calibrate.solve import Problem, Solution, solve
from pneutouch.errors import InputError
from pneutouch.mechanics.atlas.press import Flags
from pneutouch.mechanics.atlas.table import shipped
from pneutouch.mechanics.sensor import Sensor
from pneutouch.meridian.segments import Array

_START_SHARE = 0.9
"""The search begins where the greatest driving pressure is at most this share of the limit pressure: our choice."""


@dataclass(frozen=True, slots=True)
class Fit:
    """A fit; coordinates as in `Parameters`.

    Attributes:
        observations, points, parameters, sensor: What was fitted; the sensor as designed, in the laboratory's air.
        problem, solution: As solved, weights with the scatter of the runs.
        covariance: How sure it is.
        half_width: Of the 95 % intervals, (k,); NaN on a bound.
        chi_squared, freedom: Sum of squared residuals over the stated errors of reading and atlas, and its degrees of freedom.
        channel_factor: Standard deviations of points over their stated ones: force, rise, injection.
        run_factor: Variance by which runs scatter more than independent points would.
    """

    observations: Observations
    points: Points
    parameters: Parameters
    sensor: Sensor
    problem: Problem
    solution: Solution
    covariance: Covariance
    half_width: Array
    chi_squared: float
    freedom: int
    channel_factor: Array
    run_factor: float

    @property
    def full(self) -> Array:
        """All four coordinates, (4,)."""
        return self.parameters.full(self.solution.at)

    @property
    def left_out(self) -> Flags:
        """Points that the model does not have, (c, m) curves; see also `injections_left_out`."""
        size = self.points.there.size
        return self.points.there & ~self.solution.use[:size].reshape(self.points.there.shape)

    @property
    def injections_left_out(self) -> Flags:
        """Injected volumes that the model does not have, (i, n)."""
        size = self.points.there.size
        return self.points.known & ~self.solution.use[2 * size :].reshape(self.points.known.shape)


def fit(observations: Observations, sensor: Sensor, parameters: Parameters) -> Fit:
    """Fit ``parameters`` of ``sensor`` to observations.

    First with the errors stated for reading and atlas; then with those that the residuals show, channel by channel, and with
    the scatter between runs, so that beliefs are weighed against what the data are worth. Raises InputError for too few
    points, ComputationError where no fit is found.
    """
    sensor = replace(sensor, ambient_pressure=observations.ambient)
    points = points_of(observations)
    fitted = len(parameters.fitted)
    if not parameters.priors and int(points.use.sum()) <= fitted:
        raise InputError(
            f"calibrate: {int(points.use.sum())} values for {fitted} parameters without priors; there must be more values, or "
            "fewer parameters with --fit"
        )
    model = Model(sensor, points)
    stated = Problem(model, parameters, points.errors)
    first = solve(stated, _start(sensor, points, parameters))
    channels = _channel_factors(points, first, fitted)
    seen = Problem(model, parameters, points.errors * channels[points.channels])
    second = solve(seen, first.at)
    runs = factor(seen, second)
    last = Problem(model, parameters, seen.errors * np.sqrt(runs))
    found = solve(last, second.at)
    certain = covariance(last, found, runs)
    residual = found.residual * last.errors / points.errors
    return Fit(
        observations, points, parameters, sensor, last, found, certain, half_widths(certain),
        float((residual**2).sum()), max(int(found.use.sum()) - fitted, 0), channels, runs,
    )  # fmt: skip


def _start(sensor: Sensor, points: Points, parameters: Parameters) -> Array:
    """The design's values, the modulus raised where it would burst under the pressures that the sensor stood."""
    start = parameters.start[list(parameters.fitted)].copy()
    if MODULUS in parameters.fitted and points.driving.size:
        slices = shipped().slices(np.array([sensor.wall_thickness / sensor.inner_radius]), ())
        least = points.driving.max() / _START_SHARE / float(slices.limit_pressure[0])
        where = parameters.fitted.index(MODULUS)
        start[where] = max(start[where], np.log(max(least, 1e-9)))
    return start


def _channel_factors(points: Points, found: Solution, fitted: int) -> Array:
    """Root mean square of the residuals by channel, at least 1: what reading and atlas do not explain."""
    factors = np.ones(3)
    total = max(int(found.use.sum()), 1)
    spare = max(total - fitted, 1) / total
    for channel in range(3):
        rows = found.use & (points.channels == channel)
        if rows.any():
            factors[channel] = max(1.0, float(np.sqrt(np.mean(found.residual[rows] ** 2) / spare)))
    return factors
