"""Thin places of a part by kind: walls, pins, holes, channels, gaps, ridges and grooves, each as one place.

A place is a set of smooth face groups that chords join. Several features whose faces fillets merge are one place,
described by its narrowest.
"""

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, Literal

import numpy as np

from pneutouch.arrays import Array, Flags, Indices, distinct
from pneutouch.printability.measure.chords import FLANK, Chords, Side, continues, described
from pneutouch.printability.measure.joined import components
from pneutouch.printability.measure.surface import SurfaceMesh
from pneutouch.printability.subject import Point3

FeatureKind = Literal["wall", "pin", "hole", "channel", "gap", "raised", "engraved"]

OPENINGS: tuple[FeatureKind, ...] = ("hole", "channel", "gap", "engraved")
"""Kinds that are empty space, not material."""

ROUND = 2.0
"""An opening at most this many times as wide in one direction as in the other is a hole, else a gap."""

STOUT = 1.4
"""A bar at most this many times as thick in one direction as in the other is a pin, else a wall."""

LONG = 3.0
"""A hole longer than this many widths is a channel."""

_KNIFE = np.radians(30.0)
"""Angle, radians, below which faces that meet leave chords down to nothing: there the edge is reported instead."""

BLUNT = 0.5
"""Distance (mm) from its thin end at which a taper's thickness is measured: a shorter one is a blunt edge, not a wall
(our choice, unverified)."""

_BENT = 1.25
"""Ratio of a feature's length by its area to that by its extent, above which it counts as bent; a hole that is not
round reaches up to a quarter more."""

_ALONG = np.radians(2.0)
"""Faces that part by less run along each other, within the accuracy of interpolated normals."""

_PER_GROUP = 48
"""Number of chords of a face group that are examined, from the shortest on and then evenly."""


@dataclass(frozen=True)
class ThinPlace:
    """One thin place: ``size`` at its narrowest, mm, at ``where``; ``length`` along it (mm) for pins and holes, else 0.

    ``turn`` is the greatest turn (radians) between two faces of the curves around it. Of a taper ``size`` is measured
    `BLUNT` from its thin end, where its thickness is ``end``; None for places of other kinds.
    """

    kind: FeatureKind
    size: float
    where: Point3
    length: float
    turn: float = 0.0
    end: float | None = None


def thin_places(
    manifold: Any, surface: SurfaceMesh, sides: dict[Side, Chords], limits: dict[Side, float], exact: Any = None
) -> list[ThinPlace]:
    """Places with a chord up to a side's limit, mm, narrowest first. ``exact`` turns chords into exact lengths."""
    places = []
    for side, chords in sides.items():
        short = chords.take(chords.length <= limits[side])
        short = short.take(np.logical_not(_in_wedge(surface, short, side)))
        short = described(manifold, surface, _thinned(short, surface.groups))
        if not len(short):
            continue
        flat, round_ = short.flank <= FLANK, _is_round(manifold, surface, short, side)
        lengths = short.length if exact is None else exact(short)
        tapered = lengths + BLUNT * _slope(surface, short)
        for rows in _connected(short, surface.groups, round_):
            sized = _Sized(short.take(rows), lengths[rows], tapered[rows], flat[rows], round_[rows])
            around = distinct(surface.groups[short.near[rows]])
            turn = float(surface.group_turns[around].max())
            places.append(replace(_place(side, sized, len(around)), turn=turn))
    return sorted(places, key=lambda place: place.size)


def _is_round(manifold: Any, surface: SurfaceMesh, short: Chords, side: Side) -> Flags:
    """True for chords across pins (inside) or holes (outside), (n,)."""
    if side == "outside":
        return np.asarray(short.second <= ROUND * short.length)
    rows = np.flatnonzero(short.second <= STOUT * short.length)
    result = np.zeros(len(short), bool)
    result[rows] = continues(manifold, surface, short.take(rows))
    return result


def _slope(surface: SurfaceMesh, some: Chords) -> Array:
    """Rate at which each chord's faces part, mm per mm, (n,); 0 if they are parallel within the normals' accuracy."""
    near = surface.smooth_normals(some.near, some.start)
    far = surface.smooth_normals(some.far, some.start + some.length[:, None] * some.direction)
    angle = np.arccos(np.clip(-np.einsum("ij,ij->i", near, far), -1, 1))
    return np.where(angle > _ALONG, np.tan(np.minimum(angle, _KNIFE)), 0.0)


@dataclass(frozen=True)
class _Sized:
    """Chords of one place: their lengths, those with the taper, and True for the ones at a flank, or round."""

    chords: Chords
    lengths: Array
    tapered: Array
    flat: Flags
    round: Flags


