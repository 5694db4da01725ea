"""Faces, edges and smooth face groups of a triangle mesh."""

from dataclasses import dataclass
from functools import cached_property
from typing import cast

import numpy as np

from pneutouch.arrays import Array, Flags, Indices
from pneutouch.printability.measure.joined import components

CREASE = np.radians(40.0)
"""Turn from which on an edge is a drawn one; below, edges approximate a curve: nine sides and more count as round."""

_OCTAGON = np.radians(46.0)
_EQUAL = 0.05
"""Relative difference in width up to which the faces at an edge count as equal. Edges that turn no more than a regular
octagon's then approximate a curve, as on the meshes of the smallest circles; chamfers of 45 degrees do not."""

_FLAT = 1e-4
"""Faces that turn less (radians) are one flat face."""


_ARC = np.radians(25.0)
"""Edges that turn less than this count as chords of a curve when the error of a mesh is judged: 15 to a circle."""


@dataclass(frozen=True)
class Edges:
    """Edges of a closed mesh: vertices (e, 2), the faces on both sides (e, 2), and the normal's turn (e,), radians.

    ``turn`` is positive where the surface is convex; the angle inside the body is pi less it.
    """

    ends: Indices
    faces: Indices
    turn: Array


@dataclass(frozen=True)
class SurfaceMesh:
    """A closed mesh, vertices (n, 3) in mm and triangles (m, 3), facing outwards."""

    vertices: Array
    triangles: Indices

    @cached_property
    def corners(self) -> Array:
        """Triangle corners, (m, 3, 3)."""
        return self.vertices[self.triangles]

    @cached_property
    def _crosses(self) -> Array:
        a, b, c = np.moveaxis(self.corners, 1, 0)
        return np.cross(b - a, c - a)

    @cached_property
    def areas(self) -> Array:
        """Areas of the triangles, (m,), mm2."""
        return cast(Array, 0.5 * np.linalg.norm(self._crosses, axis=1))

    @cached_property
    def normals(self) -> Array:
        """Outward unit normals, (m, 3); zero for a triangle without area."""
        length = 2 * self.areas[:, None]
        return np.divide(self._crosses, length, out=np.zeros_like(self._crosses), where=length > 0)

    @cached_property
    def edges(self) -> Edges:
        """Every edge once; the mesh must be closed."""
        ends = self.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        face = np.repeat(np.arange(len(self.triangles)), 3)
        low, high = ends.min(axis=1), ends.max(axis=1)
        order = np.lexsort((ends[:, 0], high, low))
        pairs = order.reshape(-1, 2)
        faces = face[pairs]
        normal = self.normals[faces]
        turn = np.arctan2(
            np.linalg.norm(np.cross(normal[:, 0], normal[:, 1]), axis=1),
            np.einsum("ij,ij->i", normal[:, 0], normal[:, 1]),
        )
        ahead = self.corners.mean(axis=1)[faces[:, 1]] - self.vertices[ends[pairs[:, 0], 0]]
        convex = np.einsum("ij,ij->i", ahead, normal[:, 0]) <= 0
        flat = (self.areas[faces] <= 0).any(axis=1)
        return Edges(ends[pairs[:, 0]], faces, np.where(flat, 0.0, np.where(convex, turn, -turn)))

    @cached_property
    def creases(self) -> Flags:
        """True for edges that are drawn ones, not only of the mesh, (e,)."""
        edges, turn = self.edges, np.abs(self.edges.turn)
        drawn: Flags = turn >= CREASE
        rows = np.flatnonzero(drawn & (turn <= _OCTAGON))
        if len(rows):
            flat = self._joined(turn < _FLAT)
            areas = np.bincount(flat, weights=self.areas)
            # The width of a flat face over an edge is its area over the edge's length, which both sides have in common.
            low, high = np.sort(areas[flat[edges.faces[rows]]], axis=1).T
            drawn[rows] = high > (1 + _EQUAL) * low
        return drawn

    def _joined(self, smooth: Flags) -> Indices:
        """Number of the group of each triangle, (m,); triangles join over the edges that are ``smooth`` (e,)."""
        pairs = self.edges.faces[smooth]
        return components(len(self.triangles), pairs[:, 0], pairs[:, 1])

    @cached_property
    def groups(self) -> Indices:
        """Number of the smooth face group of each triangle, (m,): faces joined over edges that are no crease."""
        return self._joined(~self.creases)

    @cached_property
    def sagittas(self) -> Array:
        """Height of the arc over each smooth edge's two faces, (e,), mm: the mesh's error at a curve; 0 at creases.

        A circle that turns by t over a face of width w has the radius w/t, so the sagitta w t/8.
        """
        edges = self.edges
        along = self.vertices[edges.ends[:, 1]] - self.vertices[edges.ends[:, 0]]
        length = np.maximum(np.linalg.norm(along, axis=1), 1e-12)
        # The narrower of both faces: where a drawn edge of a few degrees ends a long face, that face is not its chord.
        width = self.areas[edges.faces].min(axis=1) * 2 / length
        turn = np.abs(edges.turn)
        return np.where(turn < _ARC, width * turn / 8, 0.0)

    @cached_property
    def group_turns(self) -> Array:
        """The greatest turn between two faces of each smooth group, (groups,), radians."""
        smooth = ~self.creases
        widest = np.zeros(int(self.groups.max()) + 1)
        np.maximum.at(widest, self.groups[self.edges.faces[smooth, 0]], np.abs(self.edges.turn[smooth]))
        return widest

    @cached_property
    def chord_error(self) -> tuple[float, int]:
        """Error of the mesh against its curves, mm, and the edge with it: the sagitta that a tenth of the length of a
        face group's curved edges exceeds, in the worst group. Single edges between faces of two curves do not count."""
        edges, sagittas = self.edges, self.sagittas
        curved = np.flatnonzero(sagittas > 1e-9)
        if not len(curved):
            return 0.0, 0
        ends = self.vertices[edges.ends[curved]]
        length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        group = self.groups[edges.faces[curved, 0]]
        order = np.lexsort((sagittas[curved], group))
        total = np.cumsum(length[order])
        last = np.append(np.flatnonzero(np.diff(group[order])), len(order) - 1)
        before = np.concatenate([[0.0], total[last[:-1]]])
        rows = order[np.searchsorted(total, before + 0.9 * (total[last] - before))]
        worst = curved[rows[int(sagittas[curved[rows]].argmax())]]
        return float(sagittas[worst]), int(worst)

    @cached_property
    def _corner_normals(self) -> Array:
        """Unit normals at each triangle's corners, (m, 3, 3), averaged over the smooth group's faces there by angle."""
        a, b, c = np.moveaxis(self.corners, 1, 0)
        sides = [(b - a, c - a), (c - b, a - b), (a - c, b - c)]
        angles = np.stack(
            [np.arctan2(np.linalg.norm(np.cross(u, v), axis=1), np.einsum("ij,ij->i", u, v)) for u, v in sides], axis=1
        )
        key = self.triangles * (int(self.groups.max()) + 1) + self.groups[:, None]
        _, number = np.unique(key.reshape(-1), return_inverse=True)
        weighted = (angles[:, :, None] * self.normals[:, None, :]).reshape(-1, 3)
        sums: Array = np.stack([np.bincount(number, weights=weighted[:, k]) for k in range(3)], axis=1)
        sums = sums / np.maximum(np.linalg.norm(sums, axis=1, keepdims=True), 1e-30)
        return cast(Array, sums[number].reshape(-1, 3, 3))

    def smooth_normals(self, faces: Indices, points: Array) -> Array:
        """Outward unit normals of the smooth surface that the mesh stands for, (n, 3), at points on given faces."""
        a, b, c = np.moveaxis(self.corners[faces], 1, 0)
        twice = np.maximum(2 * self.areas[faces], 1e-30)
        weights = np.stack(
            [np.linalg.norm(np.cross(u - points, v - points), axis=1) / twice for u, v in ((b, c), (c, a), (a, b))],
            axis=1,
        )
        mixed = np.einsum("nk,nkd->nd", weights, self._corner_normals[faces])
        return cast(Array, mixed / np.maximum(np.linalg.norm(mixed, axis=1, keepdims=True), 1e-30))


