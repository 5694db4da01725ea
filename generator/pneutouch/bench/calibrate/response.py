"""What the fitted model leaves out of the curves: a factor on force and pressure, and the error that then remains.

The sensitivity of a soft dome hardly depends on modulus, wall and dead volume, so no fit of them takes the model's
error in it away. What the runs show of that error is corrected; how far the correction differs between driving
pressures, and how far a smooth deviation of the size that the residuals show moves the sensitivity, is the error of
what remains."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.bench.calibrate.discrepancy import smooth_share
from pneutouch.bench.calibrate.fit import CalibrationFit
from pneutouch.mechanics.response import lines
from pneutouch.units import KPA

_STEP = 1e-3
"""Relative step of the derivatives by a smooth share."""

_LEAST_POINTS = 3


@dataclass(frozen=True, slots=True)
class ResponseGap:
    """Logarithms of measured over modelled, (n,) by driving pressure, means over its runs.

    Attributes:
        driving_pressures_kPa: Driving pressures, kPa, ascending.
        force, sensitivity: Of the contact force and of the sensitivity.
        smooth_force, smooth_sensitivity: Standard deviations by the model discrepancy along the travel.
    """

    driving_pressures_kPa: tuple[float, ...]
    force: Array
    sensitivity: Array
    smooth_force: float
    smooth_sensitivity: float

    @property
    def force_factor(self) -> float:
        """What the model's force is to be multiplied by."""
        return float(np.exp(self.force.mean()))

    @property
    def rise_factor(self) -> float:
        """What the model's pressure rise is to be multiplied by."""
        return self.force_factor * float(np.exp(self.sensitivity.mean()))

    @property
    def residual_errors(self) -> Array:
        """Sensitivity of the corrected model over the measured one less one, (n,)."""
        return np.asarray(np.expm1(self.sensitivity.mean() - self.sensitivity))

    def sensitivity_error(self, held_out: Sequence[float] = ()) -> float:
        """Standard uncertainty, relative, of the corrected model's sensitivity.

        The greatest of three: by the discrepancy, by the scatter between driving pressures, and by the relative errors
        ``held_out`` of pressures that a fit did not use.
        """
        outside = float(np.sqrt(np.mean(np.log1p(held_out) ** 2))) if len(held_out) else 0.0
        return max(self.smooth_sensitivity, _between(self.sensitivity), outside)

    @property
    def force_error(self) -> float:
        """The same of the force, without runs held out."""
        return max(self.smooth_force, _between(self.force))


def response_gap(fit: CalibrationFit) -> ResponseGap | None:
    """The gap of a fit; None where no run has enough points in the model."""
    p, size = fit.points, fit.points.there.size
    shape = p.there.shape
    use = fit.solution.use[:size].reshape(shape)
    force, rise = (fit.solution.model[k * size : (k + 1) * size].reshape(shape) for k in (0, 1))
    rows: dict[float, list[tuple[float, ...]]] = {}
    for i, curve in enumerate(fit.observations.curves):
        if use[i].sum() >= _LEAST_POINTS:
            model, measured = (force[i], rise[i]), (p.force[i], p.rise[i])
            row = _gap(p.travel[i], measured, model, use[i]), _smooth(p.travel[i], model, use[i], fit.sizes)
            rows.setdefault(curve.run.driving_pressure_kPa, []).append((*row[0], *row[1]))
    if not rows:
        return None
    pressures_kPa = tuple(sorted(rows))
    means = np.array([np.mean(rows[pressure_kPa], axis=0) for pressure_kPa in pressures_kPa])
    smooth = np.sqrt((means[:, 2:] ** 2).mean(axis=0))
    return ResponseGap(pressures_kPa, means[:, 0], means[:, 1], float(smooth[0]), float(smooth[1]))


def _between(values: Array) -> float:
    """Standard deviation of one more value about the mean of these, by their scatter; 0 with one alone."""
    if values.size < 2:
        return 0.0
    return float(values.std(ddof=1) * np.sqrt(1.0 + 1.0 / values.size))


def _gap(travel: Array, measured: tuple[Array, Array], model: tuple[Array, Array], use: Flags) -> tuple[float, float]:
    """Logarithms of measured over modelled force, by least squares, and sensitivity."""
    force = float((measured[0] * model[0])[use].sum() / (model[0][use] ** 2).sum())
    ratio = _sensitivity_kPa_per_N(travel, *measured, use) / _sensitivity_kPa_per_N(travel, *model, use)
    return float(np.log(max(force, 1e-6))), float(np.log(max(ratio, 1e-6)))


def _smooth(travel: Array, model: tuple[Array, Array], use: Flags, sizes: Array) -> tuple[float, float]:
    """Standard deviations of force and sensitivity, relative, by a smooth share of each channel's size."""
    share = smooth_share(travel / travel[use].max())
    force, rise = model
    here_kPa_per_N = _sensitivity_kPa_per_N(travel, force, rise, use)
    weight = force[use] ** 2 / (force[use] ** 2).sum()
    by_force, by_rise = np.zeros(share.shape[1]), np.zeros(share.shape[1])
    for k, part in enumerate(share.T):
        by_force[k] = _sensitivity_kPa_per_N(travel, force * (1.0 + _STEP * part), rise, use) / here_kPa_per_N - 1.0
        by_rise[k] = _sensitivity_kPa_per_N(travel, force, rise * (1.0 + _STEP * part), use) / here_kPa_per_N - 1.0
    of_force = float(np.linalg.norm(weight @ share[use])) * sizes[0]
    return of_force, float(np.hypot(sizes[0] * np.linalg.norm(by_force), sizes[1] * np.linalg.norm(by_rise)) / _STEP)


def _sensitivity_kPa_per_N(travel: Array, force: Array, rise: Array, use: Flags) -> float:
    """Slope of the rise over the force; the origin belongs to the curve."""
    x, f, r = (np.concatenate([[0.0], part[use]]) for part in (travel, force, rise))
    return float(lines(x, f, r / KPA).sensitivity_kPa_per_N)
