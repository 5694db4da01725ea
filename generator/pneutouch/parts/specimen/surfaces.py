"""Minimal surfaces as sheets or networks: level sets of a sum of waves, computed on a grid that ends with the box.

Level sets of a function on a grid by marching tetrahedra end exactly on the sides of the grid's box.

Each cube of the grid is six tetrahedra about its diagonal, the same six everywhere, so neighbours match and no case is
ambiguous: a level set is closed except for its rim on the box, and two level sets of one function never touch.
"""

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from pneutouch.arrays import Array, Flags, Indices
from pneutouch.parts.specimen.faces import SIDES, BoxSide, boundary, plane, rim, triangulated
from pneutouch.parts.specimen.family import (
    Box,
    Mesh,
    PatternContext,
    PatternFamily,
    PatternGeometry,
    along,
    check_count,
    check_least,
    heights,
)
from pneutouch.spec.specimen import MinimalSurface

_NEAREST = 0.01
"""Least distance of a vertex from the ends of its edge, as share of the edge: closer, triangles vanish by rounding."""

_REFINED = 1
"""Number of steps of regula falsi along the edges after the first guess."""

LevelFunction = Callable[[Array], Array]
"""A function with values (n,) at points (n, 3), mm."""

_PATHS = tuple(itertools.permutations(range(3)))
"""Paths from a cube's least corner to its greatest; each defines a tetrahedron."""


@dataclass(frozen=True)
class MarchingGrid:
    """A box divided into equal steps, ``counts`` of them along each axis."""

    box: Box
    counts: tuple[int, int, int]

    def lines(self) -> list[Array]:
        """Coordinates of the grid's planes along each axis, mm; the first and last are exactly those of the box."""
        ends = zip(self.box.low, self.box.high, self.counts, strict=True)
        return [np.linspace(low, high, count + 1) for low, high, count in ends]

    @property
    def shape(self) -> tuple[int, int, int]:
        """Number of nodes along each axis."""
        a, b, c = self.counts
        return a + 1, b + 1, c + 1


def level_set(grid: MarchingGrid, wave: LevelFunction, values: Array, level: float) -> Mesh:
    """Surface on which a wave equals ``level``, facing greater values; open on the box's sides.

    ``values`` are those of the wave at the grid's nodes. Vertices lie on the surface itself, not on its interpolation.
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
    """Values at the box's corners (8,), with z as the fastest index."""
    return values[np.ix_((0, -1), (0, -1), (0, -1))].reshape(-1)


def _cases() -> dict[int, list[list[tuple[int, int]]]]:
    """Triangles for each set of inside corners (as bits), as edges of a tetrahedron with positive orientation."""
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
    """Triangles in one tetrahedron of every cube, each corner as the key of the grid edge on which it lies."""
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
    """Key of a grid edge in one number: its lower node, and the axes along which it runs, as three bits."""
    towards = int((steps[high] - steps[low]) @ np.array([4, 2, 1]))
    return np.asarray((node + steps[low] @ strides) * 8 + towards)


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
    return np.asarray(start + np.clip(share, _NEAREST, 1 - _NEAREST)[:, None] * (end - start))


def _closed(surface: Mesh, box: Box, inside: Flags) -> Mesh:
    """The surface with caps on the box's sides; ``inside`` (8,) is True for box corners that belong to the body."""
    ends = np.array([box.low, box.high])
    corners = np.array(list(itertools.product(*ends.T)))
    first = len(surface.vertices)
    points = np.concatenate([surface.vertices, corners])
    open_edges = boundary(surface.triangles, first)
    caps = [_cap(points, ends, open_edges, side, inside, first) for side in SIDES]
    return Mesh(points, np.concatenate([surface.triangles, *caps])).compact()


def _cap(points: Array, ends: Array, open_edges: Indices, side: BoxSide, inside: Flags, first: int) -> Indices:
    """Triangles of the body on one side of the box."""
    axis, end = side
    on = (points[open_edges][:, :, axis] == ends[end, axis]).all(axis=1)
    edges = [open_edges[on][:, ::-1]]
    for run in rim(points, ends, side):
        # Along an edge of the box the body begins or ends at every vertex of its surface.
        starts = np.arange(len(run) - 1) % 2 == (0 if inside[run[0] - first] else 1)
        edges.append(np.column_stack([run[:-1], run[1:]])[starts])
    whole = np.concatenate(edges)
    return triangulated(points[:, plane(side)], whole) if len(whole) else np.zeros((0, 3), np.int64)


