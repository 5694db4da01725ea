"""Predict a sensor with one of the models."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import InputError, nearest
from pneutouch.mechanics.membrane import error_against_exact_membrane, membrane_result
from pneutouch.mechanics.membrane_contact import CLOSURES
from pneutouch.mechanics.models import (
    DEFAULT_TOLERANCE,
    HARMONICS_SETTLED,
    LIMIT_DISCRETISATION,
    MODEL_CHOICES,
    NUMERICAL,
    OBJECT_DISCRETISATION,
    SENSITIVITY_DISCRETISATION,
    TABULATION,
    USUAL,
    models_for,
    outside_harmonic,
    stated_error,
    usual_model,
)
from pneutouch.mechanics.prediction import ModelResult, SensorPrediction
from pneutouch.mechanics.sensor import IndentationProtocol, ResponseCorrection, Sensor
from pneutouch.results.prediction import ErrorEstimate
from pneutouch.units import KPA, ML

if TYPE_CHECKING:
    from pneutouch.mechanics.atlas_states import AnswerLimitation

_DISCRETISATION_SUMMARY = (
    f"Discretisation: sensitivity within {SENSITIVITY_DISCRETISATION:.1%}, limit pressure "
    f"within {LIMIT_DISCRETISATION:.1%} of a refined mesh."
)
_OBJECT_SUMMARY = (
    f"Discretisation: sensitivity within {OBJECT_DISCRETISATION:.0%}, limit pressure within "
    f"{LIMIT_DISCRETISATION:.1%} of a refined mesh (docs/background/contact.md)."
)
_TABULATION_SUMMARY = (
    f"Tabulation: sensitivity within {TABULATION:.1%} of the solid, that is within {NUMERICAL['atlas']:.1%} "
    "of a refined mesh."
)

_MEMBRANE_ASSUMPTIONS = (
    "thin neo-Hookean membrane, incompressible, C1 = mu/2; no bending stiffness: the wall's own stiffness is missing",
    "constant curvature of the free part and one thickness everywhere (paper, eq. 3 and 11)",
    "R0 is the inner radius; outer heights add the thinned wall",
    "uniaxial elongation at break is set against the equibiaxial stretch",
)

_THROUGH_BASE = (
    "the wall below the base plane, self-contact and contact with the connector are not modelled",
    "the fold of the wall at its clamped corner, which refined meshes find in deep presses, is not resolved by default",
)
_ON_BASE = (
    "next to its clamp and inside, the wall lies down without friction on the body below it; contact of the rest of "
    "the wall with itself is not modelled"
)

_BODY = "axisymmetric hyperelastic solid with the wall's full stiffness"

_HARMONIC_BODY = "hyperelastic solid with Fourier sums around the axis and the wall's full stiffness"
_HARMONIC_SUMMARY = (
    f"Discretisation: sensitivity within {OBJECT_DISCRETISATION:.0%} by the mesh; the last raise of the harmonics "
    f"changed sensitivity, force and pressure by less than {HARMONICS_SETTLED:.0%} (docs/background/off-axis.md)."
)

_SOLID_ASSUMPTIONS = (
    "R0 is the inner radius; heights are those of the inner and the outer surface",
    *_THROUGH_BASE,
    "elongation at break is set against the greatest principal stretch on the faces, half a wall away from the clamp",
)

_NOT_CHECKED = "sway and lobes of the dome around its axis are not looked for"

_CLAMPED_BASE = "rim clamped at the base plane, as in the paper"
_CLAMPED_FLANGE = "flange clamped on the faces that the connector holds, its top free"

_PLATE = "rigid, flat, frictionless plate"

_COMMON_ASSUMPTIONS = (
    "ideal gas at constant temperature (Boyle): slow contact; how far adiabatic air differs follows from wall and gas",
    "elastic wall: no rate, relaxation or temperature dependence of the resin",
)


_OTHER = "take `model` auto or solid"
_OFF_AXIS = "take `model` auto or harmonic"


def predict(
    design: str,
    sensor: Sensor,
    driving_pressures: list[float],
    *,
    model: str = "solid",
    closure: str = "variational",
    tolerance: float = DEFAULT_TOLERANCE,
) -> SensorPrediction:
    """Predict a sensor at ascending driving pressures (MPa) with one model; ``closure`` is the membrane's.

    ``auto`` takes the cheapest model whose stated error meets the tolerance (a fraction) and gives the reason. Raises
    InputError for an unknown model or closure and for a sensor outside the atlas's box, BeyondLimitError beyond the
    limit point, ComputationError if no equilibrium is found.
    """
    if model not in (*MODEL_CHOICES, USUAL):
        raise InputError(f"unknown model.{nearest(model, MODEL_CHOICES)}", key="model", value=model)
    if closure not in CLOSURES:
        raise InputError(f"unknown closure.{nearest(closure, CLOSURES)}", key="closure", value=closure)
    pressures = np.array(driving_pressures, float)
    if model == USUAL:
        model = usual_model(sensor)
    chosen, answer, why = _answer(sensor, pressures, model, closure, tolerance)
    # The factors were found against the solid's answers: the membrane's errors are others.
    correction = ResponseCorrection() if chosen == "membrane" else sensor.correction
    errors, assumptions = _stated(chosen, sensor, pressures)
    if sensor.dome.base is not None and chosen != "membrane":
        assumptions = (*(line for line in assumptions if line not in _THROUGH_BASE), _ON_BASE)
    if why:
        errors = replace(errors, model_choice=why, summary=(f"Model {chosen}: {why}.", *errors.summary))
    dead, ambient_kPa = sensor.gas.dead_volume, sensor.gas.ambient_pressure / KPA
    gas = f"dead volume {dead / ML:.4g} mL, ambient pressure {ambient_kPa:g} kPa"
    held = _CLAMPED_FLANGE if chosen == "solid" and sensor.dome.flange is not None else _CLAMPED_BASE
    return SensorPrediction(
        design=design,
        model=chosen,
        closure=closure if chosen == "membrane" else None,
        error_estimate=errors,
        limit_point=answer.limit_point,
        limits=answer.limits,
        dead_volume=dead,
        inflation=answer.inflation,
        states=tuple(state.corrected(correction) for state in answer.states),
        assumptions=(*assumptions, held, contact_words(sensor.protocol), *_COMMON_ASSUMPTIONS, gas),
    )


def contact_words(protocol: IndentationProtocol) -> str:
    """Object that presses the sensor, in words."""
    if protocol.body is None and not protocol.friction and not protocol.off_axis:
        return _PLATE
    body = "flat plate" if protocol.body is None else protocol.body.label
    hold = f"friction coefficient {protocol.friction:g} (Coulomb)" if protocol.friction else "frictionless"
    hold = "a surface that grips" if protocol.friction == np.inf else hold
    if protocol.off_axis is None:
        return f"rigid {body}, {hold}, central and straight down"
    places = [f"its axis {protocol.offset:g} mm off the dome's"] if protocol.offset else []
    places += ["endless across its plane of symmetry"] if protocol.body is not None and protocol.body.lying else []
    places += [f"leaning by {np.degrees(protocol.tilt):.4g}°"] if protocol.tilt else []
    moved = f", then {protocol.shear:g} mm sideways" if protocol.shear else ""
    return f"rigid {body}, {hold}, {' and '.join(places) or 'central'}, straight down{moved}"


def _edge(protocol: IndentationProtocol) -> str:
    """Edge that the solid gives to the pressing object, in words."""
    if protocol.body is not None:
        return "beyond its edge, or flanks of 60 degrees, the object turns up as a parabola; there the range ends"
    if protocol.plate_rim is not None:
        return f"the plate's edge is rounded with {protocol.plate_rim:g} mm, or with a cell of the mesh if that is more"
    return "the plate's edge is rounded with a thirtieth of its radius"


def _answer(
    sensor: Sensor, pressures: Array, model: str, closure: str, tolerance: float
) -> tuple[str, ModelResult, str | None]:
    """The model that answered, its answer, and the reason for it if the user did not name the model."""
    if model != "auto":
        result, limitation = _result(model, sensor, pressures, closure)
        if limitation is not None and limitation.fatal:
            raise InputError(limitation.why, key="model", value=model, remedy=_OTHER)
        return model, result, None if limitation is None else f"asked for by name, although {limitation.why}"
    sequence = models_for(sensor, tolerance)
    passed = list(sequence.passed)
    for model in sequence.models:
        result, limitation = _result(model, sensor, pressures, closure)
        if limitation is None:
            break
        passed.append(f"{model}: {limitation.why}")
    why = f"the cheapest whose stated error, {stated_error(model, sensor):.1%} in sensitivity, meets {tolerance:.1%}"
    return model, result, "; ".join([why, *(f"passed over {text}" for text in passed)])


def _result(model: str, sensor: Sensor, pressures: Array, closure: str) -> tuple[ModelResult, AnswerLimitation | None]:
    """The result of one model and its limitation."""
    if model == "membrane":
        if sensor.protocol.other_contact is not None:
            remedy = _OTHER if sensor.protocol.off_axis is None else _OFF_AXIS
            raise InputError(sensor.protocol.other_contact, key="model", value=model, remedy=remedy)
        if sensor.wall.grade is not None:
            raise InputError("the wall is graded along its arc", key="model", value=model, remedy=_OTHER)
        return membrane_result(sensor, pressures, closure), None
    if model == "atlas":
        from pneutouch.mechanics.atlas_states import atlas_result, outside_atlas

        why = outside_atlas(sensor)
        if why is not None:
            remedy = _OTHER if sensor.protocol.off_axis is None else _OFF_AXIS
            raise InputError(why, key="model", value=model, remedy=remedy)
        return atlas_result(sensor, pressures)
    from pneutouch.mechanics.solid_states import solid_result

    if model == "harmonic":
        from pneutouch.mechanics.harmonic_states import harmonic_result

        why = outside_harmonic(sensor)
        if why is not None:
            raise InputError(why, key="model", value=model, remedy=_OTHER)
        return harmonic_result(sensor, pressures), None
    if sensor.protocol.off_axis is not None:
        raise InputError(sensor.protocol.off_axis, key="model", value=model, remedy=_OFF_AXIS)
    return solid_result(sensor, pressures), None


def _stated(model: str, sensor: Sensor, pressures: Array) -> tuple[ErrorEstimate, tuple[str, ...]]:
    """Numerical errors and assumptions of a model."""
    if model == "membrane":
        return error_against_exact_membrane(sensor, pressures), _MEMBRANE_ASSUMPTIONS
    largest = sensor.wall.largest_stretch
    fitted = "" if largest is None else f", fitted to tension up to a stretch of {largest:g}"
    law = f"law {sensor.wall.hyperelastic.convention}{fitted}, Poisson ratio {sensor.wall.poisson_ratio:g}"
    if model == "atlas":
        errors = _discretised(_TABULATION_SUMMARY, sensitivity_tabulation_relative=TABULATION)
        return errors, (law, f"{_BODY}; {_NOT_CHECKED}", *_solid_assumptions(sensor))
    waves = sensor.protocol.waves
    if model == "harmonic":
        text = f"{_HARMONIC_BODY}; what is not symmetric about the planes of symmetry of the scene is left out"
        errors = _discretised(_HARMONIC_SUMMARY, stated_error(model, sensor))
        return errors, (law, text, *_solid_assumptions(sensor))
    checked = f"sway and lobes are looked for with up to {waves} waves around the axis" if waves else _NOT_CHECKED
    errors = _discretised(_DISCRETISATION_SUMMARY)
    if sensor.protocol.body is not None:
        errors = _discretised(_OBJECT_SUMMARY, OBJECT_DISCRETISATION)
    return errors, (law, f"{_BODY}; {checked}", *_solid_assumptions(sensor))


def _discretised(
    summary: str,
    sensitivity_relative: float = SENSITIVITY_DISCRETISATION,
    sensitivity_tabulation_relative: float | None = None,
) -> ErrorEstimate:
    """The errors of finite elements; the atlas adds that of its table."""
    return ErrorEstimate(
        sensitivity_relative=None,
        limit_pressure_relative=LIMIT_DISCRETISATION,
        sensitivity_discretisation_relative=sensitivity_relative,
        sensitivity_tabulation_relative=sensitivity_tabulation_relative,
        summary=(summary,),
    )


def _solid_assumptions(sensor: Sensor) -> tuple[str, ...]:
    return (*_SOLID_ASSUMPTIONS[:-1], _edge(sensor.protocol), _SOLID_ASSUMPTIONS[-1])
