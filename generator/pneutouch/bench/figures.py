"""Figures of a run: measured curves go through the same `mechanics.response` as predicted ones.

A campaign in figures: runs of a resin, an age and a driving pressure made one, each figure with its interval.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.polynomial.legendre import legvander

from pneutouch.arrays import Array
from pneutouch.bench.record import MeasuredCurve
from pneutouch.bench.statistics import Estimate, mean_of, spread_between, spread_within, widened
from pneutouch.mechanics.response import Figures, figures, hysteresis
from pneutouch.results.record import SENSITIVITY_KEY, STIFFNESS_KEY
from pneutouch.units import KPA

Pooled = Literal["mean", "within", "between"]


@dataclass(frozen=True, slots=True)
class FigureDefinition:
    """A figure of a sensor: its key, name, unit, and how many runs are made one value.

    ``reading`` is how far, relatively, the reading itself may be off in all runs alike; the interval holds it.
    """

    key: str
    name: str
    unit: str
    pooled: Pooled = "mean"
    of: str = ""
    digits: int = 3
    reading: float = 0.0


_WIDTH_READING, _AREA_READING = 0.03, 0.04
"""Biases found in the hysteresis of simulated loops of known sensors, recorded at 2 kHz with 0.2 to 0.4 % of it
(docs/background/coverage.json: ``off`` of the loop's figures)."""

FIGURES = (
    FigureDefinition(SENSITIVITY_KEY, "Sensitivity, line with intercept", "kPa/N", digits=4),
    FigureDefinition("sensitivity_through_origin_kPa_per_N", "Sensitivity, line through the origin", "kPa/N", digits=4),
    FigureDefinition("r_squared", "R²", "", digits=5),
    FigureDefinition("nonlinearity_percent", "Nonlinearity", "% of full scale"),
    FigureDefinition("repeatability_kPa_per_N", "Repeatability of the sensitivity", "kPa/N", "within", SENSITIVITY_KEY),
    FigureDefinition("part_to_part_kPa_per_N", "Part to part, of the sensitivity", "kPa/N", "between", SENSITIVITY_KEY),
    FigureDefinition(STIFFNESS_KEY, "Mean stiffness", "N/mm"),
    FigureDefinition("force_range_N", "Force at the greatest depth", "N"),
    FigureDefinition("saturation_force_N", "Saturation force", "N"),
    FigureDefinition("sensing_range_N", "Sensing range", "N"),
    FigureDefinition(
        "hysteresis_width_percent", "Hysteresis, greatest width", "% of full scale", reading=_WIDTH_READING
    ),
    FigureDefinition("hysteresis_area_percent", "Hysteresis, area of the loop", "% of loading", reading=_AREA_READING),
    FigureDefinition("relaxation_force_percent", "Relaxation of the force", "%"),
    FigureDefinition("relaxation_force_percent_per_decade", "Relaxation of the force", "% a decade"),
    FigureDefinition("relaxation_pressure_percent", "Relaxation of the pressure rise", "%"),
    FigureDefinition("relaxation_pressure_percent_per_decade", "Relaxation of the pressure rise", "% a decade"),
    FigureDefinition("drift_pressure_kPa_per_min", "Drift of the pressure without contact", "kPa/min"),
    FigureDefinition("noise_force_N", "Noise of a force sample", "N rms"),
    FigureDefinition("noise_pressure_kPa", "Noise of a pressure sample", "kPa rms"),
    FigureDefinition("resolution_N", "Resolution of the force read from the pressure", "N"),
)
"""Figures in the order of every table. Definitions with formula and source: docs/howto/measuring.md."""

BY_KEY = {figure.key: figure for figure in FIGURES}

FIRST = 1.0
"""Seconds after the hold began from which relaxation is counted: the plate's stop no longer oscillates."""

RESOLVED = 3.0
"""Noise standard deviations that count as resolved: the limit of detection of IUPAC (Gold Book, L03540)."""

_CURVE, _GAP = 8, 4
"""Coefficients of a loop's middle line and of the gap between its branches, over the root of the force, which is nearer
to travel than force is: the least that follow the solid's loops."""

_LEAST_SAMPLES = 40

_SATURATION, _DRIFT = "saturation_force_N", "drift_pressure_kPa_per_min"

COVERED = 1.96
"""Standard errors of a slope over some hundred blocks on either side of it in an interval of 95 %."""

_OF_LINE = frozenset(
    {
        SENSITIVITY_KEY,
        "sensitivity_through_origin_kPa_per_N",
        "r_squared",
        "nonlinearity_percent",
        STIFFNESS_KEY,
        "force_range_N",
        _SATURATION,
        "resolution_N",
    }
)
"""Figures of a loading curve, and what is made of them."""

_ENDS = 0.15
"""Decades at either end of a hold over which a line gives the value at the end: one block would give its noise."""

_GRID = 200


def run_figures(curve: MeasuredCurve) -> dict[str, float]:
    """The figures that one run gives, by key; those it does not determine are left out."""
    values: dict[str, float] = {}
    kind = curve.run.kind
    if len(curve.force) > 2:
        values |= _line(curve, saturating=kind == "saturation")
    if kind in ("loop", "hand") and curve.loop:
        values |= _loop(curve)
    if kind == "relaxation" and curve.relaxation is not None:
        values |= _relaxation(*curve.relaxation)
    values |= _still(curve, values.get(SENSITIVITY_KEY))
    return {key: value for key, value in values.items() if np.isfinite(value)}


def _line(curve: MeasuredCurve, *, saturating: bool) -> dict[str, float]:
    got = figures(curve.indentation, curve.force, curve.rise / KPA)
    if got is None:
        return {}
    values = line_figures(got)
    saturation = values.pop(_SATURATION, None)
    if saturating:
        saturated = {} if saturation is None else {_SATURATION: saturation}
        return {**saturated, "sensing_range_N": got.force_range[1] if saturation is None else saturation}
    return values


def line_figures(got: Figures[float]) -> dict[str, float]:
    """Figures of a loading curve by key of `FIGURES`; without saturation where it has none."""
    return {
        SENSITIVITY_KEY: got.sensitivity,
        "sensitivity_through_origin_kPa_per_N": got.sensitivity_through_origin,
        "r_squared": got.r_squared,
        "nonlinearity_percent": 100 * got.nonlinearity,
        STIFFNESS_KEY: got.stiffness,
        "force_range_N": got.force_range[1],
        **({_SATURATION: got.saturation_force} if np.isfinite(got.saturation_force) else {}),
    }


def _loop(curve: MeasuredCurve) -> dict[str, float]:
    """Hysteresis of all cycles together; the greatest difference of two noisy branches would be that of their noise.

    Both branches are fitted at once: a middle line, and a gap that closes at the greatest force.
    """
    sides = [(1.0, *cycle[:2]) for cycle in curve.loop] + [(-1.0, *cycle[2:]) for cycle in curve.loop]
    force, rise = np.concatenate([side[1] for side in sides]), np.concatenate([side[2] for side in sides])
    if force.size < _LEAST_SAMPLES or force.max() <= 0:
        return {}
    direction = np.concatenate([np.full(len(side[1]), side[0]) for side in sides])
    coefficients = np.linalg.lstsq(np.hstack(_branches(force / force.max(), direction)), rise, rcond=None)[0]
    lowest = max(min(cycle[k].min() for cycle in curve.loop) for k in (0, 2))
    grid = np.linspace(max(lowest, 0.0) / force.max(), 1.0, _GRID)
    middle, half = _branches(grid, np.ones(_GRID))
    line, gap = middle @ coefficients[:_CURVE], half @ coefficients[_CURVE:]
    width, area = hysteresis(grid, line + gap, grid, line - gap)
    return {"hysteresis_width_percent": 100 * width, "hysteresis_area_percent": 100 * area}


def _branches(share: Array, direction: Array) -> tuple[Array, Array]:
    """Columns of the middle line and of half the gap at shares of the greatest force, loading (1) or unloading (-1)."""
    root = np.sqrt(np.clip(share, 0.0, None))
    half = 0.5 * direction * (1 - root)
    place = 2 * root - 1
    return legvander(place, _CURVE - 1), half[:, None] * legvander(place, _GAP - 1)


def _relaxation(time: Array, force: Array, rise: Array) -> dict[str, float]:
    """Loss from `FIRST` to the end of the hold, and its slope over log10 of time, both over the value at `FIRST`."""
    later = time >= FIRST
    if later.sum() < 3:
        return {}
    decades = np.log10(time[later])
    figures = {}
    for name, values in (("force", force[later]), ("pressure", rise[later])):
        # Even in log time: a hold of 600 s has nine tenths of its samples in its last decade.
        grid = np.linspace(decades[0], decades[-1], _GRID)
        even = _binned(decades, values, grid)
        slope = np.polyfit(grid, even, 1)[0]
        start, end = (
            float(np.polyval(np.polyfit(grid[part] - at, even[part], 1), 0.0))
            for part, at in ((grid <= grid[0] + _ENDS, grid[0]), (grid >= grid[-1] - _ENDS, grid[-1]))
        )
        figures[f"relaxation_{name}_percent"] = float(100 * (start - end) / start)
        figures[f"relaxation_{name}_percent_per_decade"] = float(-100 * slope / start)
    return figures


def _binned(place: Array, values: Array, grid: Array) -> Array:
    """Means of values around each grid point; straight between where a bin is empty."""
    edges = np.concatenate([[-np.inf], 0.5 * (grid[1:] + grid[:-1]), [np.inf]])
    which = np.digitize(place, edges) - 1
    count = np.bincount(which, minlength=grid.size)
    total = np.bincount(which, weights=values, minlength=grid.size)
    known = count > 0
    return np.interp(grid, grid[known], total[known] / count[known])


def _still(curve: MeasuredCurve, sensitivity: float | None) -> dict[str, float]:
    """Scatter and drift of the channels without contact; the resolution too, if the run has a sensitivity."""
    if curve.run.kind in ("loop", "hand"):
        # Its rests are too short for noise and drift: the wall still recovers.
        return {}
    values = {_DRIFT: 60 * curve.drift[0] / KPA}
    noise_force, noise_kPa = curve.noise[0], curve.noise[1] / KPA
    values |= {"noise_force_N": noise_force, "noise_pressure_kPa": noise_kPa}
    if sensitivity:
        values["resolution_N"] = RESOLVED * noise_kPa / abs(sensitivity)
    return values


_MONTH = 365.25 / 12
"""Days."""

FRESH = 7.0
"""Days up to which a print is fresh: our choice; the paper measured within 72 hours."""

_APART = 3.0, 0.05
"""Ages further apart than so many days, or this share of the younger, are two: a campaign lasts some days."""

_POOL: dict[Pooled, Callable[[Sequence[Array]], Estimate]] = {
    "mean": mean_of,
    "within": spread_within,
    "between": spread_between,
}


@dataclass(frozen=True, order=True, slots=True)
class GroupKey:
    """Properties that all runs of a group share: resin, mean age in days (0 if fresh), driving pressure in kPa."""

    resin: str
    age_days: float
    driving_pressure_kPa: float

    @property
    def age(self) -> str:
        """The age in words."""
        if self.age_days == 0:
            return "fresh"
        return f"{self.age_days:.0f} days" if self.age_days < 2 * _MONTH else f"{self.age_days / _MONTH:.0f} months"


@dataclass(frozen=True, slots=True)
class RunGroup:
    """Runs of one resin, age and driving pressure; ``figures`` by key, ``each`` by curve in the order of ``curves``."""

    key: GroupKey
    curves: tuple[MeasuredCurve, ...]
    figures: dict[str, Estimate]
    each: tuple[dict[str, float], ...]

    @property
    def sensors(self) -> list[str]:
        """Names of the specimens."""
        return sorted({curve.run.sensor for curve in self.curves})

    def of_kind(self, kind: str) -> list[MeasuredCurve]:
        """The curves of one kind of run."""
        return [curve for curve in self.curves if curve.run.kind == kind]

    @property
    def lined(self) -> list[MeasuredCurve]:
        """The curves whose loading gives sensitivity and stiffness: steps where there are any, else what turns."""
        turning = [curve for curve in self.curves if curve.run.kind not in ("saturation", "hand")]
        return self.of_kind("steps") or turning or self.of_kind("hand")


def summarize(curves: Iterable[MeasuredCurve]) -> list[RunGroup]:
    """Groups in the order of resin, age and pressure."""
    every = list(curves)
    ages = _ages({curve.run.age_days for curve in every})
    sorted_in: dict[GroupKey, list[MeasuredCurve]] = {}
    for curve in every:
        run = curve.run
        key = GroupKey(run.resin, ages[run.age_days], run.driving_pressure_kPa)
        sorted_in.setdefault(key, []).append(curve)
    return [_group(key, sorted_in[key]) for key in sorted(sorted_in)]


def _ages(days: set[float]) -> dict[float, float]:
    """The age of its group for each age: ages near one another are one group, called by their mean."""
    groups: list[list[float]] = []
    for age in sorted(days):
        if groups and (age <= FRESH or age - groups[-1][-1] <= max(_APART[0], _APART[1] * groups[-1][-1]) < age):
            groups[-1].append(age)
        else:
            groups.append([age])
    return {age: 0.0 if group[0] <= FRESH else float(np.mean(group)) for group in groups for age in group}


def _group(key: GroupKey, curves: list[MeasuredCurve]) -> RunGroup:
    lined = RunGroup(key, tuple(curves), {}, ()).lined
    each = tuple(run_figures(curve) if curve in lined else _without_line(curve, run_figures(curve)) for curve in curves)
    pooled: dict[str, Estimate] = {}
    for figure in FIGURES:
        by_sensor: dict[str, list[float]] = {}
        for curve, values in zip(curves, each, strict=True):
            if (figure.of or figure.key) in values:
                by_sensor.setdefault(curve.run.sensor, []).append(values[figure.of or figure.key])
        if by_sensor:
            estimate = _POOL[figure.pooled]([np.array(by_sensor[name]) for name in sorted(by_sensor)])
            if estimate.low is None and figure.key in _ALONE:
                estimate = _ALONE[figure.key](lined if figure.key in _OF_LINE else curves, estimate)
            if np.isfinite(estimate.value):
                pooled[figure.key] = widened(estimate, figure.reading)
    return RunGroup(key, tuple(curves), pooled, each)


def _without_line(curve: MeasuredCurve, values: dict[str, float]) -> dict[str, float]:
    """Figures of a run beside others whose straight line is taken: that over other points is another."""
    if curve.run.kind == "saturation":
        return values
    return {key: value for key, value in values.items() if key not in _OF_LINE}


def _drift_of_one(curves: Sequence[MeasuredCurve], estimate: Estimate) -> Estimate:
    """The drift of the only run with the interval of its own slope; a slope without one is no drift."""
    error = next(curve.drift[1] for curve in curves if curve.run.kind not in ("loop", "hand"))
    half_kPa_per_min = COVERED * 60 * error / KPA
    if not np.isfinite(half_kPa_per_min):
        return replace(estimate, value=float("nan"))
    return replace(
        estimate, low=estimate.value - half_kPa_per_min, high=estimate.value + half_kPa_per_min, over="samples"
    )


def _stiffness_of_one(curves: Sequence[MeasuredCurve], estimate: Estimate) -> Estimate:
    """The stiffness of the only run with the interval that its first contact leaves."""
    pressed = (curve for curve in curves if len(curve.force) > 2 and np.isfinite(curve.indentation[-1]))
    curve = next(pressed, None)
    if curve is None or not np.isfinite(curve.onset_error):
        return estimate
    half = COVERED * abs(estimate.value) * curve.onset_error / float(curve.indentation[-1])
    return replace(estimate, low=estimate.value - half, high=estimate.value + half, over="samples")


_ALONE = {_DRIFT: _drift_of_one, STIFFNESS_KEY: _stiffness_of_one}
"""Figures of which a single run has an interval: that of its samples."""
