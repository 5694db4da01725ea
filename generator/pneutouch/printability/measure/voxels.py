"""Parts in cubes, for spaces that rays alone do not show, such as those behind a neck or under an overhang."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneutouch.arrays import Array, Flags, Indices

PITCH = 0.25
"""Edge of a cube, mm, on parts small enough."""

MOST = 300_000
"""Cubes of a model; a larger part gets larger ones."""

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
    """Cubes whose centres lie in the parts, given by their triangles' corners (m, 3, 3) in the design frame."""
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
    """Cubes with their centres at whole numbers that lie inside, by counting the crossings below each."""
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
