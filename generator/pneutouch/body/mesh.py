"""The print mesh of one body and the measures a closed mesh has."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pneutouch.arrays import Array, Indices
from pneutouch.body.triangles import enclosed_volume, is_closed, welded
from pneutouch.spec.material import Material


@dataclass(frozen=True, repr=False)
class Body:
    """A closed triangle mesh with a material and a role.

    ``vertices`` is (n, 3) in mm, ``triangles`` (m, 3) indices, counter-clockwise seen from outside.
    """

    name: str
    role: str
    material: Material
    vertices: Array
    triangles: Indices

    def __repr__(self) -> str:
        return f"Body({self.name!r}, {len(self.triangles)} triangles, {self.volume:.6g} mm3 of {self.material.label})"

    @property
    def corners(self) -> Array:
        """Triangle corners, shape (m, 3, 3)."""
        return self.vertices[self.triangles]

    @property
    def volume(self) -> float:
        """Volume in mm3 by the divergence theorem."""
        return enclosed_volume(self.vertices, self.triangles)

    @property
    def bounds(self) -> Array:
        """Smallest and largest corner, shape (2, 3), mm."""
        return np.array([self.vertices.min(axis=0), self.vertices.max(axis=0)])

    def is_closed(self) -> bool:
        """True if every edge is shared by exactly two triangles, in opposite directions."""
        return is_closed(self.triangles, len(self.vertices))

    def welded(self) -> Body:
        """The body as a file reader sees it: vertices rounded to float32 and merged by position."""
        vertices, indices = welded(self.vertices, self.triangles)
        return replace(self, vertices=vertices, triangles=indices)

    def manifold(self) -> Any:
        """The body as manifold3d takes it; empty if it is not closed."""
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
