"""Shapes that the program does not ship: a hemisphere under another name, a cap and a thimble."""

from __future__ import annotations

import math

from pneutouch.shape import SHAPES, shape_of
from pneutouch.shape.dome import INNER_WALL, OUTER_WALL, DomeShape
from pneutouch.shape.hemisphere import Hemisphere
from pneutouch.shape.meridian import Arc, Line


class HalfBall(Hemisphere):
    """A hemisphere, but not the one that closed forms and tables cover."""

    key, adjective = "half-ball", "half-round"


class HalfHighCap(DomeShape):
    """A cap of a sphere, half as high as its base is wide, of an even wall."""

    key, adjective = "half-high-cap", "shallow"

    @property
    def sphere(self):
        """Radius of the inner sphere: (R^2 + h^2) / 2h of a cap of radius R and height h = R/2."""
        return 1.25 * self.inner_radius

    def _arc(self, radius, tag):
        centre = self.height_of_centre
        return (Arc((0.0, centre), radius, math.asin(-centre / radius), 0.5 * math.pi, tag),)

    @property
    def height_of_centre(self):
        return 0.5 * self.inner_radius - self.sphere

    @property
    def inner(self):
        return self._arc(self.sphere, INNER_WALL)

    @property
    def outer(self):
        return self._arc(self.sphere + self.wall_thickness, OUTER_WALL)


class LongThimble(DomeShape):
    """A half ball on a cylinder as high as it is wide: faces of two pieces, without sizes of its own."""

    key, adjective = "long-thimble", "thimble-shaped"

    @property
    def inner(self):
        return self._part(self.inner_radius, INNER_WALL)

    @property
    def outer(self):
        return self._part(self.inner_radius + self.wall_thickness, OUTER_WALL)

    def _part(self, radius, tag):
        high = 2.0 * self.inner_radius
        return Line((radius, 0.0), (radius, high), tag), Arc((0.0, high), radius, 0.0, 0.5 * math.pi, tag)


SIZES = {
    "profile": {"profile": [[9.25, 0.0], [9.25, 5.0, 1.0], [4.0, 7.0, 2.0], [0.0, 7.0]]},
    "cap": {"rise": 4.0},
    "disc": {"boss_radius": 2.0, "boss_height": 1.5},
}
"""Sizes of the shipped shapes that have no usual ones, or are not plain with them."""


def shipped(inner_radius, wall_thickness):
    """Every shape of the program at one radius and wall, and a flat disc."""
    size = inner_radius, wall_thickness
    varying = {"wall_stations": [[0.0, 0.8], [0.4, 1.0], [1.0, 1.5]], "root_fillet": 0.05 * inner_radius}
    return [
        *(shape_of(key, *size, SIZES.get(key, {})) for key in SHAPES),
        shape_of("disc", *size, {}),
        *(shape_of(key, *size, varying) for key in ("hemisphere", "cap", "thimble")),
    ]