SPACING = 0.5
"""Distance of the points, mm, on parts small enough (see `MOST`)."""

MOST = 9000
"""Number of points of a part; a larger one gets a wider spacing, and still one point on every face group."""

_INSET = 0.02
"""Distance of a point near an edge from it, mm."""

_GOLDEN = (0.7548776662466927, 0.5698402909980532)
"""Steps of the R2 sequence, which fills a square evenly (Roberts 2018): powers of 1/1.3247, the plastic number."""


@dataclass(frozen=True)
class SurfaceSamples:
    """Points (n, 3) in mm, the face each lies on (n,), and the area each stands for (n,), mm2.

    Points right near drawn edges stand for no area: they are there because a taper is thinnest at its edge.
    """

    points: Array
    faces: Indices
    areas: Array


def sample(surface: SurfaceMesh, spacing: float = SPACING, most: int = MOST) -> SurfaceSamples:
    """Spread points by area, and put one in the middle of the largest face of every smooth group at least.

    Every face of a mesh with fewer than ``most`` faces gets one: curved faces are cut finely, so they are seen finely.
    """
    areas = surface.areas
    counts = _counts(surface, spacing, most)
    faces = np.repeat(np.arange(len(areas)), counts)
    first = np.concatenate([[0], np.cumsum(counts)[:-1]])
    serial = np.arange(len(faces)) - first[faces]
    u, v = np.mod(0.5 + np.outer(serial, _GOLDEN), 1.0).T
    fold = u + v > 1
    u, v = np.where(fold, 1 - u, u), np.where(fold, 1 - v, v)
    # A single point sits in the middle; the first of the sequence does not.
    u, v = (np.where(counts[faces] == 1, 1 / 3, w) for w in (u, v))
    weights = 0.98 * np.column_stack([1 - u - v, u, v]) + 0.02 / 3
    points = np.einsum("nk,nkd->nd", weights, surface.corners[faces])
    near, near_faces = _near_edges(surface, spacing)
    return SurfaceSamples(
        np.concatenate([points, near]),
        np.concatenate([faces, near_faces]),
        np.concatenate([areas[faces] / counts[faces], np.zeros(len(near_faces))]),
    )


