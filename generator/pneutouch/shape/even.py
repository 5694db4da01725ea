"""Domes over a smooth inner face. Of one wall the outer face is parallel, so that lines stay lines and arcs arcs; else
the wall varies along the arc. A fillet may lead the outer face into the flange."""

import math
from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import lru_cache
from itertools import pairwise

import numpy as np
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator
from scipy.optimize import brentq

from pneutouch.arrays import Array
from pneutouch.shape.dome import INNER_WALL, OUTER_WALL, DomeShape
from pneutouch.shape.meridian import Arc, Line, Point, Segment

_STEP = 1e-5
"""Step, over a piece, of the difference that gives the direction of a face."""

_FLAT = 0.99
"""Rise of a normal from which a wall is level."""

LEAST_BEND = 1.1
"""Least radius over the wall of a bend whose outer face is the shorter one: our choice, as cells there get no width."""

_STRAIGHT = 1e-12
"""Bow of an arc over its chord below which it is a line."""

FIT = 5e-4
"""Greatest distance in mm of arcs from the curve that they are fitted to: half of what is promised."""


@dataclass(frozen=True, slots=True)
class EvenDome(DomeShape):
    """A dome over a smooth inner face, which ends level on the axis; it is clamped across its wall.

    The wall has one thickness, or ``wall_thickness`` times the factors of ``wall_stations``, (share of the inner face's
    length, factor) from the pole at 0 to the rim at 1, on a monotone cubic that is level at the pole. Its outer face
    runs into the flange by an arc of the radius ``root_fillet``, mm; 0: with a sharp corner. Where the wall leans at
    its rim, the inner face begins below the base plane, by the height of the leaning edge.
    """

    wall_stations: tuple[tuple[float, float], ...] = field(default=(), kw_only=True)
    root_fillet: float = field(default=0.0, kw_only=True)

    @property
    @abstractmethod
    def line(self) -> tuple[Segment, ...]:
        """Pieces of the inner face from (`inner_radius`, 0) to the pole, each going on in the direction before."""

    @property
    def plain(self) -> DomeShape:
        """The shape without the fillet at its root."""
        return replace(self, root_fillet=0.0) if self.root_fillet else self

    @property
    def inner(self) -> tuple[Segment, ...]:
        """The inner face, with the outer rim in the base plane."""
        return _faces(self)[0]

    @property
    def outer(self) -> tuple[Segment, ...]:
        """The face at the wall's thickness from the inner one."""
        return _faces(self)[1]

    @property
    def stated_wall(self) -> str:
        """Thickness of the wall in words, at pole and rim where they differ."""
        if not self.wall_stations:
            return f"{self.wall_thickness:g} mm"
        pole, rim = (self.wall_thickness * factor for _, factor in (self.wall_stations[0], self.wall_stations[-1]))
        return f"{pole:.4g} mm (pole) to {rim:.4g} mm (rim)"

    @property
    def thickest(self) -> float:
        """Greatest thickness of the wall, mm."""
        return self.wall_thickness * max((factor for _, factor in self.wall_stations), default=1.0)

    @property
    def wall_fault(self) -> tuple[str, str] | None:
        """A wall that varies does not overlap itself, and a fillet has a corner and room."""
        if self.wall_stations and not _rising(self.wall_stations):
            return "wall_stations", "give two to five pairs [share, factor], from 0 to 1, with factors from 0.2 to 5"
        if self.wall_stations and self.thickest >= self.inner_radius:
            return "wall_stations", f"{self.thickest:.3g} mm of wall; it must be less than the inner radius"
        bends = [piece.radius for piece in self.line if isinstance(piece, Arc) and piece.last < piece.first]
        if self.wall_stations and min(bends, default=math.inf) <= LEAST_BEND * self.thickest:
            tight = f"the inner face bends with a radius of {min(bends):.3g} mm"
            return "wall_stations", f"{tight}, so that a wall of {self.thickest:.3g} mm overlaps itself"
        foot = self.walls()[1]
        if self.root_fillet and float(self.line[0].normals(np.zeros(1))[0, 1]) > _FLAT:
            return "root_fillet", "the wall runs level into its flange: there is no corner"
        if self.root_fillet and not any(
            piece.moved(self.root_fillet, 0.0, "").end[1] > self.root_fillet for piece in foot
        ):
            return "root_fillet", f"it must be less than the dome's height, {foot[-1].end[1]:.4g} mm"
        return None

    def walls(self) -> tuple[tuple[Segment, ...], tuple[Segment, ...]]:
        """Inner and outer face of the wall without a fillet: parallel, or apart by the factors of the stations."""
        line = self.line
        lean = float(line[0].normals(np.zeros(1))[0, 1])
        edge = self.wall_thickness * (self.wall_stations[-1][1] if self.wall_stations else 1.0)
        down = -edge * lean if lean > _STRAIGHT else 0.0
        inner = tuple(piece.moved(0.0, down, INNER_WALL) for piece in line)
        if self.wall_stations:
            return _apart(inner, self.wall_thickness, self.wall_stations)
        return inner, tuple(piece.moved(self.wall_thickness, down, OUTER_WALL) for piece in line)


