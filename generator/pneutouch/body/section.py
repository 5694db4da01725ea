"""Points inside a solid and its sections at a height z, from its exact shapes without a mesh; sections across y.

An outline is cut exactly at a level. A piece includes its lower end but not its upper end, and a point on a crossing
counts as beyond it: where two bodies meet, a point belongs to exactly one of them.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.body.shapes import Bore, Prism, Shape, Turned, sample
from pneutouch.body.solid import Body, Solid, manifold_of
from pneutouch.shape.meridian import Arc, Line, Meridian, Segment

_ON_AXIS = 1e-9
"""Distance from the axis (mm) within which a crossing counts as on it."""


@dataclass(frozen=True, slots=True)
class RisingPiece:
    """Part of an outline that crosses each level from ``low`` to ``high`` (mm) once; ``side``: which half of an arc."""

    low: float
    high: float
    piece: Segment
    side: float = 1.0

    def at(self, level: Array) -> Array:
        """First coordinate (mm) of the crossings at levels (mm; array of any shape)."""
        piece = self.piece
        if isinstance(piece, Arc):
            inside = np.maximum(piece.radius**2 - (level - piece.centre[1]) ** 2, 0.0)
            return np.asarray(piece.centre[0] + self.side * np.sqrt(inside))
        (r0, z0), (r1, z1) = piece.start, piece.end
        if r0 == r1:
            return np.full(np.shape(level), r0)
        # Computed from the lower end for either direction: two bodies that share the piece get the same numbers.
        (r0, z0), (r1, z1) = sorted([(r0, z0), (r1, z1)], key=lambda point: point[1])
        return np.asarray(r0 + (level - z0) * ((r1 - r0) / (z1 - z0)))


def rises(outline: Sequence[Segment]) -> tuple[RisingPiece, ...]:
    """Parts of an outline that cross each level once; an outline with two ends on the axis is closed along it."""
    if math.dist(outline[0].start, outline[-1].end) > _ON_AXIS:
        outline = [*outline, Line(outline[-1].end, outline[0].start, "axis")]
    starts = [piece.start[1] for piece in outline]
    pieces: list[RisingPiece] = []
    for k, piece in enumerate(outline):
        # Levels at which pieces meet are taken from one of them, so that rounding opens no gap.
        for first, last, side in _monotone(piece, starts[k], starts[(k + 1) % len(starts)]):
            if first != last:
                pieces.append(RisingPiece(min(first, last), max(first, last), piece, side))
    return tuple(pieces)


def crossings(parts: Sequence[RisingPiece], level: float) -> list[float]:
    """First coordinates (mm) at which a level crosses the outline, ascending: in, out, in, out."""
    radii = [float(part.at(np.asarray(level))) for part in parts if part.low <= level < part.high]
    return sorted(0.0 if abs(r) < _ON_AXIS else r for r in radii)


def encloses(parts: Sequence[RisingPiece], along: Array, level: Array) -> Flags:
    """Mask (n,) of the points (along, level), arrays (n,) in mm, inside the outline made of ``parts``."""
    inside = np.zeros(len(along), bool)
    for part in parts:
        at = part.at(level)
        at = np.where(np.abs(at) < _ON_AXIS, 0.0, at)
        inside ^= (part.low <= level) & (level < part.high) & (along >= at)
    return inside


def _monotone(piece: Segment, first: float, last: float) -> list[tuple[float, float, float]]:
    """Monotone parts of ``piece``, an arc cut at its extremes: first and last level, side of the centre (+1 or -1)."""
    if not isinstance(piece, Arc):
        return [(first, last, 1.0)]
    low, high = sorted((piece.first, piece.last))
    turns = range(math.floor(low / math.pi - 0.5) + 1, math.ceil(high / math.pi - 0.5))
    tops = [(k + 0.5) * math.pi for k in turns]
    angles = [piece.first, *(tops if piece.first < piece.last else reversed(tops)), piece.last]
    levels = [first, *(piece.centre[1] + piece.radius * math.sin(a) for a in angles[1:-1]), last]
    middles = [0.5 * (a + b) for a, b in pairwise(angles)]
    return [(levels[k], levels[k + 1], math.copysign(1.0, math.cos(m))) for k, m in enumerate(middles)]


@dataclass(frozen=True)
class Window:
    """Rows and columns of a level section to evaluate, by the coordinates x (c,) and y (r,) of their centres, mm."""

    x: Array
    y: Array

    @cached_property
    def squares(self) -> Array:
        """Squared distances (r, c) of the centres from the z axis, mm2."""
        return np.asarray(self.y[:, None] ** 2 + self.x[None, :] ** 2)

    def within(self, low: Array, high: Array) -> tuple[slice, slice]:
        """Slices of the rows and the columns inside a box with corners (x, y, ...), mm; x and y may also descend."""
        return places_within(self.y, low[1], high[1]), places_within(self.x, low[0], high[0])


@dataclass(frozen=True)
class _Tool:
    """A shape with the corners ``low`` and ``high`` (3,) of its bounding box and its outline (empty for a bore)."""

    shape: Shape
    low: Array
    high: Array
    outline: tuple[RisingPiece, ...]


def _inside(tool: _Tool, points: Array) -> Flags:
    """Mask (n,) of the points (n, 3) in mm inside the shape of a tool."""
    shape = tool.shape
    if isinstance(shape, Bore):
        near = (points[:, 0] - shape.x) ** 2 + (points[:, 1] - shape.y) ** 2 < shape.radius**2
        return np.asarray(near & (shape.low <= points[:, 2]) & (points[:, 2] < shape.high))
    assert isinstance(shape, Turned | Prism)
    local = shape.frame.into(points)
    if isinstance(shape, Turned):
        return encloses(tool.outline, np.hypot(local[:, 0], local[:, 1]), local[:, 2])
    inside = encloses(tool.outline, local[:, 0], local[:, 1])
    return np.asarray(inside & (shape.low <= local[:, 2]) & (local[:, 2] < shape.high))


class SolidSection:
    """Tests for points inside a solid; bounding boxes and outlines are computed once for all tests."""

    def __init__(self, solid: Solid) -> None:
        base = solid.base
        self._turned = rises(base.pieces) if isinstance(base, Meridian) else None
        self._base = _tool(Turned(base) if isinstance(base, Meridian) else base)
        self._adds = [_tool(feature.shape) for feature in solid.adds]
        self._cuts = [*map(_tool, solid.bores), *(_tool(feature.shape) for feature in solid.cuts)]
        boxes = [self._base, *self._adds]
        self.low: Array = np.min([tool.low for tool in boxes], axis=0)
        self.high: Array = np.max([tool.high for tool in boxes], axis=0)

    def contains(self, points: Array) -> Flags:
        """Mask (n,) of the points (n, 3) in mm that lie inside the solid."""
        inside = _inside(self._base, points)
        for tool in self._adds:
            inside |= _inside(tool, points)
        for tool in self._cuts:
            inside &= ~_inside(tool, points)
        return inside

    def section(self, window: Window, z: float) -> Flags:
        """Mask (r, c) of the centres of the window that lie inside the solid at height ``z`` mm."""
        inside = np.zeros((len(window.y), len(window.x)), bool)
        if self._turned is None:
            _mark(inside, window, z, self._base, True)
        else:
            for edge in crossings(self._turned, z):
                inside ^= window.squares >= edge * edge
        for tool in self._adds:
            _mark(inside, window, z, tool, True)
        for tool in self._cuts:
            _mark(inside, window, z, tool, False)
        return inside


def _mark(inside: Flags, window: Window, z: float, tool: _Tool, value: bool) -> None:
    """Set ``inside`` (r, c) to ``value`` at the window's centres that lie inside a tool at height ``z`` mm."""
    if not tool.low[2] <= z <= tool.high[2]:
        return
    box = window.within(tool.low, tool.high)
    y, x = window.y[box[0]], window.x[box[1]]
    if not len(x) or not len(y):
        return
    points = np.column_stack([np.tile(x, len(y)), np.repeat(y, len(x)), np.full(len(x) * len(y), z)])
    part = inside[box]
    part[_inside(tool, points).reshape(part.shape)] = value


