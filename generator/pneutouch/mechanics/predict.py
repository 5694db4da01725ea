"""Predict a sensor with one rung of the ladder of models."""

from __future__ import annotations

from typing import Any

import numpy as np

from pneutouch.errors import InputError, nearest
from pneutouch.mechanics.contact import CLOSURES
from pneutouch.mechanics.membrane import error_against_exact_membrane, membrane_result
from pneutouch.mechanics.prediction import Prediction
from pneutouch.mechanics.sensor import Sensor
from pneutouch.units import KPA, ML

MODELS = ("membrane", "solid")
"""The rungs there are, cheapest first."""

DISCRETISATION = {"sensitivity_discretisation_relative": 0.011, "limit_pressure_relative": 0.002}
"""Greatest relative errors of the solid at its default resolution against a refined mesh (docs/accuracy.md)."""

_DISCRETISATION_SUMMARY = (
    f"Discretisation: sensitivity within {DISCRETISATION['sensitivity_discretisation_relative']:.1%}, limit pressure "
    f"within {DISCRETISATION['limit_pressure_relative']:.1%} of a refined mesh."
)

_MEMBRANE_ASSUMPTIONS = (
    "thin neo-Hookean membrane, incompressible, C1 = mu/2; no bending stiffness: the wall's own stiffness is missing",
    "constant curvature of the free part and one thickness everywhere (paper, eq. 3 and 11)",
    "R0 is the inner radius; outer heights add the thinned wall",
    "uniaxial elongation at break is set against the equibiaxial stretch",
)

_SOLID_ASSUMPTIONS = (
    "axisymmetric hyperelastic solid with the wall's full stiffness; no wrinkles around the axis",
    "R0 is the inner radius; heights are those of the inner and the outer surface",
    "the wall below the base plane, self-contact and contact with the connector are not modelled",
    "the fold of the wall at its clamped corner, which refined meshes find in deep presses, is not resolved by default",
    "the plate's edge is rounded with a thirtieth of its radius",
    "elongation at break is set against the greatest principal stretch on the faces, half a wall away from the clamp",
)

_CLAMPED_BASE = "rim clamped at the base plane, as in the paper"
_CLAMPED_FLANGE = "flange clamped on the faces that the connector holds, its top free"

_COMMON_ASSUMPTIONS = (
    "rigid, flat, frictionless plate",
    "ideal gas at constant temperature (Boyle); fast contact is stiffer, up to 1.4 times for adiabatic air",
    "elastic wall: no rate, relaxation or temperature dependence of the resin",
)


def _merged(one: dict[str, Any], other: dict[str, Any]) -> dict[str, Any]:
    return {**one, **other, "summary": [*one.get("summary", []), *other.get("summary", [])]}


def predict(
    design: str, sensor: Sensor, driving_pressures: list[float], *,
    model: str = "solid", closure: str = "variational", sensitivity_error: dict[str, Any] | None = None,
) -> Prediction:  # fmt: skip
    """Predict a sensor at ascending driving pressures (MPa) with one rung; ``closure`` is the membrane's.

    ``sensitivity_error`` is what is known of the model's error in sensitivity for this resin. Raises
    InputError for an unknown model or closure, BeyondLimitError beyond the limit point, ComputationError where
    no equilibrium is found.
    """
    if model not in MODELS:
        raise InputError(f"--model {model}: unknown model.{nearest(model, MODELS)}")
    if closure not in CLOSURES:
        raise InputError(f"--closure {closure}: unknown closure.{nearest(closure, CLOSURES)}")
    pressures = np.array(driving_pressures, float)
    gas = f"dead volume {sensor.dead_volume / ML:.4g} mL, ambient pressure {sensor.ambient_pressure / KPA:g} kPa"
    held = _CLAMPED_FLANGE if model == "solid" and sensor.flange is not None else _CLAMPED_BASE
    if model == "membrane":
        found = membrane_result(sensor, pressures, closure)
        errors: dict[str, Any] = error_against_exact_membrane(sensor, pressures)
        assumptions: tuple[str, ...] = _MEMBRANE_ASSUMPTIONS
    else:
        from pneutouch.mechanics.solid_states import solid_result

        found = solid_result(sensor, pressures)
        errors = {**DISCRETISATION, "summary": [_DISCRETISATION_SUMMARY]}
        assumptions = (f"law {sensor.material.convention}, Poisson ratio {sensor.poisson_ratio:g}", *_SOLID_ASSUMPTIONS)
    return Prediction(
        design=design, model=model, closure=closure if model == "membrane" else None,
        error_estimate=_merged(errors, sensitivity_error or {}),
        limit_point=found.limit_point, limits=found.limits, dead_volume=sensor.dead_volume,
        inflation=found.inflation, states=found.states, assumptions=(*assumptions, held, *_COMMON_ASSUMPTIONS, gas),
    )  # fmt: skip
