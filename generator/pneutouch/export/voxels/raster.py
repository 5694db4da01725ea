"""The raster of a stack: where the droplets of a print job lie in the design frame."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.body.section import SolidSection, Window
from pneutouch.units import UM

INCH = 25.4
"""Millimetres."""

_ROUNDING = 1e-6
"""Share of a step by which a size may miss a whole number of steps through rounding."""


@dataclass(frozen=True)
class Raster:
    """Centres of the voxels in the design frame, mm: ``x`` (columns), ``y`` (rows), ``z`` (layers).

    Row 0 is the one at the greatest y of the tray, so that a slice shows the part from above; layer 0 lies on the tray.
    ``dpi`` are the dots an inch along x and y; ``pitch`` the voxel's edges along x, y, z in mm.
    """

    x: Array
    y: Array
    z: Array
    dpi: tuple[int, int]
    pitch: tuple[float, float, float]

    @property
    def voxel(self) -> float:
        """Volume of a voxel, mm3."""
        return math.prod(self.pitch)

    @property
    def size(self) -> tuple[float, float, float]:
        """Edges of the whole stack, mm."""
        x, y, z = self.pitch
        return len(self.x) * x, len(self.y) * y, len(self.z) * z

    def window(self, low: Array, high: Array) -> tuple[slice, slice, slice]:
        """Layers, rows and columns whose centres lie in the box between two corners (3,)."""
        x, y, z = (_held(centres, low[k], high[k]) for k, centres in enumerate((self.x, self.y, self.z)))
        return z, y, x

    def plane(self, rows: slice, columns: slice) -> Window:
        """The rows and columns of a layer, as sections are taken."""
        return Window(self.x[columns], self.y[rows])


def raster(
    bodies: Sequence[SolidSection], dpi: tuple[int, int], layer_um: float, *, upright: bool = True, coarser: float = 1.0
) -> Raster:
    """The raster that holds bodies: lines of the grid run through the z axis, and the lowest face is the first layer's.

    ``upright`` False turns the bodies over, half a turn about x, as `pneutouch.body.Body.turned_over` does. ``coarser``
    multiplies all three pitches, for studies of the raster's error.
    """
    low = np.min([body.low for body in bodies], axis=0)
    high = np.max([body.high for body in bodies], axis=0)
    dx, dy, dz = coarser * INCH / dpi[0], coarser * INCH / dpi[1], coarser * layer_um * UM
    x, y = _grid(low[0], high[0], dx), _grid(low[1], high[1], dy)
    # A layer is printed where its middle lies inside.
    count = max(1, math.ceil((high[2] - low[2]) / dz - 0.5 - _ROUNDING))
    up = (np.arange(count) + 0.5) * dz
    z = low[2] + up if upright else high[2] - up
    return Raster(x, y[::-1].copy() if upright else y, z, dpi, (dx, dy, dz))


def _grid(low: float, high: float, step: float) -> Array:
    first, last = math.floor(low / step + _ROUNDING), math.ceil(high / step - _ROUNDING)
    return np.asarray((np.arange(first, last) + 0.5) * step, np.float64)


def _held(centres: Array, low: float, high: float) -> slice:
    held = np.flatnonzero((centres >= low) & (centres <= high))
    return slice(int(held[0]), int(held[-1]) + 1) if len(held) else slice(0, 0)
