"""Shapes that make up a solid: a meridian revolved about any axis, a prism on any plane, a round hole along z.

A meridian is sampled to a chord tolerance. An inscribed polygon always errs to the inside and loses volume to first
order in the tolerance. If the inner vertices of an arc are moved off it by two thirds of the sagitta, every chord
encloses the area of its arc. The greatest error falls to two thirds, so fewer chords meet the same tolerance.

A sampled meridian is revolved into a closed triangle mesh, with fewer triangles than a plain grid at the same error.

Each ring has only as many vertices as its own radius needs, and its polygon is widened until it encloses the area of
its circle, which preserves the volume. Strips between rings of different counts are zipped. The count of a ring depends
only on its radius, lean and error: two bodies that share a planar face with the same rings get the same triangles
there.
"""

import itertools
import math
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np

from pneutouch.arrays import Array, Flags, Indices
from pneutouch.shape.meridian import Arc, Meridian, Point, Segment

_AXIS_TOLERANCE = 1e-9
"""Radius (mm) below which a vertex is a pole that rounding moved off the axis."""


@dataclass(frozen=True, slots=True)
class MeridianVertex:
    """A vertex of a sampled meridian, mm; revolved it is a circle (ring). ``lean``: radial part of the normal, 0 to 1.

    A ring where the normal is nearly along the axis can have fewer vertices at the same error of the surface.
    """

    radius: float
    height: float
    lean: float


def chords(arc: Arc, error: float) -> int:
    """Number of chords, placed to preserve the area under ``arc``, that keeps it within ``error`` mm."""
    sagitta = min(1.5 * error, arc.radius)
    widest = 2 * math.acos(1 - sagitta / arc.radius)
    turn = abs(arc.last - arc.first)
    # The two end chords have one end on the arc; they span 1/sqrt(2) of the others (same mean error).
    return max(2, math.ceil(turn / widest + 2 - math.sqrt(2)))


def sample(meridian: Meridian, error: float) -> list[MeridianVertex]:
    """Vertices of a meridian with arcs kept within ``error`` mm; the first is not repeated at the end."""
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
    """Corners (x, y) of a closed outline, with arcs kept within ``error`` mm and the area preserved."""
    corners: list[Point] = []
    for piece in outline:
        corners.append(piece.start)
        if isinstance(piece, Arc):
            corners += [(ring.radius, ring.height) for ring in _inner_rings(piece, chords(piece, error))]
    return corners


def circle_count(radius: float, error: float, lean: float = 1.0) -> int:
    """Number of vertices of a ring: a multiple of 4 that keeps it within ``error`` mm of its circle; 1 on the axis."""
    if radius <= 0:
        return 1
    # widen() moves a vertex outwards by r theta^2/12 to leading order; theta is the angle between vertices.
    needed = 2 * math.pi * math.sqrt(radius * lean / (12 * error))
    count = max(8, 4 * math.ceil(needed / 4))
    while radius * lean * (widen(count) - 1) > error:
        count += 4
    return count


def widen(count: int) -> float:
    """Factor on the radius that gives a regular polygon of ``count`` vertices the area of its circle; 1 for 1."""
    if count == 1:
        return 1.0
    angle = 2 * math.pi / count
    return math.sqrt(angle / math.sin(angle))


@dataclass(frozen=True)
class RevolvedRings:
    """Mesh of a revolved meridian, still in strips between neighbouring rings.

    Ring k has ``counts[k]`` of the ``vertices`` (n, 3), from ``starts[k]`` on. ``pairs`` are the two rings of each
    strip, in the order of the meridian, and ``strips`` its triangles (m, 3).
    """

    rings: list[MeridianVertex]
    counts: list[int]
    starts: list[int]
    vertices: Array
    pairs: list[tuple[int, int]]
    strips: list[Indices]


def revolve_rings(meridian: Meridian, tolerance: float) -> RevolvedRings:
    """Mesh of a solid of revolution within ``tolerance`` mm, in strips between neighbouring rings.

    Half of ``tolerance`` is used for the chords of the meridian and half for those of the circles.
    """
    error = 0.5 * tolerance
    rings = sample(meridian, error)
    counts = [circle_count(ring.radius, error, ring.lean) for ring in rings]
    starts = [0, *itertools.accumulate(counts)][:-1]
    levels = [
        np.column_stack([circle_points(r.radius, n), np.full(n, r.height)]) for r, n in zip(rings, counts, strict=True)
    ]
    vertices = np.concatenate(levels)
    pairs = [(k, k + 1) for k in range(len(rings) - 1)]
    if meridian.is_ring:
        pairs.append((len(rings) - 1, 0))
    strips = []
    for a, b in pairs:
        # Always zip from the smaller ring, so that a face is the same for both directions.
        swap = (rings[a].radius, rings[a].height) > (rings[b].radius, rings[b].height)
        one, other = (b, a) if swap else (a, b)
        strip = _zip(starts[one], counts[one], starts[other], counts[other])
        strips.append(strip[:, ::-1] if swap else strip)
    return RevolvedRings(rings, counts, starts, vertices, pairs, strips)


