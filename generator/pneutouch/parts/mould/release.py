"""Stretch that a cured membrane needs to leave its core."""

from dataclasses import dataclass

from pneutouch.meridian import Meridian
from pneutouch.parts.mould.size import MouldSize

PEEL_STRETCH = 1.5
"""Stretch of the wall's outside where a finger rolls it back over itself: a strip of thickness t bent to an inner
radius of t / 2 has its middle at the radius t, so its outside is longer by half. Own estimate."""

SAFETY = 2.0
"""Elongation at break over the strain needed: own choice, for nicks at the flange and silicone not fully cured."""


@dataclass(frozen=True, slots=True)
class Release:
    """``opening_mm`` is the smallest opening of the cured membrane, ``core_mm`` the greatest diameter of the core that
    passes it."""

    opening_mm: float
    core_mm: float

    @property
    def passing_strain(self) -> float:
        """Strain around the opening as the core passes it; 0 where it passes freely."""
        return max(self.core_mm / self.opening_mm - 1.0, 0.0)

    @property
    def strain(self) -> float:
        """The strain needed: of the passing core, or of rolling the wall back, whichever is more."""
        return max(self.passing_strain, PEEL_STRETCH - 1.0)


def release_of(membrane: Meridian, size: MouldSize) -> Release:
    """The release of a membrane (its meridian, as cured) from the core of its mould.

    It is an upper bound: the whole core is taken to pass the smallest opening, wherever that is.
    """
    # The opening is bounded by the faces below the dome: its rim and what lies within the flange.
    opening = 2 * min(min(piece.start[0], piece.end[0]) for piece in membrane.pieces[1:3])
    rim = size.faces.rim
    core = 2 * max(size.faces.inner.radius, rim.start[0], rim.end[0])
    return Release(opening, core)
