"""Figures of single runs, by the same `mechanics.response` as those of predictions, and pooled over groups of runs."""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.polynomial.legendre import legvander

from pneutouch.arrays import Array
from pneutouch.bench.record import MeasuredCurve
from pneutouch.bench.statistics import Estimate, mean_of, spread_between, spread_within, widened
from pneutouch.mechanics.response import Figures, Of, figures
from pneutouch.mechanics.viscous.runs import hysteresis
from pneutouch.results.record import SENSITIVITY_KEY, STIFFNESS_KEY
from pneutouch.units import KPA
from pneutouch.wording import data_of

Pooled = Literal["mean", "within", "between"]


@dataclass(frozen=True, slots=True)
class FigureDefinition:
    """Definition of a figure: key, name, unit, digits, and how values of several runs become one (``pooled``).

    ``of`` is the key of the figure whose values are pooled, if not its own; ``reading`` the relative bias of the
    evaluation, alike in all runs and part of the interval."""

    key: str
    name: str
    unit: str
    pooled: Pooled = "mean"
    of: str = ""
    digits: int = 3
    reading: float = 0.0


FIGURES = tuple(FigureDefinition(key, **one) for key, one in data_of(__file__).items())
"""Figures in the order of every table. Definitions with formula and source: docs/howto/measuring.md."""

BY_KEY = {figure.key: figure for figure in FIGURES}

FIRST = 1.0
"""Seconds after the hold began from which relaxation is counted: the plate's stop no longer oscillates."""

RESOLVED = 3.0
"""Resolution in standard deviations of the noise: the limit of detection of IUPAC (Gold Book, L03540)."""

_CURVE, _GAP = 8, 4
"""Numbers of coefficients of a loop's middle line and of the gap between its branches, polynomials in the root of the
force, which is nearer to the travel than the force: the fewest that follow the loops of the solid model."""

_LEAST_SAMPLES = 40

SATURATION_KEY, _DRIFT = "saturation_force_N", "drift_pressure_kPa_per_min"

COVERED = 1.96
"""Half-width of a 95 % interval in standard errors, for a slope over some hundred blocks."""

_ENDS = 0.15
"""Decades at either end of a hold over which a line gives the value at the end: one block would give its noise."""

_GRID = 200


def run_figures(curve: MeasuredCurve) -> dict[str, float]:
    """Figures of one run, by key; those that it does not determine are left out."""
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
    saturation = values.pop(SATURATION_KEY, None)
    if saturating:
        saturated = {} if saturation is None else {SATURATION_KEY: saturation}
        return {**saturated, "sensing_range_N": got.force_range[1] if saturation is None else saturation}
    return values


def line_figures(got: Figures[Of]) -> dict[str, Of]:
    """Figures of one loading curve, or of many, by key of `FIGURES`; without a saturation force if it is not finite."""
    return {
        SENSITIVITY_KEY: got.sensitivity,
        "sensitivity_through_origin_kPa_per_N": got.sensitivity_through_origin,
        "r_squared": got.r_squared,
        "nonlinearity_percent": 100 * got.nonlinearity,
        STIFFNESS_KEY: got.stiffness,
        "force_range_N": got.force_range[1],
        **({SATURATION_KEY: got.saturation_force} if np.isfinite(got.saturation_force).all() else {}),
    }


_OF_LINE = {*line_figures(Figures(*(0.0 for _ in Figures._fields))), "resolution_N"}
"""Keys of the figures of a loading curve, and of the resolution, which is derived from them."""


def _loop(curve: MeasuredCurve) -> dict[str, float]:
    """Hysteresis of all cycles, percent, by fitted branches: that of raw ones would be noise; empty for few samples."""
    fitted = fitted_loop(curve)
    if fitted is None:
        return {}
    force, middle, half = fitted
    share = force / force[-1]
    width, area = hysteresis(share, middle + half, share, middle - half)
    return {"hysteresis_width_percent": 100 * width, "hysteresis_area_percent": 100 * area}


def fitted_loop(curve: MeasuredCurve) -> tuple[Array, Array, Array] | None:
    """Force (N), and rise (MPa) on the middle line of all cycles and half the gap from there to the loading, (n,) each.

    Both branches are fitted at once, with a gap that closes at the greatest force; None for few samples.
    """
    sides = [(1.0, *cycle[:2]) for cycle in curve.loop] + [(-1.0, *cycle[2:]) for cycle in curve.loop]
    force, rise = np.concatenate([side[1] for side in sides]), np.concatenate([side[2] for side in sides])
    if force.size < _LEAST_SAMPLES or force.max() <= 0:
        return None
    direction = np.concatenate([np.full(len(side[1]), side[0]) for side in sides])
    coefficients = np.linalg.lstsq(np.hstack(_branches(force / force.max(), direction)), rise, rcond=None)[0]
    lowest = max(min(cycle[k].min() for cycle in curve.loop) for k in (0, 2))
    grid = np.linspace(max(lowest, 0.0) / force.max(), 1.0, _GRID)
    middle, half = _branches(grid, np.ones(_GRID))
    return grid * force.max(), middle @ coefficients[:_CURVE], half @ coefficients[_CURVE:]


def _branches(share: Array, direction: Array) -> tuple[Array, Array]:
    """Design matrices of middle line and half gap at shares (n,) of the greatest force; direction 1 in, -1 out."""
    root = np.sqrt(np.clip(share, 0.0, None))
    half = 0.5 * direction * (1 - root)
    place = 2 * root - 1
    return legvander(place, _CURVE - 1), half[:, None] * legvander(place, _GAP - 1)


