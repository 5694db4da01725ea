"""A selection as text for people."""

import numpy as np

from pneutouch.cli.table import table_text
from pneutouch.rounding import tenths_below
from pneutouch.selection import Candidate
from pneutouch.units import KPA
from pneutouch.workflows.select.run import SelectionRun
from pneutouch.workflows.select.words import dropped_lines, headline, missed_text, remarks, search_notes

HEAD = ["", "resin", "R0 mm", "t0 mm", "wide mm", "kPa", "S kPa/N", "U (k=2)", "range N", "ends with"]
HEAD += ["S 0 kPa..rated", "rated kPa", "binds", "solid S"]
"""Columns of the table of designs."""


def selection_text(selection: SelectionRun) -> str:
    """Ranked designs, or why there are none."""
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
    return "\n".join([*lines, "", *dropped_lines(selection), *left]).rstrip()


def _other(selection: SelectionRun, choice: Candidate, rank: int) -> str:
    """The sensitivity of the model that the row is not of: the solid's, or the atlas's under its plate."""
    if choice.contact is not None:
        return f"{choice.contact.plate_kPa_per_N:.3f}"
    return f"{selection.confirmed[rank].sensitivity_kPa_per_N:.3f}" if rank < len(selection.confirmed) else "-"


def _place(choice: Candidate) -> str:
    """Addition of an unknown place of contact to the uncertainty, in words."""
    return "not known" if choice.place is None else f"{100 * choice.place:.0f} %"


def row_of(selection: SelectionRun, choice: Candidate) -> list[str]:
    """A design in the columns of `HEAD`, without its rank and the other model's sensitivity."""
    pool = choice.pool
    return [
        choice.resin.name,
        f"{pool.radius[0]:.2f}",
        f"{pool.wall[0]:.2f}",
        f"{selection.footprint(choice):.1f}",
        f"{pool.pressure[0] / KPA:.2f}",
        f"{pool.response.lines.sensitivity_kPa_per_N[0]:.3f}",
        f"{100 * choice.expanded:.0f} %" if np.isfinite(choice.expanded) else "-",
        *([_place(choice)] if selection.problem.anywhere else []),
        f"0-{pool.force[0]:.2f}",
        choice.ends_with,
        "..".join(f"{end:.2f}" if np.isfinite(end) else "none" for end in choice.span),
        f"{tenths_below(choice.rated / KPA):.1f}",
        f"{choice.binding} ({100 * choice.margins[choice.binding]:+.0f} %)",
    ]
