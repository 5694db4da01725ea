"""A measured signal out of a CSV file: a header line, then times in s and pressures in kPa."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from pneutouch.errors import InputError, nearest
from pneutouch.texture.signal import Signal, signal
from pneutouch.units import KPA


@dataclass(frozen=True, slots=True)
class RecordColumns:
    """What the columns are called in the file's header; their units are s and kPa gauge whatever the names say."""

    time_s: str = "time_s"
    pressure_kPa: str = "pressure_kPa"  # noqa: N815


def read_signal(path: Path, columns: RecordColumns = RecordColumns()) -> Signal:
    """The signal of a UTF-8 CSV file with commas; columns beyond the two are left alone, empty lines skipped.

    Raises InputError, naming file, line and column, for a file that cannot be read, a missing or doubled column, and
    what is no number or no even sampling (``signal``).
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as stream:
            reader = csv.reader(stream, strict=True)
            places = _places(path, next(reader, []), columns)
            read = [(reader.line_num, row) for row in reader if any(cell.strip() for cell in row)]
    except FileNotFoundError:
        raise InputError(f"{path}: no such file") from None
    except IsADirectoryError:
        raise InputError(f"{path}: this is a folder; give a CSV file") from None
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: not UTF-8 text (byte {error.start})") from None
    except csv.Error as error:
        raise InputError(f"{path}: row {reader.line_num}: not valid CSV: {error}") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
    found = []
    for name, place in zip((columns.time_s, columns.pressure_kPa), places, strict=True):
        found.append(np.array([_number(path, line, row, place, name) for line, row in read], float))
    return signal(found[0], found[1] * KPA, str(path), [line for line, _ in read])


def _places(path: Path, header: list[str], columns: RecordColumns) -> list[int]:
    """Where the two columns stand."""
    names = [name.strip() for name in header]
    places = []
    for name in (columns.time_s, columns.pressure_kPa):
        if names.count(name) > 1:
            raise InputError(f"{path}: column {name}: there {names.count(name)} times; must be there once")
        if name not in names:
            hint = " Columns are separated by commas." if len(names) < 2 else nearest(name, names)
            raise InputError(f"{path}: column {name}: missing from the header '{','.join(header)[:80]}'.{hint}")
        places.append(names.index(name))
    if places[0] == places[1]:
        raise InputError(f"{path}: column {columns.time_s}: declared for both time and pressure; must be two columns")
    return places


def _number(path: Path, line: int, row: list[str], place: int, name: str) -> float:
    text = row[place].strip() if place < len(row) else ""
    try:
        return float(text)
    except ValueError:
        told = f"'{text}' is no number" if text else "empty"
        raise InputError(f"{path}: row {line}: column {name}: {told}; must be a number with a decimal point") from None
