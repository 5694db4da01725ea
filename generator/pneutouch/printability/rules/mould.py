"""Fit of a mould that closes and opens: its void is the membrane, parts stay apart, nothing is undercut, walls are
even.

Filling of a mould before its silicone sets: pour channel and vents against the viscosity and the pot life.

Release of the cured membrane from its core: the strain that it needs against its elongation at break.
"""

from pneutouch.parts.mould import MouldAssembly
from pneutouch.parts.mould.filling import SAFETY, SYRINGE_KPA, MouldFilling, filling, release_of
from pneutouch.printability.measure.mould import cavity_match, overlaps, undercuts
from pneutouch.results.printing import Excess, Finding, Severity
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


def check_mould_fit(mould: MouldAssembly) -> list[Finding]:
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
    return [
        Finding("mould fit", "error", "mould", text, fix, _MEASURED, None, Excess(match.offset, mould.tolerance, "mm"))
    ]


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
    return [Finding("mould fit", "warning", "mould", text, fix, _ERROR, None, Excess(error, _MOST_ERROR * wall, "mm"))]


_SHARE = 0.5
"""Share of the pot life that filling may take, after mixing and degassing: own choice."""

_SOURCE = "slow flow of a Newtonian liquid through pour channel and wall (parts/mould/filling.py), half the pot life"
_UNKNOWN = "the material's file states no mixed_viscosity_Pa_s"
_BUBBLE = "rise of a free bubble as wide as a vent: Hadamard (1911), Rybczynski (1911); half the pot life: own choice"


def mould_filling(mould: MouldAssembly) -> MouldFilling | None:
    """Times of filling one cavity; None if the silicone's viscosity is not known."""
    material = mould.scene.membrane_material
    if material.casting is None or material.casting.mixed_viscosity_Pa_s is None:
        return None
    viscosity = material.casting.mixed_viscosity_Pa_s.most
    return filling(mould.size, viscosity, material.density_g_per_cm3.nominal)


def check_mould_filling(mould: MouldAssembly) -> list[Finding]:
    """Compare the times of all cavities, one after another, with half of the pot life."""
    casting = mould.scene.membrane_material.casting
    times = mould_filling(mould)
    if casting is None:
        return []
    if times is None:
        text = "how long it takes to fill is not known"
        return [Finding("mould filling", "note", "mould", text, "measure the viscosity", _UNKNOWN, None, None)]
    limit, cavities = _SHARE * 60 * casting.pot_life_min.least, mould.size.shape.cavities
    syringe, findings = cavities * times.syringe_s, []
    if times.pour_s > limit:
        severity: Severity = "warning" if syringe > limit else "note"
        text = (
            f"poured through the channel it fills in {times.pour_s / 60:.0f} min; half the pot life is "
            f"{limit / 60:.0f} min; a syringe at {SYRINGE_KPA:g} kPa fills it in {syringe:.0f} s"
        )
        fix = "fill the open cap and ring and lower the core, or press the silicone in with a syringe"
        if severity == "warning":
            fix = "widen mould.sprue_diameter_mm, take fewer mould.cavities, or fill the open cap and lower the core"
        findings.append(
            Finding("mould filling", severity, "mould-core", text, fix, _SOURCE, None, Excess(times.pour_s, limit, "s"))
        )
    if times.bubble_s > limit:
        text = (
            f"a bubble as wide as a vent takes {times.bubble_s / 60:.0f} min to rise out, half the pot life is "
            f"{limit / 60:.0f} min: smaller ones stay in the wall"
        )
        fix = "degas the mixed silicone in vacuum, or widen mould.vent_diameter_mm"
        excess = Excess(times.bubble_s, limit, "s")
        findings.append(Finding("mould filling", "warning", "mould-core", text, fix, _BUBBLE, None, excess))
    return findings


_RELEASE_SOURCE = (
    "greatest diameter of the core over the smallest opening of the membrane, and the wall rolled back over itself; "
    f"a factor of {SAFETY:g} to the elongation at break: own choice"
)


def check_mould_release(mould: MouldAssembly) -> list[Finding]:
    """Compare the strain needed, times `SAFETY`, with the elongation at break."""
    release = release_of(mould.membrane, mould.size)
    needed = 100 * SAFETY * release.strain
    broken = mould.scene.membrane_material.elongation_at_break_percent
    if broken is None:
        text = f"it must stretch by {100 * release.strain:.0f} % to leave its core; how far it may is not known"
        fix = "give elongation_at_break_percent in the material's file"
        return [Finding("release", "note", "membrane", text, fix, _RELEASE_SOURCE, None, None)]
    if needed <= broken.least:
        return []
    text = (
        f"it must stretch by {100 * release.strain:.0f} % to leave its core, {needed:.0f} % with a factor of "
        f"{SAFETY:g}; it breaks at {broken.least:.0f} %"
    )
    passing = release.passing_strain >= release.strain
    fix = "lower mould.draft_deg or mould.shrinkage_percent" if passing else "take a membrane.material that stretches"
    return [
        Finding("release", "error", "membrane", text, fix, _RELEASE_SOURCE, None, Excess(needed, broken.least, "%"))
    ]
