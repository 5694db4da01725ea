"""Goodness of a fit: residuals of each run, and the correction of deviations that all runs share.

The sensitivity of a soft dome hardly depends on modulus, wall and dead volume, so a fit of them does not remove the
model's error in it. That error, as the runs show it, is corrected at the measured driving pressures and between them.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.bench.calibrate.fit import CalibrationFit
from pneutouch.bench.calibrate.fitted_atlas import FLOOR, LARGEST
from pneutouch.mechanics.response import lines
from pneutouch.mechanics.sensor import ResponseCorrection
from pneutouch.results.calibration import MissRecord
from pneutouch.units import KPA

MISSED = 0.005
"""Least residual over full scale that is reported as a miss: our choice, a few times the atlas's own error."""

_CHANCE = 0.001
"""Probability that scatter between runs alone gives a miss at a point: our choice."""


@dataclass(frozen=True, slots=True)
class RunResiduals:
    """Residuals of one run, model less measured; arrays (n,), NaN at points that the model does not reach. ``force`` is
    empty for an injection.

    Attributes:
        label: Label of the run.
        driving_pressure_kPa: Driving pressure as the campaign names it, kPa; NaN for an injection.
        at: Indentation, mm; for an injection the volume, mm3.
        force, rise: Residuals, N and MPa.
        force_scale, rise_scale: Full scale: greatest measured force (N, 1 for an injection) and rise (MPa)."""

    label: str
    driving_pressure_kPa: float
    at: Array
    force: Array
    rise: Array
    force_scale: float
    rise_scale: float

    @property
    def force_error(self) -> float:
        """Root mean square of the force residuals over full scale; NaN without residuals."""
        return _rms(self.force) / self.force_scale if self.force.size else float("nan")

    @property
    def rise_error(self) -> float:
        """Root mean square of the pressure residuals over full scale; NaN without residuals."""
        return _rms(self.rise) / self.rise_scale


def residuals(fit: CalibrationFit) -> tuple[RunResiduals, ...]:
    """Residuals of every run: curves, then injections, in their order."""
    p = fit.points
    size = p.there.size
    gap = np.where(fit.solution.use, fit.solution.model - p.values, np.nan)
    force, rise = gap[:size].reshape(p.there.shape), gap[size : 2 * size].reshape(p.there.shape)
    pressure = gap[2 * size :].reshape(p.known.shape)
    runs = []
    for i, curve in enumerate(fit.observations.curves):
        at, f, r = (part[i][p.there[i]] for part in (p.travel, force, rise))
        scales = _scale(p.force[i]), _scale(p.rise[i])
        runs.append(RunResiduals(curve.run.label, curve.run.driving_pressure_kPa, at, f, r, *scales))
    for i, injection in enumerate(fit.observations.injections):
        volume, rest = (part[i][p.known[i]] for part in (p.volume, pressure))
        runs.append(RunResiduals(injection.label, np.nan, volume, np.zeros(0), rest, 1.0, _scale(p.pressure[i])))
    return tuple(runs)


def misses(fit: CalibrationFit) -> list[MissRecord]:
    """Stretches of travel where the runs at a driving pressure deviate from the model by more than scatter explains.

    At most one stretch for each driving pressure and channel, around the greatest deviation. The scatter is pooled over
    pressures and travels, in shares of full scale; without repeated runs a deviation only has to exceed `MISSED`.
    """
    runs = [run for run in residuals(fit) if run.force.size]
    deviations = []
    for channel in ("force", "pressure"):
        groups = {
            p: _on_one_grid([run for run in runs if run.driving_pressure_kPa == p], channel)
            for p in fit.observations.driving_pressures_kPa
        }
        spread, freedom = _pooled([rows for _, rows in groups.values()])
        for driving_pressure_kPa, (at, rows) in groups.items():
            deviations += _missed(driving_pressure_kPa, channel, at, rows, spread, freedom)
    return deviations


def _on_one_grid(runs: list[RunResiduals], channel: str) -> tuple[Array, Array]:
    """Travels (n,) of the run with the fewest points, and residuals there over full scale, (runs, n)."""
    at = min((run.at for run in runs), key=len)
    rows = [
        np.interp(at, run.at, run.force / run.force_scale if channel == "force" else run.rise / run.rise_scale)
        for run in runs
    ]
    return at, np.array(rows)


def _pooled(groups: list[Array]) -> tuple[float, int]:
    """Root mean square over points of the standard deviation between runs, and its degrees of freedom."""
    squares = [((rows - rows.mean(axis=0)) ** 2).sum(axis=0) for rows in groups if len(rows) > 1]
    freedom = sum(len(rows) - 1 for rows in groups)
    if not freedom:
        return float("nan"), 0
    return float(np.sqrt(np.nanmean(np.concatenate(squares)) * len(squares) / freedom)), freedom


def _missed(
    driving_pressure_kPa: float, channel: str, at: Array, rows: Array, spread: float, freedom: int
) -> list[MissRecord]:
    from scipy.stats import t

    mean = rows.mean(axis=0)
    chance = float(t.ppf(1 - 0.5 * _CHANCE, freedom)) * spread / np.sqrt(len(rows)) if freedom else 0.0
    over = np.abs(mean) > max(MISSED, chance)
    if not over.any():
        return []
    worst = int(np.nanargmax(np.abs(mean)))
    first = last = worst
    while first > 0 and over[first - 1] and mean[first - 1] * mean[worst] > 0:
        first -= 1
    while last < len(at) - 1 and over[last + 1] and mean[last + 1] * mean[worst] > 0:
        last += 1
    return [MissRecord(driving_pressure_kPa, channel, float(at[first]), float(at[last]), float(mean[worst]))]


