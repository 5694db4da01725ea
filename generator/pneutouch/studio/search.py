"""The job that answers a target: the document of ``select``, its designs as cards, and the trade-off chart."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pneutouch.catalogue import Library
from pneutouch.catalogue.cached_library import CachedLibrary
from pneutouch.cli.graded import graded_lines, graded_table
from pneutouch.rounding import rounded
from pneutouch.studio.by_process import by_process
from pneutouch.studio.candidate import candidate_card, graded_card
from pneutouch.studio.candidate_state import CandidateStates
from pneutouch.studio.question import PAGE, Question
from pneutouch.studio.target import at_its_fields, target_of
from pneutouch.workflows.select import words
from pneutouch.workflows.select.charts import tradeoff
from pneutouch.workflows.select.document import document
from pneutouch.workflows.select.gauged import select
from pneutouch.workflows.select.graded import select_graded
from pneutouch.workflows.select.graded_document import graded_document
from pneutouch.workflows.select.run import STEPS, SelectionRun

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from pneutouch.selection import Candidate
    from pneutouch.spec.target import Target
    from pneutouch.studio.job import Report

_DIGITS = 6
_CHART = "trade-off chart"


def search(arguments: Mapping[str, Any], folder: Path, report: Report) -> dict[str, Any]:
    """Search for the target that ``values`` state; where it names no base, its designs are those of ``base`` changed.

    Raises InputError naming the field.
    """
    library, bases = CachedLibrary(Library.default().folders), arguments["bases"]
    question = Question.of({key: arguments.get(key) for key in ("base", "values")})
    with at_its_fields():
        target = target_of(question, bases)
        page = CandidateStates(question, bases, library, target)
        if target.setting.processes is not None:
            return by_process(target, page, library, report)
        return (
            _graded(target, page, library, report) if target.given.graded else _selected(target, page, library, report)
        )


def _selected(target: Target, page: CandidateStates, library: Library, report: Report) -> dict[str, Any]:
    total = len(STEPS) + 1
    run = select(target, PAGE, library, progress=lambda step: report(STEPS.index(step), total, step))
    report(len(STEPS), total, _CHART)
    return {
        "selection": {**document(run), "written": None},
        "headline": words.headline(run),
        "notes": words.search_notes(run),
        "cards": _cards(run, page),
        "remarks": [*_nothing_to_drop(run), *words.remarks(run)],
        "chart": _chart(run, library),
        "table": None,
    }


def _cards(run: SelectionRun, page: CandidateStates) -> list[dict[str, Any]]:
    """The designs by rank; if there are none, the nearest, and those that fit without one of the requirements."""

    def card(choice: Candidate, kind: str, label: str, *, rank: int | None = None, note: str = "") -> dict[str, Any]:
        """A design as the page shows it, with the state that makes it the page's design."""
        return {
            **candidate_card(run, choice, rank),
            "kind": kind,
            "label": label,
            "note": note,
            "passes": rank in run.judged,
            "state": page.state(run.base, run.assignments(choice)),
            "command": None if rank is None else page.command(rank),
        }

    answer, seen, cards = run.answer, set[str](), []
    for rank, choice in enumerate(answer.designs, start=1):
        cards.append(card(choice, "runner-up" if choice.resin.name in seen else "best", str(rank), rank=rank))
        seen.add(choice.resin.name)
    if cards or run.rejected:
        return cards
    if answer.nearest is not None:
        misses = f"it misses: {words.missed_text(run, answer.nearest)}"
        cards.append(card(answer.nearest, "nearest", "nearest", note=misses))
    for dropped, line in zip(answer.dropped, words.dropped_lines(run), strict=False):
        cards.append(card(dropped.best, "dropped", f"without {dropped.requirement}", note=line))
    return cards


def _nothing_to_drop(run: SelectionRun) -> list[str]:
    """Lines for a target that no design meets, if none fits without one of its requirements either."""
    answer = run.answer
    return [] if answer.designs or run.rejected or answer.dropped else words.dropped_lines(run)


def _chart(run: SelectionRun, library: Library) -> dict[str, Any]:
    """The chart that ``select`` draws: sensitivities in kPa/N, forces in N, pressures in kPa."""
    drawn = tradeoff(run, library)
    content: dict[str, Any] = {
        "driving_pressure_kPa": drawn.driving_pressure_kPa,
        "gauge_kPa": drawn.gauge_kPa,
        "window_kPa_per_N": drawn.window_kPa_per_N and list(drawn.window_kPa_per_N),
        "least_force_N": drawn.force,
        "caption": drawn.caption,
        "fronts": [
            {
                "title": front.resin.material.title,
                "sensitivity_kPa_per_N": front.sensitivity_kPa_per_N.tolist(),
                "force_N": front.force.tolist(),
            }
            for front in drawn.known
        ],
    }
    result: dict[str, Any] = rounded(content, _DIGITS)
    return result


def _graded(target: Target, page: CandidateStates, library: Library, report: Report) -> dict[str, Any]:
    """The search for a grade, with the constant membranes of its size as a table in place of the chart."""
    run = select_graded(target, PAGE, library, lambda trial, done, most: report(done, most, "searching grades"))
    head, rows = graded_table(run)
    rejected = [] if run.rejected is None else [f"the grade is rejected by the check: {run.rejected}"]
    card = {
        **graded_card(run),
        "kind": "best" if run.search.met else "nearest",
        "label": "grade",
        "note": "",
        "passes": run.passes,
        "state": page.state(run.base, run.assignments()),
        "command": page.command(1) if run.passes else None,
    }
    headline, *remarks = graded_lines(run)
    return {
        "selection": {**graded_document(run), "written": None},
        "headline": headline,
        "notes": [],
        "cards": [card],
        "remarks": [*rejected, *remarks],
        "chart": None,
        "table": {"caption": "The grade, and constant membranes of its size", "head": head, "rows": rows},
    }
