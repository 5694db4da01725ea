"""Driving pressures for the tasks of a sensor, the gas each takes and how long that holds; or changes of the design."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array
from pneutouch.catalogue import DesignSource, Library
from pneutouch.errors import PneutouchError
from pneutouch.mechanics import predict
from pneutouch.mechanics.line.elements import REFERENCE_TEMPERATURE
from pneutouch.mechanics.sealed_gas import SealedGas
from pneutouch.results.driving import (
    DrivingRecord,
    FigureReach,
    MeasuredLeak,
    MissedTask,
    OfflineChange,
    PressureInterval,
    ReachedTask,
    TaskGas,
    TaskRecord,
    TaskSolution,
    UnknownLeak,
)
from pneutouch.results.record import extended
from pneutouch.spec.read import Changes
from pneutouch.spec.tasks import TASK_FIGURES, DrivingTask
from pneutouch.units import KPA, ML
from pneutouch.wording import rounded
from pneutouch.workflows.driving.pressures import (
    BUDGET_KEYS,
    DrivingSolution,
    LeakSource,
    PressureBand,
    ReachCurves,
    ReachProgress,
    figure_of,
    possible,
    reach_curves,
    solutions,
)

_FIELDS = {
    "wall_thickness": ("membrane.wall_thickness_mm", 1.0),
    "inner_radius": ("membrane.inner_radius_mm", 1.0),
    "shear_modulus": ("shear modulus of the resin, MPa", 1.0),
    "dead_volume": ("pneumatics.dead_volume_mL", ML),
}
"""Inputs of the model that a design can change: name for the user, and the user's unit in the model's unit."""

_FARTHEST = 2.0
"""Greatest factor on an input up to which its derivative is extrapolated: our choice."""


def offline_changes(curves: ReachCurves, figure: str, value: float) -> list[OfflineChange]:
    """Changes of one input each that bring the figure nearer to the value, least change first; none if none does.

    Each is computed from the figure's elasticity at the nearest state; ``predicted``: the figure after the change."""
    values = curves.values(figure)
    if np.isnan(values).all():
        return []
    nearest = curves.states[int(np.nanargmin(np.abs(np.log(values / value))))]
    best = figure_of(nearest, figure)
    _, entry = min(curves.budgets, key=lambda known: abs(known[0] - nearest.driving_pressure))
    elasticities = (entry.elasticities or {}).get(BUDGET_KEYS.get(figure, figure), {})
    changes = []
    # The wall of a calibrated sensor is built.
    free = _FIELDS if curves.evaluation.scene.calibration is None else ("dead_volume",)
    for name, (what, unit) in ((name, _FIELDS[name]) for name in free):
        slope, before = elasticities.get(name, 0.0), _input(curves, name)
        if abs(slope) * np.log(_FARTHEST) < abs(np.log(value / best)) or before <= 0.0:
            continue
        after = before * (value / best) ** (1.0 / slope)
        predicted = _with(curves, name, after, nearest.driving_pressure, figure)
        if predicted is not None and abs(np.log(predicted / value)) < abs(np.log(best / value)):
            changes.append(OfflineChange(what, before / unit, after / unit, predicted))
    return sorted(changes, key=lambda change: abs(np.log(change.after / change.before)))


def _input(curves: ReachCurves, name: str) -> float:
    sensor = curves.evaluation.sensor
    parts = (sensor.dome, sensor.wall, sensor.gas)
    return float(next(getattr(part, name) for part in parts if hasattr(part, name)))


def _with(curves: ReachCurves, name: str, value: float, pressure: float, figure: str) -> float | None:
    """The figure with input ``name`` at ``value``, at a driving pressure in MPa; None if the model gives none."""
    sensor = curves.evaluation.sensor
    more = {"depth": sensor.protocol.depth * value / sensor.dome.inner_radius} if name == "inner_radius" else {}
    # A depth that the design does not state follows from its radius.
    stated = curves.evaluation.scene.design.indentation.depth_mm is not None
    sensor = sensor.replace(**{name: value, **({} if stated else more)})
    try:
        states = predict("changed", sensor, [pressure], model=curves.model).states
    except PneutouchError:
        return None
    changed = figure_of(states[0], figure)
    return None if np.isnan(changed) else changed


