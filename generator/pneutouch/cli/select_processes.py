"""``pneutouch select --process``: the best design of each process."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import typer

from pneutouch.cli.app import print_json
from pneutouch.cli.next_step import DesignPlace, report_next, report_written
from pneutouch.cli.progress import bar
from pneutouch.cli.table import table_text
from pneutouch.cli.terminal import echo
from pneutouch.errors import InputError
from pneutouch.spec.target import Target

if TYPE_CHECKING:
    from pneutouch.workflows.select.processes import ProcessSelection


def select_over(target: Target, where: str, place: DesignPlace | None, pick: int, *, json: bool, charts: bool) -> None:
    """Search each process, show the best designs and save the one picked. Exits 1 where no process has one."""
    from pneutouch.workflows.select.document import write_choice
    from pneutouch.workflows.select.processes import select_processes

    if charts:
        raise InputError("--charts cannot be given with --process", remedy="draw them for one `profile`")
    with bar("") as report:
        selection = select_processes(target, where, progress=report)
    path = None
    if selection.best and (place is not None or pick != 1):
        run = selection.pick(pick)
        if place is not None:
            path = write_choice(run, run.answer.designs[0], *place[:2], overwrite=place.overwrite)
    if json:
        print_json({**selection.document(), "written": None if path is None else str(path)})
    else:
        echo(processes_text(selection))
        if path is not None:
            report_written(path)
        elif selection.best:
            from pneutouch.output.new import free_name

            report_next(*sys.argv[1:], "--write", free_name())
    if not selection.best:
        raise typer.Exit(1)


def processes_text(selection: ProcessSelection) -> str:
    """A row for the best design of each process, and why others have none."""
    head, rows = processes_table(selection)
    return "\n".join([*([table_text(head, rows), ""] if rows else []), *processes_lines(selection)])


def processes_table(selection: ProcessSelection) -> tuple[list[str], list[list[str]]]:
    """The best design of each process that has one: columns and rows."""
    from pneutouch.cli.select_text import HEAD, row_of

    rows = []
    for number, (process, run) in enumerate(selection.best, start=1):
        best = run.answer.designs[0]
        solid = "solid" if best.contact is not None else f"{run.confirmed[0].sensitivity_kPa_per_N:.3f}"
        rows.append([str(number), process, *row_of(run, best), solid])
    return [HEAD[0], "process", *HEAD[1:]], rows


def processes_lines(selection: ProcessSelection) -> list[str]:
    """Profile and confirmation of each best design, and why a process has none."""
    from pneutouch.workflows.select.words import headline, missed_text

    lines = []
    for process, run in selection.best:
        solid = run.answer.designs[0].contact is not None or run.confirmed[0].within
        others = len({choice.resin.name for choice in run.answer.designs}) - 1
        confirmed = "confirmed by the solid" if solid else "the solid is outside its interval"
        lines.append(f"{process}: {run.base.printer.title}, {confirmed}; {others} other resins meet the target")
    for process, run in selection.runs.items():
        if not run.answer.designs:
            nearest = run.answer.nearest
            why = "" if nearest is None else f"; the nearest misses {missed_text(run, nearest)} ({nearest.resin.name})"
            lines.append(f"{process}: {headline(run)}{why}")
    return lines + [f"{process}: left out: {why}" for process, why in selection.left_out.items()]
