"""The forward model of a pad at one driving pressure, from the design of its cell."""

import hashlib
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from zipfile import BadZipFile

import numpy as np

from pneutouch.errors import BeyondLimitError, InputError
from pneutouch.evaluation.evaluate import DrawnScene
from pneutouch.mechanics.models.local import cache_folder, fingerprint, store_arrays
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.touch.cell import CellTable, cell_table
from pneutouch.mechanics.touch.forward import PadModel
from pneutouch.spec.pad import PadCalibration
from pneutouch.units import KPA, ML
from pneutouch.workflows.pad.load import ResolvedPad

Tabulate = Callable[[Sensor, float], CellTable]
"""Maker of a table that is not kept yet."""


def pad_model(pad: ResolvedPad, driving_pressure_kPa: float, made_by: Tabulate | None = None) -> PadModel:
    """Tabulate the cell of a pad, and that of each group, on the flange, at a driving pressure or that of the group.
    Each takes two minutes of processor time at the first time, more for thin walls; tables are then kept among those
    of `pneutouch table`. ``made_by`` stands in for `cell_table`.

    Cells with another gas volume behind them read by the ratio of the whole gas volumes. Raises InputError for a dome
    that is not round at its top, an object of the cell's own, a vacuum, and a pressure beyond the limit point."""
    if driving_pressure_kPa < 0.0:
        remedy = "give 0 or more"
        raise InputError("below ambient", key="driving_pressure_kPa", value=driving_pressure_kPa, remedy=remedy)
    cells = [pad.drawn(*kind) for kind in pad.worst_kinds]
    own_kPa = [driving_pressure_kPa, *(group.driving_pressure_kPa for group in pad.file.pad.groups)]
    held_kPa = [driving_pressure_kPa if one_kPa is None else one_kPa for one_kPa in own_kPa]
    sensors, tables = [_on_flange(pad, cell) for cell in cells], []
    for number, sensor in enumerate(sensors):
        try:
            tables.append(_kept(sensor, KPA * held_kPa[number], made_by))
        except BeyondLimitError as error:
            key = f"pad.groups[{number - 1}]" if number else "driving_pressure_kPa"
            problem, remedy = "the dome snaps before, at its limit point", f"give less than {error.limit / KPA:.4g}"
            raise InputError(problem, file=pad.where, key=key, value=held_kPa[number], remedy=remedy) from None
    kind, cavities = np.array(pad.file.pad.group_of), np.array([table.cavity for table in tables])
    whole = cavities + [sensor.gas.dead_volume for sensor in sensors]
    gain = whole[kind] / (ML * np.array(pad.dead_volumes_mL) + cavities[kind])
    return PadModel(np.array(pad.layout.places), tuple(tables), kind, gain)


def _on_flange(pad: ResolvedPad, cell: DrawnScene) -> Sensor:
    """A cell on its flange. Raises InputError as `pad_model`."""
    sensor, layout = cell.sensor, cell.assembly.layout
    shape = sensor.dome.shape
    why = sensor.protocol.other_contact if shape.domed else f"its dome is not round at its top: {shape.key}"
    if why is not None:
        remedy = "contact with several cells is computed for round domes under frictionless objects"
        raise InputError(f"of the cell {pad.file.pad.cell}: {why}", file=pad.where, key="pad.cell", remedy=remedy)
    return sensor.replace(flange=(layout.flange_width, layout.flange_thickness))


def pad_pressure_kPa(pad: ResolvedPad) -> float:
    """The greatest driving pressure of a pad's cell, at which it is measured and read unless another is given."""
    return max(pad.scene.design.pneumatics.driving_pressures_kPa)


def calibrated_model(pad: ResolvedPad, name: str, made_by: Tabulate | None = None) -> tuple[PadModel, PadCalibration]:
    """The forward model of a pad in hand, by a calibration, at its driving pressure. Raises InputError for an unknown
    calibration and for that of another pad."""
    calibration: PadCalibration = pad.library.load("pad-calibrations", name)
    places = np.array(pad.layout.places)
    if np.shape(calibration.places_mm) != places.shape or not np.allclose(calibration.places_mm, places, atol=1e-3):
        remedy = f"calibrate {pad.name}, or give the calibration of this pad"
        problem = f"of the pad {calibration.pad}, whose cells lie elsewhere"
        raise InputError(problem, file=pad.where, key="calibration", value=name, remedy=remedy)
    if calibration.groups != pad.file.pad.groups:
        problem, remedy = "of this pad with other groups of cells", f"calibrate {pad.name} as it is"
        raise InputError(problem, file=pad.where, key="calibration", value=name, remedy=remedy)
    model = pad_model(pad, calibration.driving_pressure_kPa, made_by)
    scaled = tuple(table.scaled(force=calibration.force_factor) for table in model.tables)
    return replace(model, tables=scaled, gain=model.gain * calibration.rise_factors), calibration


def _kept(sensor: Sensor, pressure: float, made_by: Tabulate | None = None) -> CellTable:
    """The table of a cell from the cache, else computed and kept there; one that cannot be read is made again."""
    version = fingerprint("mechanics/harmonic", "mechanics/models/harmonic.py", "mechanics/touch/cell.py")
    key = hashlib.sha256(repr((sensor, pressure, version)).encode()).hexdigest()[:16]
    path = cache_folder() / f"pad-{key}.npz"
    unreadable = suppress(OSError, ValueError, KeyError, BadZipFile)
    with unreadable, path.open("rb") as opened, np.load(opened, allow_pickle=False) as file:
        return CellTable.of({name: file[name] for name in file.files})
    table = (made_by or cell_table)(sensor, pressure)
    store_arrays(path, table.arrays())
    return table
