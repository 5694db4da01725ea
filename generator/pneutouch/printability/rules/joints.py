"""Gaps inside a body and between bodies printed together against the narrowest that stays open.

Bond of a flange's glue to membrane and connector.

Freedom of the dome to move: its predicted shapes against the rigid bodies around it.
"""

from itertools import combinations

import numpy as np

from pneutouch.arrays import Array
from pneutouch.parts.glue import GLUES, glues_for
from pneutouch.printability.measure.chords import first_hits
from pneutouch.printability.rules.feature_sizes import compare, lower, severity_of, spot, wording
from pneutouch.printability.view import PrintPart, PrintView
from pneutouch.results.printing import Excess, Finding
from pneutouch.units import KPA

_TOUCHING = 1e-3
"""Faces nearer than this (mm) are meant to touch."""

_PARALLEL = -np.cos(np.radians(10.0))
"""Faces of two bodies leave a gap where they run along each other; where they meet at an edge they leave a corner."""

_FIX = "widen the gap, close it, or print the bodies apart"


def check_gaps(view: PrintView) -> list[Finding]:
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
    return [Finding("gaps", severity, one.name, text, hint, feature.source, where, Excess(size, limit, "mm"))]


_SEATS = "take connector.seat = clamped-flange-M2, which needs none"


def check_glue(view: PrintView) -> list[Finding]:
    """Look up the pair of surfaces in the table of glues; nothing where no glue is named or chosen."""
    context = view.sensor
    if context is None or context.glued is None or context.calibrated:
        return []
    name, one, other = context.glued
    glue = GLUES[name]
    bond = glue.bond(one, other)
    if bond is not None and not bond.weak:
        return []
    pair = one if one == other else f"{one} and {other}"
    better = [each for each in glues_for(one, other) if each != name]
    named = f"take connector.glue = {' or '.join(better)}" if bond is None and better else ""
    fix = ", or ".join(part for part in (named, _SEATS) if part)
    if bond is None:
        text = f"{glue.title} does not bond {pair}: the flange comes off"
        return [Finding("glue", "error", context.membrane, text, fix, glue.source, None, None)]
    text = f"{glue.title} on {pair} carries small loads: the flange may peel off under pressure"
    return [Finding("glue", "warning", context.membrane, text, fix, glue.source, None, None)]


_SOURCE = (
    "this project's prediction: the model's wall passes through this body: its figures do not hold where they touch"
)
_TOUCH = 0.05
"""Depth in mm below which a meeting is the mesh's and the prediction's own error."""


def check_freedom(view: PrintView) -> list[Finding]:
    """The deepest meeting of the inflated or pressed wall with each other body; nothing without predicted shapes."""
    if view.sensor is None:
        return []
    others = [part for part in view.parts if part.name != view.sensor.membrane and part.sound]
    findings = []
    for part in others:
        worst: tuple[float, str, tuple[float, float, float]] | None = None
        for state in view.sensor.prediction.states:
            for shape in state.shapes:
                depth, where = _deepest(part, shape.cells.reshape(-1, 2))
                if depth > _TOUCH and (worst is None or depth > worst[0]):
                    pressed = "" if shape.indentation is None else f", pressed by {shape.indentation:.2f} mm"
                    worst = depth, f"at {state.driving_pressure / KPA:g} kPa{pressed}", where
        if worst is not None:
            text = f"the dome meets the {part.name} {worst[1]}: they would overlap by {worst[0]:.2f} mm"
            fix = "lower pneumatics.driving_pressures_kPa or indentation.depth_mm, or take another connector.seat"
            findings.append(
                Finding(
                    "freedom",
                    "warning",
                    view.sensor.membrane,
                    text,
                    fix,
                    _SOURCE,
                    worst[2],
                    Excess(worst[0], 0.0, "mm"),
                )
            )
    return findings


def _deepest(part: PrintPart, plane: Array) -> tuple[float, tuple[float, float, float]]:
    """Greatest depth in mm of points (n, 2) in (r, z) inside a body, in the half plane y = 0, and where; 0 outside."""
    low, high = part.item.body.bounds
    near = plane[(plane[:, 0] >= -1e-9) & (plane[:, 0] < high[0]) & (plane[:, 1] > low[2]) & (plane[:, 1] < high[2])]
    points = np.column_stack([near[:, 0], np.full(len(near), 1e-4), near[:, 1]])
    inside = [len(part.manifold.ray_cast(tuple(p), (p[0], p[1], high[2] + 1.0))) % 2 == 1 for p in points]
    points = points[np.array(inside, bool)]
    if not len(points):
        return 0.0, (0.0, 0.0, 0.0)
    solid = part.item.solid
    gaps = (
        solid.distance(points)
        if solid is not None
        else np.min(np.linalg.norm(part.item.body.vertices[None] - points[:, None], axis=2), axis=1)
    )
    k = int(np.argmax(gaps))
    x, y, z = (float(value) for value in points[k])
    return float(gaps[k]), (x, y, z)
