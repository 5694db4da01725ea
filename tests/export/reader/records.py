"""Documents of readers without a model: a sensor whose force over pressure is known in closed form."""

from __future__ import annotations

import struct

AMBIENT_KPA, BOTTOM_KPA, TOP_KPA, ROWS, COLUMNS, GAS = 101.325, -3.0, 24.0, 10, 33, 37


def single(value: float) -> float:
    """The number as float32 has it."""
    return float(struct.unpack("f", struct.pack("f", value))[0])


def record(*, factor: float = 1.0, relative: bool = True, range_kPa=(-101.325, 90.0)):
    """A dome that grows by 1 % a kPa, whose force is (1 + p/20) x^2 at a rise of (10 + p/10) x, x the share."""
    span = TOP_KPA - BOTTOM_KPA
    driving = [single(BOTTOM_KPA + span / (ROWS - 1) * k) for k in range(ROWS)]
    share = [k / (COLUMNS - 1) for k in range(COLUMNS)]
    gas = [single(BOTTOM_KPA + span / (GAS - 1) * k) for k in range(GAS)]
    return {
        "format": "pneutouch/reader/1",
        "design": "closed-form",
        "calibration": None,
        "model": "atlas",
        "units": {"force": "N"},
        "grid": {
            "driving_pressure_kPa": driving,
            "pressure_rise_kPa": [[single((10 + p / 10) * x) for x in share] for p in driving],
            "contact_force_N": [[single((1 + p / 20) * x * (1 + x)) for x in share] for p in driving],
            "indentation_mm": [5.0] * ROWS,
            "pressure_factor": [factor] * ROWS,
            "force_uncertainty_relative": [[single(0.05 + 0.01 * k) for k in range(5)]] * ROWS if relative else None,
            "force_uncertainty_unknown": None if relative else "an object",
            "force_uncertainty_age_days": 365.0,
        },
        "gas": {"driving_pressure_kPa": gas, "volume_mL": [single(2.0 * (1 + 0.01 * p)) for p in gas]},
        "box": {
            "driving_pressure_kPa": [0.0, TOP_KPA],
            "driving_pressure_margin_kPa": single(0.1),
            "contact_force_N": [0.0, 4.4],
            "pressure_rise_kPa": [0.0, 12.4],
            "indentation_mm": [0.0, 5.0],
            "ambient_pressure_kPa": [single(98.325), single(104.325)],
            "temperature_change_K": 5.0,
        },
        "rating": {"driving_pressure_kPa": 20.0, "basis": "assumed"},
        "gauge": {"name": None, "range_kPa": [single(x) for x in range_kPa]},
        "zero": {
            "drift_kPa_per_K": 0.3,
            "temperature_rate_K_per_h": 2.2,
            "drift_rate_kPa_per_s": single(0.3 * 2.2 / 3600),
            "drift_most_kPa": 1.5,
            "noise_least_kPa": single(1e-5),
            "noise_most_kPa": single(0.03),
            "filter_s": 1.0,
        },
        "conditions": {
            "driving_pressures_kPa": [0.0, 12.0],
            "ambient_pressure_kPa": single(AMBIENT_KPA),
            "dead_volume_mL": 0.0,
            "contact": "rigid, flat, frictionless plate",
            "assumptions": [],
        },
        "difference": {
            "nominal_N": 0.001,
            "nominal_percent": 0.02,
            "other_conditions_N": 0.002,
            "other_conditions_percent": 0.04,
            "states": 10,
        },
        "source": {"sha256": "0" * 64, "version": "0.1.0"},
    }