HOLD_SHARE = 0.01
"""Relative change of the figure up to which the sealed gas counts as holding it: our choice."""


@dataclass(frozen=True)
class TaskAnswer:
    """A task and the driving pressures that fulfil it, ascending: the first, which ``gas`` belongs to, is preferred.

    Without one ``gas`` is None; ``changes`` of the design may help, or the band ``possible`` within the uncertainty (or
    None)."""

    task: DrivingTask
    solutions: tuple[DrivingSolution, ...]
    gas: TaskGas | None
    changes: tuple[OfflineChange, ...] = ()
    possible: PressureBand | None = None

    @property
    def reached(self) -> bool:
        """True if a driving pressure fulfils the task."""
        return bool(self.solutions)


@dataclass(frozen=True)
class DrivingSchedule:
    """Answers to tasks, in the order of the tasks, and the curves that they were solved on."""

    curves: ReachCurves
    answers: tuple[TaskAnswer, ...]
    leak: LeakSource | None

    @property
    def reached(self) -> bool:
        """True if every task has a driving pressure."""
        return all(answer.reached for answer in self.answers)


def driving_schedule(
    design: str | DesignSource,
    tasks: Sequence[DrivingTask],
    changes: Changes | None = None,
    *,
    library: Library | None = None,
    model: str = "auto",
    leak: LeakSource | None = None,
    progress: ReachProgress = lambda done, total, what: None,
    **options: object,
) -> DrivingSchedule:
    """Find the driving pressures for every task of a design.

    ``leak`` was measured on this design (None: not known). ``options`` are those of `evaluation.evaluate`. Raises
    InputError."""
    curves = reach_curves(design, changes or {}, library=library, model=model, progress=progress, **options)
    solved = [tuple(solutions(curves, task.figure, task.value)) for task in tasks]
    gas, conductance = curves.gas, None
    if leak is not None:
        conductance = leak.conductance(gas, curves.evaluation.assembly)
    answers, before_mL = [], 0.0
    for task, states in zip(tasks, solved, strict=True):
        if states:
            sealed = _sealed(curves, gas, task, states[0].state.driving_pressure, before_mL, conductance)
            before_mL = sealed.injected_mL
            answers.append(TaskAnswer(task, states, sealed))
        else:
            moved = tuple(offline_changes(curves, task.figure, task.value))
            answers.append(TaskAnswer(task, (), None, moved, possible(curves, task.figure, task.value)))
    return DrivingSchedule(curves, tuple(answers), leak)


def _sealed(
    curves: ReachCurves, gas: SealedGas, task: DrivingTask, pressure: float, before_mL: float, conductance: float | None
) -> TaskGas:
    """Gas of a task at a driving pressure (MPa) that is among the states; ``before_mL`` was injected already."""
    k = int(np.searchsorted(gas.pressure, pressure))
    values = curves.values(task.figure)
    near = slice(max(0, k - 1), k + 2)
    slope = float(np.gradient(values[near], gas.pressure[near])[min(k, 1)])
    known = bool(np.isfinite(slope))
    step = HOLD_SHARE * task.value / abs(slope) if known and slope != 0.0 else None
    hold = np.inf
    if conductance is not None and step is not None and pressure > 0.0:
        hold = gas.holding_time(conductance, pressure, pressure - step)
    percent_per_kPa = math.copysign(100.0 * HOLD_SHARE / (step / KPA), slope) if step is not None else 0.0
    kPa_per_K = float(gas.by_temperature(REFERENCE_TEMPERATURE)[k]) / KPA
    injected_mL = float(gas.injected[k]) / ML
    return TaskGas(
        injected_mL=injected_mL,
        moved_mL=injected_mL - before_mL,
        by_temperature_kPa_per_K=kPa_per_K,
        figure_by_temperature_percent_per_K=percent_per_kPa * kPa_per_K if known else None,
        figure_by_pressure_percent_per_kPa=percent_per_kPa if known else None,
        hold_percent=100.0 * HOLD_SHARE,
        step_kPa=None if step is None else step / KPA,
        loss_kPa_per_min=None if conductance is None else 60.0 * float(gas.loss(conductance)[k]) / KPA,
        hold_s=None if np.isinf(hold) else hold,
    )


