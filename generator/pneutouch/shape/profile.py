"""A wall whose inner face is drawn by its user: points joined by lines, each rounded to its radius."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import ClassVar

import numpy as np

from pneutouch.arrays import Array
from pneutouch.shape.disc import FlatDome
from pneutouch.shape.even import LEAST_BEND, arc_to
from pneutouch.shape.meridian import Arc, Line, Point, Segment

_LEVEL = 1e-3
"""Greatest angle in rad between pieces that go on smoothly, and of the pole to level: that of hand-written numbers."""

_CLOSE = 1e-3
"""Length in mm by which roundings may miss or overlap each other: numbers of drawings are rounded."""

_ALONG = np.linspace(0.0, 1.0, 9)


@dataclass(frozen=True, slots=True)
class Profile(FlatDome):
    """A wall along the points ``profile``, (r, z, radius of rounding) from the rim to the pole, mm."""

    profile: tuple[tuple[float, float, float], ...]
    key, adjective = "profile", "free-form"
    usual: ClassVar = {"cavity_depth": 0.0}
    start: ClassVar = {"profile": [[1.0, 0.0, 0.0], [1.0, 0.45, 0.25], [0.62, 0.8, 1.0], [0.0, 0.8, 0.0]]}

    @property
    def line(self) -> tuple[Segment, ...]:
        """Lines and roundings, with the rim at the height 0."""
        pieces: list[Segment] = []
        here, cuts = self._point(0), self._cuts
        last = len(self.profile) - 1
        for k in range(1, last + 1):
            corner, cut = self._point(k), cuts[k]
            start = _towards(corner, self._point(k - 1), cut)
            if math.dist(here, start) > (_CLOSE if k < last else 0.0):
                pieces.append(Line(here, start, ""))
                here = start
            if cut > 0.0:
                ahead = self._point(k + 1)
                near = k + 1 == last and abs(math.dist(corner, ahead) - cut) <= _CLOSE
                end = ahead if near else _towards(corner, ahead, cut)
                # From its end back: the pole stays level, whatever the numbers were rounded to.
                pieces.append(arc_to(end, _direction(ahead, corner), here).reverse())
                here = end
        return tuple(pieces)

    @property
    def fault(self) -> tuple[str, str] | None:
        """The first reason why the points are no wall, with its place in mm."""
        why = next(self._faults(), None)
        return None if why is None else ("profile", why)

    def _point(self, k: int) -> Point:
        (r, z, _), (tip_r, tip_z, _) = self.profile[k], self.profile[-1]
        if k == len(self.profile) - 2 and abs(tip_z - z) <= _LEVEL * (r - tip_r):
            z = tip_z
        return r, z - self.profile[0][1]

    @property
    def _cuts(self) -> list[float]:
        """Length that the rounding of each point takes from the lines beside it."""
        inside = range(1, len(self.profile) - 1)
        cuts = [self.profile[k][2] * math.tan(0.5 * abs(self._turn(k))) for k in inside]
        return [0.0, *cuts, 0.0]

    def _turn(self, k: int) -> float:
        """Change of direction at a point between two others, rad, left turns positive."""
        before, here, after = (self._point(i) for i in (k - 1, k, k + 1))
        (ar, az), (br, bz) = _direction(before, here), _direction(here, after)
        return math.atan2(ar * bz - az * br, ar * br + az * bz)

    def _faults(self) -> Iterator[str]:
        points, radius = self.profile, self.inner_radius
        if abs(points[0][0] - radius) > 1e-6 or abs(points[-1][0]) > 1e-6:
            ends = f"from r = {points[0][0]:g} to r = {points[-1][0]:g}"
            yield f"the profile runs {ends}; it must run from {radius:g} mm to 0"
        if min(min(r, rounding) for r, _, rounding in points) < 0.0:
            yield "no radius may be negative"
        for k, (one, other) in enumerate(pairwise(points)):
            if math.dist(one[:2], other[:2]) < 1e-6:
                yield f"the points {k} and {k + 1} are one"
        first = _direction(self._point(0), self._point(1))
        if first[0] > _LEVEL:
            yield f"the wall leans outwards at its rim, from {self._place(self._point(0))}: begin upright or inwards"
        yield from self._corners()
        tip = _direction(self._point(len(points) - 2), self._point(len(points) - 1))
        if abs(math.atan2(tip[1], -tip[0])) > _LEVEL:
            yield f"the profile is not level on the axis, at z = {points[-1][1]:.4g} mm: its tip would be sharp"
        yield from self._crossings("inner", self.inner)
        behind = max(0.0, -min(piece.bounds()[2] for piece in self.line))
        if behind > self.cavity_depth + 1e-9 or self.inner_height <= self.floor:
            yield (
                f"the inner face lies up to {behind:.4g} mm behind its rim, and a cavity of {self.cavity_depth:g} mm "
                "leaves it no room: give membrane.cavity_depth_mm"
            )
        for piece in self.line:
            if isinstance(piece, Arc) and piece.last < piece.first and piece.radius <= LEAST_BEND * self.thickest:
                yield (
                    f"at {self._place(piece.middle)} the inner face bends with a radius of {piece.radius:.3g} mm, so "
                    f"that a wall of {self.thickest:g} mm overlaps itself; take at least {LEAST_BEND} times the wall"
                )
        yield from self._crossings("outer", self.outer)

    def _corners(self) -> Iterator[str]:
        """Points that need a rounding, and roundings without room."""
        cuts = self._cuts
        for k in range(1, len(self.profile) - 1):
            turn, place = abs(self._turn(k)), self._place(self._point(k))
            if turn > _LEVEL and self.profile[k][2] == 0.0:
                yield f"a corner of {math.degrees(turn):.3g} degrees at {place}: give it a radius, [r, z, radius]"
        for k, (one, other) in enumerate(pairwise(cuts)):
            length = math.dist(self._point(k), self._point(k + 1))
            if one + other > length + _CLOSE:
                yield (
                    f"between the points {k} and {k + 1}, {length:.4g} mm apart, the roundings need {one + other:.4g} "
                    "mm: take smaller radii"
                )

    def _crossings(self, name: str, face: tuple[Segment, ...]) -> Iterator[str]:
        crossing = _crossing(face)
        if crossing is not None:
            yield f"the {name} face crosses itself at {self._place(crossing)}"

    def _place(self, point: Point) -> str:
        """A point in words, in the coordinates of ``profile``."""
        return f"r = {point[0]:.4g}, z = {point[1] + self.profile[0][1]:.4g} mm"


def _direction(start: Point, end: Point) -> Point:
    length = math.dist(start, end)
    return (end[0] - start[0]) / length, (end[1] - start[1]) / length


def _towards(start: Point, end: Point, length: float) -> Point:
    """The point at a length from ``start`` in the direction of ``end``."""
    if length == 0.0:
        return start
    dr, dz = _direction(start, end)
    return start[0] + length * dr, start[1] + length * dz


def _crossing(face: tuple[Segment, ...]) -> Point | None:
    """A point (r, z) where a face crosses itself or the axis, in mm; None if it does not."""
    points = np.concatenate([piece.along(_ALONG)[:-1] for piece in face] + [np.array([face[-1].end])])
    if points[:-1, 0].min() < 0.0:
        r, z = points[np.argmin(points[:, 0])].tolist()
        return r, z
    start, step = points[:-1], np.diff(points, axis=0)
    apart = start[None, :] - start[:, None]
    cross = _area(step[:, None], step[None, :])
    with np.errstate(divide="ignore", invalid="ignore"):
        along, across = _area(apart, step[None, :]) / cross, _area(apart, step[:, None]) / cross
    met = (along > 0.0) & (along < 1.0) & (across > 0.0) & (across < 1.0)
    # Neighbours share a point, which rounding may take for a crossing.
    met &= np.abs(np.subtract.outer(np.arange(len(step)), np.arange(len(step)))) > 1
    if not met.any():
        return None
    i, j = np.argwhere(met)[0].tolist()
    r, z = (start[i] + along[i, j] * step[i]).tolist()
    return r, z


def _area(a: Array, b: Array) -> Array:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
