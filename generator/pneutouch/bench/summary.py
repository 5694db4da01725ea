"""A campaign in figures: runs of a resin, an age and a driving pressure made one, each figure with its interval."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.figure import FIGURES, Pooled, run_figures
from pneutouch.bench.interval import Estimate, mean_of, spread_between, spread_within, widened
from pneutouch.bench.record import MeasuredCurve

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
    each = tuple(run_figures(curve) for curve in curves)
    pooled: dict[str, Estimate] = {}
    for figure in FIGURES:
        by_sensor: dict[str, list[float]] = {}
        for curve, values in zip(curves, each, strict=True):
            if (figure.of or figure.key) in values:
                by_sensor.setdefault(curve.run.sensor, []).append(values[figure.of or figure.key])
        if by_sensor:
            estimate = _POOL[figure.pooled]([np.array(by_sensor[name]) for name in sorted(by_sensor)])
            if np.isfinite(estimate.value):
                pooled[figure.key] = widened(estimate, figure.reading)
    return RunGroup(key, tuple(curves), pooled, each)
