"""The matrix of a specimen: what its inclusion leaves of the block, with the inclusion's own triangles where they meet.

The common face is taken once and turned round, so both bodies have it corner by corner. Only the block's six sides are
triangulated again, around the inclusion's footprints. No boolean is made, so nothing depends on a tolerance.
"""

import itertools

import numpy as np

from pneutouch.arrays import Array, Indices
from pneutouch.parts.specimen.faces import SIDES, BoxSide, boundary, cut_places, plane, rim, triangulated
from pneutouch.parts.specimen.mesh import Box, Mesh, Point3


def complement(box: Box, inclusion: Mesh) -> Mesh:
    """The box without a closed inclusion inside it, whose faces on the box's sides lie on them exactly.

    Raises ComputationError if the inclusion touches itself or the box's edges in a way that leaves no solid.
    """
    return _Partition(box, inclusion).matrix()


class _Partition:
    """The vertices of both bodies, and the footprints of the inclusion on each side."""

    def __init__(self, box: Box, inclusion: Mesh) -> None:
        self._ends = np.array([box.low, box.high])
        self._inclusion = inclusion
        corners = np.array(list(itertools.product(*self._ends.T)))
        self._vertices = _with(inclusion.vertices, corners, self._ends)
        self._footprints = {side: self._on(side) for side in SIDES}
        self._extra: dict[Point3, int] = {}
        self._cuts = {side: self._cut(side) for side in SIDES}
        self._vertices = np.concatenate([self._vertices, np.array(list(self._extra)).reshape(-1, 3)])

    def matrix(self) -> Mesh:
        """The matrix."""
        on_sides = np.zeros(len(self._inclusion.triangles), bool)
        for mask in self._footprints.values():
            on_sides |= mask
        parts = [self._inclusion.triangles[~on_sides][:, ::-1], *(self._rest(side) for side in SIDES)]
        return Mesh(self._vertices, np.concatenate(parts)).compact()

    def _on(self, side: BoxSide) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
        axis, end = side
        at = self._inclusion.vertices[:, axis] == self._ends[end, axis]
        return np.asarray(at[self._inclusion.triangles].all(axis=1))

    def _outline(self, side: BoxSide) -> Indices:
        """Directed edges of the footprints on a side."""
        return boundary(self._inclusion.triangles[self._footprints[side]], len(self._inclusion.vertices))

    def _cut(self, side: BoxSide) -> list[tuple[int, int]]:
        """Straight cuts along z or y through a side that x runs along: pairs of vertices on its opposite edges."""
        axis, end = side
        if axis == 0:
            return []
        ends = self._vertices[self._outline(side)][:, :, 0]
        other = 3 - axis
        points = np.zeros((2, 3))
        points[:, axis], points[:, other] = self._ends[end, axis], self._ends[:, other]
        spans = []
        for place in cut_places(np.sort(ends, axis=1)):
            points[:, 0] = place
            low, high = (self._number(point) for point in points.tolist())
            spans.append((low, high))
        return spans

    def _number(self, point: list[float]) -> int:
        """Number of an extra vertex; two sides that are cut at one place share it."""
        return self._extra.setdefault((point[0], point[1], point[2]), len(self._vertices) + len(self._extra))

    def _rest(self, side: BoxSide) -> Indices:
        """Indices of a side around the footprints, facing outwards."""
        size, outline = len(self._vertices), self._outline(side)
        runs = rim(self._vertices, self._ends, side)
        around = np.concatenate([np.column_stack([run[:-1], run[1:]]) for run in runs])
        code, covered = around[:, 0] * size + around[:, 1], outline[:, 0] * size + outline[:, 1]
        inner = outline[~np.isin(covered, code)][:, ::-1]
        free = around[~np.isin(code, covered)]
        cuts = np.array([(a, b) for pair in self._cuts[side] for a, b in (pair, pair[::-1])], np.int64).reshape(-1, 2)
        edges = np.concatenate([free, inner, cuts])
        return triangulated(self._vertices[:, plane(side)], edges) if len(edges) else np.zeros((0, 3), np.int64)


def _with(vertices: Array, corners: Array, ends: Array) -> Array:
    """The vertices and those corners of the box that are not among them."""
    at = (vertices[:, None, :] == ends[None]).any(axis=1).all(axis=1) if len(vertices) else np.zeros(0, bool)
    there = {tuple(point) for point in vertices[at].tolist()}
    missing = [corner for corner in corners.tolist() if tuple(corner) not in there]
    return np.concatenate([vertices, np.array(missing).reshape(-1, 3)])
