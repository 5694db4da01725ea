"""The print mesh of one body and the measures a closed mesh has.

Measures of a triangle mesh: vertices (n, 3) in mm and triangles (m, 3) counter-clockwise seen from outside.

Normals for shading: averaged where a surface is smooth, apart where it has an edge.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pneutouch.arrays import Array, Index, Indices, distinct
from pneutouch.spec.material import Material


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


_EDGE_COSINE = math.cos(math.radians(40))
"""Cosine of the angle between two triangles from which on the line between them is drawn as an edge. Facets of an arc
within the mesh tolerance meet at a few degrees, the edges of parts at 45 degrees and more."""


def corner_normals(body: Body) -> Array:
    """Unit normals at the corners of every triangle, (m, 3, 3).

    A corner's normal is the mean of the triangles that share its vertex and lie within the edge angle of the corner's
    triangle, weighted by their angles there (Thürmer and Wüthrich 1998, DOI 10.1080/10867651.1998.10487487).
    """
    face, angle = _faces(body.corners)
    vertex, count = body.triangles.reshape(-1), 3 * len(body.triangles)
    order = np.argsort(vertex, kind="stable")
    at = vertex[order]
    start, stop = np.searchsorted(at, vertex, "left"), np.searchsorted(at, vertex, "right")
    owner, other = _pairs(start, stop)
    other = order[other]
    smooth = np.einsum("ij,ij->i", face[owner // 3], face[other // 3]) >= _EDGE_COSINE
    weighted = face[other // 3] * (angle.reshape(-1)[other] * smooth)[:, None]
    total = np.stack([np.bincount(owner, weighted[:, k], minlength=count) for k in range(3)], axis=1)
    length = np.linalg.norm(total, axis=1, keepdims=True)
    flat = np.repeat(face, 3, axis=0)
    return np.where(length > 1e-9, total / np.maximum(length, 1e-30), flat).reshape(-1, 3, 3)


def _faces(corners: Array) -> tuple[Array, Array]:
    """Unit normals (m, 3) and the angles at the corners (m, 3) of triangles (m, 3, 3); zero for those without area."""
    along = corners[:, [1, 2, 0]] - corners
    normal = np.cross(along[:, 0], -along[:, 2])
    area = np.linalg.norm(normal, axis=1)
    before = -along[:, [2, 0, 1]]
    angle = np.arctan2(area[:, None], np.einsum("ijk,ijk->ij", along, before))
    known = area > 1e-12
    return np.where(known[:, None], normal / np.maximum(area, 1e-30)[:, None], 0.0), angle * known[:, None]


def _pairs(start: Index, stop: Index) -> tuple[Index, Index]:
    """Every index from start to stop, (n,) each, and whose it is."""
    count = stop - start
    owner = np.repeat(np.arange(count.size), count)
    return owner, np.arange(owner.size) - np.repeat(np.cumsum(count) - count - start, count)
