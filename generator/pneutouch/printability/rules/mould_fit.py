"""Fit of a mould that closes and opens: its void is the membrane, parts stay apart, nothing is undercut, walls are
even."""

from pneutouch.parts.mould import MouldAssembly
from pneutouch.printability.finding import Excess, Finding
from pneutouch.printability.measure.mould import cavity_match, overlaps, undercuts
from pneutouch.units import UM

_MEASURED = "measured on the meshes of the closed mould"

_LEAST_DRAFT = 1.0
_DRAFT = (
    "half a degree a side is the extreme minimum and one degree standard practice in moulding "
    "(minghaomould.com, design reference, read 2026); layers of a print add texture"
)

_MOST_ERROR = 0.1
"""Share of the wall that core and cap may be apart by: own choice."""
_ERROR = "the wall at the rim differs by the clearance of the cones; a tenth of it is allowed: own choice"


def check(mould: MouldAssembly) -> list[Finding]:
    """Measure the closed mould, and judge draft and clearance."""
    return [*_overlaps(mould), *_cavity(mould), *_undercuts(mould), *_draft(mould), *_wall_error(mould)]


def _overlaps(mould: MouldAssembly) -> list[Finding]:
    return [
        Finding(
            "mould fit",
            "error",
            one,
            f"it overlaps the {other} by {volume:.3g} mm3 in the closed mould",
            "raise mould.clearance_mm, or report the design",
            _MEASURED,
            None,
            Excess(volume, 0.0, "mm3"),
        )
        for (one, other), volume in overlaps(mould.closed).items()
    ]


def _cavity(mould: MouldAssembly) -> list[Finding]:
    match = cavity_match(mould.size, mould.closed, mould.tolerance)
    if match.offset <= mould.tolerance:
        return []
    text = f"its cavity is off the membrane by {match.offset / UM:.0f} um on average"
    fix = "report the design"
    return [Finding("mould fit", "error", "mould", text, fix, _MEASURED, None, Excess(match.offset, mould.tolerance))]


def _undercuts(mould: MouldAssembly) -> list[Finding]:
    findings = []
    places = undercuts(mould.size, mould.bodies, mould.tolerance)
    for part in dict.fromkeys(place.part for place in places):
        where = next(place.where for place in places if place.part == part)
        count = sum(place.part == part for place in places)
        text = f"{count} places of it hold the silicone back along the draw"
        fix = "raise mould.draft_deg, or report the design"
        findings.append(Finding("mould fit", "error", part, text, fix, _MEASURED, where, Excess(count, 0, "places")))
    return findings


def _draft(mould: MouldAssembly) -> list[Finding]:
    draft = mould.scene.design.mould.draft_deg
    if draft >= _LEAST_DRAFT:
        return []
    text = f"its draft is {draft:g} degrees; at least {_LEAST_DRAFT:g} is recommended"
    excess = Excess(draft, _LEAST_DRAFT, "degrees")
    return [Finding("mould fit", "warning", "mould", text, "raise mould.draft_deg", _DRAFT, None, excess)]


def _wall_error(mould: MouldAssembly) -> list[Finding]:
    wall, error = mould.scene.design.membrane.wall_thickness_mm, mould.size.wall_error
    if error <= _MOST_ERROR * wall:
        return []
    text = (
        f"core and cap may stand apart by {error:.2f} mm, {100 * error / wall:.0f} % of the wall of {wall:g} mm; "
        f"at most {100 * _MOST_ERROR:g} % is recommended"
    )
    fix = "lower mould.clearance_mm and fit the cones by hand, or raise membrane.wall_thickness_mm"
    return [Finding("mould fit", "warning", "mould", text, fix, _ERROR, None, Excess(error, _MOST_ERROR * wall))]
