"""Gaps inside a body and between bodies printed together against the narrowest that stays open."""

from itertools import combinations

import numpy as np

from pneutouch.printability.finding import Excess, Finding
from pneutouch.printability.measure.rays import first_hits
from pneutouch.printability.sizes import compare, lower, severity_of, spot, wording
from pneutouch.printability.view import PrintPart, PrintView

_TOUCHING = 1e-3
"""Faces nearer than this (mm) are meant to touch."""

_PARALLEL = -np.cos(np.radians(10.0))
"""Faces of two bodies leave a gap where they run along each other; where they meet at an edge they leave a corner."""

_FIX = "widen the gap, close it, or print the bodies apart"


def check(view: PrintView) -> list[Finding]:
    """Compare every gap."""
    findings = compare(view, "gaps", {"gap": "a gap"}, "gap", _FIX)
    for job in view.jobs:
        for one, other in combinations([part for part in job.parts if part.sound], 2):
            findings += _between(one, other)
    return findings


def _between(one: PrintPart, other: PrintPart) -> list[Finding]:
    feature = one.limit("gap")
    samples, reach = one.samples, feature.recommended
    box = other.item.body.bounds + np.array([[-reach], [reach]])
    rows = np.flatnonzero(((samples.points >= box[0]) & (samples.points <= box[1])).all(axis=1))
    if not len(rows):
        return []
    normals = one.surface.normals[samples.faces[rows]]
    # Starting just inside, so that a touching face is hit and distinguished from a gap.
    starts = samples.points[rows] - 0.5 * _TOUCHING * normals
    hits = first_hits(other.manifold, starts, normals, reach + _TOUCHING)
    width = hits.distances[:, 1] - 0.5 * _TOUCHING
    facing = np.einsum("ij,ij->i", normals, other.surface.normals[hits.faces[:, 1]])
    width = np.where((width > _TOUCHING) & (facing < _PARALLEL), width, np.inf)
    first = int(width.argmin())
    size = float(width[first])
    slack = one.slack(reach, 0.0) + other.slack(reach, 0.0)
    limit = lower(size, feature, slack)
    if limit is None:
        return []
    severity = severity_of(size, feature, slack)
    text = f"the gap to the {other.name} is {wording(size, limit, severity)}"
    where = spot(samples.points[rows[first]])
    hint = one.item.hints.get("gaps", _FIX)
    return [Finding("gaps", severity, one.name, text, hint, feature.source, where, Excess(size, limit))]
