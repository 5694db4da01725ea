"""Events while a sensor is pressed: their kinds, levels and texts, and the place where a curve crosses a level.

No figure is averaged across an event that ends its range. This file loads neither the solver nor SciPy, because the
atlas uses it too.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from pneutouch.wording import data_of

#: Ratio of the stretch across a neo-Hookean surface to the least stretch along it at which the surface creases: 2.4, or
#: strain 0.35 in plane strain (Hong, Zhao & Suo 2009, Appl. Phys. Lett. 95, 111901; quoted, not derived here). The
#: smooth solution continues beyond it, but is unsafe.
CREASE = 2.4
#: The wall has left the plate inside the contact when the gap there exceeds this share of the wall thickness.
SEPARATION = 1.0e-2
#: The wall hangs over its clamp when it passes below the base plane by this share of the wall thickness.
OVERHANG = 2.0e-2
#: The wall lies on its base when it transmits this share of the plate's force to the base.
BASE_SHARE = 2.0e-2

#: Kinds of events that a straight-line fit to the curve may not include: it ends before the first of them.
BREAKS_CURVE = ("unstable", "snap", "clamp_fold", "separation", "lost", "floor", "rim")

PLATE_RIM, OBJECT_EDGE = "plate_rim", "object_edge"

DETAIL: dict[str, str] = data_of(__file__)

OBJECT_DETAIL = {**DETAIL, "separation": "the wall leaves the object inside the contact"}
"""Texts of the events for an object other than a plate."""


@dataclass(frozen=True)
class SolidEvent:
    """An event at an indentation (mm).

    Kinds that end the path: unstable (the inflated state itself), snap (a jump to another branch), clamp_fold (a
    jump at the clamped edge), lost (no equilibrium found), floor (the inner wall reaches the body behind it; a
    solid with a base continues). Kinds that do not: rim (the object meets the flange or a ring beside the wall),
    base (the outer wall lies down next to its clamp), separation (the wall leaves the plate inside the contact),
    strained (a soft object, beyond linear elasticity),
    crease, overhang (the wall hangs below its base plane where the solid has no base), plate_rim and object_edge
    (the contact reaches where the object turns up), break (break strain), gauge_range, sway and lobes (the
    axisymmetric path is unstable to one wave around the axis, or to several). ``detail``: in words.
    """

    kind: str
    indentation: float
    detail: str


class PathPoint(NamedTuple):
    """A quantity y at plate travel x, with dy/dx where it is known."""

    x: float
    y: float
    slope: float | None = None


def crossing(a: PathPoint, b: PathPoint, level: float) -> float | None:
    """Position x between points a and b at which y rises through ``level``, on the Hermite cubic if both slopes are
    known, else on a straight line; None if y does not rise through it.

    If a and b are equal: their x if their y is at or above the level, else None."""
    if a == b:
        return a.x if a.y >= level else None
    if not a.y < level <= b.y:
        return None
    span, rise = b.x - a.x, b.y - a.y
    share = np.linspace(0.0, 1.0, 1001)
    curve = a.y + share * rise
    if a.slope is not None and b.slope is not None:
        curve += share * (1.0 - share) * ((1.0 - share) * (a.slope * span - rise) + share * (rise - b.slope * span))
    return float(a.x + span * share[int(np.argmax(curve >= level))])


SWAY, LOBES, NO_LINE, ON_FLANGE = "sway", "lobes", "no line", "object on the flange"
WARNED = (SWAY, LOBES, NO_LINE)
"""Kinds to warn of: the dome leaves its axis, or its round form; no line fits the range, so that it has no figures."""


@dataclass(frozen=True, slots=True)
class Event:
    """An event of a prediction at an indentation (mm); if ``ends_range``, no figure is fitted beyond it."""

    kind: str
    indentation: float
    ends_range: bool
    message: str


def range_end(happened: list[Event], depth: float) -> float:
    """Indentation (mm) up to which figures are fitted: that of the first event that ends the range, else ``depth``."""
    return min((event.indentation for event in happened if event.ends_range), default=depth)
