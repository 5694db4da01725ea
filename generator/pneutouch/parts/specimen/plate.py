"""The rigid frame under a specimen: a plate with a hole in each corner and letters, conforming with the block on it."""

from collections.abc import Sequence

import numpy as np

from pneutouch.arrays import Array, Indices
from pneutouch.body.shapes import circle_count, circle_points
from pneutouch.parts.specimen.faces import boundary, triangulated
from pneutouch.parts.specimen.family import Box, Mesh

CORNER = 0.5
"""Share of the border that is cut off at the corner x = y = 0, to show the orientation of the specimen."""


def holes(block: Box, border: float) -> list[tuple[float, float]]:
    """Middles (x, y) of the mounting holes, mm: in the middle of the border, one in each corner."""
    (x0, y0, _), (x1, y1, _) = block.low, block.high
    half = 0.5 * border
    return [(x0 - half, y0 - half), (x1 + half, y0 - half), (x1 + half, y1 + half), (x0 - half, y1 + half)]


def plate(
    block: Box,
    bodies: Sequence[Mesh],
    border: float,
    thickness: float,
    diameter: float,
    tolerance: float,
    letters: Sequence[Array] = (),
    depth: float = 0.0,
) -> Mesh:
    """The plate, with its top at the bottom of the block; lengths in mm.

    ``bodies`` stand on it: their triangles on that plane are reused, reversed. ``letters`` are plane loops (n, 2), with
    the solid of a letter to their left, cut ``depth`` deep into the top next to the block.
    """
    top = block.low[2]
    made = _Mesh()
    under = [made.taken(body, top) for body in bodies]
    edges = [boundary(np.concatenate(under), len(made))]
    edges[0] = edges[0][:, ::-1] if len(edges[0]) else edges[0]
    bottom_edges: list[Indices] = []
    around = outline(block, border)
    high, low = made.ring(around, top), made.ring(around, top - thickness)
    edges.append(_loop(high))
    bottom_edges.append(_loop(low))
    made.wall(low, high)
    count = circle_count(0.5 * diameter, tolerance)
    rim = circle_points(0.5 * diameter, count)
    for middle in holes(block, border):
        mouth, end = made.ring(rim + middle, top), made.ring(rim + middle, top - thickness)
        edges.append(_loop(mouth)[:, ::-1])
        bottom_edges.append(_loop(end)[:, ::-1])
        made.wall(mouth, end)
    floor: list[Indices] = []
    for line in letters:
        mouth, end = made.ring(line, top), made.ring(line, top - depth)
        edges.append(_loop(mouth)[:, ::-1])
        floor.append(_loop(end))
        made.wall(mouth, end)
    points = made.points()
    flat = [_up(points, edges), _up(points, bottom_edges)[:, ::-1], *([_up(points, floor)] if floor else [])]
    return Mesh(points, np.concatenate([*under, *made.walls, *flat])).compact()


class _Mesh:
    """Vertices in the order in which they are added, and walls between rings of them."""

    def __init__(self) -> None:
        self._parts: list[Array] = []
        self._size = 0
        self._known: dict[tuple[float, ...], int] = {}
        self.walls: list[Indices] = []

    def __len__(self) -> int:
        return self._size

    def points(self) -> Array:
        """All vertices, (n, 3)."""
        return np.concatenate(self._parts)

    def taken(self, body: Mesh, top: float) -> Indices:
        """Triangles of a body on the plane z = ``top``, reversed; bodies share their vertices by position."""
        flat = body.triangles[(body.vertices[:, 2] == top)[body.triangles].all(axis=1)]
        used = np.unique(flat)
        number = np.zeros(len(body.vertices), np.int64)
        fresh: list[Array] = []
        for k in used.tolist():
            key = tuple(body.vertices[k].tolist())
            if key not in self._known:
                self._known[key] = self._size + len(fresh)
                fresh.append(body.vertices[k])
            number[k] = self._known[key]
        if fresh:
            self._add(np.array(fresh))
        return np.asarray(number[flat][:, ::-1])

    def ring(self, line: Array, height: float) -> Indices:
        """Numbers of the vertices of a loop, added at a height."""
        start = self._size
        self._add(np.column_stack([line, np.full(len(line), height)]))
        return np.arange(start, self._size)

    def wall(self, low: Indices, high: Indices) -> None:
        """Add the strip between two rings; it faces right of their direction if ``low`` is the lower ring."""
        a, b = low, np.roll(low, -1)
        c, d = high, np.roll(high, -1)
        self.walls += [np.column_stack([a, b, d]), np.column_stack([a, d, c])]

    def _add(self, points: Array) -> None:
        self._parts.append(points)
        self._size += len(points)


def outline(block: Box, border: float) -> Array:
    """Corners (5, 2) of the plate, mm, counter-clockwise from the cut corner."""
    (x0, y0, _), (x1, y1, _) = block.low, block.high
    left, right, near, far, cut = x0 - border, x1 + border, y0 - border, y1 + border, CORNER * border
    return np.array([[left + cut, near], [right, near], [right, far], [left, far], [left, near + cut]])


def _loop(ring: Indices) -> Indices:
    return np.column_stack([ring, np.roll(ring, -1)])


def _up(points: Array, edges: Sequence[Indices]) -> Indices:
    return triangulated(points[:, :2], np.concatenate(list(edges)))
