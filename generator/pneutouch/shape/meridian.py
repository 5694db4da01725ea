"""Meridians: closed loops of lines and arcs in (r, z), mm, swept into solids; exact volumes, areas and distances."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from pneutouch.arrays import Array

Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Line:
    """A straight piece from ``start`` to ``end``, (r, z) in mm; ``tag`` names the face that it sweeps."""

    start: Point
    end: Point
    tag: str

    @property
    def length(self) -> float:
        """Length in mm."""
        return math.dist(self.start, self.end)

    def along(self, share: Array) -> Array:
        """Points (n, 2) at shares (n,) of the length, 0 at the start."""
        return np.asarray(np.outer(1.0 - share, self.start) + np.outer(share, self.end))

    def normals(self, share: Array) -> Array:
        """Unit normals (n, 2) at shares (n,) of the length, to the right of the direction from start to end."""
        (r0, z0), (r1, z1) = self.start, self.end
        return np.broadcast_to(np.array([z1 - z0, r0 - r1]) / self.length, (share.size, 2))

    def share(self, points: Array) -> Array:
        """Shares (n,) of the length, 0 to 1, at which the piece is nearest to points (n, 2) in the (r, z) plane."""
        along = np.asarray(self.end) - np.asarray(self.start)
        return np.asarray(np.clip((points - np.asarray(self.start)) @ along / (along @ along), 0.0, 1.0))

    def reverse(self) -> "Line":
        """The same piece, from its end to its start."""
        return Line(self.end, self.start, self.tag)

    def moved(self, outwards: float, up: float, tag: str) -> "Line":
        """The piece moved to the right of its direction by ``outwards`` and along z by ``up``, mm."""
        (nr, nz), points = self.normals(np.zeros(1))[0].tolist(), (self.start, self.end)
        one, other = ((r + outwards * nr, z + outwards * nz + up) for r, z in points)
        return Line(one, other, tag)

    def swept(self) -> float:
        """The integral of pi r^2 dz along the piece, mm3 (a truncated cone, signed by direction)."""
        (r0, z0), (r1, z1) = self.start, self.end
        return math.pi * (z1 - z0) * (r0 * r0 + r0 * r1 + r1 * r1) / 3

    def area(self) -> float:
        """Area of the face swept by revolution, mm2."""
        return math.pi * (self.start[0] + self.end[0]) * self.length

    def distance(self, points: Array) -> Array:
        """Distances, shape (n,), of (n, 2) points in the (r, z) plane from the piece."""
        start = np.asarray(self.start)
        along = np.asarray(self.end) - start
        return np.asarray(np.linalg.norm(points - start - self.share(points)[:, None] * along, axis=1))

    def bounds(self) -> tuple[float, float, float, float]:
        """Smallest and largest r, then smallest and largest z."""
        (r0, z0), (r1, z1) = self.start, self.end
        return min(r0, r1), max(r0, r1), min(z0, z1), max(z0, z1)


@dataclass(frozen=True, slots=True)
class Arc:
    """A circular piece about ``centre`` (r, z; mm) from angle ``first`` to ``last`` (rad from the r axis towards z)."""

    centre: Point
    radius: float
    first: float
    last: float
    tag: str

    def at(self, angle: float, radius: float | None = None) -> Point:
        """Point (r, z) at ``angle`` (rad) and ``radius`` (mm) about the centre; None: the radius of the arc."""
        rho = self.radius if radius is None else radius
        return self.centre[0] + rho * math.cos(angle), self.centre[1] + rho * math.sin(angle)

    @property
    def start(self) -> Point:
        """Point at the angle ``first``."""
        return self.at(self.first)

    @property
    def end(self) -> Point:
        """Point at the angle ``last``."""
        return self.at(self.last)

    @property
    def middle(self) -> Point:
        """Point half way along the arc."""
        return self.at(0.5 * (self.first + self.last))

    @property
    def length(self) -> float:
        """Length in mm."""
        return self.radius * abs(self.last - self.first)

    def along(self, share: Array) -> Array:
        """Points (n, 2) at shares (n,) of the length, 0 at the start."""
        return np.asarray(np.asarray(self.centre) + self.radius * self._outward(share))

    def normals(self, share: Array) -> Array:
        """Unit normals (n, 2) at shares (n,) of the length, to the right of the direction from start to end."""
        return np.asarray(math.copysign(1.0, self.last - self.first) * self._outward(share))

    def share(self, points: Array) -> Array:
        """Shares (n,) of the length, 0 to 1, at which the arc is nearest to points (n, 2) in the (r, z) plane."""
        r, z = (points - np.asarray(self.centre)).T
        turn = np.mod(np.arctan2(z, r) - self.first + np.pi, 2 * np.pi) - np.pi
        return np.asarray(np.clip(turn / (self.last - self.first), 0.0, 1.0))

    def _outward(self, share: Array) -> Array:
        angle = self.first + share * (self.last - self.first)
        return np.stack([np.cos(angle), np.sin(angle)], axis=1)

    def reverse(self) -> "Arc":
        """The same piece, from its end to its start."""
        return Arc(self.centre, self.radius, self.last, self.first, self.tag)

    def moved(self, outwards: float, up: float, tag: str) -> "Arc":
        """The concentric arc to the right of the piece by ``outwards``, moved along z by ``up``, mm."""
        radius = self.radius + math.copysign(outwards, self.last - self.first)
        return Arc((self.centre[0], self.centre[1] + up), radius, self.first, self.last, tag)

    def swept(self) -> float:
        """The integral of pi r^2 dz along the piece, mm3 (closed form, signed by direction)."""

        def primitive(angle: float) -> float:
            c, rho, s = self.centre[0], self.radius, math.sin(angle)
            square = 0.5 * angle + 0.25 * math.sin(2 * angle)
            return rho * (c * c * s + 2 * c * rho * square + rho * rho * (s - s**3 / 3))

        return math.pi * (primitive(self.last) - primitive(self.first))

    def area(self) -> float:
        """Area of the face swept by revolution, mm2."""
        rise = math.sin(self.last) - math.sin(self.first)
        turn = self.last - self.first
        return abs(2 * math.pi * self.radius * (self.centre[0] * turn + self.radius * rise))

    def distance(self, points: Array) -> Array:
        """Distances, shape (n,), of (n, 2) points in the (r, z) plane from the piece."""
        offset = points - np.asarray(self.centre)
        low, high = sorted((self.first, self.last))
        angle = low + np.mod(np.arctan2(offset[:, 1], offset[:, 0]) - low, 2 * np.pi)
        to_ends = np.minimum(
            np.linalg.norm(points - np.asarray(self.start), axis=1),
            np.linalg.norm(points - np.asarray(self.end), axis=1),
        )
        radial = np.abs(np.hypot(offset[:, 0], offset[:, 1]) - self.radius)
        return np.asarray(np.where(angle <= high, radial, to_ends))

    def bounds(self) -> tuple[float, float, float, float]:
        """Smallest and largest r, then smallest and largest z."""
        low, high = sorted((self.first, self.last))
        quarters = range(math.ceil(low / (math.pi / 2)), math.floor(high / (math.pi / 2)) + 1)
        points = [self.start, self.end, *(self.at(k * math.pi / 2) for k in quarters)]
        radii, heights = zip(*points, strict=True)
        return min(radii), max(radii), min(heights), max(heights)


Segment = Line | Arc

_CLOSED = 1e-9
"""Greatest distance (mm) of ends that should meet: computed from the same numbers, they differ only by rounding."""


@dataclass(frozen=True, slots=True)
class Meridian:
    """A loop of pieces, counter-clockwise in (r, z), closed in itself or by the axis r = 0; else raises ValueError."""

    pieces: tuple[Segment, ...]

    def __post_init__(self) -> None:
        for one, other in pairwise(self.pieces):
            if math.dist(one.end, other.start) > _CLOSED:
                raise ValueError(f"the meridian is open between {one.tag} at {one.end} and {other.tag}")
        if not self.is_ring and max(abs(self.start[0]), abs(self.end[0])) > _CLOSED:
            raise ValueError(f"the meridian neither closes nor ends on the axis: {self.start}, {self.end}")
        if self.volume() <= 0:
            raise ValueError("the meridian runs clockwise: its solid would be inside out")

    @property
    def start(self) -> Point:
        """First point of the loop."""
        return self.pieces[0].start

    @property
    def end(self) -> Point:
        """Last point of the loop."""
        return self.pieces[-1].end

    @property
    def is_ring(self) -> bool:
        """True if the pieces themselves close the loop: the solid has a hole along the axis."""
        return math.dist(self.start, self.end) <= _CLOSED

    def volume(self) -> float:
        """Exact volume of the solid of revolution, mm3 (Green's theorem: the integral of pi r^2 dz)."""
        return sum(piece.swept() for piece in self.pieces)

    def tagged(self, tag: str) -> list[Segment]:
        """The pieces with a tag, in order."""
        return [piece for piece in self.pieces if piece.tag == tag]

    def bounds(self) -> tuple[float, float, float]:
        """Largest radius, smallest z and largest z, mm."""
        boxes = [piece.bounds() for piece in self.pieces]
        return max(b[1] for b in boxes), min(b[2] for b in boxes), max(b[3] for b in boxes)

    def distance(self, points: Array) -> Array:
        """Distances (n,) in mm of points (n, 3) from the exact surface of the solid of revolution."""
        plane = np.column_stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]])
        return np.asarray(np.min([piece.distance(plane) for piece in self.pieces], axis=0))


TracedPath = list[tuple[str, Point]]


def lines_around(corners: Sequence[Point], tag: str = "") -> tuple[Line, ...]:
    """Straight lines around a polygon of ``corners`` (r, z), all with the tag ``tag``; the last one closes it."""
    return tuple(Line(a, b, tag) for a, b in pairwise([*corners, corners[0]]))


def trace(start: Point, path: Iterable[tuple[str, Point]]) -> Meridian:
    """Meridian of straight faces from ``start`` along ``path``, pairs of tag and end point; none of zero length."""
    faces, here = [], start
    for tag, to in path:
        if math.dist(here, to) > 0.0:
            faces.append(Line(here, to, tag))
            here = to
    return Meridian(tuple(faces))


def cylinder(radius: float, low: float, high: float) -> Meridian:
    """Meridian of a solid cylinder about the axis, of ``radius`` from height ``low`` to ``high``, mm."""
    return trace((0.0, low), [("", (radius, low)), ("", (radius, high)), ("", (0.0, high))])
