"""Undersides of rigid objects as functions of two horizontal coordinates, x in the plane of symmetry.

Also the lines by which an object is drawn over the dome (circles around its axis, or lines along a lying body), its
placement on or off the axis, and its height at first contact with the dome.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple, Self

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.solid.indenter import RigidObject
from pneutouch.mechanics.solid.object_contact import Indenter, Plate


class SurfaceHeight(NamedTuple):
    """Height (...) of a surface at points, its gradient (..., 2) and second derivatives (..., 2, 2) by x and y."""

    height: Array
    slope: Array
    curve: Array


class Surface(ABC):
    """A rigid body above the dome, not necessarily a body of revolution about the dome's axis; lengths in R0. As an
    `Indenter` it is its section in the plane of symmetry, also for negative x."""

    @property
    @abstractmethod
    def height(self) -> float:
        """Height of the object's lowest point, or of another point that moves with it."""

    @property
    @abstractmethod
    def span(self) -> tuple[float, float]:
        """Distances from the object's own axis between which the underside is the object's own surface."""

    @abstractmethod
    def over(self, x: Array, y: Array) -> SurfaceHeight:
        """Underside of the object at points x, y, arrays of one shape."""

    @abstractmethod
    def distance(self, x: Array, y: Array) -> Array:
        """Distance of points from the object's own axis, to compare with `span`."""

    @abstractmethod
    def at(self, height: float) -> "Surface":
        """The body at another height."""

    def underside(self, r: Array) -> tuple[Array, Array, Array]:
        """Height of the section in the plane of symmetry at x = r, and its first two derivatives, arrays like r."""
        under = self.over(r, np.zeros_like(r))
        return under.height, under.slope[..., 0], under.curve[..., 0, 0]


def revolved(profile: Callable[[Array], tuple[Array, Array, Array]], x: Array, y: Array) -> SurfaceHeight:
    """Surface of revolution about x = y = 0 at points; ``profile`` gives height and two derivatives at radii."""
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
    """An object with the section of ``body`` in the plane of symmetry, centred at x = ``offset`` (R0)."""

    body: Indenter
    offset: float = 0.0

    @property
    def height(self) -> float:
        """Height of the lowest line or point, or of the centre of a plate, about which it leans."""
        return self.body.height

    @property
    def span(self) -> tuple[float, float]:
        """Radii between which the underside is that of the section itself, see `RigidObject.span`."""
        return self.body.span

    def at(self, height: float) -> Self:
        """The object at another height."""
        return replace(self, body=self.body.at(height))


@dataclass(frozen=True)
class LyingObject(ProfiledObject):
    """A straight body across the plane of symmetry, endless along y. Its section is that of ``body``, as a function of
    the distance from its middle at x = ``offset``."""

    def distance(self, x: Array, y: Array) -> Array:
        """Distance of points from the body's middle plane x = ``offset``."""
        return np.asarray(np.abs(x - self.offset) + 0.0 * y)

    def over(self, x: Array, y: Array) -> SurfaceHeight:
        """Underside of the body at points x, y, arrays of one shape."""
        along = x - self.offset + 0.0 * y
        height, slope, curve = self.body.underside(np.abs(along))
        by_xy, bend = np.zeros((*along.shape, 2)), np.zeros((*along.shape, 2, 2))
        by_xy[..., 0], bend[..., 0, 0] = np.sign(along) * slope, curve
        return SurfaceHeight(height, by_xy, bend)


@dataclass(frozen=True)
class PlacedObject(ProfiledObject):
    """A body of revolution with its axis at x = ``offset``, tilted by ``tilt`` (rad) about the y axis through its
    lowest point, or through the centre of a plate: with a positive tilt it is lower at negative x. The tilt is exact
    only for a body whose underside is flat apart from its rim."""

    tilt: float = 0.0

    def distance(self, x: Array, y: Array) -> Array:
        """Distance of points from the body's own axis."""
        return np.asarray(np.hypot((x - self.offset) / np.cos(self.tilt), y))

    def over(self, x: Array, y: Array) -> SurfaceHeight:
        """Underside of the body at points x, y, arrays of one shape."""
        along = x - self.offset
        if not self.tilt:
            return revolved(self.body.underside, along, y)
        cos, slope = np.cos(self.tilt), np.tan(self.tilt)
        level = self.body.at(0.0)
        # A horizontal length along x is longer by 1/cos in the plane of the plate, and a normal rise is so upright.
        shape = revolved(level.underside, along / cos, y)
        stretch = np.array([1.0 / cos, 1.0])
        by_xy = shape.slope * stretch / cos
        by_xy[..., 0] += slope
        curve = shape.curve * stretch[:, None] * stretch / cos
        return SurfaceHeight(self.height + along * slope + shape.height / cos, by_xy, curve)


