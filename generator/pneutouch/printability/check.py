"""Run every rule over a subject."""

from collections.abc import Callable

from pneutouch.printability.finding import Finding
from pneutouch.printability.rules import (
    casting,
    cleaning,
    contact_faces,
    driving,
    edges,
    envelope,
    feature_sizes,
    freedom,
    gaps,
    glue,
    hollows,
    layers,
    matte,
    mesh,
    mixing_curve,
    resins,
)
from pneutouch.printability.subject import PrintSubject
from pneutouch.printability.view import PrintView, SensorContext

Rule = Callable[[PrintView], list[Finding]]

RULES: dict[str, Rule] = {
    "mesh": mesh.check,
    "contact faces": contact_faces.check,
    "envelope": envelope.check,
    "resins": resins.check,
    "walls": feature_sizes.CHECKS["walls"],
    "pins": feature_sizes.CHECKS["pins"],
    "holes": feature_sizes.CHECKS["holes"],
    "channels": feature_sizes.CHECKS["channels"],
    "gaps": gaps.check,
    "emboss": feature_sizes.CHECKS["emboss"],
    "edges": edges.check,
    "hollows": hollows.check,
    "cleaning": cleaning.check,
    "matte": matte.check,
    "layers": layers.check,
    "filling": casting.filling,
    "bubbles": casting.bubbles,
    "inhibition": casting.inhibition,
    "glue": glue.check,
    "driving": driving.check,
    "mixing curve": mixing_curve.check,
    "freedom": freedom.check,
}


def check(subject: PrintSubject, sensor_context: SensorContext | None = None) -> list[Finding]:
    """All findings, errors first.

    Bodies whose mesh bounds no solid get the findings that need none: mesh, envelope and resins. Rules on the sensor's
    working (driving, layers, mixing curve) and on casting report nothing without ``sensor_context``.
    """
    view = PrintView(subject, sensor_context)
    return sorted((finding for rule in RULES.values() for finding in rule(view)), key=lambda finding: finding.rank)
