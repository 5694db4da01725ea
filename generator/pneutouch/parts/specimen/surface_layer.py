"""The family of minimal surfaces: checked, levelled to the volume fraction or thickness required, and drawn."""

from pneutouch.parts.specimen.family import (
    PatternContext,
    PatternFamily,
    PatternGeometry,
    along,
    check_count,
    check_least,
    heights,
)
from pneutouch.parts.specimen.mesh import Box
from pneutouch.parts.specimen.surfaces import PeriodicSurface, fill, fraction_of
from pneutouch.spec.specimen import MinimalSurface

_PER_CELL = 7.0
"""Triangles of a sheet per step of the grid squared and per cell's area of its two faces, measured, rounded up."""


def box(layer: MinimalSurface, context: PatternContext, number: int) -> Box:
    """The box that it fills: whole width, cells from its least corner."""
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
    """The body, with the fraction that it has as measured on its mesh."""
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
