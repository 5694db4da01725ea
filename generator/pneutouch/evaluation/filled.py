"""Uncertainty where the atlas has no states: the sources of the sensor, with the derivatives of the solid.

The solid finds each state again with every input changed by its spread. A filling counts as exact; its pressure then
is a result and has the sources of the limit pressure, which acts through the same wall.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from pneutouch.arrays import Array
from pneutouch.catalogue import ResolvedDesign
from pneutouch.errors import PneutouchError
from pneutouch.evaluation.contact_object import fillings_of
from pneutouch.evaluation.table_s1 import is_near_paper
from pneutouch.mechanics.atlas.figures import FIGURES, INPUTS, moved, unit_step
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.corrected.figures import state_logs
from pneutouch.mechanics.models.accuracy import TREND, limit_discretisation
from pneutouch.mechanics.models.choice import model_named, stated_error
from pneutouch.mechanics.models.solid import MODEL, solid_result
from pneutouch.mechanics.prediction import SensorPrediction, SensorState
from pneutouch.mechanics.sensor import Filling, Sensor
from pneutouch.mechanics.uncertainty.document import DIGITS, NOTHING, document, text, values_of
from pneutouch.mechanics.uncertainty.propagate import LIMIT, STEP, Budget, by_input, combined, from_changes
from pneutouch.mechanics.uncertainty.sources import sources
from pneutouch.mechanics.uncertainty.sources.model_error import model_errors
from pneutouch.results.record import SENSITIVITY_KEY
from pneutouch.results.uncertainty import UncertaintyRecord
from pneutouch.spec.material import Material
from pneutouch.units import KPA
from pneutouch.wording import rounded

PRESSURE_KEY = "driving_pressure_kPa"
"""Name of the figure of a filled state that stands in the place of the limit pressure."""

_LIMIT_KEY, _APEX = FIGURES[LIMIT], FIGURES.index("apex_height_outer_mm")
Again = Callable[[Sensor, float], Array]
"""Logarithms (figures, n) of the figures of n states of a sensor, driving pressures times a factor; NaN for none."""

_EXACT = "the filling counts as exact; a syringe adds its own scale to it"
_BY_SOLID = "the derivatives are the solid's, over the spread of each input"


def filled_uncertainties(
    prediction: SensorPrediction, sensor: Sensor, scene: ResolvedDesign, materials: Sequence[Material]
) -> tuple[UncertaintyRecord, ...]:
    """One record for each state given by its filling, its pressure among the figures; or the reason for none."""
    states, fillings = prediction.filled, fillings_of(scene)
    why = TREND if prediction.model == "membrane" else sensor.protocol.other_contact
    if why is not None:
        return tuple(UncertaintyRecord(unknown=why) for _ in states)
    at = [state.driving_pressure for state in states]
    here = _logs(states, at, sensor)

    def again(other: Sensor, factor: float) -> Array:
        return here if factor != 1.0 else np.hstack([_found(_filled, other, filling) for filling in fillings])

    budget = _budget(sensor, scene, materials, at, here, again)
    known = [{**values_of(prediction, state), _LIMIT_KEY: state.driving_pressure / KPA} for state in states]
    return tuple(_records(budget, known, _EXACT, scene, PRESSURE_KEY))


def driven_uncertainties(
    prediction: SensorPrediction, sensor: Sensor, scene: ResolvedDesign, materials: Sequence[Material]
) -> tuple[UncertaintyRecord, ...]:
    """One record for each state of the solid, or of a local table, at a driving pressure that the atlas covers not."""
    budget = driven_budget(prediction, sensor, scene, materials)
    return tuple(_records(budget, [values_of(prediction, state) for state in prediction.states], _BY_SOLID, scene))


def driven_budget(
    prediction: SensorPrediction, sensor: Sensor, scene: ResolvedDesign, resins: Sequence[Material], aged: float = 1.0
) -> Budget:
    """Budget of these states, of the known ``resins``, at the age ``aged`` in years."""
    at = [state.driving_pressure for state in prediction.states]
    solve = _tabulated if prediction.model == "local" else _driven

    def again(other: Sensor, factor: float) -> Array:
        return np.hstack([_found(solve, other, factor * pressure) for pressure in at])

    here = _logs(prediction.states, [prediction.limits.limit_point] * len(at), sensor)
    return _budget(sensor, scene, resins, at, here, again, prediction.model, aged)


def _budget(
    sensor: Sensor,
    scene: ResolvedDesign,
    materials: Sequence[Material],
    at: list[float],
    here: Array,
    again: Again,
    model: str = "solid",
    aged: float = 1.0,
) -> Budget:
    """Budget of states of a ``model`` ``at`` n pressures, MPa, with the logarithms ``here`` of their figures, (figures,
    n)."""
    batch = batch_of(sensor, at)
    of_sensor = sources(
        batch,
        scene.membrane_material,
        scene.printer,
        near_paper=is_near_paper(sensor),
        errors=model_errors(scene.membrane_material, materials),
        numerical={SENSITIVITY_KEY: stated_error(model, sensor), _LIMIT_KEY: limit_discretisation(sensor)},
        calibration=scene.calibration,
        anywhere=scene.design.contact.anywhere,
        aged=aged,
    )
    standard, kurtosis = by_input(batch, of_sensor)
    near, far = STEP * unit_step(batch).max(axis=1), (np.sqrt(kurtosis) * standard.max(axis=1)).max(axis=1)
    step, bare = np.maximum(near, far), sensor.replace(waves=0)

    def solved(name: str, by: float) -> Array:
        if name == "driving_pressure":
            return again(bare, float(np.exp(by)))
        if name == "dead_volume" and sensor.gas.dead_volume + by < 0.0:
            # There is no gas to take away: the change is taken as linear.
            return np.asarray(2.0 * here - solved(name, -by))
        return again(_moved(bare, name, by), 1.0)

    ends = [[solved(name, sign * by) for sign in (1.0, -1.0)] for name, by in zip(INPUTS, step.tolist(), strict=True)]
    change = np.array(ends) - here
    steps, wide = (np.broadcast_to(each[:, None], kurtosis.shape) for each in (step, far >= near))
    spread = change * (far / step)[:, None, None, None]
    slopes = from_changes(here, (change, steps), (spread, wide), batch.dead_volume, standard, kurtosis)
    return combined(of_sensor, slopes, None)


def _records(
    budget: Budget, known: Sequence[dict[str, float]], note: str, scene: ResolvedDesign, own: str = _LIMIT_KEY
) -> Iterator[UncertaintyRecord]:
    """Records of the states, ``known`` by the model; ``own``: name of what stands in place of the limit pressure."""
    names, calibrated = {_LIMIT_KEY: own}, scene.calibration is not None
    for row, values in enumerate(known):
        record = document(budget, row, values, (note,), calibrated=calibrated)
        figures = {names.get(name, name): figure for name, figure in record.known.items()}
        slopes = {names.get(name, name): slope for name, slope in (record.elasticities or {}).items()}
        summary = text(budget, row, calibrated=calibrated)
        yield rounded(replace(record, figures=figures, elasticities=slopes, summary=summary), DIGITS, NOTHING)


def _found(solve: Callable[..., Array], *given: object) -> Array:
    try:
        return solve(*given)
    except PneutouchError:
        return np.full((len(FIGURES), 1), np.nan)


def _filled(sensor: Sensor, filling: Filling) -> Array:
    states = MODEL.filled(sensor, [filling])
    return _logs(states, [state.driving_pressure for state in states])


def _driven(sensor: Sensor, pressure: float) -> Array:
    result = solid_result(sensor, np.array([pressure]), past_limit=1.0)
    return _logs(result.states, [result.limits.limit_point])


def _tabulated(sensor: Sensor, pressure: float) -> Array:
    """Figures from a local table, and by the solid where no table has them."""
    table = model_named("local")
    if table.covers(sensor) is None:
        answer = table.answer_one(sensor, np.array([pressure]))
        if answer.limitation is None:
            return _logs(answer.result.states, [answer.result.limits.limit_point])
    return _driven(sensor, pressure)


def _logs(states: Sequence[SensorState], limits: Sequence[float | None], sensor: Sensor | None = None) -> Array:
    """Logarithms (figures, n) of the figures, with ``limits`` (MPa) in the place of the limit pressure."""
    logs = state_logs(states, None if sensor is None else sensor.correction)
    with np.errstate(invalid="ignore", divide="ignore"):
        logs[LIMIT] = np.log(np.array(limits, dtype=float) / KPA)
        logs[_APEX] = np.log([state.apex_outer for state in states])
    return np.where(np.isfinite(logs), logs, np.nan)


def _moved(sensor: Sensor, name: str, by: float) -> Sensor:
    """The sensor with an input changed as in `atlas.figures.moved`."""
    value = float(getattr(moved(batch_of(sensor, [0.0]), name, np.array([by])), name)[0])
    return sensor.of_modulus(value) if name == "shear_modulus" else sensor.replace(**{name: value})
