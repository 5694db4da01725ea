"""Hollows that support has to come out of: the spaces behind a neck, and those that no straight jet reaches.

Parts are filled with cubes, which show spaces that rays alone do not, such as those behind a neck or under an overhang.
"""

from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneutouch.arrays import Array, Flags, Indices
from pneutouch.printability.measure.joined import distances, grown, largest_pieces, outside
from pneutouch.printability.subject import Point3

PITCH = 0.25
"""Edge of a cube, mm, for parts small enough (see `MOST`)."""

MOST = 300_000
"""Greatest number of cubes of a model; a larger part gets larger cubes."""

_OFF = (0.4142135623730951, 0.7320508075688772)
"""Shift of the columns in cubes: no column runs along an edge of a part drawn on whole hundredths."""


@dataclass(frozen=True)
class PartVoxels:
    """Number of the part that fills each cube, from 1, and 0 where none does, (i, j, k); one empty cube all around.

    ``pitch`` in mm, ``origin`` the centre of cube (0, 0, 0) in the build frame, whose z points up; ``frame`` (3, 3)
    turns the design frame into the build frame.
    """

    label: NDArray[np.int8]
    pitch: float
    origin: Array
    frame: Array

    @property
    def cube(self) -> float:
        """Volume of a cube, mm3."""
        return self.pitch**3

    def point(self, index: Indices | Array) -> tuple[float, float, float]:
        """Centre of a cube in the design frame, mm."""
        x, y, z = (self.origin + self.pitch * np.asarray(index)) @ self.frame
        return float(x), float(y), float(z)


def build_frame(up: Array) -> Array:
    """Rotation (3, 3) from the design frame to the build frame: ``up``, a unit vector, becomes z."""
    if up[2] > 1 - 1e-12:
        return np.eye(3)
    side = np.cross(up, np.eye(3)[int(np.abs(up).argmin())])
    side /= np.linalg.norm(side)
    return np.array([side, np.cross(up, side), up])


def fill(parts: list[Array], frame: Array, most: int = MOST) -> PartVoxels:
    """Parts, each by its triangles' corners (m, 3, 3) in the design frame, in cubes: those whose centres lie inside."""
    turned = [corners @ frame.T for corners in parts]
    low = np.min([corners.min(axis=(0, 1)) for corners in turned], axis=0)
    size = np.max([corners.max(axis=(0, 1)) for corners in turned], axis=0) - low
    pitch = max(PITCH, float(np.prod(size) / most) ** (1 / 3))
    shape = tuple(int(n) for n in np.ceil(size / pitch) + 3)
    origin = low - pitch * np.array([*_OFF, 0.5])
    label = np.zeros(shape, dtype=np.int8)
    for number, corners in enumerate(turned, start=1):
        np.copyto(label, number, where=_filled((corners - origin) / pitch, shape))
    return PartVoxels(label, pitch, origin, frame)


def _filled(corners: Array, shape: tuple[int, ...]) -> Flags:
    """Cubes, centres at whole numbers, that lie inside the triangles: crossings below each centre are counted."""
    a, b, c = np.moveaxis(corners, 1, 0)
    (ab_x, ab_y, ab_z), (ac_x, ac_y, ac_z) = (b - a).T, (c - a).T
    twice = ab_x * ac_y - ac_x * ab_y
    flat = corners[:, :, :2]
    low = np.ceil(flat.min(axis=1)).astype(np.int64)
    count = np.maximum(np.floor(flat.max(axis=1)).astype(np.int64) - low + 1, 0)
    number = np.where(twice != 0, count[:, 0] * count[:, 1], 0)
    face = np.repeat(np.arange(len(corners)), number)
    serial = np.arange(len(face)) - np.repeat(np.cumsum(number) - number, number)
    x, y = np.divmod(serial, count[face, 1])
    x, y = x + low[face, 0], y + low[face, 1]
    dx, dy = x - a[face, 0], y - a[face, 1]
    s = (dx * ac_y[face] - dy * ac_x[face]) / twice[face]
    t = (ab_x[face] * dy - ab_y[face] * dx) / twice[face]
    hit = np.flatnonzero((s >= 0) & (t >= 0) & (s + t <= 1))
    face, s, t = face[hit], s[hit], t[hit]
    height = a[face, 2] + s * ab_z[face] + t * ac_z[face]
    layer = np.clip(np.ceil(height).astype(np.int64), 0, shape[2] - 1)
    cell = np.ravel_multi_index((x[hit], y[hit], layer), shape)
    # Going up, a face that looks down is the entry.
    steps = np.bincount(cell, weights=-np.sign(twice[face]), minlength=int(np.prod(shape)))
    return np.cumsum(steps.astype(np.int8).reshape(shape), axis=2, dtype=np.int8) > 0


