"""Results as Python sees them: a record with its document, checks, and driving pressures for tasks."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pneutouch.api import show
from pneutouch.api.fields import plain
from pneutouch.errors import InputError, shown
from pneutouch.printability import Finding
from pneutouch.results.driving import DrivingRecord
from pneutouch.results.prediction import ByMixingCurve
from pneutouch.spec.read import validate
from pneutouch.spec.tasks import DrivingTask, TaskFile, read_tasks


@dataclass(frozen=True, repr=False)
class CheckResult(show.Documented):
    """The findings of a check, ``passed`` without an error; ``curves``: figures by each mixing curve of a mix."""

    name: str
    findings: tuple[Finding, ...]
    curves: tuple[ByMixingCurve, ...] = ()

    @property
    def passed(self) -> bool:
        """True if no rule is broken."""
        return all(finding.severity != "error" for finding in self.findings)

    def _document(self) -> Any:
        content = {"design": self.name, "passed": self.passed, "findings": [f.stated for f in self.findings]}
        return {**content, "mixing_curves": self.curves} if self.curves else content

    def _head(self) -> str:
        verdict = "passed" if self.passed else "not passed"
        return f"Check of {shown(self.name)}: {verdict}, {len(self.findings)} findings"

    def _rows(self) -> list[Any]:
        return [(f.severity, f.rule, f.body, f.message, f.fix) for f in self.findings]


class Result(show.Shown):
    """The results of a workflow, by key as its command prints them as JSON; `save` writes its folder."""

    def __init__(self, title: str, document: dict[str, Any], write: Callable[[Path], Path] | None = None) -> None:
        self.title, self._document, self._write = title, document, write

    def __getitem__(self, key: str) -> Any:
        return self._document[key]

    def keys(self) -> list[str]:
        """Keys of the results."""
        return list(self._document)

    def to_dict(self) -> dict[str, Any]:
        """The document that the command prints as JSON."""
        return dict(self._document)

    def save(self, out: str | Path = "outputs") -> Path:
        """Write the command's folder into ``out`` and return it. Raises InputError if it is written already."""
        if self._write is None:
            raise InputError(f"{self.title} is written already")
        return self._write(Path(out))

    def _head(self) -> str:
        return self.title

    def _rows(self) -> list[Any]:
        return list(self._document.items())


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
