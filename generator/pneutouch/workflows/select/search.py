"""The answer to a target of any kind: designs by rank, with a gauge chosen where none is named, a grade, or the best of
each process."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from pneutouch.catalogue import Library, ResolvedDesign
from pneutouch.errors import InputError
from pneutouch.results.selection import GradedRecord, ProcessesRecord, SelectionRecord
from pneutouch.spec.target import Target
from pneutouch.workflows.select.checks import write_assigned
from pneutouch.workflows.select.document import graded, selected
from pneutouch.workflows.select.graded import GradedSelectionRun, select_graded
from pneutouch.workflows.select.processes import ProcessSelection, select, select_processes
from pneutouch.workflows.select.select import STEPS, SelectionRun

SelectedRecord = SelectionRecord | GradedRecord | ProcessesRecord
"""Output of ``select``, by the kind of its target."""


@dataclass(frozen=True)
class FoundChoice:
    """A design that meets a target: its rank or its process, and what turns the base into it."""

    label: str
    base: ResolvedDesign
    assignments: list[str]

    def write(self, name: str, folder: Path, *, overwrite: bool = False) -> Path:
        """Save it as ``folder/name.toml``, a design that ``build`` takes; over a file with ``overwrite`` alone."""
        return write_assigned(self.base.design, self.assignments, name, folder, overwrite=overwrite)


@dataclass(frozen=True)
class TargetAnswer:
    """An answer: its record, the designs that meet the target, best first, and why ``check`` rejects a grade that
    would."""

    run: SelectionRun | GradedSelectionRun | ProcessSelection
    record: SelectedRecord
    choices: tuple[FoundChoice, ...]
    rejected: str | None = None

    def pick(self, rank: int) -> FoundChoice:
        """The design of a rank, or of a row over processes, from 1. Raises InputError if there is none."""
        if not 1 <= rank <= len(self.choices):
            raise InputError(f"must be from 1 to {len(self.choices)}", key="pick", value=rank)
        return self.choices[rank - 1]


def search(
    target: Target,
    where: str,
    library: Library | None = None,
    *,
    written: int | None = None,
    progress: Callable[[int, int, str], None] = lambda done, total, step: None,
) -> TargetAnswer:
    """Answer a target. Raises InputError if it names something unknown; ``where`` names the file in messages.

    The design of rank ``written``, to be saved, passes all that ``check`` looks at, as the best one does.
    """
    if target.setting.processes is not None:
        over = select_processes(target, where, library, progress=progress)
        rows = tuple(FoundChoice(name, run.base, run.assignments(run.answer.designs[0])) for name, run in over.best)
        return TargetAnswer(over, over.record, rows)
    if target.given.graded:
        grade = select_graded(
            target, where, library, lambda trial, done, most: progress(done, most, "searching grades")
        )
        best = (FoundChoice("1", grade.base, grade.assignments()),) if grade.passes else ()
        return TargetAnswer(grade, graded(grade), best, grade.rejected)
    steps = len(STEPS)
    run = select(target, where, library, written=written, progress=lambda s: progress(STEPS.index(s), steps, s))
    ranked = enumerate(run.answer.designs, start=1)
    choices = tuple(FoundChoice(str(rank), run.base, run.assignments(choice)) for rank, choice in ranked)
    return TargetAnswer(run, selected(run), choices)
