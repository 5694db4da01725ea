"""A body as an exact solid, a turned body or a prism with shapes added and cut, and as a print mesh with its measures.

Vertices are (n, 3) in mm, triangles (m, 3) counter-clockwise seen from outside. Bores between flat faces of a turned
body are meshed directly, without slivers: each face is triangulated around the openings, and the wall of each bore is a
strip between two circles. Other bores and all shapes added or cut are joined as meshes by manifold3d.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import starmap
from typing import Any

import numpy as np

from pneutouch.arrays import Array, Index, Indices, distinct
from pneutouch.body.shapes import Bore, Feature, Prism, RevolvedRings, Shape, circle_count, circle_points, revolve_rings
from pneutouch.shape.meridian import Meridian
from pneutouch.spec.material import Material
from pneutouch.units import grams


def enclosed_volume(vertices: Array, triangles: Indices) -> float:
    """Volume in mm3 by the divergence theorem; the mesh must be closed."""
    a, b, c = np.moveaxis(vertices[triangles] - vertices.mean(axis=0), 1, 0)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def is_closed(triangles: Indices, count: int) -> bool:
    """True if every edge of a mesh of ``count`` vertices is in exactly two triangles, in opposite directions."""
    edges = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    key, back = edges[:, 0] * count + edges[:, 1], edges[:, 1] * count + edges[:, 0]
    return len(distinct(key)) == len(key) and bool(np.array_equal(np.sort(key), np.sort(back)))


def manifold_of(vertices: Array, triangles: Indices) -> Any:
    """A mesh as a manifold3d object; empty if it is not closed."""
    from manifold3d import Manifold, Mesh64

    return Manifold(Mesh64(np.ascontiguousarray(vertices), np.ascontiguousarray(triangles, np.uint64)))


def mesh_of(manifold: Any) -> tuple[Array, Indices]:
    """Vertices (n, 3) and triangles (m, 3) of a manifold3d object."""
    mesh = manifold.to_mesh64()
    return np.array(mesh.vert_properties[:, :3], order="C"), mesh.tri_verts.astype(np.int64)


def welded(vertices: Array, triangles: Indices) -> tuple[Array, Indices]:
    """Vertices and triangles as read back from a file: rounded to float32, vertices of equal position merged."""
    single = vertices.astype(np.float32).astype(np.float64)
    merged, index = np.unique(single, axis=0, return_inverse=True)
    return merged, index.reshape(-1)[triangles]


@dataclass(frozen=True, repr=False)
class Body:
    """A closed triangle mesh with a material and a role (the function of the body, as in `Solid`).

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
        """Corners of the triangles (m, 3 corners, 3 coordinates), mm."""
        return self.vertices[self.triangles]

    @property
    def volume(self) -> float:
        """Volume in mm3 by the divergence theorem."""
        return enclosed_volume(self.vertices, self.triangles)

    @property
    def bounds(self) -> Array:
        """Corners of the bounding box, least then greatest, shape (2, 3), mm."""
        return np.array([self.vertices.min(axis=0), self.vertices.max(axis=0)])

    def is_closed(self) -> bool:
        """True if every edge is shared by exactly two triangles, in opposite directions."""
        return is_closed(self.triangles, len(self.vertices))

    def welded(self) -> "Body":
        """The body as read back from a file: rounded to float32, vertices of equal position merged."""
        vertices, indices = welded(self.vertices, self.triangles)
        return replace(self, vertices=vertices, triangles=indices)

    def manifold(self) -> Any:
        """The body as a manifold3d object; empty if it is not closed."""
        return manifold_of(self.vertices, self.triangles)

    def moved(self, offset: Array) -> "Body":
        """The body shifted by ``offset`` (3,), mm."""
        return replace(self, vertices=self.vertices + offset)

    def turned_over(self) -> "Body":
        """The body rotated by 180 degrees about the x axis."""
        return replace(self, vertices=self.vertices * np.array([1.0, -1.0, -1.0]))

    def under_ceilings(self, up: float) -> float:
        """Space in mm3 between the bed and faces over 45 degrees of overhang; ``up`` 1, or -1 if turned over."""
        areas = 0.5 * np.cross(self.corners[:, 1] - self.corners[:, 0], self.corners[:, 2] - self.corners[:, 0])
        height, downwards = up * self.corners[:, :, 2].mean(axis=1), -up * areas[:, 2]
        steep = downwards > math.sqrt(0.5) * np.linalg.norm(areas, axis=1)
        return float(np.sum((downwards * (height - np.min(up * self.vertices[:, 2])))[steep]))

    def surface_points(self, parts: int = 4) -> Array:
        """Points (n, 3), mm, of a grid on every triangle, ``parts`` steps along each edge, to measure deviations."""
        grid = [(i, j) for i in range(parts + 1) for j in range(parts + 1 - i)]
        weights = np.array([(i, j, parts - i - j) for i, j in grid], float) / parts
        return np.asarray(np.einsum("wk,mkd->mwd", weights, self.corners).reshape(-1, 3))


