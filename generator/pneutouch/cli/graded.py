"""``pneutouch select --graded``: the search for a grade, with its cost."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import typer

from pneutouch.cli.app import print_json
from pneutouch.cli.next_step import DesignPlace, report_written
from pneutouch.cli.progress import bar
from pneutouch.cli.table import table_text
from pneutouch.cli.terminal import echo, notify
from pneutouch.errors import InputError, RuleBrokenError
from pneutouch.rounding import tenths_below
from pneutouch.spec.target import Target
from pneutouch.units import KPA

if TYPE_CHECKING:
    from pneutouch.selection.grade_search import GradeTrial
    from pneutouch.workflows.select.graded import GradedSelectionRun


def select_graded(target: Target, where: str, place: DesignPlace | None, *, json: bool, refused: list[str]) -> None:
    """Search, show and save a grade. Exits 1 where none meets the target; ``refused`` are flags that exclude it.

    Raises RuleBrokenError if ``check`` rejects the grade that meets it; nothing is saved then.
    """
    from pneutouch.workflows.select import graded_document as shown
    from pneutouch.workflows.select.graded import select_graded as run

    if refused:
        raise InputError(f"{', '.join(f'--{flag}' for flag in refused)} cannot be given with --graded")
    begun = time.perf_counter()
    with bar("searching grades") as report:
        selection = run(target, where, progress=lambda trial, done, most: report(done, most))
    notify(f"{selection.solves} solid solves in {time.perf_counter() - begun:.0f} s")
    path = None
    if place is not None and selection.passes:
        path = shown.write_graded(selection, *place[:2], overwrite=place.overwrite)
    if json:
        print_json({**shown.graded_document(selection), "written": None if path is None else str(path)})
    else:
        echo(graded_text(selection))
        if path is not None:
            report_written(path)
    if selection.rejected is not None:
        raise RuleBrokenError(f"the grade meets the target and is rejected by `check`: {selection.rejected}")
    if not selection.search.met:
        raise typer.Exit(1)


def graded_text(selection: GradedSelectionRun) -> str:
    """The grade and the constant membranes of its size, or the requirements that are missed."""
    from pneutouch.evaluation.contact_object import contact_document
    from pneutouch.workflows.select.contact import contact_text

    contact = [f"contact: {contact_text(selection.base)}"] if contact_document(selection.base) else []
    headline, *lines = graded_lines(selection)
    return "\n".join([headline, *contact, "", table_text(*graded_table(selection)), "", *lines])


def graded_table(selection: GradedSelectionRun) -> tuple[list[str], list[list[str]]]:
    """Head and rows: the grade, then the constant membranes of its size."""
    pressures = [f"{p / KPA:g} kPa" for p in selection.grade_target.pressures]
    head = ["", *(f"S {p}" for p in pressures), *(["apart"] if len(pressures) > 1 else [])]
    head += [*(f"range {p}" for p in pressures), "ends with", "rated kPa", "meets"]
    rows = [["graded: " + selection.grade.label, *_row(selection, selection.search.best)]]
    return head, rows + [[constant.name, *_row(selection, constant.trial)] for constant in selection.constants]


def graded_lines(selection: GradedSelectionRun) -> list[str]:
    """Verdict on a grade against the target: its misses, its cost and the parts that were left out."""
    from pneutouch.workflows.select.graded_document import missed, rated_warning

    sensor = selection.sensor
    size = f"R0 {sensor.dome.inner_radius:g} mm, t0 {sensor.dome.wall_thickness:g} mm, on {selection.base.where}"
    met = "a grade meets the target" if selection.search.met else "no grade of this size meets the target; the nearest"
    lines = [f"{met}: {size}"]
    if not selection.search.met:
        lines += [f"it misses {line}" if k == 0 else line for k, line in enumerate(missed(selection))]
    warning = rated_warning(selection)
    lines += [] if warning is None else [f"warning: {warning}"]
    constant = [c.name for c in selection.constants if selection.meets(c.trial)]
    too = f"a constant membrane does too: {', '.join(constant)}"
    lines.append(too if constant else "no constant one listed meets it")
    lines.append(f"cost: {selection.solves} solid solves, {len(selection.search.trials)} of them grades")
    return lines + [f"left out: {name}: {why}" for name, why in selection.left_out.items()]


def _row(selection: GradedSelectionRun, trial: GradeTrial) -> list[str]:
    apart = [f"{100 * trial.difference:+.1f} %"] if len(trial.sensitivity_kPa_per_N) > 1 else []
    rated = "-" if trial.note else f"{tenths_below(trial.rated / KPA):.1f}"
    return [
        *(f"{value:.3f}" for value in trial.sensitivity_kPa_per_N),
        *apart,
        *(f"{value:.1f} N" for value in trial.force),
        ", ".join(dict.fromkeys(trial.ends)) or "-",
        rated,
        "yes" if selection.meets(trial) else "no",
    ]