def _near_edges(surface: SurfaceMesh, spacing: float) -> tuple[Array, Indices]:
    """Points on both faces near each drawn edge, in its middle and, where it is long, near its ends."""
    edges = surface.edges
    drawn = np.flatnonzero(surface.creases)
    ends = surface.vertices[edges.ends[drawn]]
    long = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) > 2 * spacing
    points, faces = [], []
    for share, rows in ((0.5, np.arange(len(drawn))), (0.03, np.flatnonzero(long)), (0.97, np.flatnonzero(long))):
        on_edge = (1 - share) * ends[rows, 0] + share * ends[rows, 1]
        for side in (0, 1):
            face = edges.faces[drawn[rows], side]
            inwards = surface.corners[face].mean(axis=1) - on_edge
            length = np.linalg.norm(inwards, axis=1, keepdims=True)
            points.append(on_edge + inwards * np.minimum(_INSET / np.maximum(length, _INSET), 0.3))
            faces.append(face)
    return np.concatenate(points), np.concatenate(faces)


def _counts(surface: SurfaceMesh, spacing: float, most: int) -> Indices:
    """Number of points of each face, (m,)."""
    areas = surface.areas
    quota = max(spacing**2, float(areas.sum()) / most)
    steps = np.floor(np.concatenate([[0.0], np.cumsum(areas)]) / quota + 0.5)
    counts = np.diff(steps).astype(np.int64)
    if len(areas) <= most:
        return cast(Indices, np.maximum(counts, areas > 0))
    order = np.lexsort((areas, surface.groups))
    last = np.append(np.flatnonzero(np.diff(surface.groups[order])), len(order) - 1)
    counts[order[last]] = np.maximum(counts[order[last]], 1)
    return counts
