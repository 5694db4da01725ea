"""Driving pressures as plain data, in the units of their names."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from pneutouch.mechanics.line.air import REFERENCE_TEMPERATURE
from pneutouch.rounding import rounded
from pneutouch.spec.tasks import TASK_FIGURES
from pneutouch.units import KPA, ML
from pneutouch.workflows.driving.reach import ReachCurves, figure_of
from pneutouch.workflows.driving.run import HOLD_SHARE, DrivingSchedule, SealedState, TaskAnswer
from pneutouch.workflows.driving.solve import DrivingSolution, PressureBand

_DIGITS = 6

_NO_LEAK = "no leak was measured; give the results of the coupon leak-cap or of a leak run"


def schedule_document(schedule: DrivingSchedule) -> dict[str, Any]:
    """The whole answer."""
    curves, rating = schedule.curves, schedule.curves.evaluation.rating
    leak = schedule.leak
    source = None if leak is None else {"rate_kPa_per_min": leak.rate_kPa_per_min, "at_kPa": leak.pressure_kPa}
    content = {
        "design": curves.evaluation.scene.name,
        "model": curves.model,
        "rated_pressure_kPa": rating.pressure / KPA,
        "highest_kPa": float(curves.pressures[-1]) / KPA,
        "limit": curves.evaluation.prediction.limits.binding,
        "is_fitted": rating.is_fitted,
        "dead_volume_mL": curves.gas.dead_volume / ML,
        "ambient_pressure_kPa": curves.gas.ambient / KPA,
        "temperature_C": REFERENCE_TEMPERATURE - 273.15,
        "leak": {"unknown": _NO_LEAK} if leak is None else {**(source or {}), "measured": leak.where},
        "reach": {figure: reach_document(curves, figure) for figure in TASK_FIGURES.values()},
        "tasks": [_task(answer, rating.pressure) for answer in schedule.answers],
    }
    return rounded(content, _DIGITS)


def reach_document(curves: ReachCurves, figure: str) -> dict[str, Any] | None:
    """Least and greatest value of a figure and where, over all driving pressures and up to the rated pressure."""
    pressures, values = curves.pressures, curves.values(figure)
    if np.isnan(values).all():
        return None
    within = np.where(pressures <= curves.evaluation.rating.pressure, values, np.nan)
    ends = {"": values} | ({} if np.isnan(within).all() else {"rated_": within})
    return {
        f"{part}{end}{what}": float(of[k]) / unit
        for part, column in ends.items()
        for end, k in (("low", int(np.nanargmin(column))), ("high", int(np.nanargmax(column))))
        for what, of, unit in (("", column, 1.0), ("_at_kPa", pressures, KPA))
    }


def _task(answer: TaskAnswer, rated: float) -> dict[str, Any]:
    task = answer.task
    content: dict[str, Any] = {
        "task": task.name,
        "requirement": task.figure,
        "value": task.value,
        "reached": answer.reached,
        "solutions": [_solution(one, rated) for one in answer.solutions],
    }
    if answer.gas is not None:
        content["gas"] = _gas(answer.gas)
    else:
        content["possible_band"] = _band(answer.possible)
        content["offline"] = [
            {"what": one.what, "before": one.before, "after": one.after, "predicted": one.predicted}
            for one in answer.changes
        ]
    return content


def _solution(solution: DrivingSolution, rated: float) -> dict[str, Any]:
    state = solution.state
    return {
        "driving_pressure_kPa": state.driving_pressure / KPA,
        "band": _band(solution.band),
        "above_rating": state.driving_pressure > rated,
        "apex_height_outer_mm": state.apex_outer,
        "cavity_volume_mL": state.cavity_volume / ML,
        **{figure: figure_of(state, figure) for figure in TASK_FIGURES.values()},
    }


def _band(band: PressureBand | None) -> dict[str, Any] | None:
    if band is None:
        return None
    ends = {"low_kPa": band.low / KPA, "high_kPa": band.high / KPA}
    return {**ends, "open_low": band.open_low, "open_high": band.open_high}


def _gas(gas: SealedState) -> dict[str, Any]:
    by_temperature_kPa_per_K = gas.by_temperature / KPA
    percent_per_kPa = None
    if gas.slope is not None:
        percent_per_kPa = 0.0 if gas.step is None else math.copysign(100.0 * HOLD_SHARE / (gas.step / KPA), gas.slope)
    return {
        "injected_mL": gas.injected / ML,
        "moved_mL": gas.moved / ML,
        "by_temperature_kPa_per_K": by_temperature_kPa_per_K,
        "figure_by_temperature_percent_per_K": None
        if percent_per_kPa is None
        else percent_per_kPa * by_temperature_kPa_per_K,
        "figure_by_pressure_percent_per_kPa": percent_per_kPa,
        "hold_percent": 100.0 * HOLD_SHARE,
        "step_kPa": None if gas.step is None else gas.step / KPA,
        "loss_kPa_per_min": None if gas.loss is None else 60.0 * gas.loss / KPA,
        "hold_s": None if gas.hold is None or np.isinf(gas.hold) else gas.hold,
    }
