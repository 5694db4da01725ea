"""The tables of a reader: the source of its files in C and Python.

Standard uncertainty of the force that is read at a pressure rise, over the grid of a reader.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import Evaluation
from pneutouch.evaluation.reader import CHANGE_K, CHANGE_KPA, REFERENCE_K, ReaderGrid
from pneutouch.evaluation.uncertainty import spread, unknown
from pneutouch.export.reader.reading import NOISES, UNSTEADY
from pneutouch.mechanics.atlas.coverage import other_shape
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.predict import contact_words
from pneutouch.mechanics.prediction import SensorState
from pneutouch.results.reader import (
    ForceTable,
    GasTable,
    ReaderBox,
    ReaderConditions,
    ReaderRating,
    ReaderTables,
    ReadGauge,
    ZeroDrift,
)
from pneutouch.units import KPA, ML

DAYS = 365.0
"""Days of a year of ageing, as in `SensorCalibration.remaining_year`."""

UNCERTAINTY_COLUMNS = 11
"""Number of shares of the indentation at which the uncertainty is tabulated."""

_STEP = 0.015
"""Half of the central difference, relative, as in `mechanics.uncertainty.derivatives`."""

_STEPS = 40


def force_uncertainty(evaluation: Evaluation, grid: ReaderGrid, aged: float) -> Array | None:
    """Relative standard uncertainty of the force at the rows of a grid and `UNCERTAINTY_COLUMNS` shares of the
    indentation, (n, 11); None if it is unknown, see `why_unknown`. ``aged`` is the age that counts, years.

    Sources that act on inputs of the model act through the curve of force over pressure rise; errors of the model are
    those of its sensitivity, the slope of that curve. Of another shape the solid's sensitivity stands for the whole
    curve. The gauge's noise is not in it.
    """
    sensor, scene = evaluation.sensor.even, evaluation.scene
    if why_unknown(evaluation, grid) is not None:
        return None
    from pneutouch.mechanics.atlas.figures import FIGURES, SENSITIVITY

    if lined := _lined(evaluation):
        from pneutouch.evaluation.filled import driven_budget

        resins, prediction = list(evaluation.resins.values()), replace(evaluation.prediction, states=lined)
        standard = driven_budget(prediction, evaluation.sensor, scene, resins, aged).standard[SENSITIVITY]
        along = np.interp(grid.driving_pressure, [one.driving_pressure for one in lined], standard)
        return np.repeat(along[:, None], UNCERTAINTY_COLUMNS, axis=1)

    rows = grid.driving_pressure[grid.computed :]
    sensor_spread = spread(
        sensor,
        [float(p) for p in rows],
        scene.membrane_material,
        list(evaluation.resins.values()),
        scene.printer,
        grid.model,
        calibration=scene.calibration,
        anywhere=scene.design.contact.anywhere,
        aged=aged,
    )
    slopes = _slopes(sensor_spread.batch)
    relative = np.empty((rows.size, UNCERTAINTY_COLUMNS))
    for column in range(UNCERTAINTY_COLUMNS):
        one = np.repeat(slopes[:, None, :, column], len(FIGURES), axis=1)
        variance = sum(source.variance(one)[SENSITIVITY] for source in sensor_spread.sources)
        relative[:, column] = np.sqrt(variance)
    return np.concatenate([np.repeat(relative[:1], grid.computed, axis=0), relative])


def why_unknown(evaluation: Evaluation, grid: ReaderGrid) -> str | None:
    """Reason why the uncertainty of the force is unknown, or None if it is known."""
    other = evaluation.sensor.protocol.other_contact
    if other is not None:
        return f"computed for a central plate without friction alone; here {other}"
    return None if _lined(evaluation) else unknown(evaluation.sensor.even, grid.model)


def _lined(evaluation: Evaluation) -> tuple[SensorState, ...]:
    """States with figures of a shape that the solid or its table answers for; none of a hemisphere."""
    prediction, dome = evaluation.prediction, evaluation.sensor.dome
    if prediction.model not in ("solid", "local") or dome.flange or not other_shape(evaluation.sensor):
        return ()
    return tuple(one for one in prediction.states if one.figures is not None and one.driving_pressure >= 0.0)


def _slopes(batch: SensorBatch) -> Array:
    """Derivatives of ln force at a fixed rise by ln of an input (by mm3 of dead volume), (inputs, n, columns)."""
    from pneutouch.mechanics.atlas.figures import INPUTS, moved, neighbourhood, unit_step
    from pneutouch.mechanics.atlas.respond import respond

    unit, size = unit_step(batch), len(batch)
    moves = [moved(batch, name, sign * _STEP * unit[i]) for i, name in enumerate(INPUTS) for sign in (1.0, -1.0)]
    response = respond(SensorBatch.join([batch, *moves]), _STEPS, neighbourhood())
    curves = [(response.rise[k], response.force[k]) for k in range(size * (1 + len(moves)))]
    shares = np.linspace(0.0, 1.0, UNCERTAINTY_COLUMNS)
    slopes = np.zeros((len(INPUTS), size, UNCERTAINTY_COLUMNS))
    for n in range(size):
        # The force goes to nothing with the rise: the first column is that of the first step.
        at = np.interp(np.maximum(shares, 1.0 / _STEPS) * _STEPS, np.arange(_STEPS + 1.0), curves[n][0])
        for i in range(len(INPUTS)):
            more, less = (_log_force(curves[size * (1 + 2 * i + k) + n], at) for k in (0, 1))
            slopes[i, n] = (more - less) / (2.0 * _STEP * unit[i, n])
    return slopes


def _log_force(curve: Sequence[Array], rises: Array) -> Array:
    """Logarithm of a curve's force at pressure rises; beyond its ends by its last, or first, power of the rise."""
    rise, force = np.log(curve[0][1:]), np.log(curve[1][1:])
    at = np.log(rises)
    inside = np.interp(at, rise, force)
    after = force[-1] + (at - rise[-1]) * (force[-1] - force[-2]) / (rise[-1] - rise[-2])
    before = force[0] + (at - rise[0]) * (force[1] - force[0]) / (rise[1] - rise[0])
    return np.asarray(np.where(at > rise[-1], after, np.where(at < rise[0], before, inside)))


