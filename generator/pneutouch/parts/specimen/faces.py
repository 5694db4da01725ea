"""Triangulation of a flat region from its directed boundary edges, in parts: ear clipping is quadratic in the corners.

Also the matrix of a specimen: the block without its inclusion, with the inclusion's own triangles on the common face.

The common face is taken once and reversed, so both bodies have it corner by corner. Only the block's six sides are
triangulated again, around the inclusion's footprints. No boolean is computed, so nothing depends on a tolerance.
"""

import itertools
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array, Flags, Indices, grouped
from pneutouch.errors import ComputationError
from pneutouch.parts.specimen.family import Box, Mesh, Point3

BoxSide = tuple[int, int]
"""A side of a box: axis, and 0 for its low or 1 for its high end."""

SIDES: tuple[BoxSide, ...] = tuple(itertools.product(range(3), range(2)))

_LARGE = 400
"""Number of boundary edges from which a region is cut into parts."""

_PART = 80
"""Number of boundary edges of a part."""

_CLEARANCE = 1e-3
"""Least width in mm of a gap for a cut."""

_CHUNK = 500
"""Number of holes that are compared with all outlines at once."""

_DECIMALS = 4
"""Cuts lie on a grid of 0.1 um, so that those of two sides are either at the same place or clearly apart."""


def boundary(triangles: Indices, size: int) -> Indices:
    """Directed edges (n, 2) that triangles have in one direction only; ``size`` is the number of vertices."""
    edges = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    outward, back = edges[:, 0] * size + edges[:, 1], edges[:, 1] * size + edges[:, 0]
    return np.asarray(edges[~np.isin(outward, back)])


def cut_places(spans: Array) -> list[float]:
    """Places (mm) of straight cuts that meet no span (n, 2), one for about every `_PART`; none below `_LARGE` spans."""
    if len(spans) < _LARGE:
        return []
    order = spans[np.argsort(spans[:, 0], kind="stable")]
    reached = np.maximum.accumulate(order[:-1, 1])
    gaps = np.flatnonzero(order[1:, 0] > reached + _CLEARANCE)
    places, last = [], 0
    for k in gaps.tolist():
        if k - last >= _PART:
            places.append(round(float(0.5 * (reached[k] + order[k + 1, 0])), _DECIMALS))
            last = k
    return places


def rim(points: Array, ends: Array, side: BoxSide) -> list[Indices]:
    """Vertices along the four edges of a box's side, counter-clockwise seen from outside; ``ends`` (2, 3) is the box.

    Each run ends with the corner that the next begins with, where the corners are among ``points`` (n, 3).
    """
    axis, end = side
    u, v = plane(side)
    low, high = ends
    on = points[:, axis] == ends[end, axis]
    runs = []
    for along, across, at, sign in ((u, v, low, 1), (v, u, high, 1), (u, v, high, -1), (v, u, low, -1)):
        index = np.flatnonzero(on & (points[:, across] == at[across]))
        runs.append(index[np.argsort(sign * points[index, along], kind="stable")])
    return runs


def plane(side: BoxSide) -> tuple[int, int]:
    """The two axes of a side, in the order for which counter-clockwise faces outwards."""
    axis, end = side
    return ((axis + 1) % 3, (axis + 2) % 3) if end else ((axis + 2) % 3, (axis + 1) % 3)


def triangulated(points: Array, edges: Indices) -> Indices:
    """Triangles (m, 3) of the region left of directed ``edges`` (n, 2) between plane ``points`` (k, 2); adds no point.

    Raises ComputationError if the edges do not bound a region.
    """
    try:
        groups = _grouped(points, _loops(points, edges))
    except (IndexError, KeyError):
        raise ComputationError(
            "a pattern's footprint leaves no clean face on the block's side; move or resize a layer by 0.1 mm, or "
            "report it"
        ) from None
    filled = [_filled(points, group) for group in groups]
    return np.concatenate(filled) if filled else np.zeros((0, 3), np.int64)


def _loops(points: Array, edges: Indices) -> list[Indices]:
    """The edges chained to loops of vertices; where loops meet in a point, the leftmost turn keeps them apart."""
    leaving: dict[int, list[int]] = grouped(edges.tolist())
    loops = []
    for start in list(leaving):
        while leaving[start]:
            here, loop = start, [start]
            step = leaving[start].pop()
            while step != start:
                loop.append(step)
                before, here = here, step
                step = _leftmost(points, before, here, leaving[here])
            loops.append(np.array(loop))
    return loops