_PARTS = 6
"""Number of equal parts of a section's length, between which lines are drawn."""

_ROUND = 48
"""Number of straight pieces of a circle."""

_EVERY = 6
"""Number of points of a section for each point of a line along it."""

_THICK = 0.12
"""Thickness of a plate as drawn, in R0: the model has only its underside."""

_NONE = 1e-6
"""Radius in R0 below which a circle is not drawn."""


def object_lines(body: ProfiledObject, reach: float) -> tuple[Array, ...]:
    """Lines (k, 3) that draw an object in its place, in R0; an unbounded object is drawn to a distance ``reach``."""
    section = _section(body.body, reach)
    if isinstance(body, LyingObject):
        return _lying(section, body.offset, reach)
    assert isinstance(body, PlacedObject)
    angle = np.linspace(0.0, 2.0 * np.pi, _ROUND + 1)
    lines = [_placed(body, radius, angle, height) for radius, height in _spread(section) if radius > _NONE]
    # Nearer to the dome lines along the section would cross the contact.
    upper = section[len(section) // 3 :: _EVERY] if len(section) > 2 else section
    lines += [_placed(body, upper[:, 0], turn, upper[:, 1]) for turn in 0.5 * np.pi * (0.5 + np.arange(4))]
    return tuple(lines)


def _placed(body: PlacedObject, radius: float | Array, angle: float | Array, height: float | Array) -> Array:
    """Points (x, y, z), (k, 3), of a body of revolution, from radius, angle and height about its own axis."""
    cos, sin = np.cos(body.tilt), np.sin(body.tilt)
    x, y, z = np.broadcast_arrays(radius * np.cos(angle), radius * np.sin(angle), height - body.height)
    return np.stack([body.offset + cos * x - sin * z, y, body.height + sin * x + cos * z], axis=1)


def _section(body: Indenter, reach: float) -> Array:
    """Half of a body's section, (k, 2): distance from its middle, and height."""
    if isinstance(body, Plate):
        edge = body.radius + 0.5 * body.rim
        return np.array([[edge, body.height], [edge, body.height + _THICK]])
    assert isinstance(body, RigidObject)
    return body.outline(reach)


def _spread(section: Array) -> Array:
    """Points (k, 2) at equal steps along a section; a section of two points is returned as it is."""
    if len(section) == 2:
        return section
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(section, axis=0).T)))
    at = np.linspace(0.0, along[-1], _PARTS + 1)
    return np.stack([np.interp(at, along, part) for part in section.T], axis=1)


def _lying(section: Array, offset: float, reach: float) -> tuple[Array, ...]:
    """Lines along a body that lies across the plane of symmetry, and its section at both ends."""
    whole = np.concatenate([section[::-1] * [-1.0, 1.0], section[1:]])
    ends = [
        np.stack([offset + whole[:, 0], np.full(len(whole), side * reach), whole[:, 1]], axis=1) for side in (-1.0, 1.0)
    ]
    lines = []
    for distance, height in _spread(section):
        for x in {offset - distance, offset + distance}:
            lines.append(np.array([[x, -reach, height], [x, reach, height]]))
    return (*ends, *lines)


_ANGLES = 181
"""Number of angles on the half circle at which an object may touch first."""


def first_height(surface: Surface, outline: tuple[Array, Array]) -> float:
    """Height of a surface at first contact from above with the points r, z (n,) of a dome's outer wall."""
    r, z = outline
    angle = np.linspace(0.0, np.pi, _ANGLES)[:, None]
    under = surface.at(0.0).over(r * np.cos(angle), r * np.sin(angle)).height
    return float((z - under).max())
