"""Goodness of the fit: residuals by run, and deviations that every run shares."""

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.calibrate.fit import CalibrationFit

MISSED = 0.005
"""Least residual over full scale that is called a miss: our choice, a few times the atlas's own error."""

_CHANCE = 0.001
"""Chance at which a scatter between runs would show a miss at a point by itself: our choice."""


@dataclass(frozen=True, slots=True)
class RunResiduals:
    """One run: model less measured; arrays (n,), NaN if the model has no state. Of an injection ``force`` is empty.

    Attributes:
        label: Of the run.
        driving_pressure_kPa: Driving pressure as the campaign names it, kPa; of an injection NaN.
        at: Indentation, mm; of an injection the volume, mm3.
        force, rise: Residuals, N and MPa.
        force_scale, rise_scale: Greatest measured force and rise: full scale.
    """

    label: str
    driving_pressure_kPa: float
    at: Array
    force: Array
    rise: Array
    force_scale: float
    rise_scale: float

    @property
    def force_error(self) -> float:
        """Root mean square of the force residuals over full scale; NaN without any."""
        return _rms(self.force) / self.force_scale if self.force.size else float("nan")

    @property
    def rise_error(self) -> float:
        """Root mean square of the pressure residuals over full scale; NaN without any."""
        return _rms(self.rise) / self.rise_scale


@dataclass(frozen=True, slots=True)
class SystematicDeviation:
    """A stretch where the runs at a driving pressure (kPa) all deviate alike: ``channel`` force or pressure, travels
    mm, the greatest mean residual over full scale with its sign."""

    driving_pressure_kPa: float
    channel: str
    start: float
    end: float
    share: float


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


def misses(fit: CalibrationFit) -> list[SystematicDeviation]:
    """Stretches of travel where the runs at a driving pressure deviate by more than their scatter: the model is not the
    sensor.

    The scatter is pooled over pressures and travels, in shares of full scale; without repeated runs only the stated
    errors are there to compare with.
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
    """Travels of the run with the fewest points, and all runs' residuals there over full scale, (runs, n)."""
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
) -> list[SystematicDeviation]:
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
    return [SystematicDeviation(driving_pressure_kPa, channel, float(at[first]), float(at[last]), float(mean[worst]))]


def _rms(values: Array) -> float:
    known = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(known**2))) if known.size else float("nan")


def _scale(values: Array) -> float:
    return max(float(np.abs(values).max()), 1e-12)
