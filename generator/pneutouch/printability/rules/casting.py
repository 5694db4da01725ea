"""A liquid silicone in a thin wall: whether it fills it in its pot life, what bubbles stay, what inhibits it."""

import numpy as np

from pneutouch.printability.view import PrintPart, PrintView, SensorContext
from pneutouch.results.printing import Excess, Finding, Severity
from pneutouch.spec.material import Casting

PREPARED_MIN = 8.0
"""Minutes of the pot life that weighing, mixing (3) and degassing (5) take: see `_PREPARED`."""
_PREPARED = "3 min of mixing and 5 min of vacuum (fabrication notes of the repository Athenachc/sav_gripper)"
_FLOW = f"film of a Newtonian liquid between plates under its own weight, rho g t2 / (12 eta); {_PREPARED}"
_STOKES = f"Stokes's law, a bubble rises by 2/9 rho g r2 / eta; {_PREPARED}; share of the wall: own, unverified"
_SLOW = 0.5
"""Share of the time left for pouring from which filling is a warning: the viscosity rises as it cures (own)."""
_BUBBLE = 0.5
"""Diameter of a bubble over the wall from which it is a weak spot that may leak (own, unverified)."""
_GRAVITY = 9.81
_PHOTOPOLYMER = "uncured photopolymer"
_INHIBITION = (
    "vendor, smooth-on.com/support/faq/129 on cure inhibition; joshuawoehlke.com: 24 finishes of resin prints "
    "compared, few of which let a platinum silicone cure"
)


def filling(view: PrintView) -> list[Finding]:
    """Compare the time in which the liquid runs down the wall by its weight with what mixing leaves of the pot life."""
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


def bubbles(view: PrintView) -> list[Finding]:
    """Compare the largest bubble that does not rise out of the mould in the pot life with the wall."""
    pour = _cast(view)
    if pour is None or pour[2].mixed_viscosity_Pa_s is None:
        return []
    part, context, casting = pour
    wall, diameter = context.sensor.dome.wall_thickness, _bubble(*pour)
    weak = diameter > _BUBBLE * wall
    share = f"{diameter / wall:.0%} of the {wall:g} mm wall"
    text = f"bubbles up to {diameter:.2f} mm do not rise out in the pot life: {share}"
    fix = part.item.hints.get("bubbles", "degas the mixed silicone under vacuum, and pour in a thin stream")
    source = f"{_STOKES}; {casting.pot_life_min.source}"
    severity: Severity = "warning" if weak else "note"
    excess = Excess(diameter, _BUBBLE * wall, "mm") if weak else None
    return [Finding("bubbles", severity, part.name, text, fix, source, _pole(context), excess)]


def inhibition(view: PrintView) -> list[Finding]:
    """Look for printed photopolymer that the liquid cures against: it stays sticky there."""
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
            _INHIBITION,
            None,
            None,
        )
        for surface in context.wetted
        if surface.process in ("polyjet", "resin")
    ]


def _cast(view: PrintView) -> tuple[PrintPart, SensorContext, Casting] | None:
    """The membrane where it is cast and still to be made, with its figures."""
    context = view.sensor
    part = None if context is None else view.part(context.membrane)
    if context is None or part is None or context.calibrated or not part.item.printer.is_casting:
        return None
    casting = part.item.body.material.casting
    return None if casting is None else (part, context, casting)


def _left_min(casting: Casting) -> float:
    return max(casting.pot_life_min.least - PREPARED_MIN, 0.0)


def _weight(part: PrintPart) -> float:
    """Weight of a volume of the liquid, N/m3."""
    return 1e3 * part.item.body.material.density_g_per_cm3.nominal * _GRAVITY


def _filling_min(part: PrintPart, context: SensorContext, casting: Casting) -> float:
    """Time to run along the wall from rim to pole, min."""
    assert casting.mixed_viscosity_Pa_s is not None
    dome = context.sensor.dome
    arc, wall = 1e-3 * dome.shape.arcs[0], 1e-3 * dome.wall_thickness
    speed = _weight(part) * wall**2 / (12 * casting.mixed_viscosity_Pa_s.nominal)
    return arc / speed / 60


def _bubble(part: PrintPart, context: SensorContext, casting: Casting) -> float:
    """Diameter of the largest bubble that does not rise by the dome's height in the pot life that is left, mm."""
    assert casting.mixed_viscosity_Pa_s is not None
    seconds = 60 * max(_left_min(casting), 1.0)
    speed = 1e-3 * context.sensor.dome.shape.outer_height / seconds
    radius = np.sqrt(4.5 * casting.mixed_viscosity_Pa_s.nominal * speed / _weight(part))
    return float(2e3 * radius)


def _pole(context: SensorContext) -> tuple[float, float, float]:
    shape = context.sensor.dome.shape
    return (0.0, 0.0, 0.5 * (shape.height + shape.outer_height))