_EDGE_COSINE = math.cos(math.radians(40))
"""Cosine of the least angle between two triangles that share an edge of the part: facets of an arc meet at less."""


def corner_normals(body: Body) -> Array:
    """Unit normals (m, 3, 3) at the three corners of every triangle of a body.

    The normal at a corner is the mean over the triangles that share its vertex and lean by at most 40 degrees from its
    triangle, weighted by their angles at the vertex (Thürmer and Wüthrich 1998, DOI 10.1080/10867651.1998.10487487).
    """
    face, angle = _face_normals(body.corners)
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


def _face_normals(corners: Array) -> tuple[Array, Array]:
    """Unit normals (m, 3) and corner angles (m, 3; rad) of triangles (m, 3, 3); 0 for triangles of no area."""
    along = corners[:, [1, 2, 0]] - corners
    normal = np.cross(along[:, 0], -along[:, 2])
    area = np.linalg.norm(normal, axis=1)
    before = -along[:, [2, 0, 1]]
    angle = np.arctan2(area[:, None], np.einsum("ijk,ijk->ij", along, before))
    known = area > 1e-12
    return np.where(known[:, None], normal / np.maximum(area, 1e-30)[:, None], 0.0), angle * known[:, None]


def _pairs(start: Index, stop: Index) -> tuple[Index, Index]:
    """Pairs of a row k and an index from ``start[k]`` up to but not ``stop[k]``, row after row: two arrays (n,)."""
    count = stop - start
    owner = np.repeat(np.arange(count.size), count)
    return owner, np.arange(owner.size) - np.repeat(np.cumsum(count) - count - start, count)


_SAME = 1e-9
"""Greatest difference (mm) of equal heights: computed from the same numbers, they differ only by rounding."""

_CLEAR = 0.05
"""Material in mm that must remain between a hole and the edge of its face, and between two holes."""


@dataclass(frozen=True, slots=True)
class _Hole:
    """A bore, the ``count`` of vertices of each end circle, and the first vertex of the lower and the upper circle."""

    bore: Bore
    count: int
    lower: int
    upper: int


