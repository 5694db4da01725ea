"""Placement of an object on the dome's axis or off it, and the point at which it first touches the dome."""

from __future__ import annotations

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.harmonic.surface import Surface

_ANGLES = 181
"""Angles on the half circle at which an object may touch first."""


def first_height(surface: Surface, outline: tuple[Array, Array]) -> float:
    """Height of a surface where it first touches the outer wall of an inflated dome, given as points (r, z)."""
    r, z = outline
    angle = np.linspace(0.0, np.pi, _ANGLES)[:, None]
    under = surface.at(0.0).over(r * np.cos(angle), r * np.sin(angle)).height
    return float((z - under).max())
