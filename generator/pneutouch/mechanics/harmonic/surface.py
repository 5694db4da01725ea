"""Undersides of rigid objects as functions of two horizontal coordinates, x in the plane of symmetry."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple, Self

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.solid.indenter import Indenter


class SurfaceHeight(NamedTuple):
    """Height of a surface at points, its gradient (..., 2) and second derivatives (..., 2, 2) by x and y."""

    height: Array
    slope: Array
    curve: Array


class Surface(ABC):
    """A rigid body above the dome that need not be a body of revolution about the dome's axis; lengths in R0. As an
    `Indenter` it is its section in the plane of symmetry, at negative x too."""

    @property
    @abstractmethod
    def height(self) -> float:
        """Height of its reference point."""

    @property
    @abstractmethod
    def span(self) -> tuple[float, float]:
        """Distances from its own axis between which its underside is the object's own."""

    @abstractmethod
    def over(self, x: Array, y: Array) -> SurfaceHeight:
        """Its underside at points of any one shape."""

    @abstractmethod
    def distance(self, x: Array, y: Array) -> Array:
        """Distance from its own axis, at which `span` ends."""

    @abstractmethod
    def at(self, height: float) -> Surface:
        """This body at another height."""

    def underside(self, r: Array) -> tuple[Array, Array, Array]:
        """Height of the section in the plane of symmetry at x = r and its first two derivatives."""
        under = self.over(r, np.zeros_like(r))
        return under.height, under.slope[..., 0], under.curve[..., 0, 0]


def revolved(profile: Callable[[Array], tuple[Array, Array, Array]], x: Array, y: Array) -> SurfaceHeight:
    """A surface of revolution about the axis x = y = 0, given its height over the radius and two derivatives."""
    radius = np.hypot(x, y)
    height, slope, curve = profile(radius)
    safe = np.maximum(radius, 1.0e-300)
    at_axis = radius <= 0.0
    out = np.where(at_axis[..., None], [1.0, 0.0], np.stack([x, y], axis=-1) / safe[..., None])
    ring = np.where(at_axis, curve, slope / safe)
    form = (curve - ring)[..., None, None] * out[..., :, None] * out[..., None, :]
    form[..., 0, 0] += ring
    form[..., 1, 1] += ring
    return SurfaceHeight(height, slope[..., None] * out, form)


@dataclass(frozen=True)
class ProfiledObject(Surface):
    """An object whose section is that of ``body``, its middle at x = ``offset``."""

    body: Indenter
    offset: float = 0.0

    @property
    def height(self) -> float:
        """Height of its lowest line or point, or of the middle of a plate, which it leans about."""
        return self.body.height

    @property
    def span(self) -> tuple[float, float]:
        """Radii between which the underside is the section's own, see `RigidObject.span`."""
        return self.body.span

    def at(self, height: float) -> Self:
        """This object at another height."""
        return replace(self, body=self.body.at(height))


@dataclass(frozen=True)
class LyingObject(ProfiledObject):
    """A straight body across the plane of symmetry, endless along y. Its section is that of ``body`` over the distance
    from its middle at x = ``offset``."""

    def distance(self, x: Array, y: Array) -> Array:
        """Distance from its plane of symmetry."""
        return np.asarray(np.abs(x - self.offset) + 0.0 * y)

    def over(self, x: Array, y: Array) -> SurfaceHeight:
        """Its underside at points of any one shape."""
        along = x - self.offset + 0.0 * y
        height, slope, curve = self.body.underside(np.abs(along))
        by_xy, bend = np.zeros((*along.shape, 2)), np.zeros((*along.shape, 2, 2))
        by_xy[..., 0], bend[..., 0, 0] = np.sign(along) * slope, curve
        return SurfaceHeight(height, by_xy, bend)


@dataclass(frozen=True)
class PlacedObject(ProfiledObject):
    """A body of revolution whose axis stands at x = ``offset`` and leans by ``tilt`` (rad) about the y axis through its
    lowest point, or through the middle of a plate: with a positive tilt it is lower at negative x. Only a body whose
    underside is flat but for its rim leans exactly."""

    tilt: float = 0.0

    def distance(self, x: Array, y: Array) -> Array:
        """Distance from its own axis."""
        return np.asarray(np.hypot((x - self.offset) / np.cos(self.tilt), y))

    def over(self, x: Array, y: Array) -> SurfaceHeight:
        """Its underside at points of any one shape."""
        along = x - self.offset
        if not self.tilt:
            return revolved(self.body.underside, along, y)
        cos, slope = np.cos(self.tilt), np.tan(self.tilt)
        level = self.body.at(0.0)
        # In the plane of the plate a horizontal length along x is longer by 1/cos, and so is a rise upright.
        shape = revolved(level.underside, along / cos, y)
        stretch = np.array([1.0 / cos, 1.0])
        by_xy = shape.slope * stretch / cos
        by_xy[..., 0] += slope
        curve = shape.curve * stretch[:, None] * stretch / cos
        return SurfaceHeight(self.height + along * slope + shape.height / cos, by_xy, curve)
