"""The answer to a target as text for people."""

from collections.abc import Sequence

import numpy as np

from pneutouch.cli.terminal import table_text
from pneutouch.selection import Candidate
from pneutouch.selection.graded import GradeTrial
from pneutouch.units import KPA
from pneutouch.wording import counted, tenths_below
from pneutouch.workflows.select.document import (
    Typed,
    graded_missed,
    grouped,
    headline,
    in_file,
    left_out_lines,
    missed_text,
    rated_warning,
    relief_lines,
    remarks,
    search_notes,
)
from pneutouch.workflows.select.graded import GradedSelectionRun
from pneutouch.workflows.select.processes import ProcessSelection
from pneutouch.workflows.select.search import TargetAnswer
from pneutouch.workflows.select.select import SelectionRun
from pneutouch.workflows.select.shapes import BALL_MM, ShapeSelection

HEAD = ["", "resin", "R0 mm", "t0 mm", "wide mm", "kPa", "S kPa/N", "U (k=2)", "range N", "ends with"]
HEAD += ["S 0 kPa..rated", "rated kPa", "binds", "solid S"]
"""Columns of the table of designs."""


def answer_text(answer: TargetAnswer, typed: Typed) -> str:
    """The answer to a target of any kind; ``typed`` writes a field to change as an option."""
    if isinstance(answer.run, ProcessSelection):
        return processes_text(answer.run, typed)
    if isinstance(answer.run, ShapeSelection):
        return shapes_text(answer.run, typed)
    if isinstance(answer.run, GradedSelectionRun):
        return graded_text(answer.run)
    return selection_text(answer.run, relief_lines(answer.run, answer.relief, typed))


def selection_text(selection: SelectionRun, enough: Sequence[str] = ()) -> str:
    """Ranked designs; or the nearest one and its misses, with the lines ``enough`` on changes that suffice."""
    answer, notes, left = selection.answer, search_notes(selection), remarks(selection)
    head = [*HEAD[:8], *(["place (k=1)"] if selection.problem.anywhere else []), *HEAD[8:]]
    head = head if selection.by_solid is None else [*head[:-1], "plate S"]
    if answer.designs:
        seen: set[str] = set()
        rows = []
        for rank, choice in enumerate(answer.designs):
            label = f"{rank + 1}" + (" runner-up" if choice.resin.name in seen else "")
            seen.add(choice.resin.name)
            rows.append([label, *row_of(selection, choice), _other(selection, choice, rank)])
        return "\n".join([headline(selection), *notes, "", table_text(head, rows), "", *left]).rstrip()
    if selection.rejected:
        return "\n".join([headline(selection), *notes, "", *left])
    lines = [headline(selection), *notes]
    if answer.nearest is not None:
        lines += [
            "",
            "nearest:",
            table_text(head[:-1], [["", *row_of(selection, answer.nearest)]]),
            f"it misses: {missed_text(selection, answer.nearest)}",
        ]
    return "\n".join([*lines, "", *enough, "", *left]).rstrip()


def _other(selection: SelectionRun, choice: Candidate, rank: int) -> str:
    """Sensitivity by the model that the row does not show: the solid, or the atlas under its plate."""
    if choice.contact is not None:
        return f"{choice.contact.plate_kPa_per_N:.3f}"
    return f"{selection.confirmed[rank].sensitivity:.3f}" if rank < len(selection.confirmed) else "-"


def row_of(selection: SelectionRun, choice: Candidate) -> list[str]:
    """A design in the columns of `HEAD`, without its rank and the other model's sensitivity."""
    pool, place = choice.pool, "not known" if choice.place is None else f"{100 * choice.place:.0f} %"
    ends = (f"{end:.2f}" if end >= 0.1 else f"{end:.2g}" for end in choice.span)
    return [
        choice.resin.name,
        f"{pool.radius[0]:.2f}",
        f"{pool.wall[0]:.2f}",
        f"{selection.footprint(choice):.1f}",
        f"{pool.pressure[0] / KPA:.2f}",
        f"{pool.figures.sensitivity:.3f}",
        f"{100 * choice.expanded:.0f} %" if np.isfinite(choice.expanded) else "-",
        *([place] if selection.problem.anywhere else []),
        f"0-{pool.figures.reach:.2f}",
        choice.ends_with,
        "..".join(ends).replace("nan", "none"),
        f"{tenths_below(choice.rated / KPA):.1f}",
        f"{choice.binding} ({choice.binding_margin})",
    ]


def processes_text(selection: ProcessSelection, typed: Typed = in_file) -> str:
    """A row for the best design of each process, and why others have none."""
    head, rows = processes_table(selection)
    return "\n".join([*([table_text(head, rows), ""] if rows else []), *processes_lines(selection, typed)])


def processes_table(selection: ProcessSelection) -> tuple[list[str], list[list[str]]]:
    """The best design of each process that has one: columns and rows."""

    rows = []
    for number, (process, run) in enumerate(selection.best, start=1):
        best = run.answer.designs[0]
        solid = "solid" if best.contact is not None else f"{run.confirmed[0].sensitivity:.3f}"
        rows.append([str(number), process, *row_of(run, best), solid])
    return [HEAD[0], "process", *HEAD[1:]], rows


