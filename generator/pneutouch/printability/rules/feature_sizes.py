"""Features of one body, and gaps between bodies printed together, against the smallest that their machine prints.

They are measured on the meshes. Also edges too sharp to print, and triangles too thin to be written.
"""

from collections.abc import Iterator
from functools import partial
from itertools import combinations
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.body import Body
from pneutouch.printability.measure.chords import first_hits
from pneutouch.printability.measure.thin import FeatureKind, ThinPlace
from pneutouch.printability.subject import Point3
from pneutouch.printability.view import PrintPart, PrintView
from pneutouch.results.printing import Excess, Finding, Severity
from pneutouch.spec.printer import FeatureSize

ALIKE = 0.02
"""Places of one kind and severity whose sizes differ by less (mm) are reported once."""


def compare(view: PrintView, rule: str, kinds: dict[FeatureKind, str], limit: str, fix: str) -> list[Finding]:
    """Findings of ``rule``: places of the ``kinds``, each with its name in words, below the printer's ``limit``.

    ``fix`` is the remedy unless the item gives a hint of its own.
    """
    findings = []
    for part in view.sound:
        feature = part.limit(limit)
        broken = [
            (severity, least, place)
            for place in part.places
            if place.kind in kinds
            and (least := lower(place.size, feature, part.slack(place.size, place.turn))) is not None
            for severity in [severity_of(place.size, feature, part.slack(place.size, place.turn))]
        ]
        for severity, least, places in _alike(broken):
            findings.append(_finding(part, rule, kinds[places[0].kind], severity, least, places, feature.source, fix))
    return findings


def lower(size: float, feature: FeatureSize, slack: float) -> float | None:
    """The limit that a size (mm) is below by more than ``slack``: the least, else the recommended one; or None."""
    if feature.least is not None and size < feature.least - slack:
        return feature.least
    return feature.recommended if size < feature.recommended - slack else None


def severity_of(size: float, feature: FeatureSize, slack: float) -> Severity:
    """Severity of a size too small: error if below the machine's least by more than ``slack``, else warning."""
    return "error" if feature.least is not None and size < feature.least - slack else "warning"


def wording(size: float, limit: float, severity: Severity) -> str:
    """The size against its limit, mm: ``0.45 mm; the machine makes no less than 0.6 mm``."""
    if severity == "error":
        return f"{size:.2f} mm; the machine makes no less than {limit:g} mm"
    return f"{size:.2f} mm; at least {limit:g} mm is recommended"


def _alike(broken: list[tuple[Severity, float, ThinPlace]]) -> Iterator[tuple[Severity, float, list[ThinPlace]]]:
    """Severity, limit and places that are alike (see `ALIKE`), in the order of the narrowest."""
    left = list(broken)
    while left:
        severity, least, first = left[0]
        same = [b for b in left if b[0] == severity and abs(b[2].size - first.size) < ALIKE and b[2].kind == first.kind]
        yield severity, least, [place for _, _, place in same]
        left = [b for b in left if b not in same]


def _finding(
    part: PrintPart,
    rule: str,
    noun: str,
    severity: Severity,
    limit: float,
    places: list[ThinPlace],
    source: str,
    fix: str,
) -> Finding:
    size = min((place.end for place in places if place.end is not None), default=places[0].size)
    often = f" ({len(places)} places)" if len(places) > 1 else ""
    text = f"{noun} is {wording(size, limit, severity)}{often}"
    hint = part.item.hints.get(rule, fix)
    return Finding(rule, severity, part.name, text, hint, source, places[0].where, Excess(size, limit, "mm"))


def spot(where: object) -> Point3:
    """A point as a tuple of three floats, as findings have it."""
    x, y, z = (float(value) for value in where)  # type: ignore[attr-defined]
    return x, y, z


class SizeRule(NamedTuple):
    """A rule on sizes: the printer's ``limit``, kinds of features with their names in words, and the remedy."""

    limit: str
    features: dict[FeatureKind, str]
    fix: str


_DETAIL: dict[FeatureKind, str] = {"raised": "a raised detail", "engraved": "an engraved detail"}

