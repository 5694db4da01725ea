"""Uncertainty of states given by their filling: the sources of the sensor, with the derivatives of the solid.

The atlas has states by driving pressure alone. Here the solid finds each state again with every input changed by its
spread, the filling kept, which counts as exact. The pressure of such a state is a result: it has the sources of the
limit pressure, which acts through the same wall.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TypeVar

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import ComputationError, InputError
from pneutouch.evaluation.evaluate import Evaluation, fillings_of
from pneutouch.evaluation.table_s1 import is_near_paper
from pneutouch.evaluation.uncertainty import DIGITS, NOTHING, TREND, values_of
from pneutouch.mechanics.atlas.figures import FIGURES, INPUTS, moved, unit_step
from pneutouch.mechanics.atlas.press import SensorBatch, batch_of
from pneutouch.mechanics.corrected.figures import state_logs
from pneutouch.mechanics.models.accuracy import LIMIT_DISCRETISATION
from pneutouch.mechanics.models.choice import stated_error
from pneutouch.mechanics.models.solid import MODEL
from pneutouch.mechanics.prediction import SensorState
from pneutouch.mechanics.sensor import Filling, Sensor
from pneutouch.mechanics.uncertainty.document import document, text
from pneutouch.mechanics.uncertainty.propagate import LIMIT, STEP, Derivatives, by_input, combined, from_changes
from pneutouch.mechanics.uncertainty.sources import sources
from pneutouch.mechanics.uncertainty.sources.model_error import model_errors
from pneutouch.results.record import SENSITIVITY_KEY
from pneutouch.results.uncertainty import UncertaintyRecord
from pneutouch.units import KPA
from pneutouch.wording import rounded

PRESSURE_KEY = "driving_pressure_kPa"
"""Name of the figure that stands in the place of the limit pressure."""

_APEX = FIGURES.index("apex_height_outer_mm")
Named = TypeVar("Named")

_EXACT = "the filling counts as exact; a syringe adds its own scale to it"


def filled_uncertainties(evaluation: Evaluation) -> tuple[UncertaintyRecord, ...]:
    """One record for each state given by its filling, or why it is ``unknown``; figures as in `evaluation.uncertainty`,
    and the driving pressure."""
    prediction, sensor, scene = evaluation.prediction, evaluation.sensor, evaluation.scene
    states, contact = prediction.filled, sensor.protocol.other_contact
    why = TREND if prediction.model == "membrane" else contact
    if why is not None:
        return tuple(UncertaintyRecord(unknown=why) for _ in states)
    batch = batch_of(sensor, [state.driving_pressure for state in states])
    of_sensor = sources(
        batch,
        scene.membrane_material,
        scene.printer,
        near_paper=is_near_paper(sensor),
        errors=model_errors(scene.membrane_material, list(evaluation.resins.values())),
        numerical={SENSITIVITY_KEY: stated_error("solid", sensor), FIGURES[LIMIT]: LIMIT_DISCRETISATION},
        calibration=scene.calibration,
    )
    solved = _solver(sensor, fillings_of(scene), states)
    budget = combined(of_sensor, _derivatives(batch, *by_input(batch, of_sensor), solved), None)
    calibrated, records = scene.calibration is not None, []
    for row, state in enumerate(states):
        values = {**values_of(prediction, state), FIGURES[LIMIT]: state.driving_pressure / KPA}
        record = document(budget, row, values, (_EXACT,), calibrated=calibrated)
        figures, elasticities = _renamed(record.figures), _renamed(record.elasticities)
        summary = text(budget, row, calibrated=calibrated)
        record = replace(record, figures=figures, elasticities=elasticities, summary=summary)
        records.append(rounded(record, DIGITS, NOTHING))
    return tuple(records)


def _renamed(figures: Mapping[str, Named] | None) -> dict[str, Named]:
    """Figures by name, with the name of the pressure in place of that of the limit pressure."""
    return {PRESSURE_KEY if name == FIGURES[LIMIT] else name: value for name, value in (figures or {}).items()}


def _solver(sensor: Sensor, fillings: list[Filling], states: tuple[SensorState, ...]) -> Callable[[str, float], Array]:
    """Solver for `_derivatives`: logarithms of the figures of all states with one input of the sensor changed."""
    bare, here = sensor.replace(waves=0), _logs(states, sensor)

    def solved(name: str, by: float) -> Array:
        if by == 0.0 or name == "driving_pressure":
            return here
        if name == "dead_volume" and sensor.gas.dead_volume + by < 0.0:
            # There is no gas to take away: the change is taken as linear.
            return np.asarray(2.0 * here - solved(name, -by))
        return np.hstack([_one(_moved(bare, name, by), filling) for filling in fillings])

    return solved


def _derivatives(
    batch: SensorBatch, standard: Array, kurtosis: Array, solved: Callable[[str, float], Array]
) -> Derivatives:
    """As `propagate.derivatives`, of n states: ``solved`` gives the logarithms of the figures, (figures, n), with an
    input (of `INPUTS`) changed by a number as in `moved`, the same for all; NaN for one that it does not find."""
    near, far = STEP * unit_step(batch).max(axis=1), (np.sqrt(kurtosis) * standard.max(axis=1)).max(axis=1)
    small = np.maximum(near, far)
    here = solved(INPUTS[0], 0.0)
    beside = np.array([[solved(n, s * by) for s in (1.0, -1.0)] for n, by in zip(INPUTS, small.tolist(), strict=True)])
    beside, ratio = beside - here, (far / small)[:, None, None, None]
    wide = np.broadcast_to((far >= near)[:, None], kurtosis.shape)
    steps = np.broadcast_to(small[:, None], kurtosis.shape)
    return from_changes(here, (beside, steps), (beside * ratio, wide), batch.dead_volume, standard, kurtosis)


def _one(sensor: Sensor, filling: Filling) -> Array:
    try:
        return _logs(MODEL.filled(sensor, [filling]))
    except (ComputationError, InputError):
        return np.full((len(FIGURES), 1), np.nan)


def _logs(states: tuple[SensorState, ...], sensor: Sensor | None = None) -> Array:
    """Logarithms (figures, n) of the figures, with the driving pressure in the place of the limit pressure."""
    logs = state_logs(states, None if sensor is None else sensor.correction)
    with np.errstate(invalid="ignore", divide="ignore"):
        logs[[LIMIT, _APEX]] = np.log([(s.driving_pressure / KPA, s.apex_outer) for s in states]).T
    return np.where(np.isfinite(logs), logs, np.nan)


def _moved(sensor: Sensor, name: str, by: float) -> Sensor:
    """The sensor with an input changed as in `atlas.figures.moved`."""
    value = float(getattr(moved(batch_of(sensor, [0.0]), name, np.array([by])), name)[0])
    return sensor.of_modulus(value) if name == "shear_modulus" else sensor.replace(**{name: value})
