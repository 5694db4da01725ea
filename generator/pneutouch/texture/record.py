"""A measured signal from a CSV or parquet file: times in s and pressures in kPa."""

from dataclasses import dataclass
from pathlib import Path

from pneutouch.errors import InputError
from pneutouch.tables.read import whole
from pneutouch.texture.signal import Signal, signal
from pneutouch.units import KPA


@dataclass(frozen=True, slots=True)
class RecordColumns:
    """Column names in the file's header; the units are s and kPa gauge whatever the names are."""

    time_s: str = "time_s"
    pressure_kPa: str = "pressure_kPa"


def read_signal(path: Path, columns: RecordColumns = RecordColumns()) -> Signal:
    """The signal in a file; other columns are ignored.

    Raises InputError, naming file, row and column, as `tables.read.chunks`, where one column is named for both, and for
    uneven sampling (``signal``).
    """
    names = columns.time_s, columns.pressure_kPa
    if names[0] == names[1]:
        problem = "declared for both time and pressure"
        raise InputError(problem, file=path, key=f"column {names[0]}", remedy="must be two columns")
    rows, (time, pressure_kPa) = whole(path, names)
    return signal(time, pressure_kPa * KPA, str(path), [int(row) for row in rows])
