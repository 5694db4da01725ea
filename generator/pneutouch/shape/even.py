"""Domes of one wall thickness: the outer face is parallel to the inner one, so lines stay lines and arcs arcs."""

import math
from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from pneutouch.arrays import Array
from pneutouch.shape.dome import INNER_WALL, OUTER_WALL, DomeShape
from pneutouch.shape.meridian import Arc, Line, Point, Segment

_STRAIGHT = 1e-12
"""Bow of an arc over its chord below which it is a line."""

FIT = 5e-4
"""Greatest distance in mm of arcs from the curve that they are fitted to: half of what is promised."""


@dataclass(frozen=True, slots=True)
class EvenDome(DomeShape):
    """A dome of one thickness over a smooth inner face, which ends level on the axis; it is clamped across its wall.

    Where the wall leans at its rim, the inner face begins below the base plane, by the height of the leaning edge.
    """

    @property
    @abstractmethod
    def line(self) -> tuple[Segment, ...]:
        """Pieces of the inner face from (`inner_radius`, 0) to the pole, each going on in the direction before."""

    @property
    def inner(self) -> tuple[Segment, ...]:
        """The inner face, with the outer rim in the base plane."""
        return self._face(0.0, INNER_WALL)

    @property
    def outer(self) -> tuple[Segment, ...]:
        """The face parallel to the inner one."""
        return self._face(self.wall_thickness, OUTER_WALL)

    def _face(self, outwards: float, tag: str) -> tuple[Segment, ...]:
        line = self.line
        lean = float(line[0].normals(np.zeros(1))[0, 1])
        down = -self.wall_thickness * lean if lean > _STRAIGHT else 0.0
        return tuple(piece.moved(outwards, down, tag) for piece in line)


def arc_to(start: Point, direction: Point, end: Point, tag: str = "") -> Segment:
    """The arc that leaves ``start`` in a unit ``direction`` and ends at ``end``; a line if that lies straight ahead."""
    (dr, dz), chord = direction, (end[0] - start[0], end[1] - start[1])
    aside, square = chord[1] * dr - chord[0] * dz, chord[0] ** 2 + chord[1] ** 2
    if abs(aside) <= _STRAIGHT * math.sqrt(square):
        return Line(start, end, tag)
    radius = square / (2 * aside)  # positive to the left of the direction
    centre = start[0] - radius * dz, start[1] + radius * dr
    first = math.atan2(start[1] - centre[1], start[0] - centre[0])
    turn = 2 * math.atan2(aside, chord[0] * dr + chord[1] * dz)
    return Arc(centre, abs(radius), first, first + turn, tag)


def biarc(start: Point, leaving: Point, end: Point, arriving: Point) -> tuple[Segment, Segment]:
    """Two arcs that meet smoothly, from ``start`` to ``end`` with unit directions at both; the arms are equal."""
    p, q, t, u = (np.array(each) for each in (start, end, leaving, arriving))
    v, bend = q - p, 2.0 * (1.0 - float(t @ u))
    along, square = float(v @ (t + u)), float(v @ v)
    # The root of bend d^2 + 2 along d - square, written so that it holds for parallel directions too.
    arm = square / (along + math.sqrt(along**2 + bend * square))
    r, z = (0.5 * (p + q + arm * (t - u))).tolist()
    return arc_to(start, leaving, (r, z)), arc_to(end, (-arriving[0], -arriving[1]), (r, z)).reverse()


def fitted(curve: Callable[[Array], tuple[Array, Array]], tolerance: float = FIT) -> tuple[Segment, ...]:
    """Arcs within ``tolerance`` (mm) of a smooth curve: points (n, 2) and directions (n, 2) at parameters 0 to 1."""
    for spans in (2 ** np.arange(1, 8)).tolist():
        points, directions = curve(np.linspace(0.0, 1.0, spans + 1))
        units = (directions / np.linalg.norm(directions, axis=1)[:, None]).tolist()
        ends = list(zip(points.tolist(), units, strict=True))
        pieces = [piece for (p, t), (q, u) in pairwise(ends) for piece in biarc(tuple(p), tuple(t), tuple(q), tuple(u))]
        checked = curve(np.linspace(0.0, 1.0, 16 * spans + 1))[0]
        if np.min([piece.distance(checked) for piece in pieces], axis=0).max() <= tolerance:
            break
    return tuple(pieces)