def _rms(values: Array) -> float:
    known = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(known**2))) if known.size else float("nan")


def _scale(values: Array) -> float:
    return max(float(np.abs(values).max()), 1e-12)


DOUBTFUL, DOUBTFUL_CHI = 0.1, 3.0
"""Misfit over full scale, and chi-squared per degree of freedom, from which a fit is doubtful: our choice. Simulated
sensors, with all errors that the intervals count, have at most 0.018 and 0.8 (36 of three resins)."""

CONTRADICTED_CHI = 10.0
"""Chi-squared per degree of freedom above which the runs contradict the model: our choice. The covariance includes a
model discrepancy of up to `LARGEST`, so that a model that applies has about 1, whatever its error."""


@dataclass(frozen=True, slots=True)
class ModelMisfit:
    """Root mean square residuals of all runs over their full scale, and chi-squared per degree of freedom.

    ``shares`` are the residuals of force, pressure rise and injection pressure; 0 for a channel that was not measured.
    """

    shares: tuple[float, float, float]
    chi_squared: float

    @property
    def doubtful(self) -> bool:
        """True if the model describes the runs poorly: `DOUBTFUL` or `DOUBTFUL_CHI` is exceeded."""
        return max(self.shares) > DOUBTFUL or self.chi_squared > DOUBTFUL_CHI

    @property
    def contradicted(self) -> bool:
        """True if the fitted model does not describe the sensor: the residuals of a channel exceed `LARGEST` of full
        scale, or chi-squared per degree of freedom exceeds `CONTRADICTED_CHI`."""
        return max(self.shares) > LARGEST or self.chi_squared > CONTRADICTED_CHI

    @property
    def words(self) -> str:
        """The misfit as text."""
        names = ("force", "pressure rise", "injection's pressure")
        off = ", ".join(f"{name} by {share:.1%}" for name, share in zip(names, self.shares, strict=True) if share)
        return f"{off} of full scale (root mean square), chi-squared per degree of freedom {self.chi_squared:.3g}"


def misfit(fit: CalibrationFit, runs: Sequence[RunResiduals]) -> ModelMisfit:
    """Misfit of a fit, from the residuals of its runs (`residuals`)."""
    curves = [run for run in runs if run.force.size]
    injected = [run for run in runs if not run.force.size]
    errors = (
        [run.force_error for run in curves],
        [run.rise_error for run in curves],
        [run.rise_error for run in injected],
    )
    force, rise, pressure = (float(np.nan_to_num(_rms(np.array(each)))) for each in errors)
    return ModelMisfit((force, rise, pressure), fit.chi_squared / fit.freedom if fit.freedom else 0.0)


ASSUMED_SCATTER = 0.018
"""Relative standard deviation between runs of one specimen where none was repeated: root mean square of the seven
resins of the paper's Table S1, repeatability over the sensitivity at 0 kPa. For the force nothing is published; the
same value is taken."""

_LEAST_POINTS = 3

_MOST_FREEDOM = 1e6
"""Greatest number of degrees of freedom that is returned: as good as infinite."""


@dataclass(frozen=True, slots=True)
class ResponseGap:
    """Logarithms of measured over modelled force and sensitivity, (n,) by driving pressure, means over its runs.

    Attributes:
        driving_pressures_kPa: Driving pressures, kPa, ascending.
        force, sensitivity: Log ratios of the contact force and of the sensitivity, (n,).
        force_errors, sensitivity_errors: Their standard uncertainties: scatter of the runs, pooled over the pressures,
            and the least share that no residual shows (`FLOOR`).
        depth: Travel, mm, that all runs reached at the driving pressure with the deepest runs.
        freedom: Degrees of freedom of these errors, the least over pressures; 0 where no run was repeated and the
            scatter is `ASSUMED_SCATTER`.
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
        """Factors on force and pressure rise that bring the model's curves to the measured ones."""
        force, rise = np.exp(self.force), np.exp(self.force + self.sensitivity)
        pressures = (np.array(self.driving_pressures_kPa) * KPA).tolist()
        return ResponseCorrection(tuple(pressures), tuple(force.tolist()), tuple(rise.tolist()))


def response_gap(fit: CalibrationFit) -> ResponseGap | None:
    """Gap between the runs of a fit and its model; None if no run has `_LEAST_POINTS` points that the model covers."""
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
    """Logarithms of measured over modelled force, by least squares, and of measured over modelled sensitivity."""
    force = float((measured[0] * model[0])[use].sum() / (model[0][use] ** 2).sum())
    ratio = _sensitivity(travel, *measured, use) / _sensitivity(travel, *model, use)
    return float(np.log(max(force, 1e-6))), float(np.log(max(ratio, 1e-6)))


def _sensitivity(travel: Array, force: Array, rise: Array, use: Flags) -> float:
    """Sensitivity of a curve, kPa/N, with the origin as its first point."""
    x, f, r = (np.concatenate([[0.0], part[use]]) for part in (travel, force, rise))
    return float(lines(x, f, r / KPA).sensitivity)
