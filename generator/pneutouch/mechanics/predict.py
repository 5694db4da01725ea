"""Predict a sensor with one rung of the ladder of models."""

from __future__ import annotations

from typing import Any

import numpy as np

from pneutouch.errors import InputError, nearest
from pneutouch.mechanics.contact import CLOSURES
from pneutouch.mechanics.limits import limit_point, limits
from pneutouch.mechanics.membrane import error_against_exact_membrane, membrane_states
from pneutouch.mechanics.prediction import Prediction
from pneutouch.mechanics.sensor import Sensor
from pneutouch.units import KPA

MODELS = ("membrane",)
"""The rungs there are, cheapest first."""

_MEMBRANE_ASSUMPTIONS = (
    "thin neo-Hookean membrane, incompressible, C1 = mu/2; no bending stiffness: the wall's own stiffness is missing",
    "constant curvature of the free part and one thickness everywhere (paper, eq. 3 and 11)",
    "R0 is the inner radius; outer heights add the thinned wall",
    "rigid, flat, frictionless plate; base clamped at the base plane",
    "ideal gas at constant temperature (Boyle); fast contact is stiffer, up to 1.4 times for adiabatic air",
    "elastic wall: no rate, relaxation or temperature dependence of the resin",
    "uniaxial elongation at break is set against the equibiaxial stretch",
)


def predict(
    design: str, sensor: Sensor, driving_pressures: list[float], *,
    model: str = "membrane", closure: str = "variational", sensitivity_error: dict[str, Any] | None = None,
) -> Prediction:  # fmt: skip
    """Predict a sensor at ascending driving pressures (MPa).

    ``sensitivity_error`` is what is known of the model's error in sensitivity for this resin. Raises
    InputError for an unknown model or closure, ComputationError beyond the limit point.
    """
    if model not in MODELS:
        raise InputError(f"--model {model}: unknown model.{nearest(model, MODELS)}")
    if closure not in CLOSURES:
        raise InputError(f"--closure {closure}: unknown closure.{nearest(closure, CLOSURES)}")
    pressures = np.array(driving_pressures, float)
    states = membrane_states(sensor, pressures, closure)
    gas = f"dead volume {sensor.dead_volume / 1e3:.4g} mL, ambient pressure {sensor.ambient_pressure / KPA:g} kPa"
    return Prediction(
        design=design, model=model, closure=closure,
        error_estimate={**error_against_exact_membrane(sensor, pressures), **(sensitivity_error or {})},
        limit_point=limit_point(sensor), limits=limits(sensor), dead_volume=sensor.dead_volume,
        states=states, assumptions=(*_MEMBRANE_ASSUMPTIONS, gas),
    )  # fmt: skip
