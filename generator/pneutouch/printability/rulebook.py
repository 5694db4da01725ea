"""Run every rule over a subject, or over the mould of a cast membrane, and refuse a print with errors."""

from collections.abc import Callable, Iterable
from os import PathLike
from typing import Any

from pneutouch.errors import RuleBrokenError, joined
from pneutouch.parts.mould import MouldAssembly
from pneutouch.printability.rules import bodies, cleaning, feature_sizes, mould, resins, working
from pneutouch.printability.subject import PrintItem, PrintSubject
from pneutouch.printability.view import PrintView, SensorContext
from pneutouch.results.printing import Finding

Rule = Callable[[PrintView], list[Finding]]

RULES: dict[str, Rule] = {
    "mesh": bodies.check_mesh,
    "contact faces": bodies.check_contact_faces,
    "envelope": bodies.check_envelope,
    "resins": resins.check_resins,
    "walls": feature_sizes.CHECKS["walls"],
    "pins": feature_sizes.CHECKS["pins"],
    "holes": feature_sizes.CHECKS["holes"],
    "channels": feature_sizes.CHECKS["channels"],
    "gaps": feature_sizes.check_gaps,
    "emboss": feature_sizes.CHECKS["emboss"],
    "edges": feature_sizes.check_edges,
    "hollows": cleaning.check_hollows,
    "cleaning": cleaning.check_cleaning,
    "matte": bodies.check_matte,
    "layers": working.check_layers,
    "filling": mould.check_filling,
    "bubbles": mould.check_bubbles,
    "inhibition": mould.check_inhibition,
    "glue": working.check_glue,
    "inserts": working.check_inserts,
    "gland": working.check_gland,
    "driving": working.check_driving,
    "mixing curve": resins.check_mixing_curve,
    "freedom": working.check_freedom,
}


def check(subject: PrintSubject, sensor_context: SensorContext | None = None) -> list[Finding]:
    """All findings, errors first.

    Bodies whose mesh bounds no solid get only the findings on mesh, envelope and resins. Rules on the sensor's working
    (driving, layers, glue, freedom, mixing curve) and on casting report nothing without ``sensor_context``.
    """
    view = PrintView(subject, sensor_context)
    return sorted((finding for rule in RULES.values() for finding in rule(view)), key=lambda finding: finding.rank)


MouldRule = Callable[[MouldAssembly], list[Finding]]

MOULD_RULES: dict[str, MouldRule] = {
    "mould fit": mould.check_mould_fit,
    "mould filling": mould.check_mould_filling,
    "release": mould.check_mould_release,
}

_HINTS = {
    "walls": "raise mould.wall_mm, or take another mould.profile",
    "holes": "drill it after printing, or take a wider mould.vent_diameter_mm or mould.sprue_diameter_mm",
    "channels": "drill it after printing, or take a wider mould.vent_diameter_mm or mould.sprue_diameter_mm",
    "envelope": "take fewer mould.cavities, less mould.wall_mm or another mould.profile",
    "resins": "take another mould.material or mould.profile",
    "gaps": "raise mould.wall_mm, or take another mould.profile",
}
"""Remedies in the design for findings of the printing rules on parts of a mould."""

_LEFT_TO_RAYS = ("edges", "mesh")
"""Printing rules of which only errors count for a mould: it has sharp edges, and rays measure its meshes."""


MOULD_INFILL = 0.2
"""Infill of a mould, which bears the pressure of a syringe by hand: PrusaSlicer's preset *common*."""


def mould_subject(mould: MouldAssembly) -> PrintSubject:
    """The parts of a mould as they are printed, each a job of its own; the cap lies with its pockets up."""
    items = []
    for body, solid in zip(mould.bodies, mould.solids, strict=True):
        up = (0.0, 0.0, -1.0 if solid.name == "mould-cap" else 1.0)
        infill = MOULD_INFILL if mould.printer.process == "filament" else 1.0
        items.append(PrintItem(body, mould.printer, mould.mode, solid, up=up, hints=_HINTS, infill=infill))
    return PrintSubject(tuple(items), name=f"{mould.scene.name}-mould")


def check_mould(mould: MouldAssembly) -> list[Finding]:
    """All findings on a mould, errors first."""
    printed = check(mould_subject(mould))
    kept = [finding for finding in printed if finding.rule not in _LEFT_TO_RAYS or finding.severity == "error"]
    more = [finding for rule in MOULD_RULES.values() for finding in rule(mould)]
    return sorted([*kept, *more], key=lambda finding: finding.rank)


def refuse(findings: Iterable[Finding], file: str | PathLike[str], key: str | None = None, value: Any = None) -> None:
    """Raise RuleBrokenError with all findings that are errors, if any; ``key`` names the input that decides."""
    broken = [
        RuleBrokenError(f"{f.rule}: {f.body}: {f.message}", file=file, key=key, value=value, remedy=f.fix)
        for f in findings
        if f.severity == "error"
    ]
    if broken:
        raise joined(broken)
