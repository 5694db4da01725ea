"""Driving pressures for the tasks of a sensor, with the gas that each takes and how long it stays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pneutouch.catalogue import DesignSource, Library
from pneutouch.mechanics.line.air import REFERENCE_TEMPERATURE
from pneutouch.mechanics.sealed_gas import SealedGas
from pneutouch.spec.read import Changes
from pneutouch.spec.tasks import DrivingTask
from pneutouch.workflows.driving.leak import LeakSource
from pneutouch.workflows.driving.offline import OfflineChange, offline_changes
from pneutouch.workflows.driving.reach import ReachCurves, ReachProgress, reach_curves
from pneutouch.workflows.driving.solve import DrivingSolution, PressureBand, possible, solutions

HOLD_SHARE = 0.01
"""The figure may change by this share while the sealed gas holds it: our choice."""


@dataclass(frozen=True)
class SealedState:
    """The gas of one state.

    Attributes:
        injected: From the vented sensor, volume at ambient pressure, mm3.
        moved: From the task before (the vented sensor before the first), mm3.
        by_temperature: Change of the pressure, MPa/K.
        slope: Change of the figure over the driving pressure, in its unit over MPa; None at a jump.
        step: Change of the driving pressure that changes the figure by `HOLD_SHARE`, MPa; None at an extremum.
        loss: Fall of the pressure by the leak, MPa/s; None if the leak is not known.
        hold: Time in which the leak changes the figure by `HOLD_SHARE`, s; None if one of both is not known.
    """

    injected: float
    moved: float
    by_temperature: float
    slope: float | None
    step: float | None
    loss: float | None
    hold: float | None


@dataclass(frozen=True)
class TaskAnswer:
    """A task and the driving pressures that do it, the preferred one (the lowest) first.

    Without a solution: ``changes`` of the design, and the band in which the sensor in hand may reach it all the same.
    """

    task: DrivingTask
    solutions: tuple[DrivingSolution, ...]
    gas: SealedState | None
    changes: tuple[OfflineChange, ...] = ()
    possible: PressureBand | None = None

    @property
    def reached(self) -> bool:
        """True if a driving pressure does it."""
        return bool(self.solutions)


@dataclass(frozen=True)
class DrivingSchedule:
    """The answers to tasks in their order, and the curves they were solved on."""

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
    """Solve every task of a design for its driving pressure.

    ``leak`` is what was measured on this design. ``options`` are those of `evaluation.evaluate`. Raises InputError.
    """
    curves = reach_curves(design, changes or {}, library=library, model=model, progress=progress, **options)
    solved = [tuple(solutions(curves, task.figure, task.value)) for task in tasks]
    gas, conductance = curves.gas, None
    if leak is not None:
        conductance = leak.conductance(gas, curves.evaluation.assembly)
    answers, before = [], 0.0
    for task, states in zip(tasks, solved, strict=True):
        if states:
            sealed = _sealed(curves, gas, task, states[0].state.driving_pressure, before, conductance)
            before = sealed.injected
            answers.append(TaskAnswer(task, states, sealed))
        else:
            moved = tuple(offline_changes(curves, task.figure, task.value))
            answers.append(TaskAnswer(task, (), None, moved, possible(curves, task.figure, task.value)))
    return DrivingSchedule(curves, tuple(answers), leak)


def _sealed(
    curves: ReachCurves, gas: SealedGas, task: DrivingTask, pressure: float, before: float, conductance: float | None
) -> SealedState:
    """The gas at a driving pressure (MPa) that is among the states; ``before`` is the gas injected already, mm3."""
    k = int(np.searchsorted(gas.pressure, pressure))
    values = curves.values(task.figure)
    near = slice(max(0, k - 1), k + 2)
    slope = float(np.gradient(values[near], gas.pressure[near])[min(k, 1)])
    known = bool(np.isfinite(slope))
    step = HOLD_SHARE * task.value / abs(slope) if known and slope != 0.0 else None
    hold = None
    if conductance is not None and step is not None and pressure > 0.0:
        hold = gas.holding_time(conductance, pressure, pressure - step)
    injected = float(gas.injected[k])
    return SealedState(
        injected=injected,
        moved=injected - before,
        by_temperature=float(gas.by_temperature(REFERENCE_TEMPERATURE)[k]),
        slope=slope if known else None,
        step=step,
        loss=None if conductance is None else float(gas.loss(conductance)[k]),
        hold=hold,
    )
