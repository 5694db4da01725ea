"""The paper's dome: inner and outer face are hemispheres."""

import math

import numpy as np

from pneutouch.arrays import Array
from pneutouch.shape.dome import INNER_WALL, OUTER_WALL, DomeShape
from pneutouch.shape.meridian import Arc

_QUARTER = 0.5 * math.pi


class Hemisphere(DomeShape):
    """Two concentric hemispheres centred in the base plane; the methods use polar coordinates: exact and fast."""

    __slots__ = ()
    key, adjective = "hemisphere", "hemispherical"

    @property
    def inner(self) -> tuple[Arc, ...]:
        """The inner half sphere."""
        return (Arc((0.0, 0.0), self.inner_radius, 0.0, _QUARTER, INNER_WALL),)

    @property
    def outer(self) -> tuple[Arc, ...]:
        """The outer half sphere."""
        return (Arc((0.0, 0.0), self.inner_radius + self.wall_thickness, 0.0, _QUARTER, OUTER_WALL),)

    def points(self, share: Array, depth: Array) -> Array:
        """Points (n, m, 2) of the wall, r and z in mm, as in `DomeShape.points`."""
        angle, radius = _QUARTER * share[:, None], self.inner_radius + self.wall_thickness * depth
        return np.stack([np.cos(angle) * radius, np.sin(angle) * radius], axis=-1)

    def arc_share(self, radius: Array, height: Array) -> Array:
        """Arc position of points (arrays of one shape): their angle to the axis over a right angle, 0 to 1."""
        return np.asarray(np.clip(np.arctan2(radius, np.maximum(height, 0.0)) / _QUARTER, 0.0, 1.0))

    def arc_share_scaled(self, radius: Array, height: Array) -> Array:
        """`arc_share` of points in units of `scale`: an angle needs no conversion of lengths, and so no rounding."""
        return self.arc_share(radius, height)

    def weights(self, arc: Array) -> Array:
        """Weights (n,) of arc positions (n,), 0 at the pole and 1 at the rim: radius there over that of the sphere."""
        return np.asarray(np.sin(_QUARTER * arc))


def no_hemisphere(shape: DomeShape) -> str | None:
    """Reason why formulas and tables for a hemisphere do not cover ``shape``; None if it is a hemisphere."""
    if type(shape) is Hemisphere:
        return None
    if shape.key != Hemisphere.key:
        return f"the dome is no hemisphere: its shape is {shape.key}"
    fillet = shape is not shape.plain and "the dome has a fillet at its root"
    return fillet or "the wall of the dome varies along its arc"