def _place(side: Side, some: _Sized, faces: int) -> ThinPlace:
    """The place of some chords: raised or engraved if most are at flanks, else the kind of its narrowest chords.

    ``faces`` is the number of face groups around it.
    """
    if some.flat.mean() > 0.5:
        sizes = np.where(some.flat, np.minimum(some.lengths, some.chords.flank), np.inf)
        first = int(sizes.argmin())
        return ThinPlace("raised" if side == "inside" else "engraved", float(sizes[first]), _spot(some, first), 0.0)
    first = int(some.lengths.argmin())
    size, where = float(some.lengths[first]), _spot(some, first)
    narrow = some.round & (some.lengths <= 1.1 * size)
    if not narrow.any():
        first = int(some.tapered.argmin())
        kind: FeatureKind = "wall" if side == "inside" else "gap"
        return ThinPlace(kind, float(some.tapered[first]), _spot(some, first), 0.0, end=float(some.lengths[first]))
    along = _length(some, int(np.flatnonzero(narrow)[0]), faces)
    if side == "inside":
        return ThinPlace("pin", size, where, along)
    return ThinPlace("channel" if along > LONG * size else "hole", size, where, along)


def _length(some: _Sized, row: int, faces: int) -> float:
    """Length along a pin or hole, mm: its extent along its axis, or by its area where it is bent."""
    ordered = np.sort(some.lengths[some.round])
    # numpy.median loads the masked arrays, a tenth of NumPy's import.
    median = 0.5 * float(ordered[(len(ordered) - 1) // 2] + ordered[len(ordered) // 2])
    middles, around = some.chords.middle, median * (np.pi if faces == 1 else 4.0)
    extent = float(np.ptp((middles - middles.mean(axis=0)) @ some.chords.axis[row]))
    bent = float(some.chords.area[some.round].sum()) / around
    return bent if bent > _BENT * extent else extent


def _spot(some: _Sized, row: int) -> Point3:
    x, y, z = (float(value) for value in some.chords.middle[row])
    return x, y, z


def _thinned(chords: Chords, groups: Indices) -> Chords:
    """At most `_PER_GROUP` chords of each face group; the kept ones stand for the area of all."""
    group = groups[chords.near]
    order = np.lexsort((chords.length, group))
    group = group[order]
    first = np.concatenate([[0], np.flatnonzero(np.diff(group)) + 1, [len(group)]])
    kept, scale = [], []
    for low, high in pairwise(first.tolist()):
        count = high - low
        if not count:
            continue
        share = max(1.0, count / _PER_GROUP)
        rows = order[low + distinct((np.arange(0, count, share)).astype(np.int64))]
        kept.append(rows)
        scale.append(np.full(len(rows), chords.area[order[low:high]].sum() / max(chords.area[rows].sum(), 1e-12)))
    if not kept:
        return chords
    rows = np.concatenate(kept)
    some = chords.take(rows)
    return replace(some, area=some.area * np.concatenate(scale))


def _connected(some: Chords, groups: Indices, round_: Flags) -> list[Indices]:
    """Rows of the chords of each place: chords join the face groups at their ends and, if round, at their sides."""
    near = groups[some.near]
    one = np.concatenate([near, *[near[round_]] * 2])
    other = groups[np.concatenate([some.far, *some.sides[round_].T])]
    label = components(int(groups.max()) + 1, one, other)[near]
    return [np.flatnonzero(label == number) for number in distinct(label)]


def _in_wedge(surface: SurfaceMesh, chords: Chords, side: Side) -> Flags:
    """True for chords in the corner between two faces that meet at less than 30 degrees, (n,)."""
    edges = surface.edges
    turn = edges.turn if side == "inside" else -edges.turn
    sharp = turn > np.pi - _KNIFE
    facing = np.einsum("ij,ij->i", surface.normals[chords.near], surface.normals[chords.far])
    slack = np.zeros(len(chords), bool)
    if not sharp.any():
        return slack
    ends = surface.vertices[edges.ends[sharp]]
    angle = np.maximum(np.pi - np.arccos(np.clip(facing, -1, 1)), 1e-6)
    slanted = np.flatnonzero(angle > np.radians(1.0))
    if not len(slanted):
        return slack
    away = distance_to_segments(chords.middle[slanted], ends[:, 0], ends[:, 1])
    slack[slanted] = away < 1.2 * chords.length[slanted] / angle[slanted]
    return slack


def distance_to_segments(points: Array, starts: Array, ends: Array) -> Array:
    """Distances (n,) of (n, 3) points from the nearest of m segments."""
    along = ends - starts
    square = np.maximum(np.einsum("mk,mk->m", along, along), 1e-30)
    nearest = np.full(len(points), np.inf)
    for k in range(len(starts)):
        offset = points - starts[k]
        share = np.clip(offset @ along[k] / square[k], 0, 1)
        nearest = np.minimum(nearest, np.linalg.norm(offset - share[:, None] * along[k], axis=1))
    return nearest
