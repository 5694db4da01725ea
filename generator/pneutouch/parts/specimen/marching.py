"""Level sets of a function on a grid by marching tetrahedra, ended on the sides of the grid's box exactly.

Each cube of the grid is six tetrahedra about its diagonal, the same six everywhere, so neighbours match and no case is
ambiguous: a level set is closed but for its rim on the box, and two level sets of one function never touch.
"""

import itertools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array, Flags, Indices
from pneutouch.parts.specimen.faces import SIDES, BoxSide, boundary, plane, rim, triangulated
from pneutouch.parts.specimen.mesh import Box, Mesh

_NEAREST = 0.01
"""A vertex keeps this share of its edge from the edge's ends: nearer, triangles vanish when a file rounds them."""

_REFINED = 1
"""Steps of regula falsi along the edges after the first guess."""

LevelFunction = Callable[[Array], Array]
"""Values (n,) of a function at points (n, 3), mm."""

_PATHS = tuple(itertools.permutations(range(3)))
"""Paths from a cube's least corner to its greatest; each is a tetrahedron."""


@dataclass(frozen=True)
class MarchingGrid:
    """A box in equal steps, ``counts`` of them along each axis."""

    box: Box
    counts: tuple[int, int, int]

    def lines(self) -> list[Array]:
        """Coordinates of the grid's planes along each axis, mm; the ends are the box's own."""
        ends = zip(self.box.low, self.box.high, self.counts, strict=True)
        return [np.linspace(low, high, count + 1) for low, high, count in ends]

    @property
    def shape(self) -> tuple[int, int, int]:
        """Nodes along each axis."""
        a, b, c = self.counts
        return a + 1, b + 1, c + 1


def level_set(grid: MarchingGrid, wave: LevelFunction, values: Array, level: float) -> Mesh:
    """The surface on which a wave is ``level``, facing upwards; open on the box's sides.

    ``values`` are the wave's at the grid's nodes. Vertices lie on the surface itself, not on its interpolation.
    """
    below = values < level
    keys, tables = [], _cases()
    for path in _PATHS:
        keys += _crossed(below, path, tables)
    edges = np.concatenate(keys) if keys else np.zeros((0, 3), np.int64)
    unique, number = np.unique(edges.reshape(-1), return_inverse=True)
    triangles = number.reshape(-1, 3).astype(np.int64)
    return Mesh(_places(grid, wave, values, level, unique), triangles)


def between(grid: MarchingGrid, wave: LevelFunction, values: Array, low: float | None, high: float) -> Mesh:
    """The closed body in which ``values`` at the grid's nodes are below ``high`` and, if given, not below ``low``."""
    top = level_set(grid, wave, values, high)
    inside = _corners(values) < high
    if low is None:
        return _closed(top, grid.box, inside)
    floor = level_set(grid, wave, values, low)
    both = Mesh(
        np.concatenate([top.vertices, floor.vertices]),
        np.concatenate([top.triangles, floor.triangles[:, ::-1] + len(top.vertices)]),
    )
    return _closed(both, grid.box, inside & (_corners(values) >= low))


def _corners(values: Array) -> Array:
    """Values at the box's corners (8,), z running first."""
    return values[np.ix_((0, -1), (0, -1), (0, -1))].reshape(-1)


def _cases() -> dict[int, list[list[tuple[int, int]]]]:
    """For each set of corners inside, as bits, the triangles as edges of a tetrahedron, for positive orientation."""
    corner = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    table: dict[int, list[list[tuple[int, int]]]] = {}
    for bits in range(1, 15):
        inside = [k for k in range(4) if bits >> k & 1]
        outside = [k for k in range(4) if k not in inside]
        if len(inside) == 2:
            (a, b), (c, d) = inside, outside
            faces = [[(a, c), (a, d), (b, d)], [(a, c), (b, d), (b, c)]]
        else:
            faces = [[(a, c) for a in inside for c in outside]]
        table[bits] = [_facing(corner, face, inside) for face in faces]
    return table


def _facing(corner: Array, face: list[tuple[int, int]], inside: list[int]) -> list[tuple[int, int]]:
    p, q, r = (0.5 * (corner[a] + corner[b]) for a, b in face)
    outwards = np.cross(q - p, r - p) @ (p - corner[inside].mean(axis=0)) > 0
    return face if outwards else face[::-1]