_DRIFT_SHARE = 0.001
"""Share of full scale by which the table may be off, without a status, at a driving pressure just below its box."""

AIR_K_PER_H = 2.2
"""Fastest change of the air's temperature whose drift is followed, K/h: the ramp that ANSI/ASHRAE 55 allows within an
hour (its table of drifts and ramps; the standard itself was not within reach, so that the number is unverified)."""

FILTER_S = 1.0
"""Time constant of the mean by which a touch is distinguished from the zero: our choice."""


def reader_tables(evaluation: Evaluation, grid: ReaderGrid, aged: float | None = None) -> ReaderTables:
    """The reader without its source and its largest difference from the full model. Numbers are float32 ones.

    ``aged`` is the share of a year since the calibration that the uncertainty counts, or since the print of a sensor
    without one; None: 0 of a calibrated sensor, which is its own reference, else 1. Later ageing is not known: a sensor
    that was calibrated in its first year counts the rest of it at most. Raises InputError for another share.
    """
    scene, sensor, rating = evaluation.scene, evaluation.sensor, evaluation.rating
    if aged is None:
        aged = 1.0 if scene.calibration is None else 0.0
    if not 0.0 <= aged <= 1.0:
        problem = "ageing is known for the first year alone"
        raise InputError(problem, key="age_years", value=aged, remedy="give 0 to 1 years")
    aged = min(aged, 1.0 if scene.calibration is None else scene.calibration.remaining_year)
    relative = force_uncertainty(evaluation, grid, aged)
    ambient_kPa = sensor.gas.ambient_pressure / KPA
    return ReaderTables(
        design=scene.name,
        calibration=scene.design.calibration_name,
        model=grid.model,
        units={"pressure": "kPa", "force": "N", "length": "mm", "volume": "mL", "temperature": "degC"},
        grid=ForceTable(
            driving_pressure_kPa=_single(grid.driving_pressure / KPA),
            pressure_rise_kPa=_rows(grid.rise / KPA),
            contact_force_N=_rows(grid.force),
            indentation_mm=_single(grid.reach),
            pressure_factor=_single(grid.pressure_factor),
            force_uncertainty_relative=None if relative is None else _rows(relative),
            force_uncertainty_unknown=why_unknown(evaluation, grid),
            force_uncertainty_age_days=_one(DAYS * aged),
        ),
        gas=GasTable(_single(grid.gas_pressure / KPA), _single(grid.gas_volume / ML)),
        box=_box(grid, ambient_kPa),
        rating=ReaderRating(_one(rating.pressure_kPa), rating.basis),
        gauge=_gauge(evaluation),
        zero=_zero(evaluation, grid),
        conditions=ReaderConditions(
            driving_pressures_kPa=tuple(scene.design.pneumatics.driving_pressures_kPa),
            ambient_pressure_kPa=_one(ambient_kPa),
            dead_volume_mL=sensor.gas.dead_volume / ML,
            contact=contact_words(sensor.protocol),
            assumptions=tuple(evaluation.prediction.assumptions),
        ),
    )