NARROW = 0.7
"""Share of a hollow's width below which its opening is a neck."""

_STEPS = 8
"""Number of opening widths tried at first; the width of each neck that is found is then narrowed down."""

_HALVINGS = 3

_BIAS = 0.25
"""Distance from the middle of the nearest full cube to the surface, in cubes: half a cube at a flat wall, else less."""

_TILTS = (-1.0, -0.5, 0.0, 0.5, 1.0)
"""Slopes of the lines of sight against the axis they mostly follow, in both directions across it: 98 in all."""


@dataclass(frozen=True)
class Pocket:
    """A hollow behind a neck: ``opening`` and ``width``, diameters of the largest balls in the neck and inside, mm;
    ``where``, centre of the inner ball; ``volume``, mm3; ``depth``, longest side, mm; ``region``, its cubes."""

    opening: float
    width: float
    volume: float
    depth: float
    where: Point3
    region: Flags

    @property
    def ratio(self) -> float:
        """Opening over width."""
        return self.opening / self.width


def pockets(voxels: PartVoxels, radius: Array, most: float = NARROW) -> list[Pocket]:
    """Hollows whose opening is at most the share ``most`` of their width.

    The space where a ball of a radius fits falls into pieces as the radius grows; a piece that does not reach the
    outside lies behind an opening narrower than that. ``radius`` is that of `balls`, good to half a cube.
    """
    reaching = outside(voxels.label == 0)
    pockets: list[Pocket] = []
    taken = np.zeros(radius.shape, bool)
    # Closed altogether, as far as the cubes resolve: an opening narrower than one of them.
    closed = (voxels.label == 0) & ~reaching
    if closed.any():
        for piece in largest_pieces(closed):
            pockets.append(_pocket(voxels, radius, piece, 0.5 * voxels.pitch))
            taken |= piece
    # The widest opening worth trying, mm: the share of the widest place away from the outside.
    enclosed = most * float(radius[1:-1, 1:-1, 1:-1].max())
    if enclosed <= voxels.pitch:
        return pockets
    levels = np.geomspace(voxels.pitch, enclosed, _STEPS)
    below = 0.5 * voxels.pitch
    for level in levels:
        space = radius >= level
        cut = space & ~outside(space) & ~taken
        for piece in largest_pieces(cut) if cut.any() else []:
            low = _narrowed(radius, piece, below, float(level))
            pocket = _pocket(voxels, radius, _grown(voxels, piece, float(level)), 2 * low)
            if pocket.ratio <= most:
                pockets.append(pocket)
            taken |= piece
        below = float(level)
    return pockets


def balls(voxels: PartVoxels) -> Array:
    """Radius of the largest ball around each empty cube that meets no full one, mm."""
    return np.maximum(distances(voxels.label == 0) - _BIAS, 0.0) * voxels.pitch


def _narrowed(radius: Array, piece: Flags, low: float, high: float) -> float:
    """Radius of the neck, mm, of a piece that is connected to the outside at ``low`` and cut off at ``high``."""
    seed = np.unravel_index(int(np.where(piece, radius, -1.0).argmax()), radius.shape)
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if outside(radius >= middle)[seed]:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


