"""The family of strut lattices: checked, sized to the required volume fraction, and drawn."""

import itertools
import math

import numpy as np

from pneutouch.arrays import Array
from pneutouch.body.revolve import circle_count
from pneutouch.errors import ComputationError
from pneutouch.parts.specimen.family import (
    PatternContext,
    PatternFamily,
    PatternGeometry,
    along,
    check_count,
    check_least,
    heights,
)
from pneutouch.parts.specimen.mesh import Box, Mesh
from pneutouch.parts.specimen.struts import STRUTS, Lattice, fill, half_cells, octant
from pneutouch.spec.specimen import StrutLattice

_SAMPLES = 28
"""Samples along each side of an octant for the first guess of a radius."""

_LARGEST = 0.85
"""Greatest radius over the distance at which no matrix is left: beyond it slivers remain (our choice)."""

_CLOSE = 1e-3
"""Relative error of the fraction at which the search stops."""

_TRIES = 8


def box(layer: StrutLattice, context: PatternContext, number: int) -> Box:
    """The box that the lattice fills: whole width, cells from its least corner."""
    cell = layer.pitch(context.speed)
    start, end = along(layer, context)
    low, high = heights(layer, context, layer.height_mm)
    around = Box((start, context.block.low[1], low), (end, context.block.high[1], high))
    for axis, key in ((0, "cell_mm"), (1, "cell_mm"), (2, "height_mm" if layer.height_mm else "cell_mm")):
        if around.high[axis] - around.low[axis] < 0.5 * cell - 1e-9:
            length = around.high[axis] - around.low[axis]
            text = f"half a cell of {cell:.4g} mm does not fit into {length:.4g} mm along {'xyz'[axis]}; take a smaller"
            raise context.refuse(number, key, getattr(layer, key) or cell, text)
    if layer.strut_radius_mm is not None:
        check_least(context, number, "strut_radius_mm", layer.strut_radius_mm, "pin", 2.0)
        most = _LARGEST * _greatest(layer.kind, cell)
        if layer.strut_radius_mm > most:
            raise context.refuse(
                number,
                "strut_radius_mm",
                layer.strut_radius_mm,
                f"leaves no matrix between the struts of a {layer.kind} cell of "
                f"{cell:.4g} mm; it must be at most {most:.3g} mm",
            )
    return around


def draw(layer: StrutLattice, context: PatternContext, number: int) -> PatternGeometry:
    """The lattice, with the radius and the fraction that it has as measured on its mesh."""
    around, cell = box(layer, context, number), layer.pitch(context.speed)
    (a, b, c), _ = half_cells(cell, around)
    first = layer.strut_radius_mm or _guess(layer.kind, cell, layer.volume_fraction or 0.0)
    sides = circle_count(first, context.tolerance)
    check_count(context, number, layer.period_key(), cell, a * b * c * 2.5 * sides * len(STRUTS[layer.kind]))
    if layer.strut_radius_mm is not None:
        lattice = Lattice(layer.kind, cell, layer.strut_radius_mm, sides)
        mesh = fill(lattice, around)
    else:
        lattice, mesh = _solved(layer, context, number, around, sides)
        check_count(context, number, layer.period_key(), cell, len(mesh.triangles))
    truth = {
        "cell_mm": cell,
        "strut_radius_mm": lattice.radius,
        "sides": lattice.sides,
        "volume_fraction": mesh.volume / around.volume,
    }
    return PatternGeometry(mesh, around, (cell,), truth)


def _solved(layer: StrutLattice, context: PatternContext, number: int, around: Box, sides: int) -> tuple[Lattice, Mesh]:
    """The lattice of a volume fraction: by its octant alone where half cells fill the box, else by the whole mesh."""
    cell, target = layer.pitch(context.speed), layer.volume_fraction or 0.0
    _check_fraction(layer, context, number, cell, target)
    _, whole = half_cells(cell, around)
    radius = _guess(layer.kind, cell, target)
    tried: list[tuple[float, float]] = []
    for _ in range(_TRIES):
        lattice = Lattice(layer.kind, cell, radius, sides)
        piece = octant(lattice)
        mesh = piece if whole else fill(lattice, around, piece)
        fraction = mesh.volume / (1.0 if whole else around.volume)
        if abs(fraction - target) <= _CLOSE * target:
            return lattice, fill(lattice, around, piece) if whole else mesh
        tried.append((radius, fraction))
        radius = _next(tried, target)
    raise ComputationError(
        f"layer[{number}].volume_fraction = {target:g}: no strut radius fraction within {_TRIES} steps",
        file=context.where,
        remedy="give strut_radius_mm instead",
    )


def _next(tried: list[tuple[float, float]], target: float) -> float:
    """The next radius: the fraction goes about with its square at first, then along the secant."""
    radius, fraction = tried[-1]
    if len(tried) == 1 or tried[-1][1] == tried[-2][1]:
        return radius * math.sqrt(target / fraction)
    before, was = tried[-2]
    return radius + (target - fraction) * (radius - before) / (fraction - was)


def _check_fraction(layer: StrutLattice, context: PatternContext, number: int, cell: float, target: float) -> None:
    """Raise InputError for a fraction whose struts cannot be printed or leave no matrix."""
    distances = _distances(layer.kind, cell)
    thinnest, thickest = 0.5 * context.least("pin"), _LARGEST * float(distances.max())
    low, high = (float((distances < radius).mean()) for radius in (thinnest, thickest))
    radius = _guess(layer.kind, cell, target)
    if radius > thickest or radius < thinnest:
        raise context.refuse(
            number,
            "volume_fraction",
            target,
            f"{layer.kind} struts in a cell of {cell:.4g} mm would be {2 * radius:.3g} mm thick; "
            + (
                f"it must be from {low:.3f} to {high:.3f}, {2 * thinnest:g} to {2 * thickest:.3g} mm"
                if thinnest < thickest
                else f"no fraction is printable, so take a cell_mm over {cell * thinnest / thickest:.3g}"
            ),
        )


def _guess(kind: str, cell: float, fraction: float) -> float:
    """Radius in mm within which a share ``fraction`` of evenly spread samples lies."""
    return float(np.quantile(_distances(kind, cell), fraction))


def _greatest(kind: str, cell: float) -> float:
    """Radius in mm from which no matrix is left."""
    return float(_distances(kind, cell).max())


def _distances(kind: str, cell: float) -> Array:
    """Distances (n,) in mm of samples in an octant from the nearest strut."""
    lattice = Lattice(kind, cell, 0.3 * cell, 8)
    line = (np.arange(_SAMPLES) + 0.5) / _SAMPLES
    points = np.array(list(itertools.product(line, line, line)))
    distance: Array = 0.5 * cell * lattice.distance(points)
    return distance


FAMILY = PatternFamily(box, draw)
