"""Verdicts on measured figures: against a target, and of one age against another."""

from collections.abc import Callable, Sequence
from itertools import groupby

import numpy as np

from pneutouch.bench.interval import Estimate
from pneutouch.bench.summary import RunGroup
from pneutouch.catalogue import Library
from pneutouch.report.measured import Verdict
from pneutouch.spec.campaign import AS_DESIGNED
from pneutouch.spec.material import Material
from pneutouch.spec.target import Target, TargetFigures

_INFINITE = float("inf")

_SAME_KPA = 1e-6

_YEAR = 300.0, 430.0
"""Ages in days that are compared with the paper's change in a year."""


def verdicts(target: Target, groups: Sequence[RunGroup]) -> tuple[Verdict, ...]:
    """Every requirement of a target against every group it applies to; a size is not measured here.

    A requirement that no group measures is not decided.
    """
    figures = target.target
    outcomes = []
    for what, key, low, high, text in _requirements(figures):
        only_kPa = figures.driving_pressure_kPa
        answers = [
            group
            for group in groups
            if key in group.figures
            and (only_kPa is None or np.isclose(only_kPa, group.key.driving_pressure_kPa, atol=_SAME_KPA))
        ]
        for group in answers:
            where = f"{group.key.resin}, {group.key.age}, {group.key.driving_pressure_kPa:g} kPa"
            estimate = group.figures[key]
            outcomes.append(Verdict(f"{what}, {where}", text, _interval(estimate), _passed(estimate, low, high)))
        if not answers:
            where = "" if only_kPa is None else f", {only_kPa:g} kPa"
            outcomes.append(Verdict(f"{what}{where}", text, "not measured", None))
    return tuple(outcomes)


def _requirements(figures: TargetFigures) -> list[tuple[str, str, float, float, str]]:
    """The requirements: name, figure, least, most, in words."""
    rows = []
    if (s := figures.sensitivity_kPa_per_N) is not None:
        part = figures.tolerance_percent / 100
        text = f"{s:g} kPa/N within {figures.tolerance_percent:g} %"
        rows.append(("Sensitivity", "sensitivity_kPa_per_N", s * (1 - part), s * (1 + part), text))
    if (f := figures.force_range_N) is not None:
        rows.append(("Force range", "force_range_N", f, _INFINITE, f"at least {f:g} N"))
    if (k := figures.stiffness_least_N_per_mm) is not None:
        rows.append(("Stiffness", "stiffness_N_per_mm", k, _INFINITE, f"at least {k:g} N/mm"))
    if (k := figures.stiffness_most_N_per_mm) is not None:
        rows.append(("Stiffness", "stiffness_N_per_mm", 0.0, k, f"at most {k:g} N/mm"))
    return rows


def _interval(estimate: Estimate) -> str:
    if estimate.low is None or estimate.high is None:
        return f"{estimate.value:.4g} (one run: no interval)"
    remark = "" if estimate.over == "specimens" else ", this specimen alone"
    return f"{estimate.value:.4g} ({estimate.low:.4g} to {estimate.high:.4g}{remark})"


def _passed(estimate: Estimate, low: float, high: float) -> bool | None:
    """True if the whole interval lies inside, False if it lies outside; None if it lies on both sides, or there is
    none."""
    if estimate.low is None or estimate.high is None:
        return None
    if low <= estimate.low and estimate.high <= high:
        return True
    return False if estimate.high < low or estimate.low > high else None


AgeingChange = tuple[str, float, str, float, float | None, float | None, float | None]


def ageing(groups: Sequence[RunGroup], library: Library) -> tuple[AgeingChange, ...]:
    """Change of the sensitivity since fresh, in percent of the aged one as in the paper's Supplement E.

    Resin, pressure, age, change with the ends of its 95 % interval, and the paper's change in a year where it measured
    one.
    """
    known = [group for group in groups if "sensitivity_kPa_per_N" in group.figures]
    by_sensor: Callable[[RunGroup], tuple[str, float]] = lambda group: (group.key.resin, group.key.driving_pressure_kPa)  # noqa: E731
    changes: list[AgeingChange] = []
    for (resin, pressure), some in groupby(sorted(known, key=by_sensor), key=by_sensor):
        fresh, *aged = sorted(some, key=lambda group: group.key.age_days)
        if fresh.key.age_days == 0:
            for group in aged:
                published = _published(resin, library) if _YEAR[0] <= group.key.age_days <= _YEAR[1] else None
                changes.append((resin, pressure, group.key.age, *_change(fresh, group), published))
    return tuple(changes)


def _published(resin: str, library: Library) -> float | None:
    if resin == AS_DESIGNED:
        return None
    material: Material = library.load("materials", resin)
    measured = material.measured
    change = None if measured is None else measured.sensitivity_change_one_year_percent
    return None if change is None else change.nominal


def _change(fresh: RunGroup, aged: RunGroup) -> tuple[float, float | None, float | None]:
    """Change in percent with its ends; the halves of both intervals are added as squares."""
    new, old = fresh.figures["sensitivity_kPa_per_N"], aged.figures["sensitivity_kPa_per_N"]
    value = 100 * (old.value - new.value) / old.value
    if new.high is None or old.high is None:
        return value, None, None
    half = (
        100
        * float(np.hypot((new.high - new.value) / new.value, (old.high - old.value) / old.value))
        * new.value
        / old.value
    )
    return value, value - half, value + half
