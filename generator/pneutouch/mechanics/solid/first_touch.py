"""First point of contact of a plate or another rigid object with an inflated dome."""

from typing import NamedTuple

import numpy as np

from pneutouch.mechanics.solid.contact import Plate, flat_radius, rim_radius
from pneutouch.mechanics.solid.indenter import Indenter, RigidObject, first_contact
from pneutouch.mechanics.solid.inflate import FreeState
from pneutouch.mechanics.solid.model import SolidModel


class FirstTouch(NamedTuple):
    """An object where it first touches the free dome, and the radius at which it does, in R0; 0 for a plate."""

    body: Indenter
    radius: float = 0.0


def first_touch(
    solid: SolidModel,
    free: FreeState,
    body: RigidObject | None,
    plate_diameter: float | None,
    plate_rim: float | None = None,
) -> FirstTouch:
    """A body, or without one a plate, on a free state; lengths in mm, see `indent.PressSettings`."""
    length, longest = solid.length, np.array(solid.contact.longest)
    if body is None:
        radius = np.array(np.inf if plate_diameter is None else 0.5 * plate_diameter / length)
        apex = float(free.positions[solid.mesh.outer, 1].max()) / length
        rim = rim_radius(radius, longest, None if plate_rim is None else plate_rim / length)
        return FirstTouch(Plate(apex, float(flat_radius(radius, rim)), float(rim)))
    scaled = body.scaled(1.0 / length)
    r, z = solid.contact.outline(free.positions / length)
    height, at = first_contact(scaled, r, z)
    return FirstTouch(scaled.at(height), at)
