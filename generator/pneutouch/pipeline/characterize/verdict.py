"""What was measured against a target, and one age against another."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import groupby

import numpy as np

from pneutouch.bench.interval import Estimate
from pneutouch.bench.summary import Group
from pneutouch.catalogue import Library
from pneutouch.report.measured import Verdict
from pneutouch.spec.campaign import AS_DESIGNED
from pneutouch.spec.material import Material
from pneutouch.spec.target import Target, Wanted

_INFINITE = float("inf")


def verdicts(target: Target, groups: Sequence[Group]) -> tuple[Verdict, ...]:
    """Every wish of a target against every group it speaks of; a size is no matter of measurement here."""
    wanted = target.target
    found = []
    for group in groups:
        where = f"{group.key.resin}, {group.key.age}, {group.key.driving_pressure_kPa:g} kPa"
        for what, key, low, high, text in _wishes(wanted):
            only = wanted.driving_pressure_kPa
            if key in group.figures and (only is None or only == group.key.driving_pressure_kPa):
                estimate = group.figures[key]
                found.append(Verdict(f"{what}, {where}", text, _said(estimate), _passed(estimate, low, high)))
    return tuple(found)


def _wishes(wanted: Wanted) -> list[tuple[str, str, float, float, str]]:
    """What is wished: name, figure, least, most, in words."""
    found = []
    if (s := wanted.sensitivity_kPa_per_N) is not None:
        part = wanted.tolerance_percent / 100
        text = f"{s:g} kPa/N within {wanted.tolerance_percent:g} %"
        found.append(("Sensitivity", "sensitivity_kPa_per_N", s * (1 - part), s * (1 + part), text))
    if (f := wanted.force_range_N) is not None:
        found.append(("Force range", "force_range_N", f, _INFINITE, f"at least {f:g} N"))
    if (k := wanted.stiffness_least_N_per_mm) is not None:
        found.append(("Stiffness", "stiffness_N_per_mm", k, _INFINITE, f"at least {k:g} N/mm"))
    if (k := wanted.stiffness_most_N_per_mm) is not None:
        found.append(("Stiffness", "stiffness_N_per_mm", 0.0, k, f"at most {k:g} N/mm"))
    return found


def _said(estimate: Estimate) -> str:
    if estimate.low is None or estimate.high is None:
        return f"{estimate.value:.4g} (no interval)"
    return f"{estimate.value:.4g} ({estimate.low:.4g} to {estimate.high:.4g})"


def _passed(estimate: Estimate, low: float, high: float) -> bool | None:
    """Whether the whole interval, or without one the value, lies inside; None where it lies on both sides."""
    ends = (
        (estimate.value, estimate.value)
        if estimate.low is None or estimate.high is None
        else (estimate.low, estimate.high)
    )
    if low <= ends[0] and ends[1] <= high:
        return True
    return False if ends[1] < low or ends[0] > high else None


Change = tuple[str, float, str, float, float | None, float | None, float | None]


def ageing(groups: Sequence[Group], library: Library) -> tuple[Change, ...]:
    """Change of the sensitivity since fresh, in percent of the aged one as in the paper's Supplement E.

    Resin, pressure, age, change with the ends of its 95 % interval, and the paper's change in a year where it measured one.
    """
    known = [group for group in groups if "sensitivity_kPa_per_N" in group.figures]
    by_sensor: Callable[[Group], tuple[str, float]] = lambda group: (group.key.resin, group.key.driving_pressure_kPa)  # noqa: E731
    found: list[Change] = []
    for (resin, pressure), some in groupby(sorted(known, key=by_sensor), key=by_sensor):
        fresh, *aged = sorted(some, key=lambda group: group.key.age_months)
        if fresh.key.age_months == 0:
            published = _published(resin, library)
            found += [(resin, pressure, group.key.age, *_change(fresh, group), published) for group in aged]
    return tuple(found)


def _published(resin: str, library: Library) -> float | None:
    if resin == AS_DESIGNED:
        return None
    material: Material = library.load("materials", resin)
    measured = material.measured
    change = None if measured is None else measured.sensitivity_change_one_year_percent
    return None if change is None else change.nominal


def _change(fresh: Group, aged: Group) -> tuple[float, float | None, float | None]:
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
