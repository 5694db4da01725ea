"""Error of a reader against the model that it was made from, at states that its grid does not hold."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from pneutouch.errors import ComputationError
from pneutouch.evaluation.reader import CHANGE_K, CHANGE_KPA, REFERENCE_K, ReaderCurve, ReaderGrid, curve_of, fine
from pneutouch.export.reader.reading import CELSIUS, ForceReader, Status
from pneutouch.mechanics import Sensor, predict
from pneutouch.units import KPA

if TYPE_CHECKING:
    from pneutouch.evaluation.evaluate import Evaluation

STATES = 10_000
"""Number of compared states if a press costs next to nothing."""

_PRESSES = {"atlas": 100, "membrane": 100}
_FEW = 4
"""Presses compared where each costs seconds."""

_READ = (Status.OK, Status.ABOVE_RATING)


class ReaderDifference(NamedTuple):
    """Largest difference of the force from the full model, N; ``states`` of those as tared have a force."""

    nominal_N: float
    other_conditions_N: float
    states: int


def reader_difference(evaluation: Evaluation, grid: ReaderGrid, record: dict[str, Any]) -> ReaderDifference:
    """Compare a reader with the full model at random states of its box, the same ones each time.

    Once as tared, once at other temperatures of the gas and at other ambient pressures.
    """
    draw = np.random.default_rng(0)
    presses = _PRESSES.get(grid.model, _FEW)
    each = STATES // presses
    reader, sensor = ForceReader(record), evaluation.sensor
    pressures = np.sort(draw.uniform(grid.low, grid.high, presses))
    nominal = _curves(evaluation, sensor, grid, pressures)
    differences: list[float] = []
    for pressure, curve in zip(pressures, nominal, strict=True):
        if reader.tare([float(pressure) / KPA]) in _READ:
            differences += _differences(reader, float(pressure), curve, draw.uniform(0.0, 1.0, each), {})
    if not differences:
        raise ComputationError(
            "the reader gives no force at any state of its box", remedy="take another gauge or range"
        )
    others = [0.0]
    for change_kPa in (-CHANGE_KPA, CHANGE_KPA):
        changed = sensor.replace(ambient_pressure=sensor.gas.ambient_pressure + change_kPa * KPA)
        some = pressures[:: max(1, presses // 10)]
        for pressure, curve in zip(some, _curves(evaluation, changed, grid, some), strict=True):
            for conditions in _tared(reader, changed, float(pressure), curve, grid):
                others += _differences(reader, float(pressure), curve, draw.uniform(0.0, 1.0, 50), conditions)
    return ReaderDifference(max(differences), max(others), len(differences))


def _curves(evaluation: Evaluation, sensor: Sensor, grid: ReaderGrid, pressures: Any) -> list[ReaderCurve]:
    prediction = predict(
        evaluation.scene.name,
        fine(sensor).replace(steps=97),
        [float(p) for p in pressures],
        model=grid.model,
        closure=evaluation.options.closure,
    )
    return [curve_of(state, sensor) for state in prediction.states]


def _tared(
    reader: ForceReader, sensor: Sensor, pressure: float, curve: ReaderCurve, grid: ReaderGrid
) -> Iterator[dict[str, float]]:
    """Tare so that the gas, warmer or colder since, has the driving pressure of a curve (MPa); conditions then."""
    ambient = sensor.gas.ambient_pressure
    for change in (-CHANGE_K, CHANGE_K):
        ratio = 1.0 + change / REFERENCE_K
        content_before = (pressure + ambient) * curve.gas_volume / ratio
        content = (grid.gas_pressure + ambient) * grid.gas_volume
        before = float(np.interp(content_before, content, grid.gas_pressure))
        status = reader.tare([before / KPA], REFERENCE_K - CELSIUS, ambient / KPA)
        if status in _READ:
            yield {"temperature_C": REFERENCE_K * ratio - CELSIUS, "ambient_pressure_kPa": ambient / KPA}


def _differences(
    reader: ForceReader, pressure: float, curve: ReaderCurve, shares: Any, conditions: dict[str, float]
) -> list[float]:
    depths = shares * curve.indentation[-1]
    forces, rises = (np.interp(depths, curve.indentation, column) for column in (curve.force, curve.rise))
    readings = [reader.read(float(pressure + rise) / KPA, **conditions) for rise in rises]
    return [
        abs(reading.force_N - float(force))
        for reading, force in zip(readings, forces, strict=True)
        if reading.status in _READ
    ]
