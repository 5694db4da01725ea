"""Events under the plate: detected and located, never averaged over."""

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.membrane_contact import PressedStates
from pneutouch.mechanics.sensor import Sensor

SWAY, LOBES = "sway", "lobes"
"""Kinds after which the path is that of a body of revolution only: the dome leaves its axis, or its round form."""

_NEAR_BASE = 0.98
"""Share of R0 at which the contact counts as having reached the base; beyond it the free arc has no space."""


@dataclass(frozen=True, slots=True)
class Event:
    """An event at an indentation (mm); ``ends_range`` where figures must not be fitted beyond it."""

    kind: str
    indentation: float
    ends_range: bool
    message: str


def events(sensor: Sensor, indentation: Array, pressed: PressedStates, closure: str) -> list[Event]:
    """The events of one pressed curve, in the order of the plate's travel."""
    stretch, radius, gauge = pressed.thickness_stretch**-0.5, pressed.contact_radius, sensor.gas.gauge_limit
    beyond_gauge = f"the cavity pressure leaves the gauge's range of {1e3 * gauge:g} kPa"
    at_base = "the contact reaches the base circle, where a cap of constant curvature ends"
    slack = "the wall is shorter than unloaded: a real membrane wrinkles, this theory does not"
    margins: list[tuple[str, Array, bool, str]] = [
        ("gauge range", pressed.pressure - gauge, True, beyond_gauge),
        ("plate edge", radius - sensor.protocol.plate_radius, True, "the contact reaches the edge of the plate"),
        ("contact at base", radius - _NEAR_BASE * sensor.dome.inner_radius, True, at_base),
        ("slack wall", 1 - 1e-9 - stretch, False, slack),
    ]
    if sensor.wall.break_stretch is not None:
        text = f"the stretch reaches the resin's least elongation at break, {sensor.wall.break_stretch - 1:.0%}"
        margins.append(("break strain", stretch - sensor.wall.break_stretch, True, text))
    if closure == "printed":
        falling = np.concatenate([[-1.0], -np.diff(pressed.contact_radius)])
        text = "the contact radius falls as the plate advances: the printed equations describe no contact"
        margins.append(("contact radius falls", falling, True, text))
    happened = [
        Event(kind, _crossing(indentation, margin), ends, text)
        for kind, margin, ends, text in margins
        if np.any(margin[1:] > 0)
    ]
    return sorted(happened, key=lambda event: event.indentation)


def range_end(happened: list[Event], depth: float) -> float:
    """Indentation (mm) up to which figures may be fitted: the first event that ends the range, else the depth."""
    return min((event.indentation for event in happened if event.ends_range), default=depth)


def _crossing(indentation: Array, margin: Array) -> float:
    """Indentation at which the margin turns positive, by linear interpolation between the steps."""
    after = int(np.argmax(margin > 0)) if margin[0] <= 0 else 1 + int(np.argmax(margin[1:] > 0))
    before, here = margin[after - 1], margin[after]
    if before > 0 or here == before:
        return float(indentation[after - 1])
    share = -before / (here - before)
    return float(indentation[after - 1] + share * (indentation[after] - indentation[after - 1]))
