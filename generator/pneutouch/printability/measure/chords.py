"""Thicknesses and clearances: lines from face to opposite face, and the size of the feature that they cross.

From points all over the surface a line is cast along the normal, into the body and out of it. Where it ends on a face
that looks back, within 30 degrees, its length is a thickness of the body or a width of the air. Lines across the middle
then show whether the place is thin in one direction (a wall, a gap) or in two (a pin, a hole), and lines along the
flank how high the flank is (a ridge or a groove on a face).
"""

from dataclasses import dataclass, fields, replace
from typing import Any, Literal, cast

import numpy as np
from numpy.typing import NDArray

from pneutouch.arrays import Array, Flags, Indices
from pneutouch.printability.measure.surface import SurfaceMesh, SurfaceSamples

_SELF = 1e-7
"""A hit this near the middle of a line (mm) is on the surface on which its middle lies."""


@dataclass(frozen=True)
class Neighbours:
    """Nearest faces before and behind the middle of each line: distances (n, 2), mm, inf for none, and faces (n, 2), -1
    for none."""

    distances: Array
    faces: Indices


def neighbours(manifold: Any, middles: Array, directions: Array, reach: float) -> Neighbours:
    """Cast lines through ``middles`` (n, 3) along unit ``directions`` (n, 3), from ``reach`` mm before to as far past.

    ``manifold`` is a solid of manifold3d, whose hits come in order along the line.
    """
    cast = manifold.ray_cast
    count = len(middles)
    distances, faces = np.full((count, 2), np.inf), np.full((count, 2), -1, dtype=np.int64)
    margin = 0.5 * _SELF / reach
    low, high = 0.5 - margin, 0.5 + margin
    starts, ends = (middles - reach * directions).tolist(), (middles + reach * directions).tolist()
    for k in range(count):
        before = behind = None
        for hit in cast(starts[k], ends[k]):
            share = hit.distance
            if share < low:
                before = (share, hit.face_id)
            elif share > high:
                behind = (share, hit.face_id)
                break
        if before is not None:
            distances[k, 0], faces[k, 0] = before
        if behind is not None:
            distances[k, 1], faces[k, 1] = behind
    span = 2 * reach
    distances[:, 0] = np.where(faces[:, 0] >= 0, (0.5 - distances[:, 0]) * span, np.inf)
    distances[:, 1] = np.where(faces[:, 1] >= 0, (distances[:, 1] - 0.5) * span, np.inf)
    return Neighbours(distances, faces)


def first_hits(manifold: Any, starts: Array, directions: Array, reach: float) -> Neighbours:
    """The first hit of each ray from ``starts`` (n, 3), in column 1; column 0 is as for no hit."""
    cast = manifold.ray_cast
    count = len(starts)
    distances, faces = np.full((count, 2), np.inf), np.full((count, 2), -1, dtype=np.int64)
    begins, ends = starts.tolist(), (starts + reach * directions).tolist()
    for k in range(count):
        for hit in cast(begins[k], ends[k]):
            distances[k, 1], faces[k, 1] = hit.distance * reach, hit.face_id
            break
    return Neighbours(distances, faces)


Side = Literal["inside", "outside"]

_OPPOSING = -np.cos(np.radians(30.0))
_ACROSS = -0.6
"""Greatest cosine between the normals at both ends of a line that counts as across: faces of a corner do not."""
_LINES = 6
"""Lines across the middle, 30 degrees apart: one is within 15 of the narrow direction, which it overstates by 3.5 %."""
FLANK = 1.0
"""A flank lower than this (mm) belongs to a ridge or groove on a face (own, unverified)."""
_SQUARE = 0.8
"""Least cosine between a flank's direction and the normals of the faces that end it; else they do not count."""


@dataclass(frozen=True)
class Chords:
    """Lines of one side from ``start`` (n, 3) along unit ``direction`` (n, 3) over ``length`` (n,), mm.

    ``near`` and ``far`` are the faces at both ends, ``area`` the surface each start stands for, mm2. After `described`,
    ``second`` is the narrowest width across the middle, mm (inf if wide), between the faces ``sides`` (n, 2), ``axis``
    the direction along the place, ``flank`` the height of the flank, mm (inf where it is no flank).
    """

    start: Array
    direction: Array
    length: Array
    near: Indices
    far: Indices
    area: Array
    second: Array
    sides: Indices
    axis: Array
    flank: Array

    def __len__(self) -> int:
        return len(self.length)

    @property
    def middle(self) -> Array:
        """Middles of the lines, (n, 3), mm."""
        return self.start + 0.5 * self.length[:, None] * self.direction

    @property
    def end(self) -> Array:
        """Far ends, (n, 3), mm."""
        return self.start + self.length[:, None] * self.direction

    def take(self, rows: NDArray[Any]) -> "Chords":
        """Chords of the given rows."""
        return Chords(*(getattr(self, field.name)[rows] for field in fields(self)))