def _relaxation(time: Array, force: Array, rise: Array) -> dict[str, float]:
    """Relaxation of force and pressure until the hold ends and per decade, percent of the value at `FIRST`."""
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
    """Means of the values near each grid point, interpolated linearly where a bin is empty."""
    edges = np.concatenate([[-np.inf], 0.5 * (grid[1:] + grid[:-1]), [np.inf]])
    which = np.digitize(place, edges) - 1
    count = np.bincount(which, minlength=grid.size)
    total = np.bincount(which, weights=values, minlength=grid.size)
    known = count > 0
    return np.interp(grid, grid[known], total[known] / count[known])


def _still(curve: MeasuredCurve, sensitivity: float | None) -> dict[str, float]:
    """Noise, drift of the pressure without contact and, with a sensitivity, resolution; none for loops and by hand."""
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
"""Mean length of a month, days."""

FRESH = 7.0
"""Days up to which a print is fresh: our choice; the paper measured within 72 hours."""

_APART = 3.0, 0.05
"""Ages that differ by more than both this many days and this share of the younger form separate groups."""

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
        """The age as text: "fresh", days, or months."""
        if self.age_days == 0:
            return "fresh"
        return f"{self.age_days:.0f} days" if self.age_days < 2 * _MONTH else f"{self.age_days / _MONTH:.0f} months"


@dataclass(frozen=True, slots=True)
class RunGroup:
    """Runs of one resin, age and driving pressure: ``figures`` pooled, by key, and ``each``: those of each curve."""

    key: GroupKey
    curves: tuple[MeasuredCurve, ...]
    figures: dict[str, Estimate]
    each: tuple[dict[str, float], ...]

    @property
    def sensors(self) -> list[str]:
        """Names of the group's sensors, sorted."""
        return sorted({curve.run.sensor for curve in self.curves})

    def of_kind(self, kind: str) -> list[MeasuredCurve]:
        """The curves of one kind of run."""
        return [curve for curve in self.curves if curve.run.kind == kind]

    @property
    def lined(self) -> list[MeasuredCurve]:
        """Curves that give sensitivity and stiffness: kind steps; else all but saturation and hand; else kind hand."""
        turning = [curve for curve in self.curves if curve.run.kind not in ("saturation", "hand")]
        return self.of_kind("steps") or turning or self.of_kind("hand")


def summarize(curves: Iterable[MeasuredCurve]) -> list[RunGroup]:
    """Sort curves into groups of one resin, age and driving pressure, in that order, and pool their figures."""
    every = list(curves)
    ages = _ages({curve.run.age_days for curve in every})
    sorted_in: dict[GroupKey, list[MeasuredCurve]] = {}
    for curve in every:
        run = curve.run
        key = GroupKey(run.resin, ages[run.age_days], run.driving_pressure_kPa)
        sorted_in.setdefault(key, []).append(curve)
    return [_group(key, sorted_in[key]) for key in sorted(sorted_in)]


def _ages(days: set[float]) -> dict[float, float]:
    """Mean age, in days, of the group that each age falls into; 0 for the group of fresh prints."""
    groups: list[list[float]] = []
    for age in sorted(days):
        if groups and (age <= FRESH or age - groups[-1][-1] <= max(_APART[0], _APART[1] * groups[-1][-1]) < age):
            groups[-1].append(age)
        else:
            groups.append([age])
    return {age: 0.0 if group[0] <= FRESH else float(np.mean(group)) for group in groups for age in group}


def _group(key: GroupKey, curves: list[MeasuredCurve]) -> RunGroup:
    lined = RunGroup(key, tuple(curves), {}, ()).lined
    # Of the figures of the line, a run outside `lined` has some only if it is a saturation run.
    each = tuple(
        {
            key: value
            for key, value in run_figures(curve).items()
            if key not in _OF_LINE or curve in lined or curve.run.kind == "saturation"
        }
        for curve in curves
    )
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


def _drift_of_one(curves: Sequence[MeasuredCurve], estimate: Estimate) -> Estimate:
    """Drift of the only run, with the interval of its slope; NaN if the slope has no standard error."""
    error = next(curve.drift[1] for curve in curves if curve.run.kind not in ("loop", "hand"))
    half_kPa_per_min = COVERED * 60 * error / KPA
    if not np.isfinite(half_kPa_per_min):
        return replace(estimate, value=float("nan"))
    return replace(
        estimate, low=estimate.value - half_kPa_per_min, high=estimate.value + half_kPa_per_min, over="samples"
    )


def _stiffness_of_one(curves: Sequence[MeasuredCurve], estimate: Estimate) -> Estimate:
    """Stiffness of the only run, with the interval from the standard errors of its first contact, if known, and of a
    force read in coarse steps."""
    pressed = (curve for curve in curves if len(curve.force) > 2 and np.isfinite(curve.indentation[-1]))
    curve = next(pressed, None)
    if curve is None or not np.isfinite(curve.onset_error):
        return estimate
    shares = curve.onset_error / float(curve.indentation[-1]), curve.step_error / float(np.abs(curve.force).max())
    half = COVERED * abs(estimate.value) * math.hypot(*shares)
    return replace(estimate, low=estimate.value - half, high=estimate.value + half, over="samples")


_ALONE = {_DRIFT: _drift_of_one, STIFFNESS_KEY: _stiffness_of_one}
"""Functions that give a figure of a single run an interval, by the figure's key."""