def _grown(voxels: PartVoxels, piece: Flags, by: float) -> Flags:
    """The piece with the empty cubes around it up to the distance ``by``, mm."""
    away = distances(~piece) * voxels.pitch
    return np.asarray((away <= by + 0.5 * voxels.pitch) & (voxels.label == 0))


def _pocket(voxels: PartVoxels, radius: Array, region: Flags, opening: float) -> Pocket:
    cells = np.argwhere(region)
    size = (np.ptp(cells, axis=0) + 1) * voxels.pitch
    width = max(2 * float(radius[region].max()), voxels.pitch)
    deepest = cells[int(radius[region].argmax())]
    volume = float(region.sum()) * voxels.cube
    return Pocket(min(opening, width), width, volume, float(size.max()), voxels.point(deepest), region)


def seen(voxels: PartVoxels) -> Flags:
    """Empty cubes that a straight jet reaches from outside, along one of 98 directions spread over the sphere."""
    empty = voxels.label == 0
    reached = np.zeros(empty.shape, bool)
    sights = list(product(range(3), (1, -1), product(_TILTS, _TILTS)))
    # Straight along the axes first: mostly they reach everything.
    for axis, step, tilt in sorted(sights, key=lambda sight: abs(sight[2][0]) + abs(sight[2][1])):
        _sweep(np.moveaxis(empty, axis, 0)[::step], np.moveaxis(reached, axis, 0)[::step], tilt)
        if np.array_equal(reached, empty):
            break
    return reached


def _sweep(empty: Flags, reached: Flags, tilt: tuple[float, float]) -> None:
    """Mark the cubes that parallel lines reach that enter through the border and stop at the first full cube."""
    lit = np.ones(empty.shape[1:], bool)
    shifts = np.rint(np.outer(np.arange(len(empty)), tilt)).astype(np.int64)
    before = np.zeros(2, dtype=np.int64)
    for layer in range(len(empty)):
        moved = _shifted(lit, shifts[layer] - before)
        before = shifts[layer]
        lit = moved & empty[layer]
        reached[layer] |= lit


def _shifted(lit: Flags, by: Any) -> Flags:
    """The lit cells of a layer moved by whole cubes; cells that enter from the side are lit."""
    if not by.any():
        return lit
    result = np.ones_like(lit)
    target = tuple(slice(max(int(b), 0), n + min(int(b), 0)) for b, n in zip(by, lit.shape, strict=True))
    origin = tuple(slice(max(-int(b), 0), n + min(-int(b), 0)) for b, n in zip(by, lit.shape, strict=True))
    result[target] = lit[origin]
    return result


def unseen(voxels: PartVoxels, radius: Array, reached: Flags) -> Flags:
    """Empty cubes out of sight in hollows at least two cubes wide: the cubes do not resolve anything narrower."""
    hidden = (voxels.label == 0) & ~reached
    core = hidden & (radius >= voxels.pitch)
    return np.asarray(grown(grown(core)) & hidden if core.any() else core)


def supported(voxels: PartVoxels) -> Flags:
    """Empty cubes with a full one somewhere above, which a polyjet machine fills with support."""
    full = voxels.label > 0
    above = np.maximum.accumulate(full[:, :, ::-1], axis=2)[:, :, ::-1]
    below = above & ~full
    # The lowest layer of cubes lies under the tray.
    below[:, :, 0] = False
    return below


def overhangs(voxels: PartVoxels) -> Flags:
    """Full cubes that a filament printer cannot lay on anything: nothing below them, nor one cube aside below.

    That is an overhang beyond 45 degrees, or a bridge.
    """
    full = voxels.label > 0
    carried = grown(full, (0, 1))
    below = np.zeros_like(full)
    below[:, :, 1:] = carried[:, :, :-1]
    # What stands on the tray is carried.
    below[:, :, :2] = True
    return full & ~below