def revolve(meridian: Meridian, tolerance: float) -> tuple[Array, Indices]:
    """Mesh a solid of revolution within ``tolerance`` mm: vertices (n, 3) in mm, triangles (m, 3) facing outwards."""
    made = revolve_rings(meridian, tolerance)
    return made.vertices, np.concatenate(made.strips)


def circle_points(radius: float, count: int) -> Array:
    """Corners (count, 2) of the regular polygon that stands for a circle around the origin, see `widen`."""
    angle = 2 * np.pi * np.arange(count) / count
    return radius * widen(count) * np.column_stack([np.cos(angle), np.sin(angle)])


def _zip(first: int, n: int, second: int, m: int) -> Indices:
    """Triangles (k, 3) between two rings: ``n`` vertices from number ``first`` on and ``m`` from ``second`` on.

    Walks along both rings at once; each step is on the ring whose next vertex has the smaller angle.
    """
    steps = np.concatenate([np.arange(1, n + 1) / n, np.arange(1, m + 1) / m])
    on_first = np.concatenate([np.ones(n, bool), np.zeros(m, bool)])
    order = np.argsort(steps, kind="stable")
    on_first = on_first[order]
    i = np.cumsum(on_first) - on_first
    j = np.cumsum(~on_first) - ~on_first
    a, b = first + i % n, second + j % m
    ahead = np.where(on_first, first + (i + 1) % n, second + (j + 1) % m)
    triangles = np.column_stack([a, ahead, b])
    # A ring of one vertex lies on the axis; steps along it would give triangles of zero area.
    return triangles[~on_first if n == 1 else on_first if m == 1 else slice(None)]


Vector = tuple[float, float, float]
X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


@dataclass(frozen=True, slots=True)
class Frame:
    """Coordinates of a shape: ``origin`` (mm) and unit vectors ``axis`` (z) and ``across`` (x), orthogonal."""

    origin: Vector = (0.0, 0.0, 0.0)
    axis: Vector = Z
    across: Vector = X

    @property
    def rotation(self) -> Array:
        """Matrix (3, 3) whose columns are the frame's x, y and z axes in coordinates of the solid."""
        x, z = np.array(self.across), np.array(self.axis)
        return np.column_stack([x, np.cross(z, x), z])

    def out(self, points: Array) -> Array:
        """Points (n, 3), mm, from coordinates of this frame into those of the solid."""
        return np.asarray(points @ self.rotation.T + np.array(self.origin))

    def into(self, points: Array) -> Array:
        """Points (n, 3), mm, from coordinates of the solid into those of this frame."""
        return np.asarray((points - np.array(self.origin)) @ self.rotation)


class Shape(Protocol):
    """Interface of the shapes that make up a solid; lengths in mm."""

    def volume(self) -> float:
        """Exact volume, mm3."""

    def mesh(self, tolerance: float) -> tuple[Array, Indices]:
        """Vertices (n, 3) and triangles (m, 3) of a closed mesh within ``tolerance``."""

    def distance(self, points: Array) -> Array:
        """Distances (n,) of points (n, 3) from the surface."""


@dataclass(frozen=True, slots=True)
class Turned:
    """A meridian revolved about the axis of a frame."""

    meridian: Meridian
    frame: Frame = Frame()

    def volume(self) -> float:
        """Exact volume, mm3."""
        return self.meridian.volume()

    def mesh(self, tolerance: float) -> tuple[Array, Indices]:
        """Vertices (n, 3), mm, and triangles (m, 3) of a closed mesh within ``tolerance`` mm."""
        vertices, triangles = revolve(self.meridian, tolerance)
        return (vertices if self.frame == Frame() else self.frame.out(vertices)), triangles

    def distance(self, points: Array) -> Array:
        """Distances (n,) of points (n, 3) from the surface, mm."""
        return self.meridian.distance(points if self.frame == Frame() else self.frame.into(points))


