"""Run every rule over a subject."""

from __future__ import annotations

from collections.abc import Callable

from pneutouch.printability.finding import Finding
from pneutouch.printability.rules import (
    channels,
    cleaning,
    contact_faces,
    driving,
    edges,
    emboss,
    envelope,
    freedom,
    gaps,
    holes,
    hollows,
    layers,
    matte,
    mesh,
    pins,
    resins,
    walls,
)  # fmt: skip
from pneutouch.printability.subject import PrintSubject
from pneutouch.printability.view import PrintView, SensorContext

Rule = Callable[[PrintView], list[Finding]]

RULES: dict[str, Rule] = {
    "mesh": mesh.check,
    "contact faces": contact_faces.check,
    "envelope": envelope.check,
    "resins": resins.check,
    "walls": walls.check,
    "pins": pins.check,
    "holes": holes.check,
    "channels": channels.check,
    "gaps": gaps.check,
    "emboss": emboss.check,
    "edges": edges.check,
    "hollows": hollows.check,
    "cleaning": cleaning.check,
    "matte": matte.check,
    "layers": layers.check,
    "driving": driving.check,
    "freedom": freedom.check,
}

_ORDER = {"error": 0, "warning": 1, "note": 2}


def check(subject: PrintSubject, sensor_context: SensorContext | None = None) -> list[Finding]:
    """All findings, errors first.

    Bodies whose mesh bounds no solid get the findings that need none: mesh, envelope and resins. Rules on the sensor's
    working (driving, layers) say nothing without ``sensor_context``.
    """
    view = PrintView(subject, sensor_context)
    found = [finding for rule in RULES.values() for finding in rule(view)]
    return sorted(found, key=lambda finding: _ORDER[finding.severity])
