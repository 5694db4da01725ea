"""Basis of the uncertainty of a sensor under another contact than a plate without friction, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from pneutouch.mechanics import Sensor

if TYPE_CHECKING:
    from pneutouch.mechanics.uncertainty import ContactModel


def contact_notes(sensor: Sensor, contact: ContactModel | None) -> tuple[str, ...]:
    """Notes on the uncertainty under a contact; none for a plate without friction."""
    if contact is None:
        return ()
    notes = [
        f"{sensor.protocol.other_contact}: the figures and their derivatives by modulus and friction are the solid's, "
        "the other derivatives those of a plate without friction; what the latter may miss is the source contact "
        "correction. The error of the model is that of a plate without friction against Table S1, of which the "
        "friction in those measurements is a part, so that it may count twice (docs/background/uncertainty.md)"
    ]
    friction = contact.friction
    if friction is not None and not np.isfinite(friction.standard).any(axis=0).all():
        notes.append(
            "the solid found no equilibrium at another coefficient of friction, whose uncertainty is then not in the "
            "budget"
        )
    return tuple(notes)
