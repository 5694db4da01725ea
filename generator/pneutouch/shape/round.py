"""Round shapes: caps, ellipsoids of revolution, cylinders that end in one, and hemispheres with a fillet or a wall that
varies."""

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import ClassVar

import numpy as np

from pneutouch.arrays import Array
from pneutouch.shape.dome import DomeShape
from pneutouch.shape.even import EvenDome, fitted
from pneutouch.shape.hemisphere import Hemisphere
from pneutouch.shape.meridian import Arc, Line, Segment

_QUARTER = 0.5 * math.pi


@lru_cache(maxsize=64)
def quarter(radius: float, rise: float) -> tuple[Segment, ...]:
    """Quarter of an ellipse from (``radius``, 0) to (0, ``rise``), mm, in arcs within `even.FIT` of it."""
    if radius == rise:
        return (Arc((0.0, 0.0), radius, 0.0, _QUARTER, ""),)

    def curve(share: Array) -> tuple[Array, Array]:
        cosine, sine = np.cos(_QUARTER * share), np.sin(_QUARTER * share)
        return np.stack([radius * cosine, rise * sine], axis=1), np.stack([-radius * sine, rise * cosine], axis=1)

    return fitted(curve)


@dataclass(frozen=True, slots=True)
class Ellipsoid(EvenDome):
    """Half an ellipsoid of revolution whose inner face rises by ``rise`` mm over its rim."""

    rise: float
    key, adjective = "ellipsoid", "ellipsoidal"
    usual: ClassVar = {"rise": 1.25}

    @property
    def line(self) -> tuple[Segment, ...]:
        """A quarter of the ellipse in arcs."""
        return quarter(self.inner_radius, self.rise)


@dataclass(frozen=True, slots=True)
class Thimble(EvenDome):
    """A cylinder of the height ``side`` that ends in half an ellipsoid of the height ``rise``, mm."""

    side: float
    rise: float
    key, adjective = "thimble", "thimble-shaped"
    usual: ClassVar = {"side": 0.5, "rise": 1.0}

    @property
    def line(self) -> tuple[Segment, ...]:
        """The cylinder, then a quarter of an ellipse."""
        radius, end = self.inner_radius, quarter(self.inner_radius, self.rise)
        return Line((radius, 0.0), (radius, self.side), ""), *(piece.moved(0.0, self.side, "") for piece in end)


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
