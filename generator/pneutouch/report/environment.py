"""Temperature, speed, humidity and ageing: calculated or quoted, never guessed."""

import numpy as np

from pneutouch.arrays import Array
from pneutouch.evaluation.sheet_data import SheetData
from pneutouch.units import KPA

NOT_TESTED = "not tested"


def environment(sheet: SheetData) -> list[list[str]]:
    """Rows of quantity, value and basis."""
    rows = _air(sheet) if sheet.gas is not None else _drift_alone(sheet)
    material = sheet.scene.membrane_material
    if material.shore_a and material.shore_a_one_year:
        text = f"Shore A {material.shore_a.text()} to {material.shore_a_one_year.text()}"
        rows.append(["Ageing, one year in light and air", text, "paper, Table 1"])
    return [*rows, ["Humidity, oils, ozone, UV", NOT_TESTED, ""]]


def _air(sheet: SheetData) -> list[list[str]]:
    """Effects of the air at the lowest and the highest driving pressure."""
    gas, states = sheet.gas, sheet.prediction.states
    assert gas is not None
    ends = [0, len(states) - 1] if len(states) > 1 else [0]
    at = " and ".join(f"{states[k].driving_pressure / KPA:g}" for k in ends) + " kPa"

    def values(numbers: Array, form: str, unit: str) -> str:
        texts = [format(float(numbers[k]), form) if np.isfinite(numbers[k]) else "–" for k in ends]
        return " and ".join(texts) + f" {unit}"

    rigid = values(1 / gas.wall_give, ".1f", "times")
    drift = f"ideal gas in the yielding dome at {at}, 20 °C; a rigid cavity would show {rigid} as much"
    fast = f"sensitivity with adiabatic over that with isothermal air, over the same travel at {at}"
    return [
        ["Zero drift of the sealed gas", values(gas.by_temperature_kPa_per_K, ".2f", "kPa/K"), drift],
        ["the same as force", values(gas.force_by_temperature, ".2f", "N/K"), "drift over the predicted sensitivity"],
        ["Fast contact", values(gas.fast_over_slow, ".2f", "times"), fast],
    ]


def _drift_alone(sheet: SheetData) -> list[list[str]]:
    """Outside the atlas: the drift from the predicted inflation curve; fast contact is unknown."""
    state, drift_kPa_per_K = sheet.prediction.states[0], sheet.zero_drift_kPa_per_K
    at = f"at {state.driving_pressure / KPA:g} kPa, 20 °C"
    rows = [["Zero drift of the sealed gas", f"{drift_kPa_per_K:.2f} kPa/K", f"ideal gas in the yielding dome {at}"]]
    if state.figures is not None:
        force = f"{drift_kPa_per_K / state.figures.sensitivity_kPa_per_N:.2f} N/K"
        rows.append(["the same as force", force, "drift over the predicted sensitivity"])
    return [*rows, ["Fast contact", "not known", "computed for sensors inside the atlas alone"]]