def _leftmost(points: Array, before: int, here: int, exits: list[int]) -> int:
    """Remove and return the exit from ``here`` that turns most to the left."""
    if len(exits) == 1:
        return exits.pop()
    back = points[before] - points[here]

    def turn(vertex: int) -> float:
        out = points[vertex] - points[here]
        # Angle clockwise from the incoming edge: the region lies in between.
        angle = np.arctan2(back[0] * out[1] - back[1] * out[0], back @ out)
        return float(-angle % (2 * np.pi))

    best = min(exits, key=lambda vertex: turn(vertex) or 2 * np.pi)
    exits.remove(best)
    return best


@dataclass
class _Group:
    """An outer loop with its holes."""

    outer: Indices
    holes: list[Indices]


def _grouped(points: Array, loops: list[Indices]) -> list[_Group]:
    """Outer loops with their holes; a hole belongs to the smallest outer loop around it."""
    if not loops:
        return []
    starts = np.cumsum([0, *(len(loop) for loop in loops)])[:-1]
    index = np.concatenate(loops)
    after = _shifted(index, starts)
    (x, y), (x1, y1) = points[index].T, points[after].T
    areas = 0.5 * np.add.reduceat(x * y1 - y * x1, starts)
    lows, highs = np.minimum.reduceat(points[index], starts), np.maximum.reduceat(points[index], starts)
    outer = np.flatnonzero(areas > 0)
    outer = outer[np.argsort(areas[outer], kind="stable")]
    groups = [_Group(loops[k], []) for k in outer.tolist()]
    holes = np.flatnonzero(areas <= 0)
    for chunk in np.array_split(holes, 1 + len(holes) // _CHUNK):
        within = (lows[outer] <= lows[chunk, None]) & (highs[outer] >= highs[chunk, None])
        around: Flags = np.asarray(within.all(axis=2))
        for k, row in zip(chunk.tolist(), around, strict=True):
            inside = np.flatnonzero(row).tolist()
            if len(inside) > 1:
                inside = [g for g in inside if _holds(points[groups[g].outer], points[loops[k]])]
            groups[inside[0]].holes.append(loops[k])
    return groups


def _shifted(index: Indices, starts: Indices) -> Indices:
    """Next vertex of each vertex in its loop."""
    after = np.roll(index, -1)
    after[np.append(starts[1:], len(index)) - 1] = index[starts]
    return after


def _holds(outline: Array, line: Array) -> bool:
    """True if a loop lies inside an outline, by the middle of its first edge; the two may touch only in corners."""
    x, y = 0.5 * (line[0] + line[1])
    (x0, y0), (x1, y1) = outline.T, np.roll(outline, -1, axis=0).T
    level = np.where(y1 == y0, 1.0, y1 - y0)
    crosses = ((y0 > y) != (y1 > y)) & (x < x0 + (y - y0) * (x1 - x0) / level)
    return bool(np.count_nonzero(crosses) % 2)


def _filled(points: Array, group: _Group) -> Indices:
    from manifold3d import triangulate

    outer = group.outer
    if not group.holes and len(outer) == 4 and _convex(points[outer]):
        return np.asarray(outer[np.array([[0, 1, 2], [0, 2, 3]])])
    loops = [outer, *group.holes]
    flat = triangulate([np.ascontiguousarray(points[loop]) for loop in loops])
    return np.asarray(np.concatenate(loops)[np.asarray(flat)].astype(np.int64))


def _convex(corners: Array) -> bool:
    outward = np.roll(corners, -1, axis=0) - corners
    after = np.roll(outward, -1, axis=0)
    return bool((outward[:, 0] * after[:, 1] - outward[:, 1] * after[:, 0] > 0).all())


def complement(box: Box, inclusion: Mesh) -> Mesh:
    """The box minus a closed inclusion inside it; inclusion faces on the box's sides must lie exactly on them.

    Raises ComputationError if the inclusion touches itself or the box's edges so that no solid is left.
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
        """Mesh of the matrix."""
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
        """Directed edges around the inclusion's footprints on a side."""
        return boundary(self._inclusion.triangles[self._footprints[side]], len(self._inclusion.vertices))

    def _cut(self, side: BoxSide) -> list[tuple[int, int]]:
        """Straight cuts along z or y through a side that extends along x: pairs of vertices on its opposite edges."""
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
        """Number of an added vertex; two sides cut at the same place share it."""
        return self._extra.setdefault((point[0], point[1], point[2]), len(self._vertices) + len(self._extra))

    def _rest(self, side: BoxSide) -> Indices:
        """Triangles of a side around the footprints, facing outwards."""
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
    """The vertices, followed by those corners of the box that are not among them."""
    at = (vertices[:, None, :] == ends[None]).any(axis=1).all(axis=1) if len(vertices) else np.zeros(0, bool)
    there = {tuple(point) for point in vertices[at].tolist()}
    missing = [corner for corner in corners.tolist() if tuple(corner) not in there]
    return np.concatenate([vertices, np.array(missing).reshape(-1, 3)])
