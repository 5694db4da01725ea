"""Times in which a mould fills and its air escapes, from the silicone's viscosity.

Slow flow of a Newtonian liquid: the pour channel by Hagen and Poiseuille (pipe of varying radius, 8 mu L / (pi r^4)
integrated along it), the dome's wall by the flow between parallel faces (12 mu ds / (w h^3), with the circumference at
half the arc as width w). Batchelor, An Introduction to Fluid Dynamics (1967), sections 4.2 and 4.8.
"""

import math
from dataclasses import dataclass

from pneutouch.parts.mould.size import CavityFaces, MouldSize
from pneutouch.shape.meridian import Meridian

GRAVITY = 9.80665
"""Acceleration of gravity, m/s2."""

SYRINGE_KPA = 100.0
"""Pressure of a hand on a syringe of 10 mL, about 15 N on 1.5 cm2: own estimate."""


@dataclass(frozen=True, slots=True)
class MouldFilling:
    """Times in s at a viscosity; ``pour_s`` by the weight of the silicone in funnel and window, ``syringe_s`` by hand.

    ``bubble_s`` is the time in which a bubble as wide as a vent rises from the pole out of the mould.
    """

    pour_s: float
    syringe_s: float
    bubble_s: float


def filling(size: MouldSize, viscosity_Pa_s: float, density_g_per_cm3: float) -> MouldFilling:
    """Filling times of one cavity. A bubble rises at rho g r^2 / (3 mu): Hadamard, Rybczynski (1911), free surface."""
    resistance = viscosity_Pa_s * (_channel(size) + _wall(size)) * 1e9
    volume = size.cavity_volume * 1e-9
    weight = density_g_per_cm3 * 1e3 * GRAVITY
    head = weight * (size.foot + size.shape.wall) * 1e-3
    rise = weight * (0.5e-3 * size.shape.vent_diameter) ** 2 / (3 * viscosity_Pa_s)
    height = (size.faces.high - size.foot_low) * 1e-3
    return MouldFilling(volume * resistance / head, volume * resistance / (SYRINGE_KPA * 1e3), height / rise)


def _channel(size: MouldSize) -> float:
    """The integral of 8 / (pi r^4) along the pour channel, funnel and neck, mm-3."""
    gate = 0.5 * size.shape.sprue_diameter
    half = 0.5 * size.foot
    return sum(
        8 * half / (3 * math.pi * (b - a)) * (a**-3 - b**-3) for a, b in ((size.neck, gate), (size.neck, size.mouth))
    )


def _wall(size: MouldSize) -> float:
    """Flow resistance of the wall from the flange to the pole, mm-3."""
    faces = size.faces
    inner, outer = faces.halfway
    length = 0.5 * sum(piece.length for piece in (*faces.inner, *faces.outer))
    return 12 * length / (math.pi * (inner[0] + outer[0]) * math.dist(inner, outer) ** 3)


PEEL_STRETCH = 1.5
"""Stretch on the wall's outside where a finger rolls it back over itself: a strip of thickness t, bent to an inner
radius of t / 2, has its middle at the radius t, so its outside is longer by half. Own estimate."""

SAFETY = 2.0
"""Required elongation at break over the strain needed: own choice, for nicks at the flange and incomplete curing."""


@dataclass(frozen=True, slots=True)
class Release:
    """Sizes for the release: ``opening_mm`` is the smallest opening of the cured membrane, ``core_mm`` the greatest
    diameter of the core, which passes the opening."""

    opening_mm: float
    core_mm: float

    @property
    def passing_strain(self) -> float:
        """Circumferential strain of the opening as the core passes it; 0 if it passes freely."""
        return max(self.core_mm / self.opening_mm - 1.0, 0.0)

    @property
    def strain(self) -> float:
        """Strain needed: by the passing core or by rolling the wall back, whichever is greater."""
        return max(self.passing_strain, PEEL_STRETCH - 1.0)


def release_of(membrane: Meridian, size: MouldSize) -> Release:
    """Release of a cured membrane from its core: an upper bound, as if all of the core passed the smallest opening."""
    # The opening is bounded by the faces below the dome: its rim and what lies within the flange.
    cured = CavityFaces.of(membrane, 1.0)
    opening = 2 * min(min(piece.start[0], piece.end[0]) for piece in (cured.rim, cured.underside))
    rim = size.faces.rim
    core = 2 * max(rim.start[0], rim.end[0], *(piece.bounds()[1] for piece in size.faces.inner))
    return Release(opening, core)
