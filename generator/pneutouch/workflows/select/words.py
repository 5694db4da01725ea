"""A selection in words, for the terminal and the studio."""

from pneutouch.catalogue import ResolvedDesign
from pneutouch.selection import Candidate
from pneutouch.selection.missed import missed_percent
from pneutouch.spec.target import Target
from pneutouch.workflows.select.contact import contact_notes
from pneutouch.workflows.select.document import would_need
from pneutouch.workflows.select.passing import RejectedDesign
from pneutouch.workflows.select.run import SelectionRun

_FEW = 9.95
"""Percents below this are shown with a decimal."""


def headline(selection: SelectionRun) -> str:
    """Number of designs found, in words, or that there are none."""
    answer = selection.answer
    if answer.designs:
        return f"{len(answer.designs)} designs of {answer.candidates} candidates, on {selection.base.where}"
    if selection.rejected:
        return "no design that meets the target passes the check"
    return "no design meets the target"


def search_notes(selection: SelectionRun) -> list[str]:
    """Notes on the pressing object and on the search with the solid; empty for a contact that the atlas covers."""
    return [] if selection.by_solid is None else contact_notes(selection.by_solid, selection.base)


def missed_text(selection: SelectionRun, nearest: Candidate) -> str:
    """Requirements that the nearest design misses, in percent of the required value."""
    parts = []
    for name, percent in missed_percent(selection.problem, nearest).items():
        allowed = f" ({100 * selection.problem.tolerance:g} % is allowed)" if name == "sensitivity" else ""
        digits = 1 if percent is not None and percent < _FEW else 0
        parts.append(f"{name}, not known" if percent is None else f"{name} by {percent:.{digits}f} %{allowed}")
    return ", ".join(parts) or "nothing once rounded"


def dropped_lines(selection: SelectionRun) -> list[str]:
    """Each single requirement whose removal admits a design, with the value that can be reached; or that there is
    none."""
    return [
        f"without the requirement on {dropped.requirement} alone a design fits: {would_need(selection, dropped)} "
        f"({dropped.best.resin.name})"
        for dropped in selection.answer.dropped
    ] or ["no design fits with any single requirement dropped"]


def remarks(selection: SelectionRun) -> list[str]:
    """The mount for a finger, designs that the check rejects, and resins that were left out."""
    return [
        *mount_note(selection.target, selection.base),
        *(f"gauge {'chosen' if one.chosen else 'out'}: {one.name}: {one.why}" for one in selection.gauges),
        *(_rejected(one) for one in selection.rejected),
        *(f"left out: {name}: {why}" for name, why in selection.left_out.items()),
    ]


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
