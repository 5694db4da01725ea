"""Rules on casting a liquid silicone in a thin wall, and on the mould that it fills, cures in and leaves."""

import numpy as np

from pneutouch.parts.mould import MouldAssembly
from pneutouch.parts.mould.filling import SAFETY, SYRINGE_KPA, MouldFilling, filling, release_of
from pneutouch.printability.measure.mould import cavity_match, overlaps, undercuts
from pneutouch.printability.view import PrintPart, PrintView, SensorContext
from pneutouch.results.printing import Excess, Finding, Severity
from pneutouch.shape.dome import DomeShape
from pneutouch.spec.material import Casting
from pneutouch.units import UM
from pneutouch.wording import data_of

_MEASURED = "measured on the meshes of the closed mould"

_LEAST_DRAFT = 1.0
_SOURCES: dict[str, str] = data_of(__file__)
_RELEASE = _SOURCES["release"].format(safety=SAFETY)

_MOST_ERROR = 0.1
"""Greatest error of the wall, as a share of it, by the clearance of the cones: own choice."""
_ERROR = "the wall at the rim differs by the clearance of the cones; a tenth of it is allowed: own choice"


def check_mould_fit(mould: MouldAssembly) -> list[Finding]:
    """Findings on overlaps, cavity, undercuts, draft and error of the wall of a closed mould."""
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
        fix = _narrower(mould.scene.design.membrane.dome) or "raise mould.draft_deg, or report the design"
        findings.append(Finding("mould fit", "error", part, text, fix, _MEASURED, where, Excess(count, 0, "places")))
    return findings


def _narrower(dome: DomeShape) -> str | None:
    """Remedy for a dome that is wider above its rim than at it, with the place; None for one that is not."""
    along = np.concatenate([piece.along(np.linspace(0.0, 1.0, 33)) for piece in dome.outer])
    r, z = along[along[:, 0].argmax()].tolist()
    if r <= dome.outer_radius * (1 + 1e-6):
        return None
    return f"the dome is widest above its rim, at r = {r:.4g}, z = {z:.4g} mm: draw it no wider there than at the rim"


def _draft(mould: MouldAssembly) -> list[Finding]:
    draft = mould.scene.design.mould.draft_deg
    if draft >= _LEAST_DRAFT:
        return []
    text = f"its draft is {draft:g} degrees; at least {_LEAST_DRAFT:g} is recommended"
    excess = Excess(draft, _LEAST_DRAFT, "degrees")
    return [Finding("mould fit", "warning", "mould", text, "raise mould.draft_deg", _SOURCES["draft"], None, excess)]


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
"""Share of the pot life, counted from mixing, that filling may take: own choice."""

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
    """Findings if half the pot life is shorter than pouring a cavity, or than the rise of bubbles; or unknown."""
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


def check_mould_release(mould: MouldAssembly) -> list[Finding]:
    """Finding if the strain needed to leave the core, times `SAFETY`, exceeds the elongation at break."""
    release = release_of(mould.membrane, mould.size)
    needed = 100 * SAFETY * release.strain
    broken = mould.scene.membrane_material.elongation_at_break_percent
    if broken is None:
        text = f"it must stretch by {100 * release.strain:.0f} % to leave its core; how far it may is not known"
        fix = "give elongation_at_break_percent in the material's file"
        return [Finding("release", "note", "membrane", text, fix, _RELEASE, None, None)]
    if needed <= broken.least:
        return []
    text = (
        f"it must stretch by {100 * release.strain:.0f} % to leave its core, {needed:.0f} % with a factor of "
        f"{SAFETY:g}; it breaks at {broken.least:.0f} %"
    )
    passing = release.passing_strain >= release.strain
    fix = "lower mould.draft_deg or mould.shrinkage_percent" if passing else "take a membrane.material that stretches"
    return [Finding("release", "error", "membrane", text, fix, _RELEASE, None, Excess(needed, broken.least, "%"))]


PREPARED_MIN = 8.0
"""Minutes of the pot life that weighing, mixing (3) and degassing (5) take: see `_PREPARED`."""
_PREPARED = "3 min of mixing and 5 min of vacuum (fabrication notes of the repository Athenachc/sav_gripper)"
_FLOW = f"film of a Newtonian liquid between plates under its own weight, rho g t2 / (12 eta); {_PREPARED}"
_STOKES = f"Stokes's law, a bubble rises by 2/9 rho g r2 / eta; {_PREPARED}; share of the wall: own, unverified"
_SLOW = 0.5
"""Share of the time left for pouring above which filling is a warning: the viscosity rises as it cures (own)."""
_LARGE_BUBBLE = 0.5
"""Ratio of a bubble's diameter to the wall above which it is a weak spot that may leak (own, unverified)."""
_GRAVITY = 9.81
_PHOTOPOLYMER = "uncured photopolymer"