def chords(manifold: Any, surface: SurfaceMesh, samples: SurfaceSamples, reach: float) -> dict[Side, Chords]:
    """Chords up to ``reach`` mm long, inside the body and outside. ``surface`` is the manifold's own mesh."""
    # The smooth surface's normals: those of flat faces miss the axis of a round pin or hole.
    normals = surface.smooth_normals(samples.faces, samples.points)
    chords = neighbours(manifold, samples.points, -normals, reach)
    sides: dict[Side, Chords] = {}
    for side, column, sign in (("outside", 0, 1.0), ("inside", 1, -1.0)):
        length, far = chords.distances[:, column], chords.faces[:, column]
        facing = np.einsum("ij,ij->i", normals, surface.normals[far])
        rows = np.flatnonzero(np.isfinite(length) & (length <= reach) & (facing < _OPPOSING))
        wide = np.full(len(rows), np.inf)
        sides[cast(Side, side)] = Chords(
            start=samples.points[rows],
            direction=sign * normals[rows],
            length=length[rows],
            near=samples.faces[rows],
            far=far[rows],
            area=samples.areas[rows],
            second=wide,
            sides=np.zeros((len(rows), 2), np.int64),
            axis=np.zeros((len(rows), 3)),
            flank=wide,
        )
    return sides


def described(manifold: Any, surface: SurfaceMesh, chords: Chords) -> Chords:
    """The chords with ``second``, ``axis`` and, where it is at most `FLANK`, ``flank`` measured."""
    if not len(chords):
        return chords
    second, sides, axis, flank = chords.second, chords.sides, chords.axis, chords.flank.copy()
    u, v = _tangents(chords.direction)
    reach = max(2.1 * float(chords.length.max()), FLANK)
    for k in range(_LINES):
        angle = np.pi * k / _LINES
        line = np.cos(angle) * u + np.sin(angle) * v
        middle = _lines(manifold, surface, chords.middle, line, reach)
        across = middle.across
        narrower = across < second
        second = np.where(narrower, across, second)
        sides = np.where(narrower[:, None], middle.faces, sides)
        axis = np.where(narrower[:, None], np.cross(line, chords.direction), axis)
        # A flank is low where a face square to the line ends it within FLANK: elsewhere no second line can make it low.
        rows = np.flatnonzero(middle.square.min(axis=1) <= FLANK)
        if not len(rows):
            continue
        low = chords.take(rows)
        shift = np.minimum(0.02, 0.1 * low.length)
        # Just behind the face that the chord starts on: air behind a wall, body behind a gap.
        behind = _lines(manifold, surface, low.start - shift[:, None] * low.direction, line[rows], reach)
        for one, other in ((0, 1), (1, 0)):
            flank[rows] = np.minimum(flank[rows], behind.square[:, one] + middle.square[rows, other])
    return replace(chords, second=second, sides=sides, axis=axis, flank=flank)


@dataclass(frozen=True)
class _Line:
    """Width across (n,) where both ends face each other, and distance to the faces at both ends (n, 2) where they are
    about square to the line; inf elsewhere. The faces at both ends, (n, 2)."""

    across: Array
    square: Array
    faces: Indices


def _lines(manifold: Any, surface: SurfaceMesh, middles: Array, directions: Array, reach: float) -> _Line:
    hit = neighbours(manifold, middles, directions, reach)
    normals = surface.normals[hit.faces]
    facing = np.einsum("ij,ij->i", normals[:, 0], normals[:, 1])
    both = np.isfinite(hit.distances).all(axis=1)
    lean = np.where(hit.faces >= 0, np.abs(np.einsum("nkj,nj->nk", normals, directions)), 0.0)
    return _Line(
        np.where(both & (facing < _ACROSS), hit.distances.sum(axis=1), np.inf),
        np.where(lean > _SQUARE, np.where(hit.faces >= 0, hit.distances, 0.0) * lean, np.inf),
        hit.faces,
    )


def continues(manifold: Any, surface: SurfaceMesh, chords: Chords) -> Flags:
    """True if the place goes on along its axis, (n,): at both ends as narrow a width further on, or ended before that.

    A pin does, to its tip; a web between two holes widens at both ends.
    """
    if not len(chords):
        return np.zeros(0, bool)
    step = chords.length
    reach = 2.1 * float(step.max())
    free = neighbours(manifold, chords.middle, chords.axis, reach).distances
    cross = np.cross(chords.axis, chords.direction)
    result = np.ones(len(chords), bool)
    for column, sign in ((0, -1.0), (1, 1.0)):
        ahead = chords.middle + (sign * step)[:, None] * chords.axis
        widths = [
            neighbours(manifold, ahead, across, reach).distances.sum(axis=1) for across in (chords.direction, cross)
        ]
        narrow = (widths[0] <= 1.5 * step) & (widths[1] <= 1.5 * np.minimum(chords.second, reach))
        result &= (free[:, column] <= step) | narrow
    return result


def _tangents(directions: Array) -> tuple[Array, Array]:
    """Two unit vectors (n, 3) perpendicular to each direction and to each other."""
    least = np.abs(directions).argmin(axis=1)
    u = np.cross(directions, np.eye(3)[least])
    u /= np.linalg.norm(u, axis=1)[:, None]
    return u, np.cross(directions, u)


def refined(chords: Chords, distance: Any) -> Array:
    """Lengths (n,), mm, from exact surface to exact surface; ``distance`` is the method of the exact solid.

    An end moves along the chord, outwards, inwards or not at all, to where it is nearest to the exact surface. The mesh
    leaves a circle by its tolerance on both sides, so that a bore measured from flat to flat is that much too narrow.
    """
    length = chords.length.copy()
    for points, outwards in ((chords.start, -chords.direction), (chords.end, chords.direction)):
        off = distance(points)
        shifts = np.array([0.0, 1.0, -1.0])[:, None] * off
        left = np.array([distance(points + shift[:, None] * outwards) for shift in shifts])
        # What is left, where another face is nearer than the one meant, counts for the part.
        length = length + np.take_along_axis(shifts, left.argmin(axis=0)[None], axis=0)[0] + left.min(axis=0)
    return np.asarray(length)
