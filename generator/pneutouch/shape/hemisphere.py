"""The paper's dome: inner and outer face are hemispheres."""

import math
from dataclasses import dataclass

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


@dataclass(frozen=True, slots=True)
class FilletedHemisphere(DomeShape):
    """A hemisphere whose outer face runs into the top of its flange by an arc of the radius ``root_fillet``, mm.

    The arc touches the sphere and, at `outer_radius`, the base plane.
    """

    root_fillet: float
    key, adjective = Hemisphere.key, Hemisphere.adjective

    @property
    def plain(self) -> Hemisphere:
        """The same hemisphere with a sharp corner at its root."""
        return Hemisphere(self.inner_radius, self.wall_thickness)

    @property
    def inner(self) -> tuple[Arc, ...]:
        """The inner half sphere, in two pieces: opposite the fillet and above it."""
        lean, centre, radius = self._lean, (0.0, 0.0), self.inner_radius
        return Arc(centre, radius, 0.0, lean, INNER_WALL), Arc(centre, radius, lean, _QUARTER, INNER_WALL)

    @property
    def outer(self) -> tuple[Arc, ...]:
        """The fillet, then the outer half sphere above it."""
        sphere, fillet, lean = self.inner_radius + self.wall_thickness, self.root_fillet, self._lean
        foot = (sphere + fillet) * math.cos(lean)
        return (
            Arc((foot, fillet), fillet, -_QUARTER, lean - math.pi, OUTER_WALL),
            Arc((0.0, 0.0), sphere, lean, _QUARTER, OUTER_WALL),
        )

    @property
    def _lean(self) -> float:
        """Angle above the base plane, rad, at which the fillet touches the sphere."""
        return math.asin(self.root_fillet / (self.inner_radius + self.wall_thickness + self.root_fillet))


def no_hemisphere(shape: DomeShape) -> str | None:
    """Reason why formulas and tables for a hemisphere do not cover ``shape``; None if it is a hemisphere."""
    if isinstance(shape, FilletedHemisphere):
        return f"the dome has a fillet of {shape.root_fillet:g} mm at its root"
    if shape.key == Hemisphere.key and getattr(shape, "wall_stations", None):
        return "the wall of the dome varies along its arc"
    return None if type(shape) is Hemisphere else f"the dome is no hemisphere: its shape is {shape.key}"
