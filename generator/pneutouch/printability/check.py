"""Run every rule over a sensor."""

from __future__ import annotations

from collections.abc import Callable

from pneutouch.mechanics import Prediction
from pneutouch.parts import Assembly
from pneutouch.printability.finding import Finding
from pneutouch.printability.rules import cleaning, contact_faces, driving, holes, walls

Rule = Callable[[Assembly, Prediction], list[Finding]]

RULES: dict[str, Rule] = {
    "walls": walls.check,
    "holes": holes.check,
    "contact faces": contact_faces.check,
    "cleaning": cleaning.check,
    "driving": driving.check,
}

_ORDER = {"error": 0, "warning": 1, "note": 2}


def check(assembly: Assembly, prediction: Prediction) -> list[Finding]:
    """All findings, errors first."""
    found = [finding for rule in RULES.values() for finding in rule(assembly, prediction)]
    return sorted(found, key=lambda finding: _ORDER[finding.severity])