def _crossed(below: Flags, path: tuple[int, ...], tables: dict[int, list[list[tuple[int, int]]]]) -> list[Indices]:
    """Indices in one tetrahedron of every cube, each corner as the key of the grid edge that it lies on."""
    strides = np.array([below.shape[1] * below.shape[2], below.shape[2], 1])
    steps = np.zeros((4, 3), np.int64)
    for k, axis in enumerate(path):
        steps[k + 1 :, axis] += 1
    cells = tuple(slice(0, n - 1) for n in below.shape)
    bits = np.zeros([n - 1 for n in below.shape], np.int8)
    for k, step in enumerate(steps):
        moved = tuple(slice(s.start + d, s.stop + d) for s, d in zip(cells, step, strict=True))
        bits |= below[moved].astype(np.int8) << k
    first = np.flatnonzero((bits > 0) & (bits < 15))
    case = bits.reshape(-1)[first]
    node = np.stack(np.unravel_index(first, bits.shape), axis=1) @ strides
    mirrored = np.linalg.det((steps[1:] - steps[0]).astype(float)) < 0
    keys = []
    for number, faces in tables.items():
        here = node[case == number]
        for face in faces if len(here) else ():
            pairs = [sorted(edge) for edge in (face[::-1] if mirrored else face)]
            keys.append(np.column_stack([_key(here, steps, strides, low, high) for low, high in pairs]))
    return keys


def _key(node: Indices, steps: Indices, strides: Indices, low: int, high: int) -> Indices:
    """A grid edge as one number: its lower node, and which axes it runs along as three bits."""
    towards = int((steps[high] - steps[low]) @ np.array([4, 2, 1]))
    key: Indices = (node + steps[low] @ strides) * 8 + towards
    return key


def _places(grid: MarchingGrid, wave: LevelFunction, values: Array, level: float, keys: Indices) -> Array:
    lower = np.stack(np.unravel_index(keys // 8, grid.shape), axis=1)
    step = np.stack([keys >> 2 & 1, keys >> 1 & 1, keys & 1], axis=1)
    upper = lower + step
    one, other = values[tuple(lower.T)], values[tuple(upper.T)]
    start, end = (
        np.column_stack([line[k] for line, k in zip(grid.lines(), at.T, strict=True)]) for at in (lower, upper)
    )
    near, far = np.zeros(len(keys)), np.ones(len(keys))
    for _ in range(_REFINED):
        share = near + (far - near) * (level - one) / (other - one)
        value = wave(start + share[:, None] * (end - start))
        same = (value < level) == (one < level)
        near, one = np.where(same, share, near), np.where(same, value, one)
        far, other = np.where(same, far, share), np.where(same, other, value)
    share = near + (far - near) * (level - one) / np.where(other == one, 1.0, other - one)
    placed: Array = start + np.clip(share, _NEAREST, 1 - _NEAREST)[:, None] * (end - start)
    return placed


def _closed(surface: Mesh, box: Box, inside: Flags) -> Mesh:
    """The surface with caps on the box's sides; ``inside`` (8,) states which corners of the box belong to the body."""
    ends = np.array([box.low, box.high])
    corners = np.array(list(itertools.product(*ends.T)))
    first = len(surface.vertices)
    points = np.concatenate([surface.vertices, corners])
    open_edges = boundary(surface.triangles, first)
    caps = [_cap(points, ends, open_edges, side, inside, first) for side in SIDES]
    return Mesh(points, np.concatenate([surface.triangles, *caps])).compact()


def _cap(points: Array, ends: Array, open_edges: Indices, side: BoxSide, inside: Flags, first: int) -> Indices:
    """Indices of the body on one side of the box."""
    axis, end = side
    on = (points[open_edges][:, :, axis] == ends[end, axis]).all(axis=1)
    edges = [open_edges[on][:, ::-1]]
    for run in rim(points, ends, side):
        # Along an edge of the box the body begins and ends at every vertex of its surface.
        starts = np.arange(len(run) - 1) % 2 == (0 if inside[run[0] - first] else 1)
        edges.append(np.column_stack([run[:-1], run[1:]])[starts])
    whole = np.concatenate(edges)
    return triangulated(points[:, plane(side)], whole) if len(whole) else np.zeros((0, 3), np.int64)
