"""Walls against the smallest wall that the machine prints in the material."""

from __future__ import annotations

from pneutouch.mechanics import Prediction
from pneutouch.parts import Assembly
from pneutouch.printability.finding import Finding
from pneutouch.spec.printer import Feature


def check(assembly: Assembly, prediction: Prediction) -> list[Finding]:
    """Compare the dome's wall, the ring around the groove and the wall of the port."""
    scene, layout = assembly.scene, assembly.layout
    soft = scene.printer.smallest.wall(scene.membrane_material.kind)
    rigid = scene.connector_printer.smallest.wall(scene.connector_material.kind)
    port = scene.port
    bore = 0.5 * port.bore_diameter
    walls = [
        ("membrane", "the dome's wall", layout.wall, (0.0, 0.0, layout.outer_radius), soft,
         "raise membrane.wall_thickness_mm"),
        ("connector", "the ring around the groove", layout.ring_radius - layout.groove_outer,
         (layout.ring_radius, 0.0, 0.0), rigid, "take another seat"),
        ("connector", "the port's stem", 0.5 * port.stem_diameter - bore,
         (0.5 * port.stem_diameter, 0.0, layout.plate_low), rigid, "take a larger port"),
    ]  # fmt: skip
    return [found for wall in walls if (found := _compare(*wall)) is not None]


def _compare(
    body: str, what: str, wall: float, where: tuple[float, float, float], limit: Feature, fix: str
) -> Finding | None:
    if limit.least is not None and wall < limit.least - 1e-9:
        text = f"{what} is {wall:.2f} mm; the machine prints no less than {limit.least:g} mm"
        return Finding("walls", "error", body, text, fix, limit.source, where)
    if wall < limit.recommended - 1e-9:
        text = f"{what} is {wall:.2f} mm; at least {limit.recommended:g} mm is recommended"
        return Finding("walls", "warning", body, text, fix, limit.source, where)
    return None
