"""The exact solid: a turned body or a prism with tools added to it and cut from it, a material and a role."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from pneutouch.arrays import Array, Indices
from pneutouch.body.drill import drilled
from pneutouch.body.mesh import Body
from pneutouch.body.revolve import revolve_rings
from pneutouch.body.shapes import Bore, Feature, Prism, Shape
from pneutouch.meridian import Meridian
from pneutouch.spec.material import Material
from pneutouch.units import grams


@dataclass(frozen=True)
class Solid:
    """One body as designed, exact. ``role`` is its function: membrane, connector, ring, plug, coupon ...

    ``base`` is a meridian about the z axis or a prism. ``adds`` are joined to it first; ``bores`` and ``cuts`` are
    taken away then. Bores lie wholly inside the solid and apart from one another.
    """

    name: str
    role: str
    material: Material
    base: Meridian | Prism
    bores: tuple[Bore, ...] = ()
    adds: tuple[Feature, ...] = ()
    cuts: tuple[Feature, ...] = ()

    def __repr__(self) -> str:
        return f"Solid({self.name!r} of {self.material.label})"

    @property
    def meridian(self) -> Meridian:
        """The base of a turned body. Raises TypeError for a prism."""
        if not isinstance(self.base, Meridian):
            raise TypeError(f"{self.name} is not a turned body")
        return self.base

    @cached_property
    def volume(self) -> float:
        """Exact volume, mm3."""
        added = sum(feature.net for feature in self.adds)
        cut = sum(feature.net for feature in self.cuts) + sum(bore.volume() for bore in self.bores)
        return self.base.volume() + added - cut

    @property
    def mass(self) -> float:
        """Mass in g at the material's nominal density."""
        return grams(self.volume, self.material.density_g_per_cm3.nominal)

    def distance(self, points: Array) -> Array:
        """Distances, shape (n,), of (n, 3) points in mm from the exact surfaces that bound the solid."""
        shapes = [self.base, *self.bores, *(feature.shape for feature in (*self.adds, *self.cuts))]
        nearest: Array = np.min([shape.distance(points) for shape in shapes], axis=0)
        return nearest

    def mesh(self, tolerance: float) -> Body:
        """The print mesh, within ``tolerance`` mm of the exact surface."""
        (vertices, triangles), bores = self._drilled(tolerance)
        tools: list[Shape] = [*bores, *(feature.shape for feature in self.cuts)]
        if self.adds or tools:
            parts = [feature.shape.mesh(tolerance) for feature in self.adds]
            vertices, triangles = _combined((vertices, triangles), parts, [tool.mesh(tolerance) for tool in tools])
        return Body(self.name, self.role, self.material, vertices, triangles)

    def _drilled(self, tolerance: float) -> tuple[tuple[Array, Indices], tuple[Bore, ...]]:
        """The mesh of the base, and the bores that still have to be cut; most are built into flat faces."""
        if not isinstance(self.base, Meridian):
            return self.base.mesh(tolerance), self.bores
        rings = revolve_rings(self.base, tolerance)
        built = drilled(rings, self.bores, tolerance) if self.bores else None
        if built is not None:
            return built, ()
        return (rings.vertices, np.concatenate(rings.strips)), self.bores


def _combined(
    base: tuple[Array, Indices], adds: list[tuple[Array, Indices]], cuts: list[tuple[Array, Indices]]
) -> tuple[Array, Indices]:
    """Join and cut in one batch each."""
    from manifold3d import Manifold, Mesh64, OpType

    def manifold(mesh: tuple[Array, Indices]) -> Any:
        return Manifold(Mesh64(mesh[0], mesh[1].astype(np.uint64)))

    whole = manifold(base)
    if adds:
        whole = Manifold.batch_boolean([whole, *map(manifold, adds)], OpType.Add)
    if cuts:
        whole = Manifold.batch_boolean([whole, *map(manifold, cuts)], OpType.Subtract)
    mesh = whole.to_mesh64()
    return np.array(mesh.vert_properties[:, :3], order="C"), mesh.tri_verts.astype(np.int64)
