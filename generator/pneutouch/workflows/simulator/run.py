"""Tabulate a design's press at its driving pressures and write its sensor for a simulator."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pneutouch import __version__
from pneutouch.errors import InputError, nearest
from pneutouch.evaluation.evaluate import Evaluation
from pneutouch.evaluation.reader import curve_of
from pneutouch.export.simulator.mjcf import mjcf_files
from pneutouch.export.simulator.model import PressTable, SimulatedSensor, press_table, simulated_sensor
from pneutouch.export.simulator.urdf import urdf_files
from pneutouch.mechanics import predict
from pneutouch.output.files import check_writable
from pneutouch.output.files import write_folder as write_files
from pneutouch.output.manifest import with_manifest
from pneutouch.output.recipe import BuildRecipe
from pneutouch.rounding import rounded
from pneutouch.units import KPA
from pneutouch.workflows.simulator.readme import readme

SIMULATORS = {"mujoco": mjcf_files, "urdf": urdf_files}
"""Writers of the files of a simulator's model, by the name of its format."""

STEPS = 80
"""Steps of a press: the spline through them is within 1 % of the model from a fiftieth of the range on."""

_DIGITS = 6


@dataclass(frozen=True)
class SimulatorResult:
    """A model: the name of its folder, its document, and its files by path."""

    name: str
    document: dict[str, Any]
    files: dict[str, bytes]
    inputs: dict[str, Any]


def make_simulator(evaluation: Evaluation, kind: str) -> SimulatorResult:
    """The sensor of an evaluated design for a simulator of `SIMULATORS`.

    Raises InputError for another simulator and for contact off the axis, ComputationError where a press has no range.
    """
    if kind not in SIMULATORS:
        raise InputError(f"unknown.{nearest(kind, SIMULATORS)}", key="simulator", value=kind)
    off_axis = evaluation.sensor.protocol.off_axis
    if off_axis is not None:
        raise InputError(off_axis, key="simulator", value=kind, remedy="the joint of the model moves along the axis")
    sensor = _simulated(evaluation)
    files = {"README.md": readme(sensor, kind), **SIMULATORS[kind](sensor)}
    name = f"{sensor.name}-{kind}"
    return SimulatorResult(name, _document(evaluation, sensor, kind), files, BuildRecipe.of(evaluation).inputs())


def _simulated(evaluation: Evaluation) -> SimulatedSensor:
    assembly, membrane = evaluation.assembly, evaluation.scene.membrane_material
    layout = assembly.layout
    dome = (layout.inner_radius, layout.wall, membrane.density_g_per_cm3.nominal)
    return simulated_sensor(evaluation.scene.name, assembly.bodies, assembly.solids, dome, press_tables(evaluation))


def press_tables(evaluation: Evaluation, steps: int = STEPS) -> tuple[PressTable, ...]:
    """The press at the design's driving pressures, in equal steps."""
    sensor, options = evaluation.sensor.replace(steps=steps), evaluation.options
    prediction = predict(
        evaluation.scene.name,
        sensor,
        [state.driving_pressure for state in evaluation.prediction.states],
        model=evaluation.prediction.model,
        closure=options.closure,
    )
    tables = []
    for state in prediction.states:
        curve = curve_of(state, sensor)
        rise_kPa = curve.rise / KPA
        at_kPa = state.driving_pressure / KPA
        tables.append(press_table(at_kPa, state.apex_outer, curve.indentation, curve.force, rise_kPa))
    return tuple(tables)


def _document(evaluation: Evaluation, sensor: SimulatedSensor, kind: str) -> dict[str, Any]:
    content = {
        "design": sensor.name,
        "simulator": kind,
        "model": evaluation.prediction.model,
        "version": __version__,
        "mass_g": 1e3 * sensor.inertia.mass,
        "centre_of_mass_mm": (1e3 * sensor.inertia.centre).tolist(),
        "inertia_about_centre_g_mm2": (1e9 * sensor.inertia.about_centre).tolist(),
        "states": [
            {
                "driving_pressure_kPa": table.driving_pressure_kPa,
                "apex_height_outer_mm": 1e3 * table.apex,
                "range_end_mm": 1e3 * float(table.indentation[-1]),
                "contact_force_N": float(table.force[-1]),
                "pressure_kPa": float(table.pressure_kPa[-1]),
                "greatest_stiffness_N_per_mm": 1e-3 * table.stiffest,
            }
            for table in sensor.tables
        ],
    }
    return rounded(content, _DIGITS, 1e-9)


def write_simulator(result: SimulatorResult, out: Path) -> Path:
    """Write ``out/<design>-<simulator>/``; the same input, the same bytes. Returns that folder."""
    folder = out / result.name
    check_writable(folder)
    write_files(folder, with_manifest(result.files, result.name, result.inputs))
    return folder
