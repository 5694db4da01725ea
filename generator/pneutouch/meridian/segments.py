"""Exact pieces of a meridian: straight lines and circular arcs in the (r, z) plane, lengths in mm."""

import math
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array

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
        share = np.clip((points - start) @ along / (along @ along), 0.0, 1.0)
        gap: Array = np.linalg.norm(points - start - share[:, None] * along, axis=1)
        return gap

    def bounds(self) -> tuple[float, float, float, float]:
        """Smallest and largest r, then z."""
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
        """The point at an angle, on the arc or at another radius about its centre."""
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
        """Smallest and largest r, then z."""
        low, high = sorted((self.first, self.last))
        quarters = range(math.ceil(low / (math.pi / 2)), math.floor(high / (math.pi / 2)) + 1)
        points = [self.start, self.end, *(self.at(k * math.pi / 2) for k in quarters)]
        radii, heights = zip(*points, strict=True)
        return min(radii), max(radii), min(heights), max(heights)


Segment = Line | Arc
