"""The job that answers a target: the document of ``select``, its designs as cards, and the trade-off chart.

Over several processes the answer is the command's table, and the best design of each process as a card. The page sends
a target like a question about a design: fields with texts.
"""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pneutouch.catalogue import Library
from pneutouch.catalogue.library import CachedLibrary
from pneutouch.cli.select import typed
from pneutouch.cli.select_text import (
    graded_lines,
    graded_table,
    processes_lines,
    processes_table,
    shapes_lines,
    shapes_table,
)
from pneutouch.errors import InputError, PneutouchError, shown
from pneutouch.results.record import extended, plain
from pneutouch.selection import Candidate
from pneutouch.spec.design import DesignFile
from pneutouch.spec.read import override, parse_changes, validate
from pneutouch.spec.target import Target
from pneutouch.studio.candidate import CandidateCard, CandidateStates, candidate_figures, grade_figures, shape_figures
from pneutouch.studio.form import PAGE, Question
from pneutouch.studio.job import Report
from pneutouch.wording import rounded
from pneutouch.workflows.select.charts import tradeoff
from pneutouch.workflows.select.document import dropped_lines, headline, missed_text, remarks, search_notes
from pneutouch.workflows.select.graded import GradedSelectionRun
from pneutouch.workflows.select.processes import ProcessSelection
from pneutouch.workflows.select.search import TargetAnswer
from pneutouch.workflows.select.search import search as answer
from pneutouch.workflows.select.select import STEPS, SelectionRun
from pneutouch.workflows.select.shapes import ShapeSelection


@dataclass(frozen=True, slots=True)
class PageTable:
    """A table with its caption."""

    caption: str
    head: list[str]
    rows: list[list[str]]


@dataclass(frozen=True, slots=True)
class FrontCurve:
    """Trade-off front of a resin: force range over sensitivity, (n,) each."""

    title: str
    sensitivity_kPa_per_N: tuple[float, ...]
    force_N: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class FrontChart:
    """The trade-off chart that ``select`` draws."""

    driving_pressure_kPa: float
    gauge_kPa: float
    window_kPa_per_N: tuple[float, float] | None
    least_force_N: float | None
    caption: str
    fronts: tuple[FrontCurve, ...]


@dataclass(frozen=True, slots=True)
class PageSelection:
    """The answer to a target: ``selection`` is what ``select`` prints; ``chart`` or ``table`` compares the designs."""

    selection: Mapping[str, Any]
    headline: str
    notes: list[str]
    cards: list[CandidateCard]
    remarks: list[str]
    chart: FrontChart | None
    table: PageTable | None


def _by_process(selection: ProcessSelection, document: Mapping[str, Any], page: CandidateStates) -> PageSelection:
    """The best design of each process as a card; for a process in which none meets the target, the nearest."""
    row = {process: number for number, (process, _) in enumerate(selection.best, start=1)}
    cards = [_card(process, run, page, row.get(process)) for process, run in selection.runs.items()]
    searched, (head, rows) = len(selection.runs) + len(selection.left_out), processes_table(selection)
    return PageSelection(
        selection=document,
        headline=f"{len(row) or 'none'} of {searched} processes with a design that meets the target",
        notes=[],
        cards=[card for card in cards if card is not None],
        remarks=processes_lines(selection, typed),
        chart=None,
        table=PageTable("The best design of each process", head, rows) if rows else None,
    )


def _card(process: str, run: SelectionRun, page: CandidateStates, row: int | None) -> CandidateCard | None:
    """The best design of a process, in ``row`` of the table, or the nearest with its misses; None without either."""
    choice = run.answer.nearest if row is None else run.answer.designs[0]
    if choice is None:
        return None
    figures = candidate_figures(run, choice, None if row is None else 1)
    return extended(
        CandidateCard,
        figures,
        rank=row,
        title=f"{process}: {figures.title}",
        rows=(("Profile", run.base.printer.title, ""), *figures.rows),
        kind="nearest" if row is None else "process",
        label=process,
        note=f"it misses: {missed_text(run, choice)}" if row is None else "",
        passes=row is not None and 1 in run.judged,
        state=page.state(run.base, run.assignments(choice)),
        command=None if row is None else page.command(row),
    )


def _by_shape(selection: ShapeSelection, document: Mapping[str, Any], page: CandidateStates) -> PageSelection:
    """The best design of each shape as a card, and their table."""
    found = zip(selection.designs, selection.record.designs, strict=True)
    cards = [
        extended(
            CandidateCard,
            shape_figures(record, rank),
            kind="shape",
            label=record.shape,
            note="",
            passes=True,
            state=page.state(selection.base, one.assignments),
            command=page.command(rank),
        )
        for rank, (one, record) in enumerate(found, start=1)
    ]
    (line, *remarks), (head, rows) = shapes_lines(selection, typed), shapes_table(selection)
    table = PageTable("The best design of each shape", head, rows) if rows else None
    return PageSelection(document, line, [], cards, remarks, None, table)


_CHANGES = "setting.assignments"


def target_of(question: Question, bases: Mapping[str, str]) -> Target:
    """The target of a question's fields, its base by the page's name. Raises InputError naming key and value."""
    given = [f"{name}={text}" for name, text in question.values.items() if text is not None]
    content = override({"target": {}}, parse_changes(given), Target)
    base = content.get("setting", {}).get("base")
    if isinstance(base, str):
        # The page has designs by name alone: no path of a request is opened.
        if base not in bases:
            raise InputError("unknown design", key="setting.base", value=base)
        content["setting"]["base"] = bases[base]
    return validate(Target, content, PAGE)


