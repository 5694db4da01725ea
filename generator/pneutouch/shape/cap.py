"""Parts of spheres: caps, less than half of a sphere over the base, and hemispheres with a wall that varies."""

import math
from dataclasses import dataclass, replace
from typing import ClassVar

from pneutouch.shape.dome import DomeShape
from pneutouch.shape.even import EvenDome
from pneutouch.shape.hemisphere import Hemisphere
from pneutouch.shape.meridian import Arc


@dataclass(frozen=True, slots=True)
class FreeHemisphere(EvenDome):
    """A hemisphere with a fillet at its root, or a wall that varies along its arc."""

    key, adjective = Hemisphere.key, Hemisphere.adjective

    @property
    def line(self) -> tuple[Arc, ...]:
        """A quarter of the circle."""
        return (Arc((0.0, 0.0), self.inner_radius, 0.0, 0.5 * math.pi, ""),)

    @property
    def plain(self) -> DomeShape:
        """The shape without the fillet at its root: of one wall the hemisphere of tables and formulas."""
        if not self.wall_stations:
            return Hemisphere(self.inner_radius, self.wall_thickness)
        return replace(self, root_fillet=0.0) if self.root_fillet else self


@dataclass(frozen=True, slots=True)
class Cap(EvenDome):
    """A spherical cap whose inner face rises by ``rise`` mm over its rim; clamped along a radius of the sphere."""

    rise: float
    key, adjective = "cap", "cap-shaped"
    usual: ClassVar = {"rise": 0.5}

    @property
    def line(self) -> tuple[Arc, ...]:
        """One arc of the sphere."""
        radius = 0.5 * (self.inner_radius**2 + self.rise**2) / self.rise
        centre = 0.0, self.rise - radius
        return (Arc(centre, radius, math.atan2(-centre[1], self.inner_radius), 0.5 * math.pi, ""),)

    @property
    def fault(self) -> tuple[str, str] | None:
        """A cap is no higher than a hemisphere and no flatter than its wall."""
        if self.rise > self.inner_radius:
            return "rise", f"a cap rises by its inner radius ({self.inner_radius:g} mm) at most; take an ellipsoid"
        if self.rise < self.wall_thickness:
            return "rise", f"a cap must rise by its wall ({self.wall_thickness:g} mm) at least; take a disc"
        return None
