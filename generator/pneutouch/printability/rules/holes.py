"""Holes against the smallest hole that the machine keeps open."""

from __future__ import annotations

from pneutouch.mechanics import Prediction
from pneutouch.parts import Assembly
from pneutouch.printability.finding import Finding


def check(assembly: Assembly, prediction: Prediction) -> list[Finding]:
    """Compare the port's bore, the air channel and the mounting holes."""
    scene, layout = assembly.scene, assembly.layout
    limit = scene.connector_printer.smallest.hole_mm
    holes = [
        ("the port's bore", scene.port.bore_diameter, (0.0, 0.0, layout.plate_low)),
        ("the air channel", 2 * layout.channel_radius, (0.0, 0.0, 0.0)),
        ("a mounting hole", scene.mount.hole_diameter, (layout.bolt_circle_radius, 0.0, layout.plate_low)),
    ]
    found = []
    for what, diameter, where in holes:
        if limit.least is not None and diameter < limit.least - 1e-9:
            text = f"{what} is {diameter:g} mm; the machine keeps no hole below {limit.least:g} mm open"
            fix = "take a larger port or mount, or another connector_profile"
            found.append(Finding("holes", "error", "connector", text, fix, limit.source, where))
        elif diameter < limit.recommended - 1e-9:
            text = f"{what} is {diameter:g} mm, below the recommended {limit.recommended:g} mm"
            fix = f"drill it through to {diameter:g} mm after printing"
            found.append(Finding("holes", "warning", "connector", text, fix, limit.source, where))
    return found
