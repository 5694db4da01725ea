"""Export of a sensor's pressure-to-force model for a microcontroller and Python, and of its model for a simulator."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch import __version__
from pneutouch.errors import InputError, nearest
from pneutouch.evaluation.evaluate import Evaluation
from pneutouch.evaluation.reader import curve_of, reader_difference, reader_grid
from pneutouch.evaluation.reader_tables import reader_tables
from pneutouch.export.reader.render import reader_files, sketch_note
from pneutouch.export.simulator.model import (
    TEXTS,
    PressTable,
    SimulatedDome,
    SimulatedSensor,
    mjcf_files,
    press_table,
    simulated_sensor,
    urdf_files,
)
from pneutouch.formats import versioned
from pneutouch.mechanics import predict
from pneutouch.output.files import digest, json_bytes, with_manifest, write_folder
from pneutouch.output.recipe import BuildRecipe
from pneutouch.results.reader import ReaderRecord, ReaderSource, SimulatedState, SimulatorRecord, TableError
from pneutouch.results.record import extended, plain
from pneutouch.units import KPA
from pneutouch.wording import rounded


@dataclass(frozen=True)
class ReaderResult:
    """A reader: name of its folder, its record, the record as JSON data, the files made from that, by name, and the
    reason why there is no sketch (None if there is one)."""

    name: str
    record: ReaderRecord
    document: dict[str, Any]
    files: dict[str, bytes]
    note: str | None


def make_reader(evaluation: Evaluation, aged: float | None = None) -> ReaderResult:
    """Reader of a design; ``aged`` as in `reader_tables`. Raises what `evaluation.reader.reader_grid` does."""
    grid = reader_grid(evaluation)
    tables = reader_tables(evaluation, grid, aged)
    known = reader_difference(evaluation, grid, versioned("reader", plain(tables)))
    full_N = tables.box.contact_force_N[1]
    record = extended(
        ReaderRecord,
        tables,
        difference=TableError(
            nominal_N=known.nominal_N,
            nominal_percent=100.0 * known.nominal_N / full_N,
            other_conditions_N=known.other_conditions_N,
            other_conditions_percent=100.0 * known.other_conditions_N / full_N,
            states=known.states,
        ),
        source=ReaderSource(_source(evaluation, tables.grid.force_uncertainty_age_days), __version__),
    )
    document = versioned("reader", plain(record))
    calibration, gauge = evaluation.scene.design.calibration_name, evaluation.scene.gauge
    name = evaluation.scene.name
    if calibration is not None:
        name = calibration if calibration.startswith(name) else f"{name}-{calibration}"
    return ReaderResult(f"{name}-reader", record, document, reader_files(document, name, gauge), sketch_note(gauge))


def _source(evaluation: Evaluation, age_days: float) -> str:
    """SHA-256 of all inputs of a reader: the resolved design, options, age, version."""
    inputs = BuildRecipe.of(evaluation).inputs()
    return digest(json_bytes({"inputs": inputs, "age_days": age_days, "version": __version__}))


def write_reader(result: ReaderResult, out: Path) -> Path:
    """Write ``out/<design>-reader/`` and return that folder. The same input gives the same bytes."""
    files = {"reader.json": json_bytes(result.document), **result.files}
    return write_folder(out / result.name, with_manifest(files, result.name, result.document["source"]))


def _readme(sensor: SimulatedSensor, kind: str) -> bytes:
    """README of a simulator's model of ``kind``."""
    tables, pad = [table for dome in sensor.domes for table in dome.tables], "-pad" if len(sensor.domes) > 1 else ""
    text = (
        (TEXTS / "templates" / f"{kind}{pad}.md")
        .read_text(encoding="utf-8")
        .format(
            name=sensor.name,
            count=len(sensor.domes),
            pressure=f"{tables[0].driving_pressure_kPa:g}",
            pressures=", ".join(f"{one_kPa:g}" for one_kPa in sorted({one.driving_pressure_kPa for one in tables})),
            depth=f"{1e3 * min(one.indentation[-1] for one in tables):.2f}",
            mass=1e3 * sensor.inertia.mass,
            rear=1e3 * sensor.rear,
            apex=1e3 * tables[0].apex,
        )
    )
    return text.encode()


