"""Prediction of a sensor by one of the models, and the assumptions that every prediction states."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from pneutouch.errors import InputError, PneutouchError, nearest
from pneutouch.mechanics.models.choice import (
    CLOSURES,
    DEFAULT_TOLERANCE,
    USUAL,
    model_named,
    models_for,
    remedy,
    usual_model,
)
from pneutouch.mechanics.models.interface import Answered, ModelAnswer, SensorModel
from pneutouch.mechanics.prediction import Limits, SensorPrediction, SensorState
from pneutouch.mechanics.sensor import Filling, IndentationProtocol, ResponseCorrection, Sensor
from pneutouch.units import KPA, ML
from pneutouch.wording import data_of

_WORDS = data_of(__file__)


def predict(
    design: str,
    sensor: Sensor,
    driving_pressures: list[float],
    *,
    model: str = "solid",
    closure: str = "variational",
    tolerance: float = DEFAULT_TOLERANCE,
    answers: Mapping[str, Answered] = MappingProxyType({}),
    fillings: Sequence[Filling] = (),
) -> SensorPrediction:
    """Predict a sensor at ascending driving pressures (MPa) and at ``fillings``; ``design`` is its name and ``closure``
    the membrane model's.

    ``model`` is a name of `MODEL_CHOICES` or ``usual``. ``auto`` takes the cheapest model whose stated error meets the
    ``tolerance`` (a fraction) and gives the reason. ``answers`` holds answers already computed in a batch of sensors,
    by the model's name. Raises InputError for an unknown model or closure and for a sensor that the model does not
    cover, BeyondLimitError beyond the limit point, ComputationError if no equilibrium is found.
    """
    if closure not in CLOSURES:
        raise InputError(f"unknown closure.{nearest(closure, CLOSURES)}", key="closure", value=closure)
    pressures = np.array(driving_pressures, float)
    name = usual_model(sensor) if model == USUAL else model

    def ask(model: SensorModel) -> ModelAnswer:
        given = answers.get(model.name)
        if isinstance(given, PneutouchError):
            raise given
        return given or model.closed(closure).answer_one(sensor, pressures)

    chosen, answer, why = _cheapest(sensor, tolerance, ask) if name == "auto" else _named(name, sensor, ask)
    errors, result = chosen.errors(sensor, pressures), answer.result
    if answer.limitation is not None and answer.limitation.beyond_error:
        errors = replace(errors, sensitivity_tabulation_relative=None, summary=())
    if why:
        errors = replace(errors, model_choice=why, summary=(f"Model {chosen.name}: {why}.", *errors.summary))
    # The factors were found against the solid's answers: the membrane's errors are others.
    correction = sensor.correction if chosen.correctable else ResponseCorrection()
    held = _WORDS["flange" if chosen.holds_flange and sensor.dome.flange is not None else "base"]
    dead, ambient_kPa = sensor.gas.dead_volume, sensor.gas.ambient_pressure / KPA
    gas = f"dead volume {dead / ML:.4g} mL, ambient pressure {ambient_kPa:g} kPa"
    filled, limits = _filled(chosen.closed(closure), sensor, fillings, result.limits)
    return SensorPrediction(
        design=design,
        model=chosen.name,
        closure=closure if chosen.name == "membrane" else None,
        error_estimate=errors,
        limit_point=result.limit_point,
        limits=limits,
        dead_volume=dead,
        inflation=result.inflation,
        states=tuple(state.corrected(correction).judged() for state in result.states),
        filled=tuple(state.corrected(correction).judged() for state in filled),
        assumptions=(*chosen.assumptions(sensor), held, contact_words(sensor.protocol), *_WORDS["always"], gas),
    )


def _filled(
    chosen: SensorModel, sensor: Sensor, fillings: Sequence[Filling], limits: Limits
) -> tuple[tuple[SensorState, ...], Limits]:
    """States given by their fillings, and the limits with that of a vacuum if one of them is below ambient pressure."""
    if not fillings:
        return (), limits
    states = chosen.filled(sensor, fillings)
    states = model_named(usual_model(sensor)).filled(sensor, fillings) if states is None else states
    if limits.vacuum is None and any(state.driving_pressure < 0.0 for state in states or ()):
        from pneutouch.mechanics.models.filling import buckling
        from pneutouch.mechanics.models.solid import solid_probe

        limits = replace(limits, vacuum=buckling(sensor, solid_probe(sensor).solid))
    return states or (), limits


def contact_words(protocol: IndentationProtocol) -> str:
    """Object that presses the sensor, its friction, place and motion, in words."""
    if protocol.body is None and protocol.soft is None and not protocol.friction and not protocol.off_axis:
        return str(_WORDS["plate"])
    body = "flat plate" if protocol.body is None else protocol.body.label
    hold = f"friction coefficient {protocol.friction:g} (Coulomb)" if protocol.friction else "frictionless"
    hold = "a surface that grips" if protocol.friction == np.inf else hold
    if protocol.off_axis is None:
        body = f"rigid {body}" if protocol.soft is None else protocol.soft.label
        return f"{body}, {hold}, central and straight down"
    places = [f"its axis {protocol.offset:g} mm off the dome's"] if protocol.offset else []
    places += ["endless across its plane of symmetry"] if protocol.body is not None and protocol.body.lying else []
    places += [f"leaning by {np.degrees(protocol.tilt):.4g}°"] if protocol.tilt else []
    moved = f", then {protocol.shear:g} mm sideways" if protocol.shear else ""
    return f"rigid {body}, {hold}, {' and '.join(places) or 'central'}, straight down{moved}"


_Ask = Callable[[SensorModel], ModelAnswer]


def _named(name: str, sensor: Sensor, ask: _Ask) -> tuple[SensorModel, ModelAnswer, str | None]:
    """Model ``name``, its answer, and the answer's limitation in words or None; InputError if not covered or fatal."""
    model = model_named(name)
    why = model.covers(sensor)
    answer = None if why is not None else ask(model)
    lacking = None if answer is None else answer.limitation
    if answer is None or (lacking is not None and lacking.fatal):
        raise InputError(why or (lacking.why if lacking else ""), key="model", value=name, remedy=remedy(sensor))
    return model, answer, None if lacking is None else f"asked for by name, although {lacking.why}"


def _cheapest(sensor: Sensor, tolerance: float, ask: _Ask) -> tuple[SensorModel, ModelAnswer, str | None]:
    """The cheapest model that meets a tolerance (a fraction), its answer, and the reason for the choice in words."""
    sequence = models_for(sensor, tolerance)
    passed = list(sequence.passed)
    for name in sequence.models:
        model = model_named(name)
        answer = ask(model)
        if answer.limitation is None:
            break
        passed.append(f"{name}: {answer.limitation.why}")
    error = model.stated_error(sensor)
    why = f"the cheapest whose stated error, {error:.1%} in sensitivity, meets {sequence.tolerance:.1%}"
    if sequence.tolerance > tolerance:
        why += f" (not the default of {tolerance:.1%}: no model states so little for this sensor)"
    return model, answer, "; ".join([why, *(f"passed over {text}" for text in passed)])
