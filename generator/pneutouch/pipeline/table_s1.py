"""What is known of each model's error in sensitivity: the paper's sensor in each resin against its Table S1.

The solid's errors are computed once and shipped (``make chart`` writes the file, a test recomputes cells of it):
computing them again would double the time of every prediction. The membrane's cost nothing and are computed here.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch.mechanics import Sensor, predict
from pneutouch.spec.material import Material
from pneutouch.units import GAUGE_LIMIT, KPA, STANDARD_ATMOSPHERE

PAPER_RADIUS, PAPER_WALL, PAPER_PLATE = 9.25, 1.5, 30.0
"""The paper's sensor in mm: section 2-B and Supplement B."""

PRESSURES = (0.0, 22.0)
"""Driving pressures of Table S1, kPa."""

SHIPPED = Path(__file__).with_name("table_s1.json")


def material_sensor(material: Material) -> Sensor:
    """The paper's sensor in a material: no dead volume, 14 steps to three quarters of R0.

    Raises InputError for a Poisson ratio or a law that makes no solid.
    """
    assert material.shear_modulus_MPa is not None and material.poisson_ratio is not None
    elongation = material.elongation_at_break_percent
    sensor = Sensor(
        inner_radius=PAPER_RADIUS, wall_thickness=PAPER_WALL,
        shear_modulus=material.shear_modulus_MPa.nominal, poisson_ratio=material.poisson_ratio.nominal,
        ambient_pressure=STANDARD_ATMOSPHERE, dead_volume=0.0, plate_radius=0.5 * PAPER_PLATE,
        depth=0.75 * PAPER_RADIUS, steps=14,
        break_stretch=None if elongation is None else 1 + elongation.least / 100, gauge_limit=GAUGE_LIMIT,
        law=None if material.law is None else (material.law.name, tuple(material.law.constants)),
    )  # fmt: skip
    return replace(sensor, shear_modulus=sensor.material.mu)


def measured(material: Material) -> tuple[float, float] | None:
    """The sensitivities of Table S1 for a resin, kPa/N, or None."""
    found = material.measured
    if found is None:
        return None
    return found.sensitivity_0kPa_kPa_per_N.nominal, found.sensitivity_22kPa_kPa_per_N.nominal


def compute_errors(material: Material, model: str, closure: str) -> list[float | None]:
    """Relative errors at the pressures of Table S1; None where the model gives no figure."""
    truth = measured(material)
    assert truth is not None
    states = predict("", material_sensor(material), [p * KPA for p in PRESSURES], model=model, closure=closure).states
    return [s.figures.sensitivity / t - 1 if s.figures else None for s, t in zip(states, truth, strict=True)]


def sensitivity_error(material: Material, model: str, closure: str) -> dict[str, Any]:
    """The part of ``error_estimate`` on sensitivity: greatest and single relative errors, and their basis."""
    if measured(material) is None:
        basis = f"no measurement of a sensor in {material.label} is known"
        return {"sensitivity_relative": None, "sensitivity_basis": basis, "summary": [f"Sensitivity: {basis}."]}
    if model == "solid":
        errors = json.loads(SHIPPED.read_text(encoding="utf-8"))[material.title]
    else:
        errors = compute_errors(material, model, closure)
    known = [abs(error) for error in errors if error is not None]
    pairs = ", ".join(f"{e:+.0%} at {p:g} kPa" for e, p in zip(errors, PRESSURES, strict=True) if e is not None)
    basis = "this model on the paper's sensor in the same resin against its Table S1, nothing fitted"
    return {
        "sensitivity_relative": float(np.max(known)) if known else None,
        "sensitivity_relative_0kPa_22kPa": errors,
        "sensitivity_basis": basis,
        "summary": [f"Sensitivity: {pairs or 'no figure'}; {basis}."],
    }