def processes_lines(selection: ProcessSelection, typed: Typed = in_file) -> list[str]:
    """Profile and confirmation of each best design; why a process has none, and what makes one possible if all do."""

    lines = []
    for process, run in selection.best:
        solid = run.answer.designs[0].contact is not None or run.confirmed[0].within
        others = len({choice.resin.name for choice in run.answer.designs}) - 1
        confirmed = "confirmed by the solid" if solid else "the solid is outside its interval"
        also = f"{counted(others, 'other resin')} meet{'s' if others == 1 else ''} the target"
        lines.append(f"{process}: {run.base.printer.title}, {confirmed}; {also}")
    for process, run in selection.runs.items():
        if not run.answer.designs:
            nearest = run.answer.nearest
            why = "" if nearest is None else f"; the nearest misses {missed_text(run, nearest)} ({nearest.resin.name})"
            enough = [] if process not in selection.reliefs else relief_lines(run, selection.reliefs[process], typed)
            lines += [f"{process}: {line}" for line in (f"{headline(run)}{why}", *enough, *left_out_lines(run))]
    return lines + [f"{process}: left out: {why}" for process, why in selection.left_out.items()]


SHAPE_HEAD = ["", "shape", "resin", "R0 mm", "t0 mm", "other sizes, mm", "high mm", "wide mm", "kPa", "S kPa/N"]
SHAPE_HEAD += ["N/mm", "range N", "travel mm", "ball reads", "rated kPa"]
"""Columns of the table of shapes."""


def shapes_text(selection: ShapeSelection, typed: Typed = in_file) -> str:
    """A row for the best design of each shape, and why others have none."""
    head, rows = shapes_table(selection)
    return "\n".join([*([table_text(head, rows), ""] if rows else []), *shapes_lines(selection, typed)])


def shapes_table(selection: ShapeSelection) -> tuple[list[str], list[list[str]]]:
    """The best design of each shape that has one: columns and rows."""
    rows = []
    for number, one in enumerate(selection.record.designs, start=1):
        ball = "no line" if one.ball_reading_ratio is None else f"{100 * (one.ball_reading_ratio - 1):+.0f} %"
        sizes = ", ".join(f"{key.removesuffix('_mm').replace('_', ' ')} {size:g}" for key, size in one.sizes.items())
        row = [str(number), one.shape, one.material, f"{one.inner_radius_mm:.2f}", f"{one.wall_thickness_mm:.2f}"]
        row += [sizes or "-", f"{one.height_mm:.1f}", f"{one.footprint_mm:.1f}", f"{one.driving_pressure_kPa:g}"]
        row += [f"{one.sensitivity_kPa_per_N:.3f}", f"{one.stiffness_N_per_mm:.3g}", f"0-{one.force_range_end_N:.2f}"]
        rows.append([*row, f"{one.travel_mm:.2f}", ball, f"{tenths_below(one.rated_pressure_kPa):.1f}"])
    return SHAPE_HEAD, rows


def shapes_lines(selection: ShapeSelection, typed: Typed = in_file) -> list[str]:
    """Lines on the figures of the table, the shapes without a design and the resins left out, with the reasons."""
    met = f"{counted(len(selection.designs), 'shape')} of {len(selection.designs) + len(selection.missed)}"
    lines = [f"{met} with a design that meets the target"]
    if selection.designs:
        lines[0] += f"; first: {PREFERRED[selection.target.weights.prefer or 'robust']}"
        lines.append(
            f"every figure is the solid's ({selection.solves} presses); each design passes `check`; "
            f"ball reads: pressure under a ball of {BALL_MM:g} mm radius over the plate's at the same force, less 1"
        )
    return [*lines, *(f"{name}: {why}" for name, why in selection.reasons(typed).items()), *grouped(selection.left_out)]


PREFERRED = {
    "robust": "the least effect of the wall's print error",
    "travel": "the longest travel",
    "force": "the greatest force range",
    "low": "the lowest dome",
    "ball": "the least effect of a small ball",
}
"""Words for the first design, by the target's ``prefer``."""


def graded_text(selection: GradedSelectionRun) -> str:
    """The grade and the constant membranes of its size, or the requirements that are missed."""
    from pneutouch.evaluation.contact_object import contact_document
    from pneutouch.workflows.select.checks import contact_text

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

    sensor = selection.sensor
    size = f"R0 {sensor.dome.inner_radius:g} mm, t0 {sensor.dome.wall_thickness:g} mm, on {selection.base.where}"
    met = "a grade meets the target" if selection.search.met else "no grade of this size meets the target; the nearest"
    lines = [f"{met}: {size}"]
    if not selection.search.met:
        lines += [f"it misses {line}" if k == 0 else line for k, line in enumerate(graded_missed(selection))]
    warning = rated_warning(selection)
    lines += [] if warning is None else [f"warning: {warning}"]
    constant = [c.name for c in selection.constants if selection.meets(c.trial)]
    too = f"a constant membrane does too: {', '.join(constant)}"
    lines.append(too if constant else "no constant one listed meets it")
    lines.append(f"cost: {selection.solves} solid solves, {len(selection.search.trials)} of them grades")
    return lines + [f"left out: {name}: {why}" for name, why in selection.left_out.items()]


def _row(selection: GradedSelectionRun, trial: GradeTrial) -> list[str]:
    apart = [f"{100 * trial.difference:+.1f} %"] if len(trial.sensitivity) > 1 else []
    rated = "-" if trial.note else f"{tenths_below(trial.rated / KPA):.1f}"
    return [
        *(f"{value:.3f}" for value in trial.sensitivity),
        *apart,
        *(f"{value:.1f} N" for value in trial.force),
        ", ".join(dict.fromkeys(trial.ends)) or "-",
        rated,
        "yes" if selection.meets(trial) else "no",
    ]