def drilled(rings: RevolvedRings, bores: tuple[Bore, ...], tolerance: float) -> tuple[Array, Indices] | None:
    """Vertices (n, 3) and triangles (m, 3) of a turned body with its bores; None if a bore must be cut from its mesh.

    It must be cut if it opens outside flat faces or nearer than `_CLEAR` to an edge or another bore. The rings use half
    of ``tolerance`` (mm), the circles of the straight bores all of it.
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
    """Numbers of the flat strips in which bores open, with the indices of these bores; None as in `drilled`."""
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
    """True if strip ``k`` lies flat at ``height`` (mm) and leaves more than `_CLEAR` of material around a bore."""
    one, other = (rings.rings[index] for index in rings.pairs[k])
    if abs(one.height - height) > _SAME or abs(other.height - height) > _SAME:
        return False
    centre = math.hypot(bore.x, bore.y)
    inner, outer = sorted((one.radius, other.radius))
    clear_inside = inner == 0.0 or centre - bore.radius > inner + _CLEAR
    return clear_inside and centre + bore.radius < outer - _CLEAR


def _circle(bore: Bore, count: int, height: float) -> Array:
    return np.column_stack([circle_points(bore.radius, count) + np.array([bore.x, bore.y]), np.full(count, height)])


def _perforated(points: Array, rings: RevolvedRings, k: int, holes: list[_Hole]) -> Indices:
    """Triangles (m, 3) of the flat strip ``k`` with holes, facing to the same side as the strip."""
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
    # A meridian runs counter-clockwise, so it goes inwards on a face that looks up.
    return triangles if inwards else triangles[:, ::-1]


def _wall(hole: _Hole) -> list[Indices]:
    """Arrays (m, 3) of triangles: the wall of a hole, facing its axis, and its bottom if it has one."""
    k = np.arange(hole.count)
    after = (k + 1) % hole.count
    low, high = hole.lower, hole.upper
    strips = [np.column_stack([low + k, high + k, low + after]), np.column_stack([low + after, high + k, high + after])]
    if hole.bore.closed:
        fan = np.column_stack([np.zeros(hole.count - 2, int), k[1:-1], k[2:]])
        # The bottom faces the mouth: upwards in a hole that is closed below.
        strips.append(low + fan if hole.bore.closed == "low" else high + fan[:, ::-1])
    return strips


@dataclass(frozen=True)
class Solid:
    """One body as exact shapes, mm. ``role`` is its function: membrane, connector, ring, plug, coupon ...

    ``base`` is a meridian about the z axis or a prism. First ``adds`` are joined to it; then ``bores`` and ``cuts`` are
    removed. Bores lie wholly inside the solid and do not touch one another.
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
        """Meridian of a turned body. Raises TypeError for a prism."""
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
        """Distances (n,) of points (n, 3), mm, from the nearest surface of any of its shapes, covered parts too."""
        shapes = [self.base, *self.bores, *(feature.shape for feature in (*self.adds, *self.cuts))]
        return np.asarray(np.min([shape.distance(points) for shape in shapes], axis=0))

    def deviation(self, body: Body) -> float:
        """Greatest distance in mm of a mesh of the solid from its exact surface, measured on dense points."""
        return float(self.distance(body.surface_points()).max())

    def mesh(self, tolerance: float) -> Body:
        """The body with its print mesh, within ``tolerance`` mm of the exact surface."""
        (vertices, triangles), bores = self._drilled(tolerance)
        tools: list[Shape] = [*bores, *(feature.shape for feature in self.cuts)]
        if self.adds or tools:
            parts = [feature.shape.mesh(tolerance) for feature in self.adds]
            vertices, triangles = _combined((vertices, triangles), parts, [tool.mesh(tolerance) for tool in tools])
        return Body(self.name, self.role, self.material, vertices, triangles)

    def _drilled(self, tolerance: float) -> tuple[tuple[Array, Indices], tuple[Bore, ...]]:
        """Mesh of the base, with its bores if all can be meshed directly, and the bores still to be cut."""
        if not isinstance(self.base, Meridian):
            return self.base.mesh(tolerance), self.bores
        rings = revolve_rings(self.base, tolerance)
        built = drilled(rings, self.bores, tolerance) if self.bores else None
        if built is not None:
            return built, ()
        return (rings.vertices, np.concatenate(rings.strips)), self.bores


_DIGITS = 6
"""Decimals, mm, to which the corners that a boolean leaves are told apart."""


def _combined(
    base: tuple[Array, Indices], adds: list[tuple[Array, Indices]], cuts: list[tuple[Array, Indices]]
) -> tuple[Array, Indices]:
    """Mesh of ``base`` with the meshes ``adds`` joined to it and then the meshes ``cuts`` removed."""
    from manifold3d import Manifold, OpType

    whole = manifold_of(*base)
    if adds:
        whole = Manifold.batch_boolean([whole, *starmap(manifold_of, adds)], OpType.Add)
    if cuts:
        whole = Manifold.batch_boolean([whole, *starmap(manifold_of, cuts)], OpType.Subtract)
    vertices, triangles = mesh_of(whole)
    # A tool that nearly meets an edge leaves triangles too narrow for a file in float32: their ends become one.
    _, kept, index = np.unique(np.round(vertices, _DIGITS), axis=0, return_index=True, return_inverse=True)
    if kept.size == len(vertices):
        return vertices, triangles
    joined = index.reshape(-1)[triangles]
    return vertices[kept], joined[(joined != np.roll(joined, 1, axis=1)).all(axis=1)]
