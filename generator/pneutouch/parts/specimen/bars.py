"""Straight bars across the path: built from their corners, flush where they meet a side of the block, never cut."""

import math

import numpy as np

from pneutouch.arrays import Array
from pneutouch.body import Frame, Prism, Solid
from pneutouch.parts.specimen.family import (
    DECIMALS,
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
from pneutouch.shape.meridian import lines_around
from pneutouch.spec.specimen import Bars

_CORNERS = np.array(
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], dtype=np.int64
)
_FACES = np.array([
    [0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7], [0, 1, 5], [0, 5, 4],
    [1, 2, 6], [1, 6, 5], [2, 3, 7], [2, 7, 6], [3, 0, 4], [3, 4, 7],
])  # fmt: skip

_MOST_EXACT = 500
"""Greatest number of bars written to STEP: beyond it Open CASCADE takes minutes."""


def places(layer: Bars, context: PatternContext) -> Array:
    """Positions (n,) of the near sides of the bars along the path, mm: whole bars only."""
    start, end = along(layer, context)
    pitch = layer.pitch(context.speed)
    first = start + layer.offset_mm
    count = math.floor((end - first - layer.width_mm) / pitch + 1e-9) + 1
    return np.asarray(np.round(first + pitch * np.arange(max(count, 0)), DECIMALS))


def box(layer: Bars, context: PatternContext, number: int) -> Box:
    """Box around all bars. Raises InputError for sizes that cannot be printed."""
    pitch = layer.pitch(context.speed)
    check_least(context, number, "width_mm", layer.width_mm, "wall")
    check_least(context, number, "height_mm", layer.height_mm, "wall")
    between = pitch - layer.width_mm
    if between < context.least_matrix() - 1e-9:
        raise context.refuse(
            number,
            "width_mm",
            layer.width_mm,
            f"leaves {between:.4g} mm of matrix between bars at a pitch of {pitch:.4g} mm; the {context.printer.title} "
            f"makes no wall of {context.matrix.label} thinner than {context.least_matrix():g} mm",
        )
    check_count(context, number, layer.period_key(), pitch, 30 * (context.block.high[0] / pitch))
    lefts = places(layer, context)
    if not len(lefts):
        start, end = along(layer, context)
        text = f"no bar {layer.width_mm:g} mm wide fits between {start:g} and {end:g} mm; lower it or raise end_mm"
        raise context.refuse(number, "offset_mm", layer.offset_mm, text)
    low, high = heights(layer, context, layer.height_mm)
    near, far = _across(layer, context)
    return Box((float(lefts[0]), near, low), (float(lefts[-1]) + layer.width_mm, far, high))


def _across(layer: Bars, context: PatternContext) -> tuple[float, float]:
    low, high = context.block.low[1], context.block.high[1]
    if layer.span_mm is None or layer.span_mm == high - low:
        return low, high
    near = round(0.5 * (low + high - layer.span_mm), DECIMALS)
    return near, round(near + layer.span_mm, DECIMALS)


def draw(layer: Bars, context: PatternContext, number: int) -> PatternGeometry:
    """Geometry of the bars, 12 triangles each, with their exact volume."""
    around = box(layer, context, number)
    lefts = places(layer, context)
    rights = np.round(lefts + layer.width_mm, DECIMALS)
    vertices = np.empty((len(lefts), 8, 3))
    vertices[:, :, 0] = np.where(_CORNERS[:, 0] == 1, rights[:, None], lefts[:, None])
    for axis in (1, 2):
        vertices[:, :, axis] = np.array([around.low[axis], around.high[axis]])[_CORNERS[:, axis]]
    triangles = _FACES + 8 * np.arange(len(lefts))[:, None, None]
    side = (around.high[1] - around.low[1]) * (around.high[2] - around.low[2])
    return PatternGeometry(
        Mesh(vertices.reshape(-1, 3), triangles.reshape(-1, 3)),
        around,
        (layer.pitch(context.speed),),
        {"count": len(lefts), "width_mm": layer.width_mm, "first_mm": float(lefts[0]), "offset_mm": layer.offset_mm},
        float((rights - lefts).sum()) * side,
        tuple(
            _solid(context, number, k, float(x), around, float(end))
            for k, (x, end) in enumerate(zip(lefts, rights, strict=True))
        )
        if len(lefts) <= _MOST_EXACT
        else (),
    )


def _solid(context: PatternContext, number: int, k: int, left: float, around: Box, right: float) -> Solid:
    low, high = around.low[2], around.high[2]
    corners = [(left, low), (right, low), (right, high), (left, high)]
    outline = lines_around(corners)
    # The prism's own y is the block's z, so its axis runs against the block's y.
    upright = Frame(axis=(0.0, -1.0, 0.0), across=(1.0, 0.0, 0.0))
    prism = Prism(outline, -around.high[1], -around.low[1], upright)
    return Solid(f"layer-{number + 1}-bar-{k + 1}", "inclusion", context.inclusion, prism)


FAMILY = PatternFamily(box, draw)