# A channel is a hole longer than three widths; details are ridges and grooves with flanks lower than a millimetre.
SIZE_RULES = {
    "walls": SizeRule("wall", {"wall": "a wall"}, "make the wall thicker, or take another printer"),
    "pins": SizeRule("pin", {"pin": "a pin"}, "make the pin thicker, or let it lean on a wall"),
    "holes": SizeRule("hole", {"hole": "a hole"}, "make the hole wider, or drill it through after printing"),
    "channels": SizeRule(
        "channel", {"channel": "a channel"}, "make the channel wider or shorter, or drill it through after printing"
    ),
    "emboss": SizeRule("emboss", _DETAIL, "make the detail wider and higher"),
}


def check(view: PrintView, name: str) -> list[Finding]:
    """Findings of the rule ``name`` of `SIZE_RULES`: features of its kinds that are below the printer's limit."""
    rule = SIZE_RULES[name]
    return compare(view, name, rule.features, rule.limit, rule.fix)


CHECKS = {name: partial(check, name=name) for name in SIZE_RULES}
"""The `SIZE_RULES` as functions of a view, by name."""


_KNIFE = 30.0
"""Angle between faces inside the body (degrees) below which an edge is too sharp."""
_ROUNDING = 1e-4
"""Degrees by which an edge drawn at the limit may miss it."""
_LENGTH = 0.5
"""Length of sharp edges in mm above which there is a finding."""
_SHARP = "own, unverified: an edge thins to nothing, and below the smallest wall it is not printed"
_WRITTEN = "STL holds coordinates as 32-bit floats; 3MF readers do likewise"


def check_edges(view: PrintView) -> list[Finding]:
    """Findings on edges that are too sharp, and on triangles that vanish when a file rounds their corners."""
    return [finding for part in view.sound for finding in (*_knives(part), *_collapsed(part))]


def _knives(part: PrintPart) -> list[Finding]:
    edges = part.surface.edges
    angle = 180.0 - np.degrees(edges.turn)
    sharp = np.flatnonzero(angle < _KNIFE - _ROUNDING)
    ends = part.surface.vertices[edges.ends[sharp]]
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    total = float(lengths.sum())
    if total <= _LENGTH:
        return []
    least = float(angle[sharp].min())
    text = f"{total:.1f} mm of edge as sharp as {least:.0f} degrees; below {_KNIFE:g} degrees it does not print"
    fix = part.item.hints.get("edges", "blunt the edge")
    where = spot(ends[int(lengths.argmax())].mean(axis=0))
    return [Finding("edges", "warning", part.name, text, fix, _SHARP, where, Excess(least, _KNIFE, "degrees"))]


def _collapsed(part: PrintPart) -> list[Finding]:
    body = part.item.body
    rounded = body.vertices.astype(np.float32).astype(np.float64)
    before, after = _areas(body.vertices, body), _areas(rounded, body)
    lost = np.flatnonzero(np.einsum("ij,ij->i", before, after) <= 0)
    if not len(lost):
        return []
    text = f"{len(lost)} triangles vanish or turn over when a file rounds their corners"
    fix = part.item.hints.get(
        "edges", "mesh the body again with a wider tolerance, or merge the points that nearly meet"
    )
    where = spot(body.corners[lost[0]].mean(axis=0))
    return [Finding("edges", "warning", part.name, text, fix, _WRITTEN, where, Excess(len(lost), 0, "triangles"))]


def _areas(vertices: Array, body: Body) -> Array:
    a, b, c = np.moveaxis(vertices[body.triangles], 1, 0)
    return np.asarray(np.cross(b - a, c - a))


_TOUCHING = 1e-3
"""Faces nearer than this (mm) are meant to touch."""

_PARALLEL = -np.cos(np.radians(10.0))
"""Greatest cosine between normals of two bodies' faces that leave a gap; faces that meet at an edge do not."""

_GAP_FIX = "widen the gap, close it, or print the bodies apart"


def check_gaps(view: PrintView) -> list[Finding]:
    """Findings on gaps narrower than the printer's limit, within a body and between the bodies of a job."""
    findings = compare(view, "gaps", {"gap": "a gap"}, "gap", _GAP_FIX)
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
    hint = one.item.hints.get("gaps", _GAP_FIX)
    return [Finding("gaps", severity, one.name, text, hint, feature.source, where, Excess(size, limit, "mm"))]
