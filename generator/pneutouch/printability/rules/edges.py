"""Edges too sharp to print, and triangles too thin to be written."""

import numpy as np

from pneutouch.arrays import Array
from pneutouch.body import Body
from pneutouch.printability.finding import Excess, Finding
from pneutouch.printability.sizes import spot
from pneutouch.printability.view import PrintPart, PrintView

_KNIFE = 30.0
"""Angle inside the body (degrees) below which an edge is a knife's."""
_ROUNDING = 1e-4
"""Degrees by which an edge drawn at the limit may miss it."""
_LENGTH = 0.5
"""Length of sharp edges in mm that is worth a word."""
_SHARP = "own, unverified: an edge thins to nothing, and below the smallest wall it is not printed"
_WRITTEN = "STL holds coordinates as 32-bit floats; 3MF readers do likewise"


def check(view: PrintView) -> list[Finding]:
    """Look at the angle inside of every edge, and at every triangle after rounding."""
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
