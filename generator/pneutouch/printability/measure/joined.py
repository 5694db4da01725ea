"""Connected components of a graph and of a space in cubes, and distances in such a space.

With NumPy only: SciPy's `csgraph` and `ndimage` give the same in as much time (test_joined.py), but loading both takes
half as long as `import numpy, scipy.linalg`, longer than these rules take on a dome and its connector.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneutouch.arrays import Array, Flags, Index, Indices
from pneutouch.printability.subject import Point3


def components(count: int, one: Indices, other: Indices) -> Indices:
    """Component of each of ``count`` nodes, (count,), numbered by first node; edges join ``one`` and ``other`` (n,)."""
    # Each node points to one of its component that is no later; edges hook the pointers together, which then shorten.
    first = np.arange(count)
    while True:
        a, b = first[one], first[other]
        apart = np.flatnonzero(a != b)
        if not len(apart):
            return np.cumsum(first == np.arange(count))[first] - 1
        one, other, a, b = one[apart], other[apart], a[apart], b[apart]
        np.minimum.at(first, np.maximum(a, b), np.minimum(a, b))
        shorter = first[first]
        while not np.array_equal(shorter, first):
            first, shorter = shorter, shorter[shorter]


def outside(space: Flags) -> Flags:
    """The pieces of a space in cubes (i, j, k) that reach the border of the grid; cubes join over their faces."""
    pieces = _Pieces(space)
    reached = np.zeros(pieces.count, bool)
    for face in (np.s_[0], np.s_[-1], np.s_[:, 0], np.s_[:, -1], np.s_[:, :, 0], np.s_[:, :, -1]):
        reached[pieces.piece[pieces.number[face][space[face]]]] = True
    return space if reached.all() else reached[pieces.piece][pieces.number] & space


def largest_pieces(space: Flags, most: int = 10) -> list[Flags]:
    """The largest pieces of more than one cube, at most ``most``, largest first; cubes join over their faces."""
    pieces = _Pieces(space)
    label = pieces.piece[pieces.number]
    size = np.bincount(label[space], minlength=pieces.count)
    order = np.argsort(-size, kind="stable")[:most]
    return [(label == one) & space for one in order if size[one] > 1]


def grown(space: Flags, axes: tuple[int, ...] = (0, 1, 2)) -> Flags:
    """The space with the cubes next to it along the axes."""
    result = space.copy()
    for axis in axes:
        rows, wider = np.moveaxis(space, axis, 0), np.moveaxis(result, axis, 0)
        wider[1:] |= rows[:-1]
        wider[:-1] |= rows[1:]
    return result


class _Pieces:
    """The pieces of a space: ``number`` (i, j, k) of the run of each of its cubes, and ``piece`` of each run.

    A run is a row of cubes of the space along the last axis; there are far fewer runs than cubes.
    """

    def __init__(self, space: Flags) -> None:
        begins = space.copy()
        begins[:, :, 1:] &= ~space[:, :, :-1]
        runs = int(begins.sum())
        # Cubes outside the space have the number of the run before them, which nothing reads.
        self.number = np.maximum(np.cumsum(begins.ravel(), dtype=np.int32) - 1, 0).reshape(space.shape)
        pairs = [self._pairs(space, axis) for axis in (0, 1)]
        one, other = (np.concatenate(ends) for ends in zip(*pairs, strict=True))
        self.piece = components(max(runs, 1), one, other)
        self.count = int(self.piece.max()) + 1

    def _pairs(self, space: Flags, axis: int) -> tuple[Index, Index]:
        """Runs that lie side by side along an axis, once for each stretch over which they do."""
        low = tuple(slice(None, -1) if k == axis else slice(None) for k in range(3))
        high = tuple(slice(1, None) if k == axis else slice(None) for k in range(3))
        both = space[low] & space[high]
        both[:, :, 1:] &= ~both[:, :, :-1].copy()
        return self.number[low][both].astype(np.intp), self.number[high][both].astype(np.intp)


def distances(space: Flags) -> Array:
    """Distance in cubes of each cube of a space (i, j, k) from the nearest that is not in it; 0 outside the space.

    Exact: the squares are separable, so one axis after the other is searched (Saito and Toriwaki 1994, Pattern
    Recognition 27, 1551). A space without outside has the length of the model's diagonal everywhere.
    """
    most = int(sum(n * n for n in space.shape))
    # Squares as whole numbers of 16 bits where they fit: less memory to move.
    kind = np.int16 if 2 * most < np.iinfo(np.int16).max else np.int32
    square = _along_last(space, most, kind)
    for axis in (1, 0):
        square = _widened(square, axis)
    return np.asarray(np.sqrt(square, dtype=np.float64))


def _along_last(space: Flags, most: int, kind: Any) -> NDArray[Any]:
    """Square of the distance to the nearest cube outside the space along the last axis; ``most`` without one."""
    n = space.shape[2]
    place = np.arange(n, dtype=kind)
    before = np.maximum.accumulate(np.where(space, kind(-n), place), axis=2)
    after = np.minimum.accumulate(np.where(space, kind(2 * n), place)[:, :, ::-1], axis=2)[:, :, ::-1]
    near = np.minimum(place - before, after - place)
    return np.asarray(np.where(near < n, near * near, kind(most)))


_ROWS = 8
"""Layers that are searched at a time: few enough for the processor's cache."""


def _widened(square: NDArray[Any], axis: int) -> NDArray[Any]:
    """The least of the squares in each row along an axis, each with the square of its distance in the row added."""
    across = 1 - axis
    widest = np.empty_like(square)
    for first in range(0, square.shape[across], _ROWS):
        layers = (slice(None),) * across + (slice(first, first + _ROWS),)
        rows = np.ascontiguousarray(np.moveaxis(square[layers], axis, 0))
        least = rows.copy()
        for step in range(1, len(rows)):
            if step * step >= least.max():
                break
            more = rows + rows.dtype.type(step * step)
            np.minimum(least[step:], more[:-step], out=least[step:])
            np.minimum(least[:-step], more[step:], out=least[:-step])
        widest[layers] = np.moveaxis(least, 0, axis)
    return widest


_NOTHING = 1e-6
"""Volume in mm3 below which a shell is due to rounding."""


@dataclass(frozen=True)
class Hollow:
    """A closed hollow: ``volume`` in mm3, ``bounds`` (2, 3) in mm, and ``body``, the name of the one it lies in."""

    body: str
    volume: float
    bounds: Array

    @property
    def where(self) -> Point3:
        """Middle of its bounding box, mm."""
        x, y, z = (float(value) for value in self.bounds.mean(axis=0))
        return x, y, z

    def alike(self, other: "Hollow") -> bool:
        """True if both are the same hollow."""
        return bool(np.allclose(self.bounds, other.bounds, atol=1e-6))


def voids(manifold: Any, body: str) -> list[Hollow]:
    """Hollows of a manifold3d solid, smallest first; ``body`` is its name."""
    hollows = []
    for shell in manifold.decompose():
        volume = float(shell.volume())
        if volume < -_NOTHING:
            hollows.append(Hollow(body, -volume, np.array(shell.bounding_box()).reshape(2, 3)))
    return sorted(hollows, key=lambda hollow: hollow.volume)
