"""A sensor's force over gauge pressure and driving pressure, tabulated for readers in machines.

Error of a reader against the model that it was made from, at states that its grid does not hold.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import ComputationError
from pneutouch.evaluation.calibrated import BEYOND
from pneutouch.evaluation.evaluate import Evaluation
from pneutouch.evaluation.resins import tested_kPa
from pneutouch.export.reader.reading import CELSIUS, ForceReader, Status
from pneutouch.mechanics import Sensor, SensorPrediction, SensorState, predict
from pneutouch.units import KPA

COLUMNS = 41
"""Number of indentations in a row of the grid, from no contact to the end of the range."""

ROWS = {"atlas": 17, "membrane": 17, "local": 17, "solid": 9, "harmonic": 5}
"""Number of driving pressures of the grid by model: the cost of a press differs a thousandfold."""

GAS_ROWS = 65
"""Number of driving pressures at which the gas volume without contact is tabulated."""

CHANGE_K = 5.0
"""Change of the gas temperature since the tare, up and down, that a reader corrects: our choice."""

CHANGE_KPA = 3.0
"""Change of the ambient pressure, up and down, that a reader corrects: our choice, the weather of most days."""

REFERENCE_K = 293.15
"""Temperature, K, from which changes of temperature are counted."""

_LIMIT_SHARE = 0.97
"""Share of the limit point, or of the gauge's limit, up to which the grid goes beyond the design's pressures."""


class ReaderCurve(NamedTuple):
    """A press at one driving pressure within its range: indentation (mm), force (N), pressure rise (MPa), of one
    length and ascending, and the gas volume before contact (cavity and dead volume, mm3)."""

    indentation: Array
    force: Array
    rise: Array
    gas_volume: float


@dataclass(frozen=True)
class ReaderGrid:
    """Force and pressure rise of n driving pressures at m shares of the indentation.

    Attributes:
        driving_pressure: Equal steps, MPa (n,). Rows below zero are extrapolated: see `computed`.
        computed: Index of the first row that the model computed, the number of extrapolated rows.
        reach: Indentation of the last column, mm (n,).
        force: N (n, m), the first column 0, ascending along the rows.
        rise: MPa (n, m), the first column 0, ascending along the rows.
        pressure_factor: Pressure rise of the sensor over that of the gas law, (n,): 1 without a calibration.
        gas_pressure: Equal steps over the same span, MPa (k,).
        gas_volume: Cavity and dead volume without contact at these, mm3 (k,).
        low, high: Lowest and highest driving pressure that may be set, MPa.
        model: Name of the model.
    """

    driving_pressure: Array
    computed: int
    reach: Array
    force: Array
    rise: Array
    pressure_factor: Array
    gas_pressure: Array
    gas_volume: Array
    low: float
    high: float
    model: str

    @property
    def full_scale(self) -> float:
        """Greatest force of the grid's computed rows, N."""
        return float(self.force[self.computed :, -1].max())


def reader_grid(evaluation: Evaluation) -> ReaderGrid:
    """Tabulate a design's sensor. Raises ComputationError if a press has no range, InputError as `predict` does."""
    sensor, options = evaluation.sensor, evaluation.options
    set_to = [pressure_kPa * KPA for pressure_kPa in tested_kPa(evaluation.scene)]
    rows, computed, low, high = _driving_pressures(evaluation, min(set_to), max(set_to))
    computed_rows = [float(p) for p in rows[computed:]]
    prediction = predict(
        evaluation.scene.name,
        fine(sensor),
        computed_rows,
        model=options.model,
        closure=options.closure,
        tolerance=options.tolerance,
    )
    curves = [curve_of(state, sensor, _deepest(evaluation)) for state in prediction.states]
    reach = _common_reach(np.array([curve.indentation[-1] for curve in curves]))
    share = np.linspace(0.0, 1.0, COLUMNS)
    force, rise = (
        np.stack(
            [
                _at(curve.indentation, getattr(curve, name), end * share)
                for curve, end in zip(curves, reach, strict=True)
            ]
        )
        for name in ("force", "rise")
    )
    gas_pressure = np.linspace(rows[0], rows[-1], GAS_ROWS)
    return ReaderGrid(
        driving_pressure=rows,
        computed=computed,
        reach=_continued(reach, computed),
        force=_continued(force, computed),
        rise=_continued(rise, computed),
        pressure_factor=np.array([sensor.correction.at(max(float(p), 0.0))[1] for p in rows]),
        gas_pressure=gas_pressure,
        gas_volume=_gas_volume(prediction, sensor, gas_pressure),
        low=low,
        high=high,
        model=prediction.model,
    )


def fine(sensor: Sensor) -> Sensor:
    """The sensor pressed in at least as many steps as the grid has."""
    return sensor.replace(steps=max(COLUMNS - 1, sensor.protocol.steps))