_DIGITS = 6

_NO_LEAK = "no leak was measured; give the results of the coupon leak-cap or of a leak run"


def driving_record(schedule: DrivingSchedule) -> DrivingRecord:
    """A driving schedule as a record."""
    curves, rating, leak = schedule.curves, schedule.curves.evaluation.rating, schedule.leak
    record = DrivingRecord(
        design=curves.evaluation.scene.name,
        model=curves.model,
        rated_pressure_kPa=rating.pressure / KPA,
        highest_kPa=float(curves.pressures[-1]) / KPA,
        limit=curves.evaluation.prediction.limits.binding,
        is_fitted=rating.is_fitted,
        is_calibrated=schedule.curves.evaluation.scene.calibration is not None,
        dead_volume_mL=curves.gas.dead_volume / ML,
        ambient_pressure_kPa=curves.gas.ambient / KPA,
        temperature_C=REFERENCE_TEMPERATURE - 273.15,
        leak=UnknownLeak(_NO_LEAK)
        if leak is None
        else MeasuredLeak(leak.rate_kPa_per_min, leak.pressure_kPa, leak.where),
        reach={figure: _reach(curves, figure) for figure in TASK_FIGURES.values()},
        tasks=tuple(_task(answer, rating.pressure) for answer in schedule.answers),
    )
    return rounded(record, _DIGITS)


def _reach(curves: ReachCurves, figure: str) -> FigureReach | None:
    """Least and greatest value of a figure with their pressures, over all driving pressures and up to the rated."""
    pressures, values = curves.pressures, curves.values(figure)
    if np.isnan(values).all():
        return None
    at_kPa = pressures / KPA
    reach = FigureReach(*_ends(at_kPa, values))
    within = pressures <= curves.evaluation.rating.pressure
    if np.isnan(values[within]).all():
        return reach
    low, low_at_kPa, high, high_at_kPa = _ends(at_kPa[within], values[within])
    return replace(reach, rated_low=low, rated_low_at_kPa=low_at_kPa, rated_high=high, rated_high_at_kPa=high_at_kPa)


def _ends(at_kPa: Array, values: Array) -> tuple[float, float, float, float]:
    """Least value with its pressure, greatest value with its pressure."""
    low, high = int(np.nanargmin(values)), int(np.nanargmax(values))
    return float(values[low]), float(at_kPa[low]), float(values[high]), float(at_kPa[high])


def _task(answer: TaskAnswer, rated: float) -> ReachedTask | MissedTask:
    task = answer.task
    stated = TaskRecord(
        task=task.name,
        requirement=task.figure,
        value=task.value,
        reached=answer.reached,
        solutions=tuple(_solution(one, rated) for one in answer.solutions),
    )
    if answer.gas is not None:
        return extended(ReachedTask, stated, gas=answer.gas)
    return extended(MissedTask, stated, possible_band=_band(answer.possible), offline=answer.changes)


def _solution(solution: DrivingSolution, rated: float) -> TaskSolution:
    state = solution.state
    return TaskSolution(
        driving_pressure_kPa=state.driving_pressure / KPA,
        band=_band(solution.band),
        above_rating=state.driving_pressure > rated,
        apex_height_outer_mm=state.apex_outer,
        cavity_volume_mL=state.cavity_volume / ML,
        **{figure: figure_of(state, figure) for figure in TASK_FIGURES.values()},
    )


def _band(band: PressureBand | None) -> PressureInterval | None:
    return None if band is None else PressureInterval(band.low / KPA, band.high / KPA, band.open_low, band.open_high)
