"""Rules on the mould of a cast membrane: each part on its printer, and the mould's functions: fill, close, let go."""

from collections.abc import Callable

from pneutouch.parts.mould import MouldAssembly
from pneutouch.printability.check import check
from pneutouch.printability.finding import Finding
from pneutouch.printability.rules import mould_filling, mould_fit, mould_release
from pneutouch.printability.subject import PrintItem, PrintSubject

MouldRule = Callable[[MouldAssembly], list[Finding]]

MOULD_RULES: dict[str, MouldRule] = {
    "mould fit": mould_fit.check,
    "mould filling": mould_filling.check,
    "release": mould_release.check,
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
"""Rules of printing whose remarks on a mould stand elsewhere: its edges close on one another, and `mould_fit` measures
its meshes."""


def mould_subject(mould: MouldAssembly) -> PrintSubject:
    """The parts of a mould as they are printed, each a job of its own; the cap lies with its pockets up."""
    items = []
    for body, solid in zip(mould.bodies, mould.solids, strict=True):
        up = (0.0, 0.0, -1.0 if solid.name == "mould-cap" else 1.0)
        items.append(PrintItem(body, mould.printer, mould.mode, solid, up=up, hints=_HINTS))
    return PrintSubject(tuple(items), name=f"{mould.scene.name}-mould")


def check_mould(mould: MouldAssembly) -> list[Finding]:
    """All findings on a mould, errors first."""
    printed = check(mould_subject(mould))
    kept = [finding for finding in printed if finding.rule not in _LEFT_TO_RAYS or finding.severity == "error"]
    more = [finding for rule in MOULD_RULES.values() for finding in rule(mould)]
    return sorted([*kept, *more], key=lambda finding: finding.rank)
