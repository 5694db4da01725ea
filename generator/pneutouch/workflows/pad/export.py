"""Export of a pad's reader, for a microcontroller and Python, and of its model for a simulator."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch import __version__
from pneutouch.arrays import Array
from pneutouch.errors import InputError
from pneutouch.export.reader.pad_render import PadReaderSource, pad_reader_files
from pneutouch.export.simulator.model import SimulatedDome, press_table, simulated_sensor
from pneutouch.mechanics.touch.cell import TABLE_ERROR, CellAnswer, CellTable
from pneutouch.mechanics.touch.forward import PadModel
from pneutouch.mechanics.touch.reader_table import reader_table
from pneutouch.output.files import digest, json_bytes, with_manifest, write_folder
from pneutouch.units import KPA
from pneutouch.workflows.export_reader import STEPS, simulator_files
from pneutouch.workflows.pad.build_pad import inputs
from pneutouch.workflows.pad.campaign import noise_kPa
from pneutouch.workflows.pad.load import ResolvedPad
from pneutouch.workflows.pad.touch import Tabulate, calibrated_model, pad_model, pad_pressure_kPa


def write_pad_reader(pad: ResolvedPad, calibration: str | None, out: Path, made_by: Tabulate | None = None) -> Path:
    """Write ``out/<pad>-reader/``: header of C99 and Python module, by a calibration or as predicted at the greatest
    driving pressure of the cell. The same input gives the same bytes. Raises InputError as `calibrated_model`."""
    model, table = pad_tables(pad, calibration, made_by)
    made_of = digest(json_bytes(table))
    pressure_kPa = round(model.table.driving_pressure / KPA, 6)
    source = PadReaderSource(pad.name, pressure_kPa, calibration, __version__, made_of)
    name = f"{pad.name}-reader"
    return write_folder(out / name, with_manifest(pad_reader_files(table, source), name, {"table": made_of}))


def pad_tables(
    pad: ResolvedPad, calibration: str | None, made_by: Tabulate | None = None
) -> tuple[PadModel, Mapping[str, Any]]:
    """The forward model of a pad and the table of its reader, as `write_pad_reader` has them."""
    model, error = _model(pad, calibration, made_by)
    return model, reader_table(model, noise_kPa(pad), error)


def _model(pad: ResolvedPad, calibration: str | None, made_by: Tabulate | None) -> tuple[PadModel, float]:
    """The forward model of a pad, and the error of its rises over the greatest."""
    error = TABLE_ERROR / 3.0
    if calibration is None:
        return pad_model(pad, pad_pressure_kPa(pad), made_by), error
    # A fit to one ball does not lessen the error of the table for others.
    model, known = calibrated_model(pad, calibration, made_by)
    return model, max(error, known.model_error)


def write_pad_simulator(
    pad: ResolvedPad, calibration: str | None, kind: str, out: Path, made_by: Tabulate | None = None
) -> Path:
    """Write ``out/<pad>-<kind>/``: the pad for a simulator as of `simulator_files`, by a calibration or as predicted as
    its reader, each dome as under a level plate. Raises InputError as `calibrated_model` and `simulator_files`."""
    files = simulator_files(kind)
    if any(dome.shape != pad.layout.cell.shape for dome in pad.layout.domes):
        problem, remedy = "its domes differ, and those of a model are equal", "give groups driving pressures alone"
        raise InputError(problem, file=pad.where, key="pad.groups", remedy=remedy)
    model, _ = _model(pad, calibration, made_by)
    presses, domes = [_level_press(table) for table in model.tables], []
    for number, (place, k) in enumerate(zip(pad.layout.places, model.table_of, strict=True)):
        table, (travel, answer), gain = model.tables[k], presses[k], float(model.gain[number])
        press = float(table.plates.first[0, 0]), travel, answer.force, gain * answer.rise / KPA
        states = (press_table(round(table.driving_pressure / KPA, 6), *press),)
        domes.append(SimulatedDome(f"{pad.name}-{number + 1}", 1e-3 * np.array([*place, 0.0]), states))
    density = pad.scene.membrane_material.density_g_per_cm3.nominal
    sensor = simulated_sensor(pad.name, pad.bodies, pad.solids, pad.layout.cell.shape, density, tuple(domes))
    name, follows_from = f"{pad.name}-{kind}", {**inputs(pad), "calibration": calibration}
    return write_folder(out / name, with_manifest(files(sensor), name, follows_from))


def _level_press(table: CellTable) -> tuple[Array, CellAnswer]:
    """Travels (m,) of a level plate on a cell, mm, from first contact to the end of the range, and its answers."""
    travel = np.linspace(0.0, float(table.plates.reach[0, 0]), STEPS + 1)
    return travel, table.under_plate(np.zeros(len(travel)), float(table.plates.first[0, 0]) - travel)
