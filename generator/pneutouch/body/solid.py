"""The exact solid: a revolved meridian with straight bores, a material and a role."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pneutouch.body.mesh import Body
from pneutouch.body.revolve import Triangles, Vertices, circle_count, revolve, widen
from pneutouch.meridian import Meridian
from pneutouch.meridian.segments import Array
from pneutouch.spec.material import Material
from pneutouch.units import grams


@dataclass(frozen=True, slots=True)
class Bore:
    """A round hole along z: centre (x, y), radius, and the two faces it runs between, mm."""

    x: float
    y: float
    radius: float
    low: float
    high: float
    blind: bool = False

    @property
    def volume(self) -> float:
        """Volume removed, mm3."""
        return math.pi * self.radius**2 * (self.high - self.low)

    def distance(self, points: Array) -> Array:
        """Distances, shape (n,), of (n, 3) points from the bore's wall and, if blind, its bottom."""
        radial = np.hypot(points[:, 0] - self.x, points[:, 1] - self.y) - self.radius
        axial = np.maximum(np.maximum(self.low - points[:, 2], points[:, 2] - self.high), 0.0)
        wall: Array = np.hypot(radial, axial)
        if not self.blind:
            return wall
        bottom: Array = np.hypot(np.maximum(radial, 0.0), points[:, 2] - self.high)
        return np.minimum(wall, bottom)


@dataclass(frozen=True)
class Solid:
    """One body as designed, exact. ``role`` is what it does: membrane or connector."""

    name: str
    role: str
    material: Material
    meridian: Meridian
    bores: tuple[Bore, ...] = ()

    @cached_property
    def volume(self) -> float:
        """Exact volume, mm3; bores lie wholly inside the revolved solid and apart from one another."""
        return self.meridian.volume() - sum(bore.volume for bore in self.bores)

    @property
    def mass(self) -> float:
        """Mass in g at the material's nominal density."""
        return grams(self.volume, self.material.density_g_per_cm3.nominal)

    def distance(self, points: Array) -> Array:
        """Distances, shape (n,), of (n, 3) points in mm from the exact surface."""
        gaps = [self.meridian.distance(points), *(bore.distance(points) for bore in self.bores)]
        nearest: Array = np.min(gaps, axis=0)
        return nearest

    def mesh(self, tolerance: float) -> Body:
        """The print mesh, within ``tolerance`` mm of the exact surface."""
        vertices, triangles = revolve(self.meridian, tolerance)
        if self.bores:
            vertices, triangles = _drill(vertices, triangles, self.bores, tolerance)
        return Body(self.name, self.role, self.material, vertices, triangles)


def _drill(
    vertices: Vertices, triangles: Triangles, bores: tuple[Bore, ...], tolerance: float
) -> tuple[Vertices, Triangles]:
    """Cut the bores in one batch; a bore reaches past its open faces so that no two faces coincide."""
    from manifold3d import Manifold, Mesh64, OpType

    blank = Manifold(Mesh64(vertices, triangles.astype(np.uint64)))
    tools = []
    for bore in bores:
        count = circle_count(bore.radius, tolerance)
        height = bore.high - bore.low + (1.0 if bore.blind else 2.0)
        drill = Manifold.cylinder(height, bore.radius * widen(count), circular_segments=count)
        tools.append(drill.translate((bore.x, bore.y, bore.low - 1.0)))
    cut = Manifold.batch_boolean([blank, *tools], OpType.Subtract).to_mesh64()
    return np.array(cut.vert_properties[:, :3], order="C"), cut.tri_verts.astype(np.int64)
