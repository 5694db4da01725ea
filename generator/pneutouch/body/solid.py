"""The exact solid: a turned body or a prism with tools added to it and cut from it, a material and a role.

Holes along the axis of a turned body, built into its flat faces instead of cut out of its mesh.

A face that holes open in is triangulated in its plane with the holes left out, and each hole's wall is a strip
between two circles. Nothing is intersected, so no slivers arise and nothing depends on a tolerance.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from pneutouch.arrays import Array, Indices
from pneutouch.body.mesh import Body
from pneutouch.body.shapes import Bore, Feature, Prism, RevolvedRings, Shape, circle_count, revolve_rings, widen
from pneutouch.shape.meridian import Meridian
from pneutouch.spec.material import Material
from pneutouch.units import grams

_SAME = 1e-9
"""Heights computed from the same numbers may differ by rounding alone (mm)."""

_CLEAR = 0.05
"""Rim in mm that must be left between a hole and the edge of its face, and between two holes."""


@dataclass(frozen=True, slots=True)
class _Hole:
    """A bore with its circles: first vertices of the lower and the upper one."""

    bore: Bore
    count: int
    lower: int
    upper: int


def drilled(rings: RevolvedRings, bores: tuple[Bore, ...], tolerance: float) -> tuple[Array, Indices] | None:
    """The turned body with its bores, or None if a bore does not run between flat faces and must be cut.

    Half of ``tolerance`` (mm) went into the rings; a bore takes all of it, for it is straight.
    """
    faces = _faces(rings, bores)
    if faces is None:
        return None
    vertices, holes = [rings.vertices], []
    size = len(rings.vertices)
    for bore in bores:
        count = circle_count(bore.radius, tolerance)
        holes.append(_Hole(bore, count, size, size + count))
        vertices += [_circle(bore, count, bore.low), _circle(bore, count, bore.high)]
        size += 2 * count
    points = np.concatenate(vertices)
    strips = [strip for k, strip in enumerate(rings.strips) if k not in faces]
    for k, inside in faces.items():
        strips.append(_perforated(points, rings, k, [holes[index] for index in inside]))
    for hole in holes:
        strips += _wall(hole)
    return points, np.concatenate(strips)


def _faces(rings: RevolvedRings, bores: tuple[Bore, ...]) -> dict[int, list[int]] | None:
    """The flat strips that bores open in, with the indices of these bores."""
    faces: dict[int, list[int]] = {}
    for index, bore in enumerate(bores):
        for height in ([bore.low] if bore.closed != "low" else []) + ([bore.high] if bore.closed != "high" else []):
            hits = [k for k in range(len(rings.pairs)) if _holds(rings, k, bore, height)]
            if len(hits) != 1:
                return None
            faces.setdefault(hits[0], []).append(index)
    together = [(a, b) for inside in faces.values() for a in inside for b in inside if a < b]
    apart = all(
        math.hypot(bores[a].x - bores[b].x, bores[a].y - bores[b].y) > bores[a].radius + bores[b].radius + _CLEAR
        for a, b in together
    )
    return faces if apart else None


def _holds(rings: RevolvedRings, k: int, bore: Bore, height: float) -> bool:
    """True if strip ``k`` is flat, at ``height``, and wide enough around a bore."""
    one, other = (rings.rings[index] for index in rings.pairs[k])
    if abs(one.height - height) > _SAME or abs(other.height - height) > _SAME:
        return False
    centre = math.hypot(bore.x, bore.y)
    inner, outer = sorted((one.radius, other.radius))
    clear_inside = inner == 0.0 or centre - bore.radius > inner + _CLEAR
    return clear_inside and centre + bore.radius < outer - _CLEAR


def _circle(bore: Bore, count: int, height: float) -> Array:
    angle = 2 * np.pi * np.arange(count) / count
    radius = bore.radius * widen(count)
    return np.column_stack([bore.x + radius * np.cos(angle), bore.y + radius * np.sin(angle), np.full(count, height)])


def _perforated(points: Array, rings: RevolvedRings, k: int, holes: list[_Hole]) -> Indices:
    """A flat strip with holes, facing as the strip did."""
    from manifold3d import triangulate

    first, second = rings.pairs[k]
    inwards = rings.rings[first].radius > rings.rings[second].radius
    inner, outer = (second, first) if inwards else (first, second)
    loops = [np.arange(rings.starts[outer], rings.starts[outer] + rings.counts[outer])]
    if rings.counts[inner] > 1:
        loops.append(np.arange(rings.starts[inner], rings.starts[inner] + rings.counts[inner])[::-1])
    height = rings.rings[first].height
    for hole in holes:
        start = hole.lower if abs(hole.bore.low - height) <= _SAME and hole.bore.closed != "low" else hole.upper
        loops.append(np.arange(start, start + hole.count)[::-1])
    index = np.concatenate(loops)
    flat = triangulate([np.ascontiguousarray(points[loop, :2]) for loop in loops])
    triangles: Indices = index[np.asarray(flat)].astype(np.int64)
    # A meridian runs counter-clockwise: it goes inwards over a face that looks up.
    return triangles if inwards else triangles[:, ::-1]


def _wall(hole: _Hole) -> list[Indices]:
    """The wall of a hole, facing its axis, and its bottom if it has one."""
    k = np.arange(hole.count)
    after = (k + 1) % hole.count
    low, high = hole.lower, hole.upper
    strips = [np.column_stack([low + k, high + k, low + after]), np.column_stack([low + after, high + k, high + after])]
    if hole.bore.closed:
        fan = np.column_stack([np.zeros(hole.count - 2, int), k[1:-1], k[2:]])
        # The bottom looks towards the mouth: up where the hole is closed below.
        strips.append(low + fan if hole.bore.closed == "low" else high + fan[:, ::-1])
    return strips


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
