"""Runs that deviate from the others of their sensor, as a file of another sensor does."""

from collections.abc import Sequence

import numpy as np

from pneutouch.bench.record import MeasuredCurve
from pneutouch.mechanics.response import figures
from pneutouch.units import KPA

APART = 0.15
"""Share by which runs of one sensor may differ: our choice. The paper's three runs differ by 1 % in sensitivity, its
three identical sensors by 2 to 10 % (Fig. 7 and S2)."""

TIMES = 5.0
"""Factor on the scatter of the others (1.4826 times their median deviation) that must be exceeded too."""


def outliers(curves: Sequence[MeasuredCurve]) -> list[tuple[MeasuredCurve, str]]:
    """Runs that deviate from the others of one sensor, kind, driving pressure and age, and the reason.

    The force at the greatest common depth and the slope of pressure over force are compared, as logarithms: a run
    deviates where one of them is off the median of the others by more than `APART` and `TIMES` their scatter. Of two
    runs that differ by `APART` both are reported.
    """
    groups: dict[tuple[object, ...], list[MeasuredCurve]] = {}
    for curve in curves:
        run = curve.run
        groups.setdefault((run.sensor, run.kind, run.driving_pressure_kPa, run.age_days), []).append(curve)
    odd: list[tuple[MeasuredCurve, str]] = []
    for group in groups.values():
        odd += _apart(group)
    return odd


def _apart(group: list[MeasuredCurve]) -> list[tuple[MeasuredCurve, str]]:
    if len(group) < 2:
        return []
    depth = min(float(curve.indentation[-1]) for curve in group)
    forces = np.array([float(np.interp(depth, curve.indentation, curve.force)) for curve in group])
    slopes_kPa_per_N = np.array([_sensitivity_kPa_per_N(curve) for curve in group])
    reasons: dict[int, str] = {}
    for name, values in ((f"force at {depth:.3g} mm", forces), ("slope of pressure over force", slopes_kPa_per_N)):
        if not (values > 0).all():
            continue
        for k in range(len(group)):
            others = np.delete(values, k)
            middle = float(np.median(others))
            scatter = 1.4826 * float(np.median(np.abs(np.log(others / middle))))
            if abs(np.log(values[k] / middle)) > max(np.log1p(APART), TIMES * scatter):
                reasons.setdefault(k, f"{name} is {values[k] / middle:.2f} times that of")
    which = "the other run" if len(group) == 2 else f"the other {len(group) - 1} runs"
    question = "is one of them" if len(group) == 2 else "is it"
    return [
        (group[k], f"{why} {which} of sensor {group[k].run.sensor}; {question} of another sensor?")
        for k, why in sorted(reasons.items())
    ]


def _sensitivity_kPa_per_N(curve: MeasuredCurve) -> float:
    values = figures(curve.indentation, curve.force, curve.rise / KPA)
    return float("nan") if values is None else values.sensitivity_kPa_per_N