PeriodicFunction = Callable[[Array, Array, Array], Array]
Form = Literal["sheet", "network"]


def _gyroid(x: Array, y: Array, z: Array) -> Array:
    return np.asarray(np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x))


def _schwarz_p(x: Array, y: Array, z: Array) -> Array:
    return np.asarray(np.cos(x) + np.cos(y) + np.cos(z))


def _diamond(x: Array, y: Array, z: Array) -> Array:
    return np.asarray(np.cos(x) * np.cos(y) * np.cos(z) - np.sin(x) * np.sin(y) * np.sin(z))


SURFACES: dict[str, PeriodicFunction] = {"gyroid": _gyroid, "schwarz-p": _schwarz_p, "diamond": _diamond}
"""First nodal approximations; x, y and z in radians, with 2 pi per cell (von Schnering and Nesper 1991)."""

PINCHED: dict[str, float] = {"gyroid": math.sqrt(2.0), "schwarz-p": 1.0, "diamond": math.sqrt(0.5)}
"""Level at which a neck closes, by kind: that of the wave's saddle. Beyond it the body falls apart."""

RADIUS: dict[str, float] = {"gyroid": 0.13, "schwarz-p": 0.16, "diamond": 0.066}
"""Radius of curvature in cells that sets the step of the grid; the resulting deviation is tested."""

_SAMPLES = 48
"""Number of samples along each axis of a cell, at interval centres, for the level of a given fraction."""

_CLOSE = 2e-3
"""Relative error of the volume fraction at which the search for a level stops."""

_TRIES = 5


@dataclass(frozen=True)
class PeriodicSurface:
    """A surface family with its cell in mm, its form, and the chord tolerance of its mesh in mm."""

    kind: str
    cell: float
    form: Form
    tolerance: float

    @property
    def step(self) -> float:
        """Step of the grid in mm that meets the tolerance, from the wave's least radius of curvature."""
        return math.sqrt(8 * self.tolerance * RADIUS[self.kind] * self.cell)

    def grid(self, box: Box) -> MarchingGrid:
        """Grid over a box, with steps as equal as the box allows."""
        step = self.step
        a, b, c = (max(2, math.ceil((high - low) / step)) for low, high in zip(box.low, box.high, strict=True))
        return MarchingGrid(box, (a, b, c))

    def values(self, grid: MarchingGrid) -> Array:
        """Values of the wave at the grid's nodes; cells start at the box's least corner."""
        x, y, z = (2 * np.pi * (line - line[0]) / self.cell for line in grid.lines())
        return self._wave(x[:, None, None], y[None, :, None], z[None, None, :])

    def at(self, box: Box) -> Callable[[Array], Array]:
        """The wave as a function of points (n, 3) in mm; cells start at the box's least corner."""
        low = np.array(box.low)

        def wave(points: Array) -> Array:
            x, y, z = 2 * np.pi * (points - low).T / self.cell
            return self._wave(x, y, z)

        return wave

    def levels(self, level: float) -> tuple[float | None, float]:
        """Levels between which the body lies; the lower is None for a network."""
        return (-level, level) if self.form == "sheet" else (None, level)

    def limits(self) -> tuple[float, float]:
        """Least and greatest volume fraction of one cell for which the body is connected."""
        pinched, wave = PINCHED[self.kind], self._samples()
        if self.form == "sheet":
            return 0.0, float((np.abs(wave) < pinched).mean())
        return float((wave < -pinched).mean()), float((wave < pinched).mean())

    def level(self, fraction: float) -> float:
        """Level at which one cell has a volume fraction, from the quantile of evenly spread samples."""
        wave = self._samples()
        return float(np.quantile(np.abs(wave) if self.form == "sheet" else wave, fraction))

    def _samples(self) -> Array:
        middle = 2 * np.pi * (np.arange(_SAMPLES) + 0.5) / _SAMPLES
        return self._wave(middle[:, None, None], middle[None, :, None], middle[None, None, :]).reshape(-1)

    def _wave(self, x: Array, y: Array, z: Array) -> Array:
        return np.asarray(SURFACES[self.kind](x, y, z))


