"""Known errors of each model in sensitivity: the paper's sensor in each resin against its Table S1.

The solid's errors are computed once and shipped: computing them again would double the time of every prediction.
``python -m benchmarks.paper`` writes the file, and a test recomputes cells of it. The membrane's are computed here.
"""

import hashlib
import json
from functools import lru_cache
from pathlib import Path

import numpy as np

from pneutouch.mechanics import Sensor, predict
from pneutouch.mechanics.paper_sensor import is_paper_sensor, material_sensor
from pneutouch.results.prediction import SensitivityError
from pneutouch.shape.hemisphere import no_hemisphere
from pneutouch.spec.material import Material
from pneutouch.units import KPA

PRESSURES = (0.0, 22.0)
"""Driving pressures of Table S1, kPa."""

SHIPPED = Path(__file__).with_name("table_s1.json")

NEAR_WALL, NEAR_DEAD_VOLUME = (0.10, 0.25), 0.2
"""Least and greatest wall ratio, and greatest dead volume over the cavity's, that count as near the paper's sensor."""


def measured(material: Material) -> tuple[float, float] | None:
    """The sensitivities of Table S1 for a resin, kPa/N, at `PRESSURES`; None if the paper did not measure it."""
    published = material.measured
    if published is None:
        return None
    return published.sensitivity_0kPa_kPa_per_N.nominal, published.sensitivity_22kPa_kPa_per_N.nominal


def published_sensitivities(sensor: Sensor, material: Material) -> dict[float, float]:
    """Sensitivities of Table S1, kPa/N, by driving pressure, kPa; empty if the sensor is not one that was measured."""
    values = measured(material)
    return dict(zip(PRESSURES, values, strict=True)) if values and is_paper_sensor(sensor) else {}


def compute_errors(material: Material, model: str, closure: str) -> list[float | None]:
    """Relative errors of a model in sensitivity at `PRESSURES`; None where the model gives no figure."""
    truth = measured(material)
    assert truth is not None
    return list(_errors(material_sensor(material), truth, model, closure))


@lru_cache
def _errors(sensor: Sensor, truth: tuple[float, float], model: str, closure: str) -> tuple[float | None, ...]:
    states = predict("", sensor, [p * KPA for p in PRESSURES], model=model, closure=closure).states
    return tuple(s.figures.sensitivity / t - 1 if s.figures else None for s, t in zip(states, truth, strict=True))


def fingerprint(material: Material) -> str:
    """Digest of the inputs of the solid's error on the paper's sensor: mechanical properties and measurements of the
    resin."""
    sensor = material_sensor(material)
    facts = [
        sensor.wall.shear_modulus,
        sensor.wall.poisson_ratio,
        sensor.wall.break_stretch,
        sensor.wall.law,
        measured(material),
    ]
    return hashlib.sha256(json.dumps(facts).encode()).hexdigest()[:16]


def is_near_paper(sensor: Sensor) -> bool:
    """True if a sensor is so near the paper's that a model's error on the paper's sensor applies to it."""
    low, high = NEAR_WALL
    dome, least = sensor.dome, NEAR_DEAD_VOLUME * sensor.dome.shape.cavity_volume
    close = low <= dome.wall_thickness / dome.inner_radius <= high and no_hemisphere(dome.shape.plain) is None
    return close and sensor.protocol.other_contact is None and sensor.gas.dead_volume <= least and dome.flange is None


def sensitivity_error(material: Material, sensor: Sensor, model: str, closure: str) -> SensitivityError:
    """Error of the sensitivity for ``error_estimate``: greatest and single relative errors, and their basis.

    Unknown where nothing was measured, and where the sensor is not near the measured one.
    """
    if measured(material) is None:
        return _unknown(f"no measurement of a sensor in {material.label} is known")
    if not is_near_paper(sensor):
        return _unknown(
            "the only measurements are of the paper's sensor (wall 0.16 R0, no stated dead volume, clamped base) under "
            "a plate taken as frictionless"
        )
    if model in ("atlas", "solid"):
        errors = json.loads(SHIPPED.read_text(encoding="utf-8")).get(fingerprint(material))
        errors = errors or compute_errors(material, "solid", closure)
    else:
        errors = compute_errors(material, model, closure)
    known = [abs(error) for error in errors if error is not None]
    pairs = ", ".join(f"{e:+.0%} at {p:g} kPa" for e, p in zip(errors, PRESSURES, strict=True) if e is not None)
    basis = "this model on the paper's sensor in the same resin against its Table S1, nothing fitted"
    greatest = float(np.max(known)) if known else None
    return SensitivityError(greatest, basis, f"Sensitivity: {pairs or 'no figure'}; {basis}.", tuple(errors))


def _unknown(why: str) -> SensitivityError:
    return SensitivityError(None, why, f"Sensitivity: error unknown; {why}.")
