"""A design evaluated: drawn, predicted, and refused where it cannot be."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from pneutouch.catalogue import Library, Scene, load_scene
from pneutouch.errors import BeyondLimitError, InputError, nearest
from pneutouch.mechanics import Prediction, Sensor, predict
from pneutouch.mechanics.ladder import DEFAULT_TOLERANCE
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.parts import Assembly, assemble
from pneutouch.pipeline.table_s1 import sensitivity_error
from pneutouch.printability import Finding, check
from pneutouch.spec.printer import Printer
from pneutouch.units import KPA

CLAMPS = ("base", "flange")
"""Where the solid is held."""


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

    @cached_property
    def uncertainty(self) -> tuple[dict[str, Any], ...]:
        """How sure the figures of each state are; a sweep that does not ask does not pay."""
        from pneutouch.pipeline.uncertainty import documents

        return documents(self)


def evaluate(
    name: str, assignments: list[str] | None = None, *,
    model: str = "solid", closure: str = "variational", clamp: str = "base", tolerance: float = DEFAULT_TOLERANCE,
    library: Library | None = None,
) -> Evaluation:  # fmt: skip
    """Load, draw and predict a design given by name or path. Raises InputError where it cannot work.

    ``tolerance`` is what ``model="auto"`` must meet. ``clamp`` says where the solid is held: at the "base" plane, as in the paper, or at the "flange", as printed.
    """
    if clamp not in CLAMPS:
        raise InputError(f"--clamp {clamp}: unknown.{nearest(clamp, CLAMPS)}")
    shelves = library or Library.default()
    scene = load_scene(name, assignments, shelves)
    assembly = assemble(scene)
    _check_envelope(assembly)
    sensor = sensor_of(assembly, clamp)
    pressures = [p * KPA for p in scene.design.pneumatics.driving_pressures_kPa]
    try:
        prediction = predict(
            scene.name, sensor, pressures, model=model, closure=closure, tolerance=tolerance,
            sensitivity_error=lambda rung: sensitivity_error(scene.membrane_material, sensor, rung, closure),
        )  # fmt: skip
    except BeyondLimitError as error:
        raise _beyond_limit(scene, error) from None
    _check_plate(scene, prediction)
    return Evaluation(scene, assembly, sensor, prediction, shelves)


def sensor_of(assembly: Assembly, clamp: str = "base") -> Sensor:
    """The mechanics' view of an assembly: mm and MPa."""
    layout = assembly.layout
    design = assembly.scene.design
    return replace(
        _material_sensor(assembly.scene),
        inner_radius=layout.inner_radius,
        wall_thickness=layout.wall,
        ambient_pressure=design.pneumatics.ambient_pressure_kPa * KPA,
        dead_volume=assembly.dead_volume,
        plate_radius=0.5 * design.indentation.plate_diameter_mm,
        depth=design.depth_mm,
        steps=design.indentation.steps,
        flange=(layout.flange_width, layout.flange_thickness) if clamp == "flange" else None,
    )


def _material_sensor(scene: Scene) -> Sensor:
    """The paper's sensor in the scene's resin; a law that makes no solid is the material file's fault."""
    try:
        return material_sensor(scene.membrane_material)
    except InputError as error:
        raise InputError(f"{scene.where}: membrane.material = {scene.design.membrane.material!r}: {error}") from None


def _beyond_limit(scene: Scene, error: BeyondLimitError) -> InputError:
    """The limit point in terms of the design file."""
    pressures = scene.design.pneumatics.driving_pressures_kPa
    k = int(np.argmin([abs(p - error.pressure / KPA) for p in pressures]))
    return InputError(
        f"{scene.where}: pneumatics.driving_pressures_kPa[{k}] = {pressures[k]:g}: beyond the limit point, where "
        f"the dome snaps; with this resin, wall and radius it must be at most {error.limit / KPA:.2f} kPa"
    )


def _check_plate(scene: Scene, prediction: Prediction) -> None:
    """Refuse a plate whose edge would dig into the dome within the depth."""
    for state in prediction.states:
        ending = [event for event in state.events if event.ends_range]
        if ending and ending[0].kind == "plate edge":
            raise InputError(
                f"{scene.where}: indentation.plate_diameter_mm = {scene.design.indentation.plate_diameter_mm:g}: the contact "
                f"reaches the plate's edge at {ending[0].indentation:.2f} mm of indentation; it must be wider than the "
                f"contact (twice membrane.inner_radius_mm = {2 * scene.design.membrane.inner_radius_mm:g} mm is safe), or "
                f"indentation.depth_mm less"
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
