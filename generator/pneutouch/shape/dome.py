"""The form of a dome at rest: two faces over one base plane, and the quantities derived from them."""

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, fields
from itertools import pairwise
from typing import Any, ClassVar

import numpy as np

from pneutouch.arrays import Array
from pneutouch.shape.meridian import Arc, Line, Point, Segment

INNER_WALL = "inner wall"
OUTER_WALL = "outer wall"
"""Tags of the pieces of the inner and the outer face."""


@dataclass(frozen=True, slots=True)
class DomeShape(ABC):
    """A dome over the base plane z = 0, the top of its flange; lengths in mm.

    This is a base class, not a protocol: a shape defines its faces and inherits all derived quantities. Each face
    is a chain of pieces from the base to the pole. Pieces with the same index are opposite each other: straight
    lines across the wall connect equal shares of their lengths. A shape with more sizes adds fields for it.
    ``inner_radius`` is the radius of the inner face at the base, ``key`` the name in a design file, ``adjective``
    the shape in words, ``usual`` further sizes over the inner radius where none are given, ``start`` more for a new
    design. The outer face begins in the base plane, the inner one in it or, where the wall leans at its rim, below.
    """

    inner_radius: float
    wall_thickness: float
    key: ClassVar[str]
    adjective: ClassVar[str]
    usual: ClassVar[Mapping[str, float]] = {}
    start: ClassVar[Mapping[str, Any]] = {}

    @property
    @abstractmethod
    def inner(self) -> tuple[Segment, ...]:
        """Pieces of the face towards the cavity, from base to pole, tagged `INNER_WALL`."""

    @property
    @abstractmethod
    def outer(self) -> tuple[Segment, ...]:
        """Pieces of the face that is pressed, from base to pole, tagged `OUTER_WALL`."""

    @property
    def further(self) -> str:
        """The sizes of the inner face and a boss in words, such as "rise 4.5 mm"; empty without any."""
        sizes = [(field.name.replace("_", " "), getattr(self, field.name)) for field in fields(self)[2:]]
        words = [
            f"{size} {name}" if isinstance(size, int) else f"{name} {size:g} mm"
            for name, size in sizes
            if isinstance(size, int | float) and size and name != "root fillet"
        ]
        return ", ".join(words)

    @property
    def stated_wall(self) -> str:
        """Thickness of the wall in words."""
        return f"{self.wall_thickness:g} mm"

    @property
    def plain(self) -> "DomeShape":
        """The shape without the fillet at its root: itself if it has none."""
        return self

    @property
    def scale(self) -> float:
        """Unit of length (mm) of the solid's dimensionless quantities: the inner radius."""
        return self.inner_radius

    @property
    def outer_radius(self) -> float:
        """Radius of the outer face at the base plane."""
        return self.outer[0].start[0]

    @property
    def upright(self) -> bool:
        """True if the wall stands upright on the base plane, so that its clamped edge lies in it."""
        inner, outer = self.inner[0].start, self.outer[0].start
        return abs(inner[1]) + abs(outer[1]) + abs(outer[0] - inner[0] - self.wall_thickness) < 1e-9 * self.inner_radius

    @property
    def floor(self) -> float:
        """Height of the rigid body behind the dome: that of the inner face's rim, for a flat wall lower."""
        return self.inner[0].start[1]

    @property
    def inner_height(self) -> float:
        """Height of the pole of the inner face over the base plane."""
        return self.inner[-1].end[1]

    @property
    def height(self) -> float:
        """Height of the pole of the inner face over the floor."""
        return self.inner_height - self.floor

    @property
    def outer_height(self) -> float:
        """Height of the highest point of the outer face."""
        return max(piece.bounds()[3] for piece in self.outer)

    @property
    def cavity_volume(self) -> float:
        """Volume under the inner face down to the floor, mm3."""
        return sum(piece.swept() for piece in self.inner) + self.pocket

    @property
    def domed(self) -> bool:
        """True if the outer face is curved at its pole and convex, so that an even press touches it in a disc."""
        turns = [piece.last > piece.first for piece in self.outer if isinstance(piece, Arc)]
        return isinstance(self.outer[-1], Arc) and all(turns)

    @property
    def pocket(self) -> float:
        """Volume between the floor and the inner face's rim, mm3."""
        return math.pi * self.inner_radius**2 * (self.inner[0].start[1] - self.floor)

    @property
    def wall_volume(self) -> float:
        """Volume of the wall between its faces and the edge where it is clamped, mm3."""
        edge = Line(self.inner[0].start, self.outer[0].start, "")
        return sum(piece.swept() for piece in (edge, *self.outer)) - sum(piece.swept() for piece in self.inner)

    @property
    def fault(self) -> tuple[str, str] | None:
        """Field that makes the shape impossible, and the reason in words; None if it can be made."""
        return None

    @property
    def wall_fault(self) -> tuple[str, str] | None:
        """As `fault`, of a wall that varies and of a fillet."""
        return None

    @property
    def arcs(self) -> tuple[float, float]:
        """Lengths of the inner and the outer face from base to pole."""
        return sum(piece.length for piece in self.inner), sum(piece.length for piece in self.outer)

    def points(self, share: Array, depth: Array) -> Array:
        """Points (n, m, 2) of the wall, r and z in mm.

        ``share`` (n,) goes from the base (0) to the pole (1), ``depth`` (m,) from the inner face (0) to the outer (1).
        """
        inner, outer = (self._of_face(face, share)[:, None] for face in (self.inner, self.outer))
        return np.asarray((1.0 - depth[:, None]) * inner + depth[:, None] * outer)

    def normals(self, share: Array) -> Array:
        """Unit normals (n, 2) of the outer face, outwards, at shares (n,) from the base to the pole."""
        return self._of_face(self.outer, share, normals=True)

    def leaning(self, lean: float) -> Point:
        """Point (r, z) of the outer face whose normal is at the angle ``lean`` (rad) to the axis; an end if none is."""
        # The lean is interpolated linearly between the places, which is exact on an arc.
        share = np.linspace(1.0, 0.0, 2001)
        normal = self.normals(share)
        # On a wavy face the place farthest from the axis up to which it leans no more.
        leans = np.maximum.accumulate(np.arctan2(normal[:, 0], normal[:, 1]))
        place = np.interp(lean, leans, share)
        ((r, z),) = self._of_face(self.outer, np.array([place])).tolist()
        return r, z

    def arc_share(self, radius: Array, height: Array) -> Array:
        """Arc position of points (r, z in mm; arrays of one shape): 0 at the pole, 1 at the rim.

        It is the position of the nearest point of the outer face; points below the base plane count as in that plane.
        """
        points = np.stack([np.ravel(radius), np.maximum(np.ravel(height), 0.0)], axis=1)
        stops, gaps = self._stops, [piece.distance(points) for piece in self.outer]
        shares = [a + (b - a) * piece.share(points) for piece, (a, b) in zip(self.outer, pairwise(stops), strict=True)]
        nearest = np.take_along_axis(np.array(shares), np.argmin(gaps, axis=0)[None], axis=0)
        return 1.0 - nearest.reshape(np.shape(radius))

    def arc_share_scaled(self, radius: Array, height: Array) -> Array:
        """`arc_share` for radii and heights in units of `scale`, as the solid uses them."""
        return self.arc_share(self.scale * radius, self.scale * height)

    def weights(self, arc: Array) -> Array:
        """Weights (n,) of arc positions (n,), 0 at the pole, in a mean over the wall: radius of its middle, mm."""
        return np.asarray(self.points(1.0 - arc, np.array([0.5]))[:, 0, 0])

    @property
    def _stops(self) -> Array:
        """Shares (k + 1,) of the wall's mean length, 0 at the base to 1 at the pole, at which its k pieces meet."""
        lengths = [inner.length + outer.length for inner, outer in zip(self.inner, self.outer, strict=True)]
        return np.concatenate([[0.0], np.cumsum(lengths) / np.sum(lengths)])

    def _of_face(self, face: tuple[Segment, ...], share: Array, normals: bool = False) -> Array:
        """Points (n, 2) of a face, or its unit normals, at shares (n,) of the wall's length from the base."""
        stops, values = self._stops, np.empty((share.size, 2))
        piece_at = np.clip(np.searchsorted(stops, share, side="right") - 1, 0, len(face) - 1)
        for k, piece in enumerate(face):
            at = piece_at == k
            within = (share[at] - stops[k]) / (stops[k + 1] - stops[k])
            values[at] = piece.normals(within) if normals else piece.along(within)
        return values
