"""The pressed shape of the paper's state II: a flat disc and a free part of constant curvature.

The free part is an arc tangent to the plate at radius rho and height h, through the base circle R0
(eq. 11). Area and volume follow in closed form, with their derivatives by rho and h. Write c = R0 - rho,
a = (c^2 + h^2)/(2h) for the arc's radius and theta for the angle it spans; then

    A = pi [rho^2 + 2 rho a theta + c^2 + h^2]
    V = pi [rho^2 h + rho a^2 theta - rho c (a - h) + a h^2 - h^3/3] .

rho = 0 gives the cap of state I.
"""

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array


@dataclass(frozen=True, slots=True)
class PressedCap:
    """Membrane ``area`` (mm2, middle surface = inner surface in this theory) and cavity ``volume`` (mm3).

    Derivatives are by the contact radius (``_rho``) and the plate height (``_h``).
    """

    area: Array
    volume: Array
    area_rho: Array
    area_h: Array
    volume_rho: Array
    volume_h: Array


def pressed_cap(rho: Array, h: Array, inner_radius: float) -> PressedCap:
    """Evaluate the shape at contact radii ``rho`` (0 to R0) and plate heights ``h``, broadcast together."""
    c = inner_radius - rho
    a = (c**2 + h**2) / (2 * h)
    theta = np.arctan2(c, a - h)
    slope = 2 * rho * h + a**2 * theta - 2 * rho * a * theta * c / h + rho * (2 * a - h) - c * a + rho * c**2 / h
    return PressedCap(
        area=np.pi * (rho**2 + 2 * rho * a * theta + c**2 + h**2),
        volume=np.pi * (rho**2 * h + rho * a**2 * theta - rho * c * (a - h) + a * h**2 - h**3 / 3),
        area_rho=2 * np.pi * (2 * rho + a * theta - rho * theta * c / h - c),
        area_h=2 * np.pi * (rho * theta * (1 - a / h) + rho * c / h + h),
        volume_rho=np.pi * slope,
        volume_h=np.pi * (rho**2 + 2 * rho * a * theta * (1 - a / h) + 2 * rho * c * a / h + a * h),
    )
