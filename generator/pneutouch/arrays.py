"""The array types that the package's annotations use, whose shapes and units stand in each docstring."""

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Scalar = TypeVar("Scalar", bound=np.generic)

Array = NDArray[np.float64]
"""Numbers."""

Singles = NDArray[np.float32]
"""Numbers in single precision."""

Complex = NDArray[np.complex128]
"""Complex numbers."""

Flags = NDArray[np.bool_]
"""Truth values."""

Index = NDArray[np.intp]
"""Positions in another array."""

Indices = NDArray[np.int64]
"""Whole numbers that are stored: the vertices of triangles and edges, ranks."""

Labels = NDArray[np.uint8]
"""The material of each voxel."""

Pixels = NDArray[np.uint32]
"""Packed RGBA colours."""


def distinct(values: NDArray[Scalar]) -> NDArray[Scalar]:
    """The distinct numbers of an array of any shape, ascending, (n,).

    `numpy.unique` of them loads the masked arrays, which takes a tenth as long as NumPy itself.
    """
    ordered = np.sort(values, axis=None)
    first = np.ones(ordered.size, dtype=bool)
    first[1:] = ordered[1:] != ordered[:-1]
    return ordered[first]