def _tool(shape: Shape) -> _Tool:
    outline: tuple[RisingPiece, ...] = ()
    if isinstance(shape, Bore):
        low = np.array([shape.x - shape.radius, shape.y - shape.radius, shape.low])
        return _Tool(shape, low, np.array([shape.x + shape.radius, shape.y + shape.radius, shape.high]), outline)
    assert isinstance(shape, Turned | Prism)
    if isinstance(shape, Turned):
        outline = rises(shape.meridian.pieces)
        radius, bottom, top = shape.meridian.bounds()
        corners = np.array([[x, y, z] for x in (-radius, radius) for y in (-radius, radius) for z in (bottom, top)])
    else:
        outline = rises(shape.outline)
        boxes = np.array([piece.bounds() for piece in shape.outline])
        wide, tall = (boxes[:, 0].min(), boxes[:, 1].max()), (boxes[:, 2].min(), boxes[:, 3].max())
        corners = np.array([[x, y, z] for x in wide for y in tall for z in (shape.low, shape.high)])
    moved = shape.frame.out(corners)
    return _Tool(shape, moved.min(axis=0), moved.max(axis=0), outline)


def places_within(centres: Array, low: float, high: float) -> slice:
    """Places in ascending ``centres`` (n,) of those from ``low`` to ``high``; an empty slice if there are none."""
    held = np.flatnonzero((centres >= low) & (centres <= high))
    return slice(int(held[0]), int(held[-1]) + 1) if len(held) else slice(0, 0)


