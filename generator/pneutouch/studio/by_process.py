"""The answer to a target over several processes: the table of the command, and the best design of each as a card."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pneutouch.cli.select_processes import processes_lines, processes_table
from pneutouch.studio.candidate import candidate_card
from pneutouch.studio.question import PAGE
from pneutouch.workflows.select.processes import select_processes
from pneutouch.workflows.select.words import missed_text

if TYPE_CHECKING:
    from pneutouch.catalogue import Library
    from pneutouch.spec.target import Target
    from pneutouch.studio.candidate_state import CandidateStates
    from pneutouch.studio.job import Report
    from pneutouch.workflows.select.run import SelectionRun


def by_process(target: Target, page: CandidateStates, library: Library, report: Report) -> dict[str, Any]:
    """Search each process of a target; for one in which no design meets it, the card shows the nearest."""
    selection = select_processes(target, PAGE, library, progress=report)
    row = {process: number for number, (process, _) in enumerate(selection.best, start=1)}
    cards = [_card(process, run, page, row.get(process)) for process, run in selection.runs.items()]
    searched, (head, rows) = len(selection.runs) + len(selection.left_out), processes_table(selection)
    return {
        "selection": {**selection.document(), "written": None},
        "headline": f"{len(row) or 'none'} of {searched} processes with a design that meets the target",
        "notes": [],
        "cards": [card for card in cards if card is not None],
        "remarks": processes_lines(selection),
        "chart": None,
        "table": {"caption": "The best design of each process", "head": head, "rows": rows} if rows else None,
    }


def _card(process: str, run: SelectionRun, page: CandidateStates, row: int | None) -> dict[str, Any] | None:
    """The best design of a process, in ``row`` of the table, or the nearest one with its misses; None without
    either."""
    choice = run.answer.nearest if row is None else run.answer.designs[0]
    if choice is None:
        return None
    card = candidate_card(run, choice, None if row is None else 1)
    return {
        **card,
        "rank": row,
        "title": f"{process}: {card['title']}",
        "rows": [("Profile", run.base.printer.title, ""), *card["rows"]],
        "kind": "nearest" if row is None else "process",
        "label": process,
        "note": f"it misses: {missed_text(run, choice)}" if row is None else "",
        "passes": row is not None and 1 in run.judged,
        "state": page.state(run.base, run.assignments(choice)),
        "command": None if row is None else page.command(row),
    }
