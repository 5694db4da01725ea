"""The array types that the package's annotations use; shapes and units stand in each docstring."""

import numpy as np
from numpy.typing import NDArray

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
