"""Rules on support that cannot be washed out: hollows behind necks, corners out of sight, long thin channels."""

import numpy as np

from pneutouch.arrays import Flags, Indices
from pneutouch.printability.measure.cavities import NARROW, Pocket, overhangs
from pneutouch.printability.measure.chords import first_hits
from pneutouch.printability.subject import Point3
from pneutouch.printability.view import PrintJob, PrintView
from pneutouch.results.printing import Excess, Finding, Severity

_VENDOR = "vendor, objet.com Tips and Tricks: a confined hollow is not cleanable; "
_NECK = _VENDOR + "share of the width that the opening needs: own, unverified"
_SIGHT = (
    _VENDOR
    + "near impossible with turns (PMC7172018); a straight jet in 300 directions, volume allowed: own, unverified"
)
_LONG = "Forge Labs PolyJet guideline: deep holes keep residue; ten widths: own, unverified"
_FILAMENT = "own, unverified: support that no tool reaches stays in"

CONFINED = 0.5
"""Ratio of an opening to the width behind it, below which a hollow is as good as closed."""
SLENDER = 10.0
"""Ratio of a channel's length to its width from which water does not suffice to clear it."""
_HIDDEN = 2.0
"""Least volume out of sight (mm3) for a finding; it must also be 30 cubes of the model."""
_SAMPLED, _DIRECTIONS = 40, 300
"""Number of cubes out of sight that are checked again, and of directions over the sphere (Fibonacci's spiral)."""
_BRIDGED = 50.0
"""Area of a ceiling, mm2, that a filament printer bridges without support: about 7 mm in each direction."""


def check_cleaning(view: PrintView) -> list[Finding]:
    """Findings on hollows and channels in which support would stay; a casting has no support."""
    findings = []
    for job in view.jobs:
        if job.sound and not job.printer.is_casting:
            findings += [*_necks(job), *_hidden(job)]
            if job.printer.process == "polyjet":
                findings += _slender(job)
    return findings


def _necks(job: PrintJob) -> list[Finding]:
    findings = []
    for pocket in job.pockets:
        if (
            pocket.width < 2.5 * job.voxels.pitch
            or job.in_hollow(pocket.where)
            or not _needs_support(job, pocket.region)
        ):
            continue
        severity: Severity = "error" if pocket.ratio < CONFINED else "warning"
        source = _NECK
        if job.printer.process != "polyjet":
            severity, source = "warning", _FILAMENT
        fix = "widen the opening, or split the part there"
        excess = Excess(pocket.ratio, CONFINED if severity == "error" else NARROW, "")
        findings.append(_finding(job, severity, _words(pocket), fix, source, pocket.where, excess))
    return findings


def _words(pocket: Pocket) -> str:
    return (
        f"a hollow of {pocket.volume:.3g} mm3, {pocket.width:.1f} mm wide and {pocket.depth:.1f} mm deep, opens by "
        f"{pocket.opening:.1f} mm only ({pocket.ratio:.0%} of its width)"
    )


def _hidden(job: PrintJob) -> list[Finding]:
    voxels = job.voxels
    hidden = job.hidden.copy()
    for pocket in job.pockets:
        hidden &= ~pocket.region
    cells = np.argwhere(hidden)
    volume, least = len(cells) * voxels.cube, max(_HIDDEN, 30 * voxels.cube)
    if volume <= least or not _needs_support(job, hidden):
        return []
    # The cubes have few directions: check some of them again with rays on the mesh.
    sampled = cells[np.linspace(0, len(cells) - 1, min(len(cells), _SAMPLED)).astype(np.int64)]
    dark = sampled[~_escapes(job, sampled)]
    volume *= len(dark) / len(sampled)
    if volume <= least:
        return []
    middle = dark[int(np.linalg.norm(dark - dark.mean(axis=0), axis=1).argmin())]
    text = f"{volume:.3g} mm3 of support lie where no straight jet comes"
    fix = "straighten the passage or open it from a second side"
    polyjet = job.printer.process == "polyjet"
    where, excess = voxels.point(middle), Excess(volume, least, "mm3")
    return [_finding(job, "warning", text, fix, _SIGHT if polyjet else _FILAMENT, where, excess)]


def _escapes(job: PrintJob, cells: Indices) -> Flags:
    """True for cubes from whose middle a straight line leads to the outside, (n,)."""
    index = np.arange(_DIRECTIONS) + 0.5
    height, turn = 1 - 2 * index / _DIRECTIONS, np.pi * (1 + 5**0.5) * index
    ring = np.sqrt(1 - height**2)
    directions = np.column_stack([ring * np.cos(turn), ring * np.sin(turn), height])
    starts = np.repeat([job.voxels.point(cell) for cell in cells], _DIRECTIONS, axis=0)
    reach = 2 * float(np.linalg.norm(job.bounds[1] - job.bounds[0]))
    hits = first_hits(job.union, starts, np.tile(directions, (len(cells), 1)), reach)
    return np.asarray(np.isinf(hits.distances[:, 1]).reshape(len(cells), _DIRECTIONS).any(axis=1))


def _needs_support(job: PrintJob, region: Flags) -> bool:
    """True if a region is filled with support: always by PolyJet, else under ceilings too wide to bridge."""
    if job.printer.process == "polyjet":
        return True
    ceiling = overhangs(job.voxels)[:, :, 1:] & region[:, :, :-1]
    return float(ceiling.sum()) * job.voxels.pitch**2 > _BRIDGED


def _slender(job: PrintJob) -> list[Finding]:
    findings = []
    for part in job.parts:
        for place in part.places:
            if place.kind == "channel" and place.length > SLENDER * place.size:
                slender = place.length / place.size
                text = f"a channel {place.size:.2f} mm wide is {slender:.0f} times as long"
                fix = part.item.hints.get("cleaning", "push a wire through and flush from both sides")
                where, excess = place.where, Excess(slender, SLENDER, "")
                findings.append(Finding("cleaning", "warning", part.name, text, fix, _LONG, where, excess))
    return findings


def _finding(
    job: PrintJob, severity: Severity, text: str, fix: str, source: str, where: Point3, excess: Excess
) -> Finding:
    part = job.nearest(where)
    fix = part.item.hints.get("cleaning", fix)
    return Finding("cleaning", severity, part.name, text, fix, source, where, excess)


_SOURCE = "vendor, objet.com Tips and Tricks: a confined hollow is not cleanable"
_CLOSED_FILAMENT = "our choice, unverified: a closed hollow cannot be inspected, and loose support stays in it"


def check_hollows(view: PrintView) -> list[Finding]:
    """Findings on closed hollows, in each body and between the bodies that a job joins."""
    findings = []
    for job in view.jobs:
        source = _SOURCE if job.printer.process == "polyjet" else _CLOSED_FILAMENT
        for hollow in job.hollows if job.sound else []:
            text = f"a closed hollow of {hollow.volume:.3g} mm3"
            part = job.nearest(hollow.where)
            fix = part.item.hints.get("hollows", "open it with a hole to clean through, or fill it")
            excess = Excess(hollow.volume, 0.0, "mm3")
            findings.append(Finding("hollows", "error", hollow.body, text, fix, source, hollow.where, excess))
    return findings