def _rising(stations: tuple[tuple[float, ...], ...]) -> bool:
    """True for pairs whose shares rise from 0 to 1, with factors from 0.2 to 5."""
    if len(stations) < 2 or any(len(pair) != 2 for pair in stations):
        return False
    shares, factors = [share for share, _ in stations], [factor for _, factor in stations]
    rising = shares[0] == 0.0 and shares[-1] == 1.0 and all(a < b for a, b in pairwise(shares))
    return rising and 0.2 <= min(factors) <= max(factors) <= 5.0


@lru_cache(maxsize=256)
def _faces(dome: EvenDome) -> tuple[tuple[Segment, ...], tuple[Segment, ...]]:
    inner, outer = dome.walls()
    return _filleted(inner, outer, dome.root_fillet) if dome.root_fillet else (inner, outer)


def _apart(
    inner: tuple[Segment, ...], wall: float, stations: tuple[tuple[float, float], ...]
) -> tuple[tuple[Segment, ...], tuple[Segment, ...]]:
    """The inner face in pieces opposite the arcs of an outer face at ``wall`` times the factors of the stations."""
    places, factors = np.array(stations).T
    slopes = PchipInterpolator(places, factors).derivative()(places)
    thickness = CubicHermiteSpline(places, wall * factors, wall * np.where(places == 0.0, 0.0, slopes))
    lengths = np.array([piece.length for piece in inner])
    ends = 1.0 - np.concatenate([[0.0], np.cumsum(lengths)]) / lengths.sum()
    pairs: list[tuple[Segment, Segment]] = []
    for piece, first, last in zip(inner, ends[:-1].tolist(), ends[1:].tolist(), strict=True):

        def place(share: Array, piece: Segment = piece, first: float = first, last: float = last) -> Array:
            away = thickness(first + share * (last - first))
            return np.asarray(piece.along(share) + piece.normals(share) * away[:, None])

        def curve(share: Array, place: Callable[[Array], Array] = place) -> tuple[Array, Array]:
            return place(share), (place(share + _STEP) - place(share - _STEP)) / (2 * _STEP)

        arcs = fitted(curve)
        stops = np.linspace(0.0, 1.0, len(arcs) + 1).tolist()
        pairs += [
            (_part(piece, *ends), replace(arc, tag=OUTER_WALL)) for arc, ends in zip(arcs, pairwise(stops), strict=True)
        ]
    return tuple(one for one, _ in pairs), tuple(other for _, other in pairs)


def _part(piece: Segment, first: float, last: float) -> Segment:
    """The piece between two shares of its length."""
    if isinstance(piece, Line):
        (r0, z0), (r1, z1) = piece.along(np.array([first, last])).tolist()
        return Line((r0, z0), (r1, z1), piece.tag)
    turn = piece.last - piece.first
    return replace(piece, first=piece.first + first * turn, last=piece.first + last * turn)


def _filleted(
    inner: tuple[Segment, ...], outer: tuple[Segment, ...], radius: float
) -> tuple[tuple[Segment, ...], tuple[Segment, ...]]:
    """Faces with an arc from the base plane to the outer face, in pieces opposite those of the inner one."""
    above = [piece.moved(radius, 0.0, "") for piece in outer]
    k = next(k for k, piece in enumerate(above) if piece.end[1] > radius)
    at = np.array([brentq(lambda share: above[k].along(np.array([share]))[0, 1] - radius, 0.0, 1.0)])
    (r, _), (nr, nz) = above[k].along(at)[0].tolist(), outer[k].normals(at)[0].tolist()
    angle, share = math.atan2(-nz, -nr), float(at[0])
    arc = Arc((r, radius), radius, -0.5 * math.pi, angle - (2 * math.pi if angle > 0.0 else 0.0), OUTER_WALL)
    beside = (*inner[:k], _part(inner[k], 0.0, share))
    stops = np.cumsum([0.0, *(piece.length for piece in beside)])
    fillet = (_part(arc, *ends) for ends in pairwise((stops / stops[-1]).tolist()))
    return (*beside, _part(inner[k], share, 1.0), *inner[k + 1 :]), (
        *fillet,
        _part(outer[k], share, 1.0),
        *outer[k + 1 :],
    )


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
