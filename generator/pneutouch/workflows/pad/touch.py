"""The forward model of a pad at one driving pressure, from the design of its cell."""

from collections.abc import Callable

import numpy as np

from pneutouch.errors import InputError
from pneutouch.mechanics.touch.cell import cell_table
from pneutouch.mechanics.touch.forward import PadModel
from pneutouch.shape.hemisphere import no_hemisphere
from pneutouch.units import KPA, ML
from pneutouch.workflows.pad.load import ResolvedPad


def pad_model(
    pad: ResolvedPad, driving_pressure_kPa: float, progress: Callable[[int, int], None] = lambda done, total: None
) -> PadModel:
    """Tabulate the cell of a pad at a driving pressure, about half a minute of processor time.

    Cells with another gas volume behind them read by the ratio of the whole gas volumes. Raises InputError for a shape
    other than a hemisphere, an object of the cell's own, a vacuum, and a pressure beyond the limit point."""
    cell = pad.worst
    test = cell.sensor.protocol
    why = no_hemisphere(cell.sensor.dome.shape) or test.other_contact
    if why is not None:
        remedy = "contact with several cells is computed for hemispheres under frictionless objects"
        raise InputError(f"of the cell {pad.file.pad.cell}: {why}", file=pad.where, key="pad.cell", remedy=remedy)
    if driving_pressure_kPa < 0.0:
        remedy = "give 0 or more"
        raise InputError("below ambient", key="driving_pressure_kPa", value=driving_pressure_kPa, remedy=remedy)
    table = cell_table(cell.sensor, driving_pressure_kPa * KPA, progress)
    behind = ML * np.array(pad.dead_volumes_mL)
    gain = (cell.sensor.gas.dead_volume + table.cavity) / (behind + table.cavity)
    return PadModel(np.array(pad.layout.places), table, gain)
