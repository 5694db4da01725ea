"""Freedom of the dome to move: its predicted shapes against the rigid bodies around it."""

import numpy as np

from pneutouch.arrays import Array
from pneutouch.printability.finding import Excess, Finding
from pneutouch.printability.view import PrintPart, PrintView
from pneutouch.units import KPA

_SOURCE = (
    "this project's prediction: the model's wall passes through this body: its figures do not hold where they touch"
)
_TOUCH = 0.05
"""Depth in mm below which a meeting is the mesh's and the prediction's own error."""


def check(view: PrintView) -> list[Finding]:
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
                Finding("freedom", "warning", view.sensor.membrane, text, fix, _SOURCE, worst[2], Excess(worst[0], 0.0))
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
