"""The uncertainty of the contact: an unknown friction, and the part of another contact that the plate's derivatives
miss."""

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.uncertainty.contact import ContactModel
from pneutouch.mechanics.uncertainty.source import CONTACT_FIGURES, FIGURE, FIGURES, UncertaintySource, counting

FRICTION, CORRECTION = "friction", "contact correction"
"""Names of the sources of `contact_sources`."""

WALL_GAP, OBJECT_WALL_GAP = 0.4, 0.7
"""Greatest difference found of d ln figure / d ln wall between the plate without friction and one with friction, and
other objects (docs/background/contact.md)."""


def contact_sources(contact: ContactModel, others: list[UncertaintySource]) -> list[UncertaintySource]:
    """Sources of the contact of n sensors; ``others`` act on the wall, whose derivative is the plate's."""
    size, source_list = len(contact.pressures), []
    friction = contact.friction
    if friction is not None:
        for figure in CONTACT_FIGURES:
            known = np.isfinite(friction.standard[figure])
            source_list.append(
                UncertaintySource(
                    FRICTION,
                    FIGURE,
                    np.where(known, friction.standard[figure], 0.0),
                    "log-rectangular",
                    counting(size, only=(figure,)) & known,
                    friction.origin,
                    False,
                )
            )
    walls = np.zeros(size)
    for source in others:
        walls = np.hypot(walls, source.moves.get("wall_thickness", 0.0))
    return [*source_list, _of_wall(contact, walls)]


def _of_wall(contact: ContactModel, walls: Array) -> UncertaintySource:
    gap = WALL_GAP if contact.sensor.protocol.body is None else OBJECT_WALL_GAP
    return UncertaintySource(
        CORRECTION,
        FIGURE,
        gap * walls / np.sqrt(3.0),
        "rectangular",
        counting(walls.size, only=CONTACT_FIGURES[:-1]),
        f"the derivative by the wall is that of a plate without friction; greatest difference found {gap:g} "
        f"(d ln {FIGURES[0]} / d ln wall)",
        True,
    )
