"""Sheets across the block with a sine or a sum of sines on top: a section, sampled to tolerance and drawn across."""

import math

import numpy as np

from pneutouch.arrays import Array
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
)
from pneutouch.spec.specimen import RandomPhase, Sinusoid

Wave = tuple[tuple[float, ...], tuple[float, ...], float]
"""Pitches (mm), phases (radians) and the amplitude (mm) of every sine."""


def _wave(layer: Sinusoid | RandomPhase, context: PatternContext) -> Wave:
    if isinstance(layer, Sinusoid):
        pitch = layer.pitch(context.speed)
        return (pitch,), (-2 * math.pi * layer.offset_mm / pitch,), layer.amplitude_mm
    pitches = layer.pitches(context.speed)
    phases = np.random.default_rng(layer.seed).uniform(0.0, 2 * math.pi, len(pitches))
    return tuple(pitches), tuple(round(float(phase), 6) for phase in phases), layer.amplitude_mm


def _samples(wave: Wave, start: float, end: float, tolerance: float) -> tuple[Array, Array]:
    """Positions along the path, so dense that chords keep the tolerance, and heights of the sum of sines there, mm."""
    pitches, phases, amplitude = wave
    curvature = sum(amplitude * (2 * math.pi / pitch) ** 2 for pitch in pitches)
    count = max(2, math.ceil((end - start) / math.sqrt(8 * tolerance / curvature)))
    x = np.round(np.linspace(start, end, count + 1), DECIMALS)
    sines = [np.sin(2 * math.pi * (x - start) / pitch + phase) for pitch, phase in zip(pitches, phases, strict=True)]
    return x, np.asarray(amplitude * np.sum(sines, axis=0))


def _section(layer: Sinusoid | RandomPhase, context: PatternContext, number: int) -> tuple[Array, Array, float]:
    """Positions along the path, heights of the top, and height of the flat bottom, mm."""
    check_least(context, number, "height_mm", layer.height_mm, "wall")
    least = context.least_matrix()
    if layer.depth_mm < least - 1e-9:
        raise context.refuse(
            number,
            "depth_mm",
            layer.depth_mm,
            f"the matrix would thin to nothing over the crests; it must be at least {least:g} mm, the "
            f"thinnest wall of {context.matrix.label} on the {context.printer.title}",
        )
    start, end = along(layer, context)
    wave = _wave(layer, context)
    key = layer.period_key()
    check_count(context, number, key, min(wave[0]), 60 * (end - start) / min(wave[0]))
    x, rise = _samples(wave, start, end, context.tolerance)
    top = np.round(context.block.high[2] - layer.depth_mm + rise - rise.max(), DECIMALS)
    return x, top, round(float(top.min()) - layer.height_mm, DECIMALS)


def box(layer: Sinusoid | RandomPhase, context: PatternContext, number: int) -> Box:
    """The box around the sheet."""
    x, top, floor = _section(layer, context, number)
    low, high = context.block.low[1], context.block.high[1]
    return Box((float(x[0]), low, floor), (float(x[-1]), high, float(top.max())))


def draw(layer: Sinusoid | RandomPhase, context: PatternContext, number: int) -> PatternGeometry:
    """Geometry of the sheet, with its exact volume under the sampled section."""
    x, top, floor = _section(layer, context, number)
    pitches, phases, amplitude = _wave(layer, context)
    low, high = context.block.low[1], context.block.high[1]
    area = float(np.sum(0.5 * (top[1:] + top[:-1] - 2 * floor) * np.diff(x)))
    return PatternGeometry(
        _swept(x, top, floor, low, high),
        box(layer, context, number),
        pitches,
        {"amplitude_mm": amplitude, "phases_rad": list(phases), "start_mm": float(x[0])},
        area * (high - low),
    )


def _swept(x: Array, top: Array, floor: float, low: float, high: float) -> Mesh:
    """Solid between a line of heights and a flat floor, extruded from y = low to y = high."""
    n = len(x)
    section = np.concatenate([np.column_stack([x, np.full(n, floor)]), np.column_stack([x, top])])
    near, far = (np.column_stack([section[:, 0], np.full(2 * n, y), section[:, 1]]) for y in (low, high))
    k = np.arange(n - 1)
    a, b, c, d = k, k + 1, n + k + 1, n + k
    m = 2 * n
    caps = [np.column_stack([a, b, c]), np.column_stack([a, c, d])]
    triangles = [*caps, *(m + cap[:, ::-1] for cap in caps)]
    for one, other in ((b, a), (d, c)):
        triangles += [np.column_stack([one, other, m + other]), np.column_stack([one, m + other, m + one])]
    for here, there in ((0, n), (2 * n - 1, n - 1)):
        triangles += [np.array([[here, there, m + there], [here, m + there, m + here]])]
    return Mesh(np.concatenate([near, far]), np.concatenate(triangles).astype(np.int64))


FAMILY = PatternFamily(box, draw)
