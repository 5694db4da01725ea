"""The meridian: a closed loop of pieces that sweeps a solid."""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from pneutouch.arrays import Array
from pneutouch.meridian.segments import Point, Segment

_CLOSED = 1e-9
"""Ends that should meet are computed from the same numbers: they may differ by rounding alone (mm)."""


@dataclass(frozen=True, slots=True)
class Meridian:
    """A loop of pieces, counter-clockwise in (r, z); it closes on itself or along the axis r = 0."""

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

    def swept(self, tag: str) -> float:
        """Volume between the axis and the faces with ``tag``, mm3, for either direction of the faces."""
        return abs(sum(piece.swept() for piece in self.tagged(tag)))

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
