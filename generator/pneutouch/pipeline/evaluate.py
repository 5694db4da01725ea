"""A design evaluated: drawn, predicted, and refused where it cannot be."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from pneutouch.catalogue import Library, Scene, load_scene
from pneutouch.errors import InputError
from pneutouch.mechanics import Prediction, Sensor, predict
from pneutouch.mechanics.limits import limit_point
from pneutouch.parts import Assembly, assemble
from pneutouch.printability import Finding, check
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer
from pneutouch.units import GAUGE_LIMIT, KPA, STANDARD_ATMOSPHERE

PAPER_RADIUS, PAPER_WALL, PAPER_PLATE = 9.25, 1.5, 30.0
"""The paper's sensor in mm: section 2-B and Supplement B."""


@dataclass(frozen=True)
class Evaluation:
    """A scene with its bodies and its prediction; findings are made when asked for."""

    scene: Scene
    assembly: Assembly
    sensor: Sensor
    prediction: Prediction
    library: Library

    @cached_property
    def findings(self) -> list[Finding]:
        """What the rules say."""
        return check(self.assembly, self.prediction)


def evaluate(
    name: str, assignments: list[str] | None = None, *,
    model: str = "membrane", closure: str = "variational", library: Library | None = None,
) -> Evaluation:  # fmt: skip
    """Load, draw and predict a design given by name or path. Raises InputError where it cannot work."""
    shelves = library or Library.default()
    scene = load_scene(name, assignments, shelves)
    assembly = assemble(scene)
    _check_envelope(assembly)
    sensor = sensor_of(assembly)
    _check_driving(scene, sensor)
    pressures = [p * KPA for p in scene.design.pneumatics.driving_pressures_kPa]
    prediction = predict(
        scene.name, sensor, pressures, model=model, closure=closure,
        sensitivity_error=sensitivity_error(scene.membrane_material, model, closure),
    )  # fmt: skip
    return Evaluation(scene, assembly, sensor, prediction, shelves)


def sensor_of(assembly: Assembly) -> Sensor:
    """The mechanics' view of an assembly: mm and MPa."""
    design, material = assembly.scene.design, assembly.scene.membrane_material
    return replace(
        material_sensor(material),
        inner_radius=assembly.layout.inner_radius,
        wall_thickness=assembly.layout.wall,
        ambient_pressure=design.pneumatics.ambient_pressure_kPa * KPA,
        dead_volume=assembly.dead_volume,
        plate_radius=0.5 * design.indentation.plate_diameter_mm,
        depth=design.depth_mm,
        steps=design.indentation.steps,
    )


def material_sensor(material: Material) -> Sensor:
    """The paper's sensor in a material: no dead volume, 14 steps to three quarters of R0."""
    assert material.shear_modulus_MPa is not None and material.poisson_ratio is not None
    elongation = material.elongation_at_break_percent
    return Sensor(
        inner_radius=PAPER_RADIUS, wall_thickness=PAPER_WALL,
        shear_modulus=material.shear_modulus_MPa.nominal, poisson_ratio=material.poisson_ratio.nominal,
        ambient_pressure=STANDARD_ATMOSPHERE, dead_volume=0.0, plate_radius=0.5 * PAPER_PLATE,
        depth=0.75 * PAPER_RADIUS, steps=14,
        break_stretch=None if elongation is None else 1 + elongation.least / 100, gauge_limit=GAUGE_LIMIT,
    )  # fmt: skip


def sensitivity_error(material: Material, model: str, closure: str) -> dict[str, Any]:
    """The model's relative error in sensitivity on the paper's sensor in this material, where it was measured."""
    if material.measured is None:
        return {
            "sensitivity_relative": None,
            "sensitivity_basis": f"no measurement of a sensor in {material.label} is known",
        }
    states = predict("", material_sensor(material), [0.0, 22 * KPA], model=model, closure=closure).states
    measured = (material.measured.sensitivity_0kPa_kPa_per_N, material.measured.sensitivity_22kPa_kPa_per_N)
    errors = [
        state.figures.sensitivity / quantity.nominal - 1
        for state, quantity in zip(states, measured, strict=True)
        if state.figures is not None
    ]
    return {
        "sensitivity_relative": float(np.max(np.abs(errors))) if errors else None,
        "sensitivity_relative_0kPa_22kPa": errors,
        "sensitivity_basis": "this model on the paper's sensor in the same resin against its Table S1, nothing fitted",
    }


def _check_driving(scene: Scene, sensor: Sensor) -> None:
    limit = limit_point(sensor).driving_pressure / KPA
    for k, pressure in enumerate(scene.design.pneumatics.driving_pressures_kPa):
        if pressure > limit:
            raise InputError(
                f"{scene.where}: pneumatics.driving_pressures_kPa[{k}] = {pressure:g}: beyond the limit point, where "
                f"the dome snaps; with this resin, wall and radius it must be at most {limit:.2f} kPa"
            )


def _check_envelope(assembly: Assembly) -> None:
    scene = assembly.scene
    machines: list[tuple[str, Printer]] = [
        ("profile", scene.printer), ("connector_profile", scene.connector_printer)
    ]  # fmt: skip
    for solid, (key, printer) in zip(assembly.solids, machines, strict=True):
        radius, low, high = solid.meridian.bounds()
        size, room = (2 * radius, 2 * radius, high - low), printer.envelope_mm
        if any(length > limit for length, limit in zip(size, (room.x, room.y, room.z), strict=True)):
            raise InputError(
                f"{scene.where}: print.{key} = {getattr(scene.design.print, key)!r}: the {solid.name} is "
                f"{size[0]:.1f} x {size[1]:.1f} x {size[2]:.1f} mm (membrane.inner_radius_mm = "
                f"{assembly.layout.inner_radius:g}); it must fit {room.x:g} x {room.y:g} x {room.z:g} mm"
            )
