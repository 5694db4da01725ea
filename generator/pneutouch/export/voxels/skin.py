"""The skin of a mixed body: its outermost voxels stay soft resin, and their share of the other resin goes to the voxels
just beneath.

A voxel is skin where one of its six neighbours lies outside the body, whatever is there: so no stiff droplet lies at a
face, where air could leak along it, and the membrane's faces are as smooth as the soft resin's.
"""

from collections.abc import Callable, Iterable
from typing import Generic, TypeVar

import numpy as np

from pneutouch.arrays import Flags, Singles

Item = TypeVar("Item")

LEAST_REACH, MOST_REACH = 0.12, 0.4
"""Distance in mm from a skin voxel over which its share may go, and two voxels at least: less than a wall; our
choice."""


def interior(below: Flags | None, here: Flags, above: Flags | None) -> Flags:
    """Voxels of a layer (rows, columns) with all six neighbours inside; None is an empty layer."""
    if below is None or above is None:
        return np.zeros_like(here)
    inner = here & below & above
    inner[1:] &= here[:-1]
    inner[:-1] &= here[1:]
    inner[:, 1:] &= here[:, :-1]
    inner[:, :-1] &= here[:, 1:]
    inner[0], inner[-1], inner[:, 0], inner[:, -1] = False, False, False, False
    return inner


def reach_for(most: float, pitch: tuple[float, float, float]) -> float:
    """Distance in mm over which the share of a skin voxel goes if the share is ``most`` at most.

    Far enough that an edge, where the shares of two faces come together, is not filled beyond one.
    """
    required = 2 * most * max(pitch) / (1 - most) if most < 1 else MOST_REACH
    return min(max(required, LEAST_REACH), MOST_REACH)


class RecentLayers(Generic[Item]):
    """Something made for layers in turn; the last ``keep`` are kept, so that neighbours need not be made again."""

    def __init__(self, make: Callable[[int], Item], keep: int) -> None:
        self._make, self._keep = make, keep
        self._items: dict[int, Item] = {}

    def __call__(self, number: int) -> Item:
        """The item of a layer."""
        if number not in self._items:
            self._items[number] = self._make(number)
            while len(self._items) > self._keep:
                del self._items[next(iter(self._items))]
        return self._items[number]


class SkinCompensation:
    """Addition to the share of every interior voxel, so that the body keeps the share of its skin.

    The share requested in a skin voxel goes in equal parts to the interior voxels of the box of ``reach`` mm around it:
    the sum over the body is kept, and so is that of any region much larger than the reach. What has no interior near is
    lost.
    """

    def __init__(
        self, parts: Callable[[int], tuple[Flags, Singles] | None], pitch: tuple[float, float, float], reach: float
    ) -> None:
        """``parts`` gives the interior and the skin's shares (0 elsewhere) of a layer, None beyond the body's."""
        x, y, z = (max(2, round(reach / step)) for step in pitch)
        self._parts, self._plane, self._up = parts, (y, x), z
        self._capacity = RecentLayers(self._capacities, 2 * z + 2)
        self._given = RecentLayers(self._gifts, 2 * z + 2)

    @property
    def ahead(self) -> int:
        """Number of layers to each side that are looked at."""
        return 2 * self._up

    def layer(self, number: int) -> Singles | None:
        """Addition in a layer, (rows, columns); it has a meaning for the interior alone."""
        return _sum(self._given(k) for k in self._around(number))

    def _around(self, number: int) -> range:
        return range(number - self._up, number + self._up + 1)

    def _capacities(self, number: int) -> Singles | None:
        parts = self._parts(number)
        return None if parts is None else _boxed(parts[0].astype(np.float32), self._plane)

    def _gifts(self, number: int) -> Singles | None:
        parts = self._parts(number)
        capacity = _sum(self._capacity(k) for k in self._around(number))
        if parts is None or capacity is None:
            return None
        deficit = parts[1]
        return _boxed(np.divide(deficit, capacity, out=np.zeros_like(deficit), where=capacity > 0), self._plane)


def _sum(layers: Iterable[Singles | None]) -> Singles | None:
    total: Singles | None = None
    for layer in layers:
        if layer is not None:
            total = layer.copy() if total is None else np.add(total, layer, out=total)
    return total


def _boxed(values: Singles, reach: tuple[int, int]) -> Singles:
    """Sums over the box of so many rows and columns in each direction."""
    for axis, far in enumerate(reach):
        lines = np.moveaxis(values, axis, 0)
        total = values.copy()
        out = np.moveaxis(total, axis, 0)
        for step in range(1, far + 1):
            out[step:] += lines[:-step]
            out[:-step] += lines[step:]
        values = total
    return values
