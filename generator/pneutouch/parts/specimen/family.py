"""Interface of a family of patterns, with the boxes, meshes and checks that the families share."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from pneutouch.arrays import Array, Indices
from pneutouch.body import Solid
from pneutouch.body.solid import enclosed_volume, is_closed, welded
from pneutouch.errors import InputError, shown
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer
from pneutouch.spec.specimen import Layer

Point3 = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Box:
    """A box with edges along the axes between two corners, mm."""

    low: Point3
    high: Point3

    @property
    def volume(self) -> float:
        """Volume, mm3."""
        a, b, c = (high - low for low, high in zip(self.low, self.high, strict=True))
        return a * b * c

    def gap(self, other: "Box") -> float:
        """Greatest gap along an axis between the boxes, mm; negative if they overlap."""
        return max(max(self.low[k] - other.high[k], other.low[k] - self.high[k]) for k in range(3))


@dataclass(frozen=True)
class Mesh:
    """``vertices`` (n, 3) in mm and ``triangles`` (m, 3), counter-clockwise seen from outside."""

    vertices: Array
    triangles: Indices

    @property
    def volume(self) -> float:
        """Volume in mm3 by the divergence theorem; the mesh must be closed."""
        return enclosed_volume(self.vertices, self.triangles)

    def is_closed(self) -> bool:
        """True if every edge is shared by exactly two triangles, before and after vertices are merged in float32."""
        vertices, triangles = welded(self.vertices, self.triangles)
        return is_closed(self.triangles, len(self.vertices)) and is_closed(triangles, len(vertices))

    def compact(self) -> "Mesh":
        """The mesh without unused vertices."""
        used = np.zeros(len(self.vertices), bool)
        used[self.triangles.reshape(-1)] = True
        number = np.cumsum(used) - 1
        return Mesh(self.vertices[used], number[self.triangles].astype(np.int64))


def joined(meshes: list[Mesh]) -> Mesh:
    """One mesh of several that do not touch one another."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    return Mesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate([mesh.triangles + start for mesh, start in zip(meshes, starts, strict=False)]),
    )


def snapped(mesh: Mesh, box: Box, slack: float) -> Mesh:
    """The mesh with coordinates within ``slack`` mm of a side of the box moved onto that side."""
    vertices = mesh.vertices.copy()
    for axis in range(3):
        for side in (box.low[axis], box.high[axis]):
            column = vertices[:, axis]
            column[np.abs(column - side) <= slack] = side
    return Mesh(vertices, mesh.triangles)


MOST_TRIANGLES = 3_000_000
"""Greatest number of triangles of one pattern: about 1.5 GiB of memory and a 3MF file of 60 MB, beyond which tray
software was not tried (our choice)."""

DECIMALS = 4
"""Decimals of coordinates, a grid of 0.1 um: two faces are either the same or clearly apart."""


@dataclass(frozen=True)
class PatternContext:
    """The block in which a pattern is drawn, and its file for messages; ``speed`` in mm/s, ``tolerance`` in mm."""

    block: Box
    printer: Printer
    matrix: Material
    inclusion: Material
    speed: float
    tolerance: float
    where: str

    def refuse(self, number: int, key: str, value: Any, right: str) -> InputError:
        """Error for one value of a layer: names file, layer, key and value; ``right`` states what would be valid."""
        given = f"{value:g}" if isinstance(value, float | int) else shown(value)
        return InputError(f"layer[{number}].{key} = {given}: {right}", file=self.where)

    def least(self, kind: str) -> float:
        """Smallest wall or pin in mm that the printer makes of the patterns' material."""
        smallest = self.printer.smallest
        feature = smallest.wall(self.inclusion.kind) if kind == "wall" else smallest.pin(self.inclusion.kind)
        return feature.least or feature.recommended

    def least_matrix(self) -> float:
        """Least wall in mm that the printer can make of the matrix material."""
        feature = self.printer.smallest.wall(self.matrix.kind)
        return feature.least or feature.recommended


@dataclass(frozen=True)
class PatternGeometry:
    """A drawn pattern: mesh, filled box, pitches along the path in mm, and further properties in ``truth``.

    ``volume`` is exact if there is an exact shape, else None; ``solids`` are the exact shapes for STEP.
    """

    mesh: Mesh
    box: Box
    pitches: tuple[float, ...]
    truth: dict[str, Any] = field(default_factory=dict)
    volume: float | None = None
    solids: tuple[Solid, ...] = ()


@dataclass(frozen=True)
class PatternFamily:
    """A family: ``box`` returns the box that a pattern will fill, before it is drawn; ``draw`` draws the pattern.

    Both take the layer, the context and the layer's number for messages, and raise InputError for impossible values.
    """

    box: Callable[[Any, PatternContext, int], Box]
    draw: Callable[[Any, PatternContext, int], PatternGeometry]


def along(layer: Layer, context: PatternContext) -> tuple[float, float]:
    """Beginning and end of a layer along the path, mm."""
    end = context.block.high[0] if layer.end_mm is None else layer.end_mm
    return round(layer.start_mm, DECIMALS), round(end, DECIMALS)


def heights(layer: Layer, context: PatternContext, height: float | None) -> tuple[float, float]:
    """Least and greatest z of a layer, mm; without a height it extends to the bottom of the block."""
    top = round(context.block.high[2] - layer.depth_mm, DECIMALS)
    return (context.block.low[2] if height is None else round(top - height, DECIMALS)), top


def check_inside(box: Box, context: PatternContext, number: int, layer: Layer) -> None:
    """Raise InputError if a pattern extends out of the block, or is within a micrometre of a side but not on it."""
    block = context.block
    keys = ("end_mm" if layer.end_mm is not None else "start_mm", "span_mm", "depth_mm")
    for axis, key in enumerate(keys):
        low, high = block.low[axis], block.high[axis]
        if box.low[axis] < low - 1e-9 or box.high[axis] > high + 1e-9:
            size = ("length_mm", "width_mm", "height_mm")[axis]
            raise context.refuse(
                number,
                key,
                getattr(layer, key, high),
                f"the pattern reaches from {box.low[axis]:g} to {box.high[axis]:g} mm along {'xyz'[axis]}; it must "
                f"stay between {low:g} and {high:g} mm, so make it smaller or raise block.{size}",
            )
        for gap in (box.low[axis] - low, high - box.high[axis]):
            if 0 < gap < 1e-3:
                text = f"a gap of {1e3 * gap:.2g} um to the side of the block; make it flush or at least 1 um"
                raise context.refuse(number, key, getattr(layer, key, high), text)


def check_least(context: PatternContext, number: int, key: str, value: float, kind: str, factor: float = 1.0) -> None:
    """Raise InputError where ``factor`` times a value (mm) is thinner than the printer makes a ``kind``."""
    least = context.least(kind)
    if factor * value < least - 1e-9:
        raise context.refuse(
            number,
            key,
            value,
            f"the {context.printer.title} makes no {kind} of {context.inclusion.label} thinner than {least:g} mm; "
            f"it must be at least {least / factor:g} mm",
        )


def check_count(context: PatternContext, number: int, key: str, value: float, triangles: float) -> None:
    """Raise InputError if a pattern would have more triangles than files can carry."""
    if triangles > MOST_TRIANGLES:
        raise context.refuse(
            number,
            key,
            value,
            f"the pattern would take about {triangles / 1e6:.3g} million triangles; the most is "
            f"{MOST_TRIANGLES / 1e6:g} million (about 1.5 GiB), so take a larger cell or pitch, or a smaller block",
        )