@dataclass(frozen=True, slots=True)
class Prism:
    """A closed outline in the plane of a frame, counter-clockwise, extruded from ``low`` to ``high`` along its axis."""

    outline: tuple[Segment, ...]
    low: float
    high: float
    frame: Frame = Frame()

    def area(self) -> float:
        """Exact area of the outline, mm2 (Green's theorem: the integral of x dy)."""
        return sum(_under(piece) for piece in self.outline)

    def volume(self) -> float:
        """Exact volume, mm3."""
        return self.area() * (self.high - self.low)

    def mesh(self, tolerance: float) -> tuple[Array, Indices]:
        """Vertices (n, 3), mm, and triangles (m, 3) of a closed mesh within ``tolerance`` mm."""
        from manifold3d import CrossSection

        raised = CrossSection([polygon(self.outline, tolerance)]).extrude(self.high - self.low).to_mesh64()
        vertices = np.array(raised.vert_properties[:, :3], order="C") + np.array([0.0, 0.0, self.low])
        return self.frame.out(vertices), raised.tri_verts.astype(np.int64)

    def distance(self, points: Array) -> Array:
        """Distances (n,) of points (n, 3) from the surface, mm."""
        local = self.frame.into(points)
        plane, height = local[:, :2], local[:, 2]
        across: Array = np.min([piece.distance(plane) for piece in self.outline], axis=0)
        axial = np.maximum(np.maximum(self.low - height, height - self.high), 0.0)
        to_face = np.minimum(np.abs(height - self.low), np.abs(height - self.high))
        inside = _inside(plane, polygon(self.outline, 1e-4))
        return np.asarray(np.minimum(np.hypot(across, axial), np.where(inside, to_face, np.hypot(across, to_face))))


@dataclass(frozen=True, slots=True)
class Bore:
    """A round hole along z, mm: centre (x, y), radius, ends ``low`` and ``high``; ``closed``: the end with a bottom."""

    x: float
    y: float
    radius: float
    low: float
    high: float
    closed: Literal["", "low", "high"] = ""

    def volume(self) -> float:
        """Exact volume between the two ends, mm3."""
        return math.pi * self.radius**2 * (self.high - self.low)

    def mesh(self, tolerance: float) -> tuple[Array, Indices]:
        """Vertices (n, 3) and triangles (m, 3) of the drill: 1 mm longer at open ends, so that no faces coincide."""
        count = circle_count(self.radius, tolerance)
        ring = circle_points(self.radius, count) + np.array([self.x, self.y])
        low = self.low if self.closed == "low" else self.low - 1.0
        high = self.high if self.closed == "high" else self.high + 1.0
        vertices = np.concatenate([np.column_stack([ring, np.full(count, z)]) for z in (low, high)])
        k = np.arange(count)
        after = (k + 1) % count
        fan = np.column_stack([np.zeros(count - 2, int), k[1:-1], k[2:]])
        sides = [np.column_stack([k, after, k + count]), np.column_stack([after, after + count, k + count])]
        return vertices, np.concatenate([*sides, fan[:, ::-1], fan + count])

    def distance(self, points: Array) -> Array:
        """Distances (n,) of points (n, 3), mm, from the wall of the bore or its bottom, whichever is nearer."""
        radial = np.hypot(points[:, 0] - self.x, points[:, 1] - self.y) - self.radius
        axial = np.maximum(np.maximum(self.low - points[:, 2], points[:, 2] - self.high), 0.0)
        wall: Array = np.hypot(radial, axial)
        if not self.closed:
            return wall
        floor = self.low if self.closed == "low" else self.high
        bottom: Array = np.hypot(np.maximum(radial, 0.0), points[:, 2] - floor)
        return np.minimum(wall, bottom)


@dataclass(frozen=True, slots=True)
class Feature:
    """A shape added to or cut from a solid, and the volume ``net`` (mm3) that this adds or removes: without overlap."""

    shape: Shape
    net: float


def _under(piece: Segment) -> float:
    if isinstance(piece, Arc):

        def primitive(angle: float) -> float:
            across = 0.5 * angle + 0.25 * math.sin(2 * angle)
            return piece.centre[0] * piece.radius * math.sin(angle) + piece.radius**2 * across

        return primitive(piece.last) - primitive(piece.first)
    (x0, y0), (x1, y1) = piece.start, piece.end
    return 0.5 * (x0 + x1) * (y1 - y0)


def _inside(points: Array, outline: list[Point]) -> Flags:
    """Mask (n,) of the points (n, 2) inside a polygon, by crossings of a ray."""
    odd = np.zeros(len(points), bool)
    x, y = points.T
    for (x0, y0), (x1, y1) in zip(outline, [*outline[1:], outline[0]], strict=True):
        if y0 != y1:
            odd ^= ((y0 > y) != (y1 > y)) & (x < x0 + (y - y0) * (x1 - x0) / (y1 - y0))
    return odd