def _box(grid: ReaderGrid, ambient_kPa: float) -> ReaderBox:
    return ReaderBox(
        driving_pressure_kPa=_single(np.array([grid.low, grid.high]) / KPA),
        driving_pressure_margin_kPa=_one(_margin(grid) / KPA),
        contact_force_N=(0.0, _one(grid.full_scale)),
        pressure_rise_kPa=(0.0, _one(float(grid.rise[grid.computed :, -1].max()) / KPA)),
        indentation_mm=(0.0, _one(float(grid.reach[grid.computed :].max()))),
        ambient_pressure_kPa=_single(np.array([ambient_kPa - CHANGE_KPA, ambient_kPa + CHANGE_KPA])),
        temperature_change_K=CHANGE_K,
    )


def _gauge(evaluation: Evaluation) -> ReadGauge:
    """The gauge of the design and the gauge pressures that it reads; without one from vacuum to the sensor's limit."""
    gauge, gas = evaluation.scene.gauge, evaluation.sensor.gas
    ambient_kPa = gas.ambient_pressure / KPA
    if gauge is None:
        return ReadGauge(None, _single(np.array([-ambient_kPa, gas.gauge_limit / KPA])))
    # An absolute gauge reads the ambient pressure too: what it reads at every ambient pressure of the box.
    low, _ = gauge.gauge_pressures_kPa(ambient_kPa - CHANGE_KPA)
    _, high = gauge.gauge_pressures_kPa(ambient_kPa + CHANGE_KPA)
    # A gauge at rest may read below its range by its error.
    below = 0.0 if gauge.error_kPa is None else gauge.error_kPa.nominal
    return ReadGauge(evaluation.scene.design.pneumatics.gauge, _single(np.array([low - below, high])))


def _zero(evaluation: Evaluation, grid: ReaderGrid) -> ZeroDrift:
    """Bounds of the drift that a reader follows: the effect of warmer air on the sealed gas, and the gauge's noise."""
    ambient = evaluation.sensor.gas.ambient_pressure
    content = (grid.gas_pressure + ambient) * grid.gas_volume
    inside = grid.gas_pressure >= min(grid.low, grid.gas_pressure[-2])
    per_kelvin_kPa = float((content / np.gradient(content, grid.gas_pressure))[inside].max()) / REFERENCE_K / KPA
    return ZeroDrift(
        drift_kPa_per_K=_one(per_kelvin_kPa),
        temperature_rate_K_per_h=AIR_K_PER_H,
        drift_rate_kPa_per_s=_one(per_kelvin_kPa * AIR_K_PER_H / 3600.0),
        drift_most_kPa=_one(per_kelvin_kPa * CHANGE_K),
        noise_least_kPa=_one(_noise_kPa(evaluation, grid)),
        # Beyond this scatter of readings without contact something moves, and they are no tare.
        noise_most_kPa=_one(max(NOISES * _noise_kPa(evaluation, grid), UNSTEADY * float(grid.rise.max()) / KPA)),
        filter_s=FILTER_S,
    )


def _noise_kPa(evaluation: Evaluation, grid: ReaderGrid) -> float:
    """Noise of the gauge as far as it is known, kPa: at least that of float32 numbers of its pressures."""
    gauge = evaluation.scene.gauge
    noise_kPa = 0.0 if gauge is None or gauge.noise_kPa is None else gauge.noise_kPa.nominal
    step_kPa = 0.0 if gauge is None or gauge.resolution_kPa is None else gauge.resolution_kPa.nominal
    rounding_kPa = float(np.finfo(np.float32).eps) * float(grid.driving_pressure[-1] + grid.rise.max()) / KPA
    return max(noise_kPa, step_kPa / math.sqrt(12.0), rounding_kPa)


def _margin(grid: ReaderGrid) -> float:
    """Distance of a driving pressure below the box, MPa, over which the table moves by `_DRIFT_SHARE` at most."""
    first = grid.computed
    step = float(grid.driving_pressure[1] - grid.driving_pressure[0])
    moved = np.interp(grid.rise[first], grid.rise[first + 1], grid.force[first + 1]) - grid.force[first]
    slope = float(np.abs(moved).max()) / step
    return min(_DRIFT_SHARE * grid.full_scale / slope, step) if slope > 0.0 else step


def _one(value: float) -> float:
    """The number rounded to float32, with as many digits as distinguish it."""
    return float(f"{float(np.float32(value)):.9g}")


def _single(values: Array) -> tuple[float, ...]:
    """Numbers as `_one` gives them."""
    return tuple(map(_one, values))


def _rows(values: Array) -> tuple[tuple[float, ...], ...]:
    return tuple(map(_single, values))
