"""Support on the face that senses, which it would leave matte and rough."""

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.printability.finding import Excess, Finding
from pneutouch.printability.measure.rays import first_hits
from pneutouch.printability.sizes import spot
from pneutouch.printability.view import PrintJob, PrintPart, PrintView

_SOURCE = "vendor: faces that support touches come out matte (DOC-37004 p. 5-34); share allowed: own, unverified"
_MOST = 0.01
"""Share of the sensing face that support may touch."""
_DOWN = {"polyjet": -0.02, "filament": -0.7, "resin": -0.7}
"""Vertical part of the normal below which a face needs support: any overhang (PolyJet), past 45 degrees (others)."""
_OFF = 1e-3
"""Distance from the face in mm at which the look upwards starts."""


def check(view: PrintView) -> list[Finding]:
    """Measure the share of each sensing face that looks down or lies under something of the same job; none is cast."""
    return [
        finding
        for job in view.jobs
        for part in job.parts
        if part.item.sensing is not None
        and job.sound
        and not job.printer.is_casting
        and (finding := _check(job, part)) is not None
    ]


def _check(job: PrintJob, part: PrintPart) -> Finding | None:
    samples, sensing = part.samples, part.item.sensing
    rows = np.flatnonzero(
        (samples.areas > 0) & (np.zeros(len(samples.areas), bool) if sensing is None else sensing(samples.points))
    )
    if not len(rows):
        return None
    areas, points = samples.areas[rows], samples.points[rows]
    touched = _touched(job, part, points, part.surface.normals[samples.faces[rows]])
    share = float(areas[touched].sum() / areas.sum())
    if share <= _MOST:
        return None
    text = f"support touches {share:.0%} of the sensing face; at most {_MOST:.0%} may be matte"
    fix = part.item.hints.get("matte", "turn the part so that its sensing face looks up")
    where = spot(points[touched][0])
    return Finding("matte", "warning", part.name, text, fix, _SOURCE, where, Excess(share, _MOST, ""))


def _touched(job: PrintJob, part: PrintPart, points: Array, normals: Array) -> Flags:
    touched: Flags = normals @ job.up < _DOWN[part.process]
    height = float(job.bounds[1][2] - job.bounds[0][2]) + 1.0
    upwards = np.broadcast_to(job.up, points.shape)
    for other in job.parts:
        left = np.flatnonzero(~touched)
        hits = first_hits(other.manifold, points[left] + _OFF * normals[left], upwards[left], height)
        touched[left] |= np.isfinite(hits.distances[:, 1])
    return touched
