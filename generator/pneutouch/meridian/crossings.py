"""Inside and outside of a closed outline of arcs and lines, exactly: where a level crosses it.

A piece counts at its lower end and not at its upper one, and a point on a crossing lies beyond it. Two outlines that
share a piece therefore never both hold a point of it, and never both leave it out.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.meridian.segments import Arc, Line, Segment

_ON_AXIS = 1e-9
"""A crossing nearer to the axis than this (mm) is on it."""


@dataclass(frozen=True, slots=True)
class RisingPiece:
    """Part of an outline between two levels, mm, that every level between them crosses once."""

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
        # From the lower end for either direction of the piece: two bodies that share it get the same numbers.
        (r0, z0), (r1, z1) = sorted([(r0, z0), (r1, z1)], key=lambda point: point[1])
        return np.asarray(r0 + (level - z0) * ((r1 - r0) / (z1 - z0)))


def rises(outline: Sequence[Segment]) -> tuple[RisingPiece, ...]:
    """The rises of a closed outline; one that ends on the axis is closed along it."""
    if math.dist(outline[0].start, outline[-1].end) > _ON_AXIS:
        outline = [*outline, Line(outline[-1].end, outline[0].start, "axis")]
    starts = [piece.start[1] for piece in outline]
    pieces: list[RisingPiece] = []
    for k, piece in enumerate(outline):
        # Levels where pieces meet are taken from one of them, so that rounding opens no gap between them.
        for first, last, side in _monotone(piece, starts[k], starts[(k + 1) % len(starts)]):
            if first != last:
                pieces.append(RisingPiece(min(first, last), max(first, last), piece, side))
    return tuple(pieces)


def crossings(parts: Sequence[RisingPiece], level: float) -> list[float]:
    """First coordinates, in order and even in number, at which a level crosses the outline: in, out, in, out."""
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
    """Pieces from level to level, with the side of the centre on which each lies; an arc is cut where it turns."""
    if not isinstance(piece, Arc):
        return [(first, last, 1.0)]
    low, high = sorted((piece.first, piece.last))
    turns = range(math.floor(low / math.pi - 0.5) + 1, math.ceil(high / math.pi - 0.5))
    tops = [(k + 0.5) * math.pi for k in turns]
    angles = [piece.first, *(tops if piece.first < piece.last else reversed(tops)), piece.last]
    levels = [first, *(piece.centre[1] + piece.radius * math.sin(a) for a in angles[1:-1]), last]
    middles = [0.5 * (a + b) for a, b in pairwise(angles)]
    return [(levels[k], levels[k + 1], math.copysign(1.0, math.cos(m))) for k, m in enumerate(middles)]
