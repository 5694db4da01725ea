"""Correction of the fitted model by its error in the curves: factors on force and pressure by driving pressure.

The sensitivity of a soft dome hardly depends on modulus, wall and dead volume, so no fit of them takes the model's
error in it away. What the runs show of that error is corrected where it was measured, and between."""

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.bench.calibrate.discrepancy import FLOOR
from pneutouch.bench.calibrate.fit import CalibrationFit
from pneutouch.mechanics.response import lines
from pneutouch.mechanics.sensor import ResponseCorrection
from pneutouch.units import KPA

ASSUMED_SCATTER = 0.018
"""Relative standard deviation between runs of one specimen where none was repeated: root mean square of the seven
resins of the paper's Table S1, repeatability over the sensitivity at 0 kPa. Of the force nothing is published; the same
is taken."""

_LEAST_POINTS = 3

_MOST_FREEDOM = 1e6
"""Degrees of freedom of errors that do not include the scatter: as good as infinite."""


@dataclass(frozen=True, slots=True)
class ResponseGap:
    """Logarithms of measured over modelled, (n,) by driving pressure, means over its runs.

    Attributes:
        driving_pressures_kPa: Driving pressures, kPa, ascending.
        force, sensitivity: Of the contact force and of the sensitivity.
        force_errors, sensitivity_errors: Their standard uncertainties: scatter of the runs, pooled over the pressures,
            and the least share that no residual shows (`FLOOR`).
        depth: Travel, mm, to which every run went of the driving pressure whose runs went deepest.
        freedom: Degrees of freedom of these errors, the fewest there; 0 where no run was repeated and the scatter is
            `ASSUMED_SCATTER`.
    """

    driving_pressures_kPa: tuple[float, ...]
    force: Array
    sensitivity: Array
    force_errors: Array
    sensitivity_errors: Array
    depth: float
    freedom: float

    @property
    def correction(self) -> ResponseCorrection:
        """The factors that make the model's curves those measured."""
        force, rise = np.exp(self.force), np.exp(self.force + self.sensitivity)
        pressures = (np.array(self.driving_pressures_kPa) * KPA).tolist()
        return ResponseCorrection(tuple(pressures), tuple(force.tolist()), tuple(rise.tolist()))


def response_gap(fit: CalibrationFit) -> ResponseGap | None:
    """The gap of a fit; None if no run has enough points in the model."""
    p, size = fit.points, fit.points.there.size
    shape = p.there.shape
    use = fit.solution.use[:size].reshape(shape)
    force, rise = (fit.solution.model[k * size : (k + 1) * size].reshape(shape) for k in (0, 1))
    rows: dict[float, list[tuple[float, float]]] = {}
    depths: dict[float, float] = {}
    for i, curve in enumerate(fit.observations.curves):
        if use[i].sum() >= _LEAST_POINTS:
            row = _gap(p.travel[i], (p.force[i], p.rise[i]), (force[i], rise[i]), use[i])
            pressure_kPa, end = curve.run.driving_pressure_kPa, float(p.travel[i][use[i]].max())
            rows.setdefault(pressure_kPa, []).append(row)
            depths[pressure_kPa] = min(end, depths.get(pressure_kPa, end))
    if not rows:
        return None
    pressures_kPa = tuple(sorted(rows))
    groups = [np.array(rows[pressure_kPa]) for pressure_kPa in pressures_kPa]
    means = np.array([group.mean(axis=0) for group in groups])
    errors, freedom = scatter_errors(groups)
    columns = means[:, 0], means[:, 1], errors[:, 0], errors[:, 1]
    return ResponseGap(pressures_kPa, *columns, depth=max(depths.values()), freedom=freedom)


def scatter_errors(groups: list[Array]) -> tuple[Array, float]:
    """Standard uncertainties (n, 2) of the means of n groups of runs, and their degrees of freedom.

    Rows of a group are its runs; columns are logarithms of a force and of a sensitivity, the rise over the force. The
    scatter is pooled over the groups; the freedom of scatter and `FLOOR` together follows Welch and Satterthwaite (JCGM
    100, G.4.1), the floor's being infinite."""
    counts = np.array([len(group) for group in groups])
    spare = int((counts - 1).sum())
    squares = sum(((group - group.mean(axis=0)) ** 2).sum(axis=0) for group in groups)
    variance = squares / spare if spare else np.full(2, ASSUMED_SCATTER**2)
    scatter = variance / counts[:, None]
    # A sensitivity divides one reading by the other, so the least shares of both are in it.
    whole = scatter + np.array([FLOOR[0] ** 2, FLOOR[0] ** 2 + FLOOR[1] ** 2])
    share = float((scatter / whole).max())
    return np.sqrt(whole), min(spare / max(share**2, 1e-30), _MOST_FREEDOM)


def _gap(travel: Array, measured: tuple[Array, Array], model: tuple[Array, Array], use: Flags) -> tuple[float, float]:
    """Logarithms of measured over modelled force, by least squares, and sensitivity."""
    force = float((measured[0] * model[0])[use].sum() / (model[0][use] ** 2).sum())
    ratio = _sensitivity_kPa_per_N(travel, *measured, use) / _sensitivity_kPa_per_N(travel, *model, use)
    return float(np.log(max(force, 1e-6))), float(np.log(max(ratio, 1e-6)))


def _sensitivity_kPa_per_N(travel: Array, force: Array, rise: Array, use: Flags) -> float:
    """Slope of the rise over the force; the origin belongs to the curve."""
    x, f, r = (np.concatenate([[0.0], part[use]]) for part in (travel, force, rise))
    return float(lines(x, f, r / KPA).sensitivity_kPa_per_N)
