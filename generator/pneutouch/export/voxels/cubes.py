"""A coarse grid of cubes over voxels, in which fractions are compared."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array, Flags, Singles


@dataclass(frozen=True)
class Cubes:
    """A coarse grid over a window of voxels, (layers, rows, columns); ``edge`` are voxels of a cube in each
    direction."""

    shape: tuple[int, int, int]
    edge: tuple[int, int, int]

    @staticmethod
    def over(shape: tuple[int, int, int], pitch: tuple[float, float, float], edge: float) -> Cubes:
        """Cubes of about ``edge`` mm over a window of voxels of ``pitch`` mm along x, y, z."""
        counts = tuple(max(1, round(edge / step)) for step in reversed(pitch))
        return Cubes(shape, counts)  # type: ignore[arg-type]

    def empty(self) -> Array:
        """A number for every cube."""
        return np.zeros(tuple(-(-n // e) for n, e in zip(self.shape, self.edge, strict=True)))

    def add(self, totals: Array, layer: int, values: Array | Flags | Singles) -> None:
        """Add a layer's values (rows, columns) to the totals of their cubes."""
        _, rows, columns = self.edge
        summed = np.add.reduceat(values.astype(np.float32), np.arange(0, values.shape[0], rows), axis=0)
        totals[layer // self.edge[0]] += np.add.reduceat(summed, np.arange(0, values.shape[1], columns), axis=1)
