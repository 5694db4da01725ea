"""A selection as text for people."""

import numpy as np

from pneutouch.catalogue import ResolvedDesign
from pneutouch.cli.table import table_text
from pneutouch.selection import Candidate
from pneutouch.selection.missed import missed_percent
from pneutouch.spec.target import Target
from pneutouch.units import KPA
from pneutouch.workflows.select.contact import contact_notes
from pneutouch.workflows.select.document import would_need
from pneutouch.workflows.select.passing import RejectedDesign
from pneutouch.workflows.select.run import SelectionRun

_HEAD = ["", "resin", "R0 mm", "t0 mm", "wide mm", "kPa", "S kPa/N", "U (k=2)", "range N", "ends with"]
_HEAD += ["S 0 kPa..rated", "rated kPa", "binds", "solid S"]

_FEW = 9.95
"""Percents below this are shown with a decimal."""


def selection_text(selection: SelectionRun) -> str:
    """Ranked designs, or why there are none."""
    answer = selection.answer
    notes = [] if selection.by_solid is None else contact_notes(selection.by_solid, selection.base)
    head = [*_HEAD[:8], *(["place (k=1)"] if selection.problem.anywhere else []), *_HEAD[8:]]
    head = head if selection.by_solid is None else [*head[:-1], "plate S"]
    left = [*mount_note(selection.target, selection.base), *(_rejected(one) for one in selection.rejected)]
    left += [f"left out: {name}: {why}" for name, why in selection.left_out.items()]
    if answer.designs:
        seen: set[str] = set()
        rows = []
        for rank, choice in enumerate(answer.designs):
            label = f"{rank + 1}" + (" runner-up" if choice.resin.name in seen else "")
            seen.add(choice.resin.name)
            rows.append([label, *_row(selection, choice), _other(selection, choice, rank)])
        first = f"{len(answer.designs)} designs of {answer.candidates} candidates, on {selection.base.where}"
        return "\n".join([first, *notes, "", table_text(head, rows), "", *left]).rstrip()
    if selection.rejected:
        return "\n".join(["no design that meets the target passes the check", *notes, "", *left])
    lines = ["no design meets the target", *notes]
    if answer.nearest is not None:
        lines += [
            "",
            "nearest:",
            table_text(head[:-1], [["", *_row(selection, answer.nearest)]]),
            f"it misses: {_missed(selection, answer.nearest)}",
        ]
    lines += [
        "",
        *(
            f"without the requirement on {dropped.requirement} alone a design fits: {would_need(selection, dropped)} "
            f"({dropped.best.resin.name})"
            for dropped in answer.dropped
        ),
    ]
    if not answer.dropped:
        lines.append("no design fits with any single requirement dropped")
    return "\n".join([*lines, *left]).rstrip()


def _other(selection: SelectionRun, choice: Candidate, rank: int) -> str:
    """The sensitivity of the model that the row is not of: the solid's, or the atlas's under its plate."""
    if choice.contact is not None:
        return f"{choice.contact.plate_kPa_per_N:.3f}"
    return f"{selection.confirmed[rank].sensitivity_kPa_per_N:.3f}" if rank < len(selection.confirmed) else "-"


def mount_note(target: Target, base: ResolvedDesign) -> list[str]:
    """The sleeve for the finger that the target names: its own name has the number of another finger."""
    diameter_mm, name = target.target.finger_diameter_mm, base.design.connector.mount
    if diameter_mm is None or name.endswith(f"-{diameter_mm:g}"):
        return []
    return [f"mount: {base.mount.title}: {name} with connector.finger_diameter_mm = {diameter_mm:g}"]


def _rejected(one: RejectedDesign) -> str:
    """A design that the check rejects, and why."""
    pool = one.choice.pool
    size = f"{one.choice.resin.name}, R0 {pool.radius[0]:.2f} mm, t0 {pool.wall[0]:.2f} mm"
    return f"rejected: {size}: {one.rule + ': ' if one.rule else ''}{one.reason}"


def _missed(selection: SelectionRun, nearest: Candidate) -> str:
    """What the nearest design misses, in percent of what is required."""
    parts = []
    for name, percent in missed_percent(selection.problem, nearest).items():
        allowed = f" ({100 * selection.problem.tolerance:g} % is allowed)" if name == "sensitivity" else ""
        digits = 1 if percent is not None and percent < _FEW else 0
        parts.append(f"{name}, not known" if percent is None else f"{name} by {percent:.{digits}f} %{allowed}")
    return ", ".join(parts) or "nothing once rounded"


def _place(choice: Candidate) -> str:
    """What an unknown place of contact adds to the uncertainty."""
    return "not known" if choice.place is None else f"{100 * choice.place:.0f} %"


def _row(selection: SelectionRun, choice: Candidate) -> list[str]:
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
        f"{choice.rated / KPA:.1f}",
        f"{choice.binding} ({100 * choice.margins[choice.binding]:+.0f} %)",
    ]
