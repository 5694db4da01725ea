"""Ellipsoids of revolution, flat or high, and cylinders that end in one."""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np

from pneutouch.arrays import Array
from pneutouch.shape.even import EvenDome, fitted
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