def fill(surface: PeriodicSurface, box: Box, fraction: float) -> Mesh:
    """Closed body in a box with a volume fraction of the box, accurate to 0.2 % as measured on the mesh."""
    grid = surface.grid(box)
    values, wave = surface.values(grid), surface.at(box)
    level = surface.level(fraction)
    slope = (surface.level(1.02 * fraction) - surface.level(0.98 * fraction)) / (0.04 * fraction)
    mesh = between(grid, wave, values, *surface.levels(level))
    for _ in range(_TRIES):
        missing = fraction - mesh.volume / box.volume
        if abs(missing) <= _CLOSE * fraction:
            break
        level += missing * slope
        mesh = between(grid, wave, values, *surface.levels(level))
    return mesh


def fraction_of(surface: PeriodicSurface, box: Box, thickness: float) -> float:
    """Volume fraction of a sheet whose volume is ``thickness`` mm times the area of its middle surface."""
    grid = surface.grid(box)
    middle = level_set(grid, surface.at(box), surface.values(grid), 0.0)
    a, b, c = np.moveaxis(middle.vertices[middle.triangles], 1, 0)
    area = 0.5 * float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())
    return thickness * area / box.volume


_PER_CELL = 7.0
"""Triangles of a face over its area in squared steps of the grid; measured, rounded up. A cell has 3 cell^2 of face."""


def box(layer: MinimalSurface, context: PatternContext, number: int) -> Box:
    """Box that the body fills: the whole width, with cells from its least corner. Raises InputError."""
    if layer.thickness_mm is not None:
        check_least(context, number, "thickness_mm", layer.thickness_mm, "wall")
    start, end = along(layer, context)
    low, high = heights(layer, context, layer.height_mm)
    around = Box((start, context.block.low[1], low), (end, context.block.high[1], high))
    cell = layer.pitch(context.speed)
    if min(b - a for a, b in zip(around.low, around.high, strict=True)) < 0.5 * cell - 1e-9:
        text = f"half a cell of {cell:.4g} mm does not fit into the layer; take a smaller cell, or a higher layer"
        raise context.refuse(number, "cell_mm", cell, text)
    surface = PeriodicSurface(layer.kind, cell, layer.form, context.tolerance)
    faces = 2 if layer.form == "sheet" else 1
    estimate = _PER_CELL * faces * 3.0 / cell * around.volume / surface.step**2
    check_count(context, number, layer.period_key(), cell, estimate)
    return around


def draw(layer: MinimalSurface, context: PatternContext, number: int) -> PatternGeometry:
    """Geometry of the body, with the volume fraction as measured on its mesh."""
    around, cell = box(layer, context, number), layer.pitch(context.speed)
    surface = PeriodicSurface(layer.kind, cell, layer.form, context.tolerance)
    requested = layer.volume_fraction
    fraction = (
        fraction_of(surface, around, layer.thickness_mm)
        if requested is None and layer.thickness_mm
        else requested or 0.0
    )
    low, high = surface.limits()
    if not low < fraction < high:
        key, value = ("thickness_mm", layer.thickness_mm) if requested is None else ("volume_fraction", requested)
        raise context.refuse(
            number,
            key,
            value,
            f"the {layer.kind} {layer.form} would fill {fraction:.3g} of the layer; it hangs together from "
            f"{low:.3f} to {high:.3f} only",
        )
    mean = fraction / fraction_of(surface, around, 1.0)
    if layer.form == "sheet" and requested is not None and mean < context.least("wall") - 1e-9:
        raise context.refuse(
            number,
            "volume_fraction",
            requested,
            f"the sheet would be {mean:.3g} mm thick on average; the {context.printer.title} makes no "
            f"wall thinner than {context.least('wall'):g} mm, so it must be at least "
            f"{requested * context.least('wall') / mean:.3f}, or take a larger cell_mm",
        )
    mesh = fill(surface, around, fraction)
    truth = {
        "cell_mm": cell,
        "form": layer.form,
        "volume_fraction": mesh.volume / around.volume,
        **({"mean_thickness_mm": mean} if layer.form == "sheet" else {}),
    }
    return PatternGeometry(mesh, around, (cell,), truth)


FAMILY = PatternFamily(box, draw)
