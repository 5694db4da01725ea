"""Temperature, speed, humidity and ageing: calculated or quoted, never guessed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from pneutouch.catalogue import ResolvedDesign
from pneutouch.mechanics import SensorPrediction, SensorState
from pneutouch.units import KPA

if TYPE_CHECKING:
    from pneutouch.mechanics.uncertainty import GasNotes

_ROOM = 293.15
"""K, as in `mechanics.uncertainty`."""

NOT_TESTED = "not tested"


def environment(scene: ResolvedDesign, prediction: SensorPrediction, gas: GasNotes | None) -> list[list[str]]:
    """Rows of quantity, value and basis; ``gas`` holds what the atlas says of the air, one entry a state."""
    rows = _air(prediction, gas) if gas is not None else _drift_alone(scene, prediction)
    material = scene.membrane_material
    if material.shore_a and material.shore_a_one_year:
        text = f"Shore A {material.shore_a.text()} to {material.shore_a_one_year.text()}"
        rows.append(["Ageing, one year in light and air", text, "paper, Table 1"])
    return [*rows, ["Humidity, oils, ozone, UV", NOT_TESTED, ""]]


def _air(prediction: SensorPrediction, gas: GasNotes) -> list[list[str]]:
    """At the lowest and the highest driving pressure."""
    ends = [0, len(prediction.states) - 1] if len(prediction.states) > 1 else [0]
    at = " and ".join(f"{prediction.states[k].driving_pressure / KPA:g}" for k in ends) + " kPa"

    def values(numbers: np.ndarray[tuple[int], np.dtype[np.float64]], form: str, unit: str) -> str:
        texts = [format(float(numbers[k]), form) if np.isfinite(numbers[k]) else "–" for k in ends]
        return " and ".join(texts) + f" {unit}"

    return [
        ["Zero drift of the sealed gas", values(gas.by_temperature_kPa_per_K, ".2f", "kPa/K"),
         f"ideal gas in the yielding dome at {at}, 20 °C; a rigid cavity would show {values(1 / gas.wall_give, '.1f', 'times')} as much"],
        ["the same as force", values(gas.force_by_temperature, ".2f", "N/K"), "drift over the predicted sensitivity"],
        ["Fast contact", values(gas.fast_over_slow, ".2f", "times"),
         f"sensitivity with adiabatic over that with isothermal air, over the same travel at {at}"],
    ]  # fmt: skip


def _drift_alone(scene: ResolvedDesign, prediction: SensorPrediction) -> list[list[str]]:
    """Without the atlas: the drift, from the predicted inflation curve; nothing is known of fast contact."""
    state = prediction.states[0]
    drift_kPa_per_K = zero_drift_kPa_per_K(scene, prediction, state)
    at = f"at {state.driving_pressure / KPA:g} kPa, 20 °C"
    rows = [["Zero drift of the sealed gas", f"{drift_kPa_per_K:.2f} kPa/K", f"ideal gas in the yielding dome {at}"]]
    if state.figures is not None:
        force = f"{drift_kPa_per_K / state.figures.sensitivity_kPa_per_N:.2f} N/K"
        rows.append(["the same as force", force, "drift over the predicted sensitivity"])
    return [*rows, ["Fast contact", "not known", "computed for sensors inside the atlas alone"]]


def zero_drift_kPa_per_K(scene: ResolvedDesign, prediction: SensorPrediction, state: SensorState) -> float:
    """Pressure change of the shut-in gas by temperature without contact, kPa/K.

    The dome yields as the gas warms: dp/dT = (p_abs/T) k/(k + p_abs/V), k = dp/dV of the dome and V the gas.
    """
    curve = prediction.inflation
    slope = float(np.interp(state.cavity_volume, curve.volume, np.gradient(curve.pressure, curve.volume)))
    absolute = scene.design.pneumatics.ambient_pressure_kPa * KPA + state.driving_pressure
    gas = absolute / (state.cavity_volume + prediction.dead_volume)
    return absolute / _ROOM * slope / (slope + gas) / KPA
