"""Measures of a triangle mesh: vertices (n, 3) in mm and triangles (m, 3) counter-clockwise seen from outside."""

import numpy as np

from pneutouch.arrays import Array, Indices, distinct


def enclosed_volume(vertices: Array, triangles: Indices) -> float:
    """Volume in mm3 by the divergence theorem; the mesh must be closed."""
    a, b, c = np.moveaxis(vertices[triangles] - vertices.mean(axis=0), 1, 0)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def is_closed(triangles: Indices, count: int) -> bool:
    """True if every edge between ``count`` vertices is shared by exactly two triangles, in opposite directions."""
    edges = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    key, back = edges[:, 0] * count + edges[:, 1], edges[:, 1] * count + edges[:, 0]
    return len(distinct(key)) == len(key) and bool(np.array_equal(np.sort(key), np.sort(back)))


def welded(vertices: Array, triangles: Indices) -> tuple[Array, Indices]:
    """The mesh as a file reader sees it: vertices rounded to float32 and merged by position."""
    single = vertices.astype(np.float32).astype(np.float64)
    merged, index = np.unique(single, axis=0, return_inverse=True)
    return merged, index.reshape(-1)[triangles]