def _driving_pressures(evaluation: Evaluation, lowest: float, highest: float) -> tuple[Array, int, float, float]:
    """Rows of the grid, index of the first that is not below zero, lowest and highest driving pressure of the box; MPa.

    The box goes beyond the design's driving pressures by the effect of a temperature change of `CHANGE_K`, and the grid
    beyond the box by the effect of the ambient pressure. Below zero the models have no answer.
    """
    ambient = evaluation.sensor.gas.ambient_pressure
    limits = evaluation.prediction.limits
    limit = np.inf if limits.limit_point is None else limits.limit_point
    cap = _LIMIT_SHARE * min(limit, evaluation.sensor.gas.gauge_limit)
    high = max(min(highest + (highest + ambient) * CHANGE_K / REFERENCE_K, cap), highest)
    low = max(lowest - (lowest + ambient) * CHANGE_K / REFERENCE_K, 0.0)
    margin = ambient * CHANGE_K / REFERENCE_K + CHANGE_KPA * KPA
    steps = ROWS[evaluation.prediction.model] - 1
    bottom = low - margin
    if bottom >= 0.0:
        return np.linspace(bottom, high, steps + 1), 0, low, high
    # The parabola below zero goes through three computed rows.
    below = min(max(1, round(steps * -bottom / (high - bottom))), steps - 2)
    step = high / (steps - below)
    return np.asarray(step * np.arange(-below, steps - below + 1)), below, low, high


def curve_of(state: SensorState, sensor: Sensor, deepest: float = np.inf) -> ReaderCurve:
    """The part of a press that a reader may use: up to its range's end, ``deepest`` (mm), or where it turns back.

    Raises ComputationError if nothing is left.
    """
    end = min(state.range_end, deepest)
    kept = int(np.searchsorted(state.indentation, end * (1 + 1e-9), side="right"))
    rising = (np.diff(state.force[:kept]) > 0.0) & (np.diff(state.pressure_rise[:kept]) > 0.0)
    kept = kept if rising.all() else int(np.argmin(rising)) + 1
    if kept < 3:
        raise ComputationError(
            f"at {state.driving_pressure / KPA:.4g} kPa force and pressure do not rise together from first contact: "
            "there is no range to read a force in",
            remedy="take other driving pressures",
        )
    part = slice(0, kept)
    depth, force, rise = (a[part] - a[0] for a in (state.indentation, state.force, state.pressure_rise))
    if rising.all() and end > state.indentation[kept - 1]:
        last = np.append(depth, end - state.indentation[0])
        force, rise = (
            _at(state.indentation - state.indentation[0], a - a[0], last) for a in (state.force, state.pressure_rise)
        )
        depth = last
    return ReaderCurve(depth, force, rise, state.cavity_volume + sensor.gas.dead_volume)


def _at(x: Array, y: Array, at: Array) -> Array:
    from scipy.interpolate import PchipInterpolator

    place, first = np.unique(x, return_index=True)
    return np.asarray(PchipInterpolator(place, y[first])(np.clip(at, place[0], place[-1])))


def _deepest(evaluation: Evaluation) -> float:
    """Greatest indentation that the calibration covers, mm; infinite without a calibration or a measured depth."""
    calibration = evaluation.scene.calibration
    measured = None if calibration is None else calibration.source.depth_mm
    return np.inf if measured is None else BEYOND * measured


def _common_reach(ends: Array) -> Array:
    """Ends of the rows (n,), none over 1.1 times a neighbour's: between rows both are read at one share of them."""
    reach = ends.copy()
    for order in (range(1, len(ends)), range(len(ends) - 2, -1, -1)):
        step = 1 if order.step == 1 else -1
        for k in order:
            reach[k] = min(reach[k], 1.1 * reach[k - step])
    return reach


def _continued(rows: Array, below: int) -> Array:
    """Rows with ``below`` rows added in front, extrapolated by the parabola through the first three."""
    steps = -np.arange(below, 0, -1).reshape(-1, *[1] * (rows.ndim - 1))
    a, b, c = rows[0], rows[1], rows[2]
    added = a + steps * (b - a) + 0.5 * steps * (steps - 1) * (c - 2 * b + a)
    return np.concatenate([added, rows])


def _gas_volume(prediction: SensorPrediction, sensor: Sensor, pressures: Array) -> Array:
    """Cavity and dead volume without contact at driving pressures, mm3; below zero with the slope at zero."""
    inflation = prediction.inflation
    top = int(np.argmax(inflation.pressure))
    pressure, volume = inflation.pressure[: top + 1], inflation.volume[: top + 1]
    read = _at(pressure, volume, np.maximum(pressures, 0.0))
    small = 0.01 * float(pressure[-1])
    slope = (float(_at(pressure, volume, np.array([small]))[0]) - float(volume[0])) / small
    return np.asarray(read + np.minimum(pressures, 0.0) * slope + sensor.gas.dead_volume)


STATES = 10_000
"""Number of states compared under the conditions of the tare, over all presses."""

_PRESSES = {"atlas": 100, "local": 100, "membrane": 100}
_FEW = 4
"""Number of presses if each costs seconds, for models that ``_PRESSES`` does not name."""

_READ = (Status.OK, Status.ABOVE_RATING)


class ReaderDifference(NamedTuple):
    """Largest differences of the force from the full model, N; ``states``: number compared as when tared."""

    nominal_N: float
    other_conditions_N: float
    states: int


def reader_difference(evaluation: Evaluation, grid: ReaderGrid, record: dict[str, Any]) -> ReaderDifference:
    """Compare a reader with the full model at random states of its box, the same ones each time.

    Under the conditions of the tare, and at other gas temperatures and ambient pressures. Raises ComputationError.
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
    """Tare with gas that, warmed or cooled by `CHANGE_K`, gets to ``pressure`` (MPa); yield the later conditions."""
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
