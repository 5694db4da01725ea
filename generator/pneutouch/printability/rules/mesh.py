"""Mesh of a part: a solid, and as fine as the machine: no coarser, and not much finer."""

import numpy as np

from pneutouch.arrays import Array
from pneutouch.printability.rules.feature_sizes import spot
from pneutouch.printability.view import PrintPart, PrintView
from pneutouch.results.printing import Excess, Finding
from pneutouch.units import UM

_SOLID = (
    "vendor, objet.com Tips and Tricks: watertight; vertices rounded to 32-bit floats and merged, as STL readers do"
)
_FINEST = "the machine's finest step: least of layer height and pixel, as its profile states; "
_VENDOR = "vendor, objet.com Tips and Tricks: finer does not print better; four times finer: own, unverified"
_GUESS = 1.5
"""A sagitta overstates the deviation of a mesh that keeps its area by as much."""
_FINER = 4.0
"""Chords this many times narrower than the finest step needs make at least as many times the triangles."""


def check_mesh(view: PrintView) -> list[Finding]:
    """Measure closedness, the deviation from the exact solid and the width of chords."""
    findings = []
    for part in view.parts:
        findings += _open(part) or [*_coarse(part), *_fine(part)]
    return findings


def _open(part: PrintPart) -> list[Finding]:
    if not part.item.body.is_closed():
        text = "the mesh is not closed"
    elif not part.read.is_closed():
        text = "the mesh is not closed once its points are rounded to 32-bit floats and merged"
    elif not part.sound:
        text = "the mesh bounds no solid: it is inside out or not manifold"
    else:
        return []
    fix = part.item.hints.get("mesh", "mend the mesh where it comes from; nothing else is measured on it")
    return [Finding("mesh", "error", part.name, text, fix, _SOLID, None, None)]


def _coarse(part: PrintPart) -> list[Finding]:
    step = part.item.printer.finest_step(part.item.mode)
    if part.item.solid is None:
        (deviation, edge), how = part.surface.chord_error, "by the turn of its edges"
        where = part.surface.vertices[part.surface.edges.ends[edge]].mean(axis=0)
    else:
        points = _points(part)
        distances = part.item.solid.distance(points)
        deviation, how = float(distances.max()), "from the exact solid"
        where = points[int(distances.argmax())]
    if deviation <= step * (_GUESS if part.item.solid is None else 1.02):
        return []
    text = f"the mesh is off by {deviation / UM:.0f} um ({how}); the machine's finest step is {step / UM:g} um"
    fix = part.item.hints.get("mesh", f"mesh it within {step:g} mm")
    source = f"{_FINEST}{part.item.printer.step_source}"
    return [Finding("mesh", "warning", part.name, text, fix, source, spot(where), Excess(deviation, step, "mm"))]


def _points(part: PrintPart) -> Array:
    """Corners, middles of edges and middles of triangles: where a mesh is farthest off a smooth surface."""
    body, ends = part.surface, part.surface.edges.ends
    return np.concatenate([body.vertices, body.vertices[ends].mean(axis=1), body.corners.mean(axis=1)])


def _fine(part: PrintPart) -> list[Finding]:
    step = part.item.printer.finest_step(part.item.mode)
    sagittas = part.surface.sagittas
    curved = sagittas[sagittas > 1e-9]
    if len(curved) < 100:
        return []
    # Nine tenths of them are no higher; numpy.percentile loads the masked arrays, a tenth of NumPy's import.
    highest = np.interp(0.9 * (len(curved) - 1), np.arange(len(curved)), np.sort(curved))
    # A sagitta goes with the square of the chord's width.
    finer = float(np.sqrt(step / highest))
    if finer <= _FINER:
        return []
    text = f"its chords are {finer:.0f} times narrower than the machine's finest step of {step / UM:g} um needs"
    fix = part.item.hints.get("mesh", f"mesh it within {step:g} mm; the file gets smaller, the print the same")
    return [Finding("mesh", "note", part.name, text, fix, _FINEST + _VENDOR, None, Excess(finer, _FINER, ""))]
