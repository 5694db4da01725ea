"""Driving pressures as an object: the figure of a task, the pressure that gives it, and the gas needed for it."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from pneutouch.api import show
from pneutouch.api.fields import plain
from pneutouch.errors import InputError, shown
from pneutouch.results.driving import DrivingRecord
from pneutouch.spec.read import validate
from pneutouch.spec.tasks import DrivingTask, TaskFile, read_tasks


def tasks_of(tasks: str | Path | Iterable[Mapping[str, Any]]) -> list[DrivingTask]:
    """Tasks of a file, or of mappings of their keys. Raises InputError."""
    if isinstance(tasks, str | Path):
        return read_tasks(Path(tasks))
    content = [{key: _number(value) for key, value in task.items()} for task in tasks]
    if len(content) == 1:
        return [validate(DrivingTask, content[0], "the task")]
    if not content:
        raise InputError("holds no task", key="tasks", remedy="give a mapping for each")
    return validate(TaskFile, {"task": content}, "the tasks").task


def _number(value: Any) -> Any:
    """A value as strict models take it: a whole number becomes a float."""
    value = plain(value)
    return float(value) if isinstance(value, int) and not isinstance(value, bool) else value


class DrivingResult(show.Documented):
    """The driving pressures for the tasks of a design, in their order; None for a task that no pressure fulfils."""

    def __init__(self, answer: DrivingRecord) -> None:
        self._record = answer
        self._solved = [task.solutions[0] if task.reached else None for task in answer.tasks]
        self.driving_pressures_kPa = [None if one is None else one.driving_pressure_kPa for one in self._solved]

    @property
    def reached(self) -> bool:
        """True if every task has a driving pressure."""
        return None not in self.driving_pressures_kPa

    @property
    def driving_pressure_kPa(self) -> float | None:
        """Driving pressure of the first task, kPa; None if no pressure fulfils it."""
        return self.driving_pressures_kPa[0]

    @property
    def band_kPa(self) -> tuple[float, float] | None:
        """Band of pressures at which the sensor in hand may fulfil the first task (k = 2), kPa; None if unknown.

        It ends at 0 and at the highest pressure computed; see ``open_low`` and ``open_high`` of `to_dict`.
        """
        band = None if self._solved[0] is None else self._solved[0].band
        return None if band is None else (band.low_kPa, band.high_kPa)

    def _document(self) -> Any:
        return self._record

    def _head(self) -> str:
        return f"Driving pressures of {shown(self._record.design)}, model {self._record.model}"

    def _rows(self) -> list[Any]:
        rows = []
        for task, pressure_kPa in zip(self._record.tasks, self.driving_pressures_kPa, strict=True):
            reached = "not reached" if pressure_kPa is None else f"{pressure_kPa:.4g} kPa"
            rows.append((task.task or "", f"{task.requirement}={task.value:g}", reached))
        return rows