_ASIDE = 1e-4
"""Offset of the plane that cuts a mesh, mm: at y = 0 itself it would meet whole rows of vertices."""


def section_outline(solid: Solid, tolerance: float) -> list[Array]:
    """Loops (n, 2) of (x, z) in mm where the plane y = 0 cuts a solid, within ``tolerance`` mm.

    For a turned body with no more than bores they come from its meridian and the bores that the plane meets, in a tenth
    of the time of meshing and cutting. Other solids are meshed and cut.
    """
    if not isinstance(solid.base, Meridian) or solid.adds or solid.cuts:
        return mesh_outline(solid.mesh(tolerance))
    loops, holes = _turned(solid.base, tolerance), [_opening(bore) for bore in solid.bores if abs(bore.y) < bore.radius]
    return _without(loops, holes) if holes else loops


def _turned(meridian: Meridian, tolerance: float) -> list[Array]:
    """Loops (n, 2) of both sides of a meridian: one if it ends on the axis, two if it closes away from the axis."""
    right = np.array([(ring.radius, ring.height) for ring in sample(meridian, tolerance)])
    left = right[::-1] * np.array([-1.0, 1.0])
    if meridian.is_ring:
        return [right, left]
    return [np.concatenate([right, left[left[:, 0] < 0.0]])]


def _opening(bore: Bore) -> Array:
    """Corners (4, 2) in (x, z) of the rectangle that a bore removes, 1 mm past open faces as in `Bore.mesh`."""
    half = math.sqrt(bore.radius**2 - bore.y**2)
    low = bore.low if bore.closed == "low" else bore.low - 1.0
    high = bore.high if bore.closed == "high" else bore.high + 1.0
    x = bore.x + half * np.array([-1.0, 1.0, 1.0, -1.0])
    return np.stack([x, [low, low, high, high]], axis=1)


def _without(loops: list[Array], holes: list[Array]) -> list[Array]:
    from manifold3d import CrossSection

    return [np.asarray(loop) for loop in (CrossSection(loops) - CrossSection(holes)).to_polygons()]


def mesh_outline(body: Body, height: float = 0.0) -> list[Array]:
    """Loops (n, 2) of (x, z) in mm where the plane y = ``height`` - 1e-4 mm (`_ASIDE`) cuts the mesh of a body."""
    whole = manifold_of(body.vertices[:, [0, 2, 1]] * np.array([1.0, 1.0, -1.0]), body.triangles)
    return [np.asarray(loop) for loop in whole.slice(_ASIDE - height).to_polygons()]
