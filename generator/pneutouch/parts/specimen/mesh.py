"""Meshes without a material, and the boxes they fill."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array, Indices
from pneutouch.body.triangles import enclosed_volume, is_closed, welded

Point3 = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Box:
    """A box along the axes between two corners, mm."""

    low: Point3
    high: Point3

    @property
    def volume(self) -> float:
        """Volume, mm3."""
        a, b, c = (high - low for low, high in zip(self.low, self.high, strict=True))
        return a * b * c

    def gap(self, other: Box) -> float:
        """Greatest distance along an axis between the boxes, mm; negative where they overlap."""
        return max(max(self.low[k] - other.high[k], other.low[k] - self.high[k]) for k in range(3))


@dataclass(frozen=True)
class Mesh:
    """``vertices`` (n, 3) in mm and ``triangles`` (m, 3), counter-clockwise seen from outside."""

    vertices: Array
    triangles: Indices

    @property
    def volume(self) -> float:
        """Volume in mm3 by the divergence theorem; the mesh must be closed."""
        return enclosed_volume(self.vertices, self.triangles)

    def is_closed(self) -> bool:
        """True if every edge is shared by exactly two triangles, before and after vertices are merged in float32."""
        vertices, triangles = welded(self.vertices, self.triangles)
        return is_closed(self.triangles, len(self.vertices)) and is_closed(triangles, len(vertices))

    def compact(self) -> Mesh:
        """The mesh without vertices that no triangle has."""
        used = np.zeros(len(self.vertices), bool)
        used[self.triangles.reshape(-1)] = True
        number = np.cumsum(used) - 1
        return Mesh(self.vertices[used], number[self.triangles].astype(np.int64))


def joined(meshes: list[Mesh]) -> Mesh:
    """Meshes that are apart from one another as one."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    return Mesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate([mesh.triangles + start for mesh, start in zip(meshes, starts, strict=False)]),
    )


def snapped(mesh: Mesh, box: Box, slack: float) -> Mesh:
    """The mesh with coordinates within ``slack`` mm of a side of the box put on it."""
    vertices = mesh.vertices.copy()
    for axis in range(3):
        for side in (box.low[axis], box.high[axis]):
            column = vertices[:, axis]
            column[np.abs(column - side) <= slack] = side
    return Mesh(vertices, mesh.triangles)
