"""A calibration of the paper's sensor, in a library of its own, and predictions of it."""

from __future__ import annotations

from pneutouch.catalogue import Library
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.spec.toml_text import toml_text

MODULUS, WALL, VOLUME = 0.2, 1.55, 0.31
LOW, HIGH = (1.05, 1.01), (0.97, 1.03)
"""Factors on force and pressure at 0 and 12 kPa."""
CONTENT = {
    "format": "pneutouch/calibration/1",
    "title": "sensor A, spring",
    "covariance": [[9e-4, -6e-4, 0.0], [-6e-4, 1.6e-3, 0.0], [0.0, 0.0, 4e-4]],
    "source": {
        "sensor": "A",
        "campaign": "spring",
        "lab": "",
        "digest": "ab" * 32,
        "simulated": False,
        "curves": 4,
        "injections": 1,
        "driving_pressures_kPa": [0.0, 12.0],
        "ambient_pressure_kPa": 101.325,
        "age_days": 73.0,
    },
    "design": {
        "name": "paper-dome",
        "material": "TangoPlus",
        "inner_radius_mm": 9.25,
        "wall_thickness_mm": 1.5,
        "dead_volume_mL": 0.3,
    },
    "parameters": [
        {"key": "shear_modulus_MPa", "value": MODULUS, "fitted": True, "covered": True},
        {"key": "wall_thickness_mm", "value": WALL, "fitted": True, "covered": True},
        {"key": "dead_volume_mL", "value": VOLUME, "fitted": True, "covered": True},
    ],
    "response": {
        "force_factors": [LOW[0], HIGH[0]],
        "pressure_factors": [LOW[1], HIGH[1]],
        "sensitivity_errors_relative": [0.01, 0.01],
        "force_errors_relative": [0.015, 0.015],
        "errors_freedom": 60.0,
        "held_out_pressures_kPa": [],
        "held_out_sensitivity_errors": [],
    },
}
DEAD = {"pneumatics.dead_volume_mL": 0.3}
AT = {**DEAD, "pneumatics.driving_pressures_kPa": [0.0, 6.0, 12.0, 22.0]}


def changed(**tables):
    """The content with keys of its tables changed."""
    return {**CONTENT, **{name: {**CONTENT[name], **keys} for name, keys in tables.items()}}


def held(error):
    """The keys of a response of one pressure held out, with its error."""
    return {"held_out_pressures_kPa": [12.0], "held_out_sensitivity_errors": [error]}


def library_of(folder, shipped, content=CONTENT):
    path = folder / "calibrations" / "mine.toml"
    path.parent.mkdir(exist_ok=True)
    path.write_text(toml_text(content))
    return Library((folder, *shipped.folders))


def predicted(place, changes=AT, design="paper-dome@mine", **options):
    return evaluate(design, changes, model="atlas", library=place, **options)