_SIMULATORS = {"mujoco": mjcf_files, "urdf": urdf_files}
"""Functions that make the files of a simulator's model, by the name of its format."""


def simulator_files(kind: str) -> Callable[[SimulatedSensor], dict[str, bytes]]:
    """Function that makes the files of a model for the simulator ``kind``, by path. Raises InputError for no such."""
    if kind not in _SIMULATORS:
        raise InputError(f"unknown.{nearest(kind, _SIMULATORS)}", key="simulator", value=kind)
    return lambda sensor: {"README.md": _readme(sensor, kind), **_SIMULATORS[kind](sensor)}


STEPS = 80
"""Steps of a press: above a fiftieth of the range, the spline through them is within 1 % of the model."""

_DIGITS = 6


@dataclass(frozen=True)
class SimulatorResult:
    """A simulator's model: name of its folder, its record, its files by path, and the inputs for the manifest."""

    name: str
    record: SimulatorRecord
    files: dict[str, bytes]
    inputs: Mapping[str, Any]


def make_simulator(evaluation: Evaluation, kind: str) -> SimulatorResult:
    """Model of an evaluated design's sensor for the simulator ``kind``, one that `simulator_files` knows.

    Raises InputError for another simulator and for contact off the axis, ComputationError where a press has no range.
    """
    made_by = simulator_files(kind)
    off_axis = evaluation.sensor.protocol.off_axis
    if off_axis is not None:
        raise InputError(off_axis, key="simulator", value=kind, remedy="the joint of the model moves along the axis")
    sensor = _simulated(evaluation)
    name = f"{sensor.name}-{kind}"
    return SimulatorResult(
        name, _record(evaluation, sensor, kind), made_by(sensor), BuildRecipe.of(evaluation).inputs()
    )


def _simulated(evaluation: Evaluation) -> SimulatedSensor:
    assembly, membrane = evaluation.assembly, evaluation.scene.membrane_material
    dome, name = (assembly.layout.shape, membrane.density_g_per_cm3.nominal), evaluation.scene.name
    domes = (SimulatedDome(name, np.zeros(3), press_tables(evaluation)),)
    return simulated_sensor(name, assembly.bodies, assembly.solids, *dome, domes)


def press_tables(evaluation: Evaluation, steps: int = STEPS) -> tuple[PressTable, ...]:
    """Presses at the design's driving pressures, in equal steps."""
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


def _record(evaluation: Evaluation, sensor: SimulatedSensor, kind: str) -> SimulatorRecord:
    record = SimulatorRecord(
        design=sensor.name,
        simulator=kind,
        model=evaluation.prediction.model,
        version=__version__,
        mass_g=1e3 * sensor.inertia.mass,
        centre_of_mass_mm=tuple((1e3 * sensor.inertia.centre).tolist()),
        inertia_about_centre_g_mm2=tuple(map(tuple, (1e9 * sensor.inertia.about_centre).tolist())),
        states=tuple(
            SimulatedState(
                driving_pressure_kPa=table.driving_pressure_kPa,
                apex_height_outer_mm=1e3 * table.apex,
                range_end_mm=1e3 * float(table.indentation[-1]),
                contact_force_N=float(table.force[-1]),
                pressure_kPa=float(table.pressure_kPa[-1]),
                greatest_stiffness_N_per_mm=1e-3 * table.stiffest,
            )
            for table in sensor.tables
        ),
    )
    return rounded(record, _DIGITS, 1e-9)


def write_simulator(result: SimulatorResult, out: Path) -> Path:
    """Write ``out/<design>-<simulator>/`` and return that folder. The same input gives the same bytes."""
    return write_folder(out / result.name, with_manifest(result.files, result.name, result.inputs))
