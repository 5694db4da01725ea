"""The print mesh of one body and the measures a closed mesh has."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pneutouch.arrays import Array, Indices
from pneutouch.spec.material import Material


@dataclass(frozen=True)
class Body:
    """A closed triangle mesh with a material and a role.

    ``vertices`` is (n, 3) in mm, ``triangles`` (m, 3) indices, counter-clockwise seen from outside.
    """

    name: str
    role: str
    material: Material
    vertices: Array
    triangles: Indices

    @property
    def corners(self) -> Array:
        """Triangle corners, shape (m, 3, 3)."""
        return self.vertices[self.triangles]

    @property
    def volume(self) -> float:
        """Volume in mm3 by the divergence theorem."""
        a, b, c = np.moveaxis(self.corners - self.vertices.mean(axis=0), 1, 0)
        return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)

    @property
    def bounds(self) -> Array:
        """Smallest and largest corner, shape (2, 3), mm."""
        return np.array([self.vertices.min(axis=0), self.vertices.max(axis=0)])

    def is_closed(self) -> bool:
        """Whether every edge is shared by exactly two triangles that run along it in opposite ways."""
        edges = self.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        key = edges[:, 0] * (len(self.vertices) + 1) + edges[:, 1]
        back = edges[:, 1] * (len(self.vertices) + 1) + edges[:, 0]
        return len(np.unique(key)) == len(key) and bool(np.array_equal(np.sort(key), np.sort(back)))

    def welded(self) -> Body:
        """The body as a file reader sees it: vertices rounded to float32 and merged by position."""
        single = self.vertices.astype(np.float32).astype(np.float64)
        merged, index = np.unique(single, axis=0, return_inverse=True)
        return replace(self, vertices=merged, triangles=index.reshape(-1)[self.triangles])

    def manifold(self) -> Any:
        """The body as manifold3d takes it; empty where it is not closed."""
        from manifold3d import Manifold, Mesh64

        return Manifold(Mesh64(np.ascontiguousarray(self.vertices), self.triangles.astype(np.uint64)))

    def moved(self, offset: Array) -> Body:
        """The body shifted by ``offset`` (3,), mm."""
        return replace(self, vertices=self.vertices + offset)

    def turned_over(self) -> Body:
        """The body turned by half a turn about the x axis."""
        return replace(self, vertices=self.vertices * np.array([1.0, -1.0, -1.0]))

    def surface_points(self, parts: int = 4) -> Array:
        """Points spread over every triangle, edges and corners included, for measuring deviation."""
        grid = [(i, j) for i in range(parts + 1) for j in range(parts + 1 - i)]
        weights = np.array([(i, j, parts - i - j) for i, j in grid], float) / parts
        points: Array = np.einsum("wk,mkd->mwd", weights, self.corners).reshape(-1, 3)
        return points