@contextmanager
def at_its_fields() -> Iterator[None]:
    """Attach errors about the base's fields to the form's field of assignments; the message names the base's field."""
    try:
        yield
    except PneutouchError as error:
        for each in (error, *error.others):
            if each.key is not None and each.key.partition(".")[0] in DesignFile.model_fields:
                value = "" if each.value is None else f" = {shown(each.value)}"
                each.problem, each.key, each.value = f"{each.key}{value}: {each.problem}", _CHANGES, None
        raise


_DIGITS = 6
_CHART = "trade-off chart"


def search(arguments: Mapping[str, Any], folder: Path, report: Report) -> PageSelection:
    """Search designs for the target ``values``; its base is ``base`` if it has none. Raises InputError at the field."""
    library, bases = CachedLibrary(Library.default().folders), arguments["bases"]
    question = Question.of({key: arguments.get(key) for key in ("base", "values")})
    with at_its_fields():
        target = target_of(question, bases)
        page = CandidateStates(question, bases, library, target)
        charted = target.setting.processes is target.setting.shapes is None and not target.given.graded
        steps = len(STEPS) + 1

        def progress(done: int, total: int, step: str) -> None:
            report(done, steps if charted else total, step)

        found = answer(target, PAGE, library, progress=progress)
        run, document = found.run, {**plain(found.record), "written": None}
        if isinstance(run, ProcessSelection):
            return _by_process(run, document, page)
        if isinstance(run, ShapeSelection):
            return _by_shape(run, document, page)
        if isinstance(run, GradedSelectionRun):
            return _graded(run, document, page)
        report(len(STEPS), steps, _CHART)
        return PageSelection(
            selection=document,
            headline=headline(run),
            notes=search_notes(run),
            cards=_cards(run, found, page),
            remarks=[*_nothing_to_drop(run), *remarks(run)],
            chart=_chart(run, library),
            table=None,
        )


def _cards(run: SelectionRun, found: TargetAnswer, page: CandidateStates) -> list[CandidateCard]:
    """The designs by rank; else the nearest, and those that fit with one change or without one requirement."""

    def card(
        choice: Candidate, kind: str, label: str, *, rank: int | None = None, note: str = "", run: SelectionRun = run
    ) -> CandidateCard:
        """A design as the page shows it, with the state that makes it the page's design."""
        return extended(
            CandidateCard,
            candidate_figures(run, choice, rank),
            kind=kind,
            label=label,
            note=note,
            passes=rank in run.judged,
            state=page.state(run.base, run.assignments(choice)),
            command=None if rank is None else page.command(rank),
        )

    answer, seen, cards = run.answer, set[str](), []
    for rank, choice in enumerate(answer.designs, start=1):
        cards.append(card(choice, "runner-up" if choice.resin.name in seen else "best", str(rank), rank=rank))
        seen.add(choice.resin.name)
    if cards or run.rejected:
        return cards
    if answer.nearest is not None:
        misses = f"it misses: {missed_text(run, answer.nearest)}"
        cards.append(card(answer.nearest, "nearest", "nearest", note=misses))
    for change in found.relief.changes:
        option = typed(change.field, change.value)
        note = f"with {option} it meets the target"
        cards.append(card(change.run.answer.designs[0], "changed", option, note=note, run=change.run))
    for dropped, line in zip(answer.dropped, dropped_lines(run, found.relief, typed), strict=False):
        cards.append(card(dropped.best, "dropped", f"without {dropped.requirement}", note=line))
    return cards


def _nothing_to_drop(run: SelectionRun) -> list[str]:
    """Lines for a target that no design meets even with one requirement dropped; else empty."""
    answer = run.answer
    return [] if answer.designs or run.rejected or answer.dropped else dropped_lines(run)


def _chart(run: SelectionRun, library: Library) -> FrontChart:
    """The chart that ``select`` draws: sensitivities in kPa/N, forces in N, pressures in kPa."""
    drawn = tradeoff(run, library)
    fronts = (
        FrontCurve(each.resin.material.title, tuple(each.sensitivity.tolist()), tuple(each.force.tolist()))
        for each in drawn.known
    )
    chart = FrontChart(
        drawn.driving_pressure_kPa, drawn.gauge_kPa, drawn.window_kPa_per_N, drawn.force, drawn.caption, tuple(fronts)
    )
    return rounded(chart, _DIGITS)


def _graded(run: GradedSelectionRun, document: Mapping[str, Any], page: CandidateStates) -> PageSelection:
    """Answer to a target for a graded wall; a table of membranes of constant mix replaces the chart."""
    head, rows = graded_table(run)
    rejected = [] if run.rejected is None else [f"the grade is rejected by the check: {run.rejected}"]
    card = extended(
        CandidateCard,
        grade_figures(run),
        kind="best" if run.search.met else "nearest",
        label="grade",
        note="",
        passes=run.passes,
        state=page.state(run.base, run.assignments()),
        command=page.command(1) if run.passes else None,
    )
    headline, *remarks = graded_lines(run)
    return PageSelection(
        selection=document,
        headline=headline,
        notes=[],
        cards=[card],
        remarks=[*rejected, *remarks],
        chart=None,
        table=PageTable("The grade, and constant membranes of its size", head, rows),
    )