def check_filling(view: PrintView) -> list[Finding]:
    """Finding if the silicone takes too much of the pot life left after mixing to run down the wall by its weight."""
    pour = _cast(view)
    if pour is None or pour[2].mixed_viscosity_Pa_s is None:
        return []
    part, context, casting = pour
    wall, needed_min, left_min = context.sensor.dome.wall_thickness, _filling_min(*pour), _left_min(casting)
    if needed_min <= _SLOW * left_min:
        return []
    text = (
        f"{part.item.body.material.label} needs {needed_min:.0f} min to run down a {wall:g} mm wall by its own weight; "
        f"{left_min:.0f} min of its pot life of {casting.pot_life_min.nominal:g} min are left after mixing"
    )
    fix = part.item.hints.get("filling", "inject it with a syringe, or take a thicker wall or a thinner silicone")
    excess = Excess(needed_min, left_min, "min")
    source = f"{_FLOW}; {casting.pot_life_min.source}"
    return [Finding("filling", "warning", part.name, text, fix, source, _pole(context), excess)]


def check_bubbles(view: PrintView) -> list[Finding]:
    """Finding on the largest bubble that does not rise out of the mould in the pot life left after mixing."""
    pour = _cast(view)
    if pour is None or pour[2].mixed_viscosity_Pa_s is None:
        return []
    part, context, casting = pour
    wall, diameter = context.sensor.dome.wall_thickness, _bubble(*pour)
    weak = diameter > _LARGE_BUBBLE * wall
    share = f"{diameter / wall:.0%} of the {wall:g} mm wall"
    text = f"bubbles up to {diameter:.2f} mm do not rise out in the pot life: {share}"
    fix = part.item.hints.get("bubbles", "degas the mixed silicone under vacuum, and pour in a thin stream")
    source = f"{_STOKES}; {casting.pot_life_min.source}"
    severity: Severity = "warning" if weak else "note"
    excess = Excess(diameter, _LARGE_BUBBLE * wall, "mm") if weak else None
    return [Finding("bubbles", severity, part.name, text, fix, source, _pole(context), excess)]


def check_inhibition(view: PrintView) -> list[Finding]:
    """Findings on printed photopolymer against which the silicone cures: it stays sticky there."""
    pour = _cast(view)
    if pour is None or _PHOTOPOLYMER not in pour[2].inhibited_by:
        return []
    part, context, _ = pour
    return [
        Finding(
            "inhibition",
            "warning",
            part.name,
            f"{part.item.body.material.label} cures against the {surface.body}, printed in {surface.material}: "
            "photopolymer inhibits its cure, and the face stays sticky",
            "post-cure, wash and seal the print, and test a drop first; or print it in filament",
            _SOURCES["inhibition"],
            None,
            None,
        )
        for surface in context.wetted
        if surface.process in ("polyjet", "resin")
    ]


def _cast(view: PrintView) -> tuple[PrintPart, SensorContext, Casting] | None:
    """Part, context and casting data of a membrane that is cast and still to be made; None for any other."""
    context = view.sensor
    part = None if context is None else view.part(context.membrane)
    if context is None or part is None or context.calibrated or not part.item.printer.is_casting:
        return None
    casting = part.item.body.material.casting
    return None if casting is None else (part, context, casting)


def _left_min(casting: Casting) -> float:
    return max(casting.pot_life_min.least - PREPARED_MIN, 0.0)


def _weight(part: PrintPart) -> float:
    """Specific weight of the liquid, N/m3."""
    return 1e3 * part.item.body.material.density_g_per_cm3.nominal * _GRAVITY


def _filling_min(part: PrintPart, context: SensorContext, casting: Casting) -> float:
    """Time in which the silicone runs along the wall between rim and pole, min."""
    assert casting.mixed_viscosity_Pa_s is not None
    dome = context.sensor.dome
    arc, wall = 1e-3 * dome.shape.arcs[0], 1e-3 * dome.wall_thickness
    speed = _weight(part) * wall**2 / (12 * casting.mixed_viscosity_Pa_s.nominal)
    return arc / speed / 60


def _bubble(part: PrintPart, context: SensorContext, casting: Casting) -> float:
    """Diameter of the largest bubble that does not rise by the dome's height in the pot life left, mm."""
    assert casting.mixed_viscosity_Pa_s is not None
    seconds = 60 * max(_left_min(casting), 1.0)
    speed = 1e-3 * max(context.sensor.dome.shape.outer_height, context.sensor.dome.wall_thickness) / seconds
    return float(2e3 * np.sqrt(4.5 * casting.mixed_viscosity_Pa_s.nominal * speed / _weight(part)))


def _pole(context: SensorContext) -> tuple[float, float, float]:
    shape = context.sensor.dome.shape
    return (0.0, 0.0, 0.5 * (shape.inner_height + shape.outer_height))
