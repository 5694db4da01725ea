"""Runs of a plan, recorded one after the other: the next one, its steps by the time since it began, and its file."""

import bisect
import itertools
import json
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from pydantic import TypeAdapter, ValidationError

from pneutouch.errors import InputError
from pneutouch.output.files import replace_file
from pneutouch.results.plan import PlannedRun, PlannedStep
from pneutouch.spec.campaign import CAMPAIGN, campaign_of
from pneutouch.spec.files import inside, read_bytes
from pneutouch.workflows.live.readers import TARE_S

_WORDS = {
    "set_pressure": "set the driving pressure to {value:g} {unit} and shut the valve",
    "vent": "vent to {value:g} {unit}",
    "move": "press to {value:g} {unit}",
    "hold": "hold {value:g} {unit}",
    "wait": "wait, touch nothing",
}
"""Steps of a run for people, by action."""

_CLEAR = "lift the object by {value:g} {unit} above the sensor"

BY_HAND = ("injection",)
"""Kinds of run whose readings are written down, and not recorded over time."""


@dataclass(frozen=True)
class PlanRuns:
    """The runs of a plan in a folder."""

    folder: Path
    runs: tuple[PlannedRun, ...]
    design: str

    @classmethod
    def of(cls, folder: Path) -> "PlanRuns":
        """The plan in a folder. Raises InputError where there is none, or one that was changed by hand."""
        path = folder / "plan.json"
        if not path.is_file():
            raise InputError("holds no plan.json", file=folder, remedy="`pneutouch plan DESIGN` writes one")
        try:
            plan = json.loads(read_bytes(path))
            runs, design = TypeAdapter(tuple[PlannedRun, ...]).validate_python(plan["runs"]), str(plan["design"])
        except (ValueError, KeyError, TypeError, ValidationError) as error:
            raise InputError(f"is no plan: {error}", file=path, remedy="plan anew") from None
        for place, run in enumerate(runs):
            inside(folder, run.file, file=path, key=f"runs[{place}].file")
        return cls(folder, runs, design)

    def check_design(self, name: str) -> None:
        """Raise InputError for a sensor of another design than that of the plan."""
        if name != self.design:
            problem = f"is of {self.design}, and the sensor is of {name}"
            raise InputError(problem, key="plan", value=str(self.folder), remedy="plan for this design")

    @cached_property
    def recordable(self) -> tuple[PlannedRun, ...]:
        """Runs that are recorded over time."""
        return tuple(run for run in self.runs if run.kind not in BY_HAND)

    def check_source(self, simulated: bool) -> None:
        """Make the plan's campaign one of simulated runs, or of measured ones, where nothing was recorded yet.

        Raises InputError where simulated and measured runs would be in one campaign."""
        path = self.folder / CAMPAIGN
        campaign, _ = campaign_of(path)
        if campaign.simulated == simulated:
            return
        text, recorded = read_bytes(path).decode(), any((self.folder / run.file).exists() for run in campaign.runs)
        here, there = (f"\nsimulated = {str(one).lower()}\n" for one in (campaign.simulated, simulated))
        if recorded or text.count(here) != 1:
            kinds = ("simulated", "measured") if campaign.simulated else ("measured", "simulated")
            problem = f"is of {kinds[0]} runs, and a {kinds[1]} one cannot be among them"
            raise InputError(problem, file=path, key="simulated", remedy="plan into another folder")
        replace_file(path, text.replace(here, there).encode())

    @property
    def open(self) -> tuple[PlannedRun, ...]:
        """Runs that have no file yet, in order."""
        return tuple(run for run in self.recordable if not (self.folder / run.file).exists())

    @property
    def by_hand(self) -> tuple[Path, ...]:
        """Files that are still to be written by hand."""
        files = (self.folder / run.file for run in self.runs if run.kind in BY_HAND)
        return tuple(file for file in files if not file.exists())

    def chosen(self, number: int | None) -> PlannedRun:
        """The run of a number, else the first that has no file. Raises InputError where there is none."""
        if number is None:
            if not self.open:
                raise InputError(
                    "every run has its file", file=self.folder, remedy="go on with `pneutouch characterize`"
                )
            return self.open[0]
        known = {run.number: run for run in self.recordable}
        if number not in known:
            by_hand = any(run.number == number for run in self.runs)
            problem = "is read by hand: write its volumes and pressures into its file" if by_hand else "no such run"
            raise InputError(problem, key="run", value=number, remedy=f"give one of 1 to {len(self.runs)}")
        return known[number]


class RunSteps:
    """The steps of a run by the time since its record began.

    Attributes:
        before: Steps before the record, in words, with the seconds that each takes.
    """

    def __init__(self, run: PlannedRun) -> None:
        self.run = run
        place = next(k for k, step in enumerate(run.steps) if step.action == "record")
        self.before = [(_said(step), step.seconds) for step in run.steps[:place]]
        self._timed = [step for step in run.steps[place:] if step.seconds > 0.0]
        self._ends = list(itertools.accumulate(step.seconds for step in self._timed))

    def zero(self, seconds: float) -> bool:
        """True where the zero of the sensor is read after ``seconds``: at the end of a rest, before the object moves;
        of a leak run at its beginning."""
        place = bisect.bisect_right(self._ends, seconds)
        if place >= len(self._timed) or self._timed[place].action not in ("wait", "set_pressure"):
            return False
        if self.run.kind == "leak":
            return seconds < TARE_S
        after = self._timed[place + 1].action if place + 1 < len(self._timed) else ""
        left = self._ends[place] - seconds
        return after == "move" and left <= min(TARE_S, 0.5 * self._timed[place].seconds)

    @property
    def before_s(self) -> float:
        """Time before the record."""
        return sum(seconds for _, seconds in self.before)

    def ahead(self, seconds: float) -> tuple[str, float]:
        """The step to be done ``seconds`` after the run was called, before its record, and the time that is left."""
        for words, length in self.before:
            if seconds < length:
                return words, length - seconds
            seconds -= length
        return "done", 0.0

    @property
    def seconds(self) -> float:
        """Length of the record."""
        return self._ends[-1]

    def at(self, seconds: float) -> tuple[str, float]:
        """The step to be done after ``seconds``, in words, and the time that is left of it, s."""
        place = bisect.bisect_right(self._ends, seconds)
        if place >= len(self._timed):
            return "done", 0.0
        return _said(self._timed[place]), self._ends[place] - seconds


def _said(step: PlannedStep) -> str:
    """A step in words."""
    value = 0.0 if step.value is None else step.value
    words = _CLEAR if step.action == "move" and value < 0.0 else _WORDS[step.action]
    return words.format(value=abs(value), unit=step.unit)
