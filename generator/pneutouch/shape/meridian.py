"""Meridians: closed loops of straight lines and arcs in the (r, z) plane, mm, that sweep a solid of revolution.

They are sampled to a chord tolerance, and cut exactly at a level. A piece includes its lower end but not its upper end,
and a point on a crossing counts as beyond it: of two outlines that share a piece, exactly one contains a point on it.

An inscribed polygon always errs to the inside and loses volume to first order in the tolerance. If the inner vertices
of an arc are moved off it by two thirds of the sagitta, every chord encloses the area of its arc. The greatest error
falls to two thirds, so fewer chords meet the same tolerance.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from pneutouch.arrays import Array, Flags

Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Line:
    """A straight piece from ``start`` to ``end``; ``tag`` names the face that it sweeps."""

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

    def reverse(self) -> Line:
        """The same piece, from its end to its start."""
        return Line(self.end, self.start, self.tag)

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
        gap: Array = np.linalg.norm(points - start - self.share(points)[:, None] * along, axis=1)
        return gap

    def bounds(self) -> tuple[float, float, float, float]:
        """Smallest and largest r, then smallest and largest z."""
        (r0, z0), (r1, z1) = self.start, self.end
        return min(r0, r1), max(r0, r1), min(z0, z1), max(z0, z1)


@dataclass(frozen=True, slots=True)
class Arc:
    """A circular piece about ``centre`` from angle ``first`` to ``last`` (rad from the r axis towards z)."""

    centre: Point
    radius: float
    first: float
    last: float
    tag: str

    def at(self, angle: float, radius: float | None = None) -> Point:
        """Point at an angle, on the arc or at another radius about its centre."""
        rho = self.radius if radius is None else radius
        return self.centre[0] + rho * math.cos(angle), self.centre[1] + rho * math.sin(angle)

    @property
    def start(self) -> Point:
        """First end."""
        return self.at(self.first)

    @property
    def end(self) -> Point:
        """Last end."""
        return self.at(self.last)

    @property
    def middle(self) -> Point:
        """Point half way along."""
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

    def reverse(self) -> Arc:
        """The same piece, from its end to its start."""
        return Arc(self.centre, self.radius, self.last, self.first, self.tag)

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
        gap: Array = np.where(angle <= high, radial, to_ends)
        return gap

    def bounds(self) -> tuple[float, float, float, float]:
        """Smallest and largest r, then smallest and largest z."""
        low, high = sorted((self.first, self.last))
        quarters = range(math.ceil(low / (math.pi / 2)), math.floor(high / (math.pi / 2)) + 1)
        points = [self.start, self.end, *(self.at(k * math.pi / 2) for k in quarters)]
        radii, heights = zip(*points, strict=True)
        return min(radii), max(radii), min(heights), max(heights)


Segment = Line | Arc


_ON_AXIS = 1e-9
"""Distance from the axis (mm) within which a crossing counts as on it."""


@dataclass(frozen=True, slots=True)
class RisingPiece:
    """Part of an outline between two levels, mm, that crosses each level between them exactly once."""

    low: float
    high: float
    piece: Segment
    side: float = 1.0

    def at(self, level: Array) -> Array:
        """First coordinate of the crossings at levels of any shape."""
        piece = self.piece
        if isinstance(piece, Arc):
            inside = np.maximum(piece.radius**2 - (level - piece.centre[1]) ** 2, 0.0)
            return np.asarray(piece.centre[0] + self.side * np.sqrt(inside))
        (r0, z0), (r1, z1) = piece.start, piece.end
        if r0 == r1:
            return np.full(np.shape(level), r0)
        # Computed from the lower end for either direction: two bodies that share the piece get the same numbers.
        (r0, z0), (r1, z1) = sorted([(r0, z0), (r1, z1)], key=lambda point: point[1])
        return np.asarray(r0 + (level - z0) * ((r1 - r0) / (z1 - z0)))


def rises(outline: Sequence[Segment]) -> tuple[RisingPiece, ...]:
    """Rising pieces of a closed outline; an outline that ends on the axis is closed along it."""
    if math.dist(outline[0].start, outline[-1].end) > _ON_AXIS:
        outline = [*outline, Line(outline[-1].end, outline[0].start, "axis")]
    starts = [piece.start[1] for piece in outline]
    pieces: list[RisingPiece] = []
    for k, piece in enumerate(outline):
        # Levels at which pieces meet are taken from one of them, so that rounding opens no gap.
        for first, last, side in _monotone(piece, starts[k], starts[(k + 1) % len(starts)]):
            if first != last:
                pieces.append(RisingPiece(min(first, last), max(first, last), piece, side))
    return tuple(pieces)


def crossings(parts: Sequence[RisingPiece], level: float) -> list[float]:
    """First coordinates at which a level crosses the outline, ascending and even in number: in, out, in, out."""
    radii = [float(part.at(np.asarray(level))) for part in parts if part.low <= level < part.high]
    return sorted(0.0 if abs(r) < _ON_AXIS else r for r in radii)


def encloses(parts: Sequence[RisingPiece], along: Array, level: Array) -> Flags:
    """True for points (along, level), arrays (n,) in mm, inside the outline."""
    inside = np.zeros(len(along), bool)
    for part in parts:
        at = part.at(level)
        at = np.where(np.abs(at) < _ON_AXIS, 0.0, at)
        inside ^= (part.low <= level) & (level < part.high) & (along >= at)
    return inside


def _monotone(piece: Segment, first: float, last: float) -> list[tuple[float, float, float]]:
    """Parts that are monotone in level: first and last level, and side of the centre; an arc is cut at its extremes."""
    if not isinstance(piece, Arc):
        return [(first, last, 1.0)]
    low, high = sorted((piece.first, piece.last))
    turns = range(math.floor(low / math.pi - 0.5) + 1, math.ceil(high / math.pi - 0.5))
    tops = [(k + 0.5) * math.pi for k in turns]
    angles = [piece.first, *(tops if piece.first < piece.last else reversed(tops)), piece.last]
    levels = [first, *(piece.centre[1] + piece.radius * math.sin(a) for a in angles[1:-1]), last]
    middles = [0.5 * (a + b) for a, b in pairwise(angles)]
    return [(levels[k], levels[k + 1], math.copysign(1.0, math.cos(m))) for k, m in enumerate(middles)]


_CLOSED = 1e-9
"""Greatest distance (mm) of ends that should meet: computed from the same numbers, they differ only by rounding."""


@dataclass(frozen=True, slots=True)
class Meridian:
    """A closed loop of pieces, counter-clockwise in (r, z); it may be closed along the axis r = 0."""

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
        """True if the loop closes away from the axis (the solid has a hole along it)."""
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
        """Distances, shape (n,), of (n, 3) points from the exact surface of the solid."""
        plane = np.column_stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]])
        nearest: Array = np.min([piece.distance(plane) for piece in self.pieces], axis=0)
        return nearest


_AXIS_TOLERANCE = 1e-9
"""Radius (mm) below which a vertex is a pole that rounding moved off the axis."""


@dataclass(frozen=True, slots=True)
class MeridianVertex:
    """A vertex of the sampled meridian: ``lean`` is the radial part of the surface normal there (0 to 1).

    A ring on a face that leans little can be cut into fewer parts at the same error.
    """

    radius: float
    height: float
    lean: float


def chords(arc: Arc, error: float) -> int:
    """Number of chords that keep an arc within ``error`` mm if they preserve its area."""
    sagitta = min(1.5 * error, arc.radius)
    widest = 2 * math.acos(1 - sagitta / arc.radius)
    turn = abs(arc.last - arc.first)
    # The two end chords have one end on the arc; they span 1/sqrt(2) of the others (same mean error).
    return max(2, math.ceil(turn / widest + 2 - math.sqrt(2)))


def sample(meridian: Meridian, error: float) -> list[MeridianVertex]:
    """Vertices (rings) of a meridian whose arcs stay within ``error`` mm; the first is not repeated at the end."""
    rings: list[MeridianVertex] = []
    for piece in meridian.pieces:
        rings.append(MeridianVertex(*piece.start, lean=1.0))
        if isinstance(piece, Arc):
            rings += _inner_rings(piece, chords(piece, error))
    if not meridian.is_ring:
        rings.append(MeridianVertex(*meridian.end, lean=1.0))
    return [ring if ring.radius > _AXIS_TOLERANCE else MeridianVertex(0.0, ring.height, ring.lean) for ring in rings]


def _inner_rings(arc: Arc, count: int) -> list[MeridianVertex]:
    turn = arc.last - arc.first
    step = turn / (count - 2 + math.sqrt(2))
    radius = arc.radius + 2 / 3 * arc.radius * (1 - math.cos(step / 2))
    angles = [arc.first + step / math.sqrt(2) + k * step for k in range(count - 1)]
    return [MeridianVertex(*arc.at(angle, radius), lean=abs(math.cos(angle))) for angle in angles]


def polygon(outline: tuple[Segment, ...], error: float) -> list[Point]:
    """Corners of a closed outline, with arcs within ``error`` mm and the area preserved."""
    corners: list[Point] = []
    for piece in outline:
        corners.append(piece.start)
        if isinstance(piece, Arc):
            corners += [(ring.radius, ring.height) for ring in _inner_rings(piece, chords(piece, error))]
    return corners


TracedPath = list[tuple[str, Point]]


def trace(start: Point, path: Iterable[tuple[str, Point]]) -> Meridian:
    """Meridian of straight faces from ``start`` along ``path``; faces of zero length are left out."""
    faces, here = [], start
    for tag, to in path:
        if math.dist(here, to) > 0.0:
            faces.append(Line(here, to, tag))
            here = to
    return Meridian(tuple(faces))


def cylinder(radius: float, low: float, high: float) -> Meridian:
    """Meridian of a solid cylinder about the axis."""
    return trace((0.0, low), [("", (radius, low)), ("", (radius, high)), ("", (0.0, high))])
