"""The table of a pad's exported reader: the cell's answers on nodes between which it goes straight, and objects from
which its fits start."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from pneutouch.arrays import Array, Indices
from pneutouch.mechanics.touch.cell import RADII, TABLE_ERROR, TILTS, CellTable
from pneutouch.mechanics.touch.forward import ObjectKind, PadModel
from pneutouch.mechanics.touch.objects import KINDS, answer_of, random_objects
from pneutouch.units import KPA

_BENDS, _SHARES, _LEANS = 7, 19, 7
"""Nodes of curvature, offset and lean: 140 kB."""
STARTS = (192, 64, 384)
"""Number of objects of `KINDS` from which a fit starts."""
STRAIGHT = 0.003
"""Error of rises between the nodes over the greatest of a reading: root mean square (tests/export/reader)."""
_OF_EACH = 40
"""Number of random objects from which each of those is chosen."""
_SEED = 1
_TOUCHED = 4.0
"""Rise in standard deviations of the gauge from which a cell counts as touched."""


def reader_table(model: PadModel, noise_kPa: float, model_error: float = TABLE_ERROR / 3.0) -> Mapping[str, Any]:
    """The table as data; ``noise_kPa`` is the standard deviation of a gauge, ``model_error`` that of the prediction
    over the greatest rise of a reading. Numbers are rounded to those of float32."""
    radius = model.table.radius
    random = np.random.default_rng(_SEED)
    drawn = [random_objects(model, kind, _OF_EACH * size, random) for kind, size in zip(KINDS, STARTS, strict=True)]
    return {
        "places_mm": _single(model.places),
        "gains": _single(model.gain),
        "table_of": model.table_of.tolist(),
        "noise_kPa": _single(noise_kPa),
        "touched_kPa": _single(_TOUCHED * noise_kPa),
        "model_error": _single(np.hypot(model_error, STRAIGHT)),
        "radius_mm": _single(radius),
        "top_mm": _single(model.top),
        "bends": _single([radius / size for size in reversed(model.radii)]),
        "steepest": _single(TILTS[-1]),
        "spreads": [_single(objects.std(axis=0)) for objects in drawn],
        "tables": [_nodes_of(table, radius) for table in model.tables],
        "starts": [
            _starts(model, kind, objects, size, noise_kPa)
            for kind, objects, size in zip(KINDS, drawn, STARTS, strict=True)
        ],
    }


def _nodes_of(table: CellTable, unit: float) -> Mapping[str, Any]:
    """The table of a cell as data; ``unit`` is the inner radius over which curvatures count."""
    bends = np.linspace(1.0 / RADII[-1], 1.0 / RADII[0], _BENDS)
    shares, leans = np.linspace(0.0, 1.0, _SHARES), np.linspace(0.0, TILTS[-1], _LEANS)
    axes = (bends, shares), (np.ones(1), leans), (bends, shares)
    nodes = [table.straight(f"{kind}s", *axis) for kind, axis in zip(KINDS, axes, strict=True)]
    return {
        "outer_mm": _single(table.outer),
        "depth_mm": _single(table.depth),
        "bends": _single(bends[[0, -1]] * unit / table.radius),
        "nodes": [
            {"first_mm": _single(first), "reach_mm": _single(reach), "values": _single(values / [1.0, 1.0, 1.0, KPA])}
            for first, reach, values in nodes
        ],
    }


def _starts(model: PadModel, kind: ObjectKind, objects: Array, count: int, noise_kPa: float) -> list[dict[str, Any]]:
    """Objects whose readings are as far apart as can be, with their rises on the scale on which the nearest is."""
    scaled = np.arcsinh(answer_of(model, kind, objects).rise / KPA / (_TOUCHED * noise_kPa))
    return [{"object": _single(objects[k]), "scaled_rises": _single(scaled[k])} for k in _apart(scaled, count)]


def _apart(points: Array, count: int) -> Indices:
    """Numbers of ``count`` of the points (m, n), each the one farthest from those before it."""
    chosen = [0]
    distance = np.square(points - points[0]).sum(axis=1)
    while len(chosen) < count:
        chosen.append(int(distance.argmax()))
        distance = np.minimum(distance, np.square(points - points[chosen[-1]]).sum(axis=1))
    return np.array(chosen)


def _single(values: Any) -> Any:
    return np.asarray(values, dtype=np.float32).astype(float).tolist()
