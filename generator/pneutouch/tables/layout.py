"""Layout of a table in a file: its format, cells and columns, and chunks of its rows."""

import csv
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import NamedTuple

from pneutouch.arrays import Array
from pneutouch.errors import InputError, nearest
from pneutouch.tables.unit_words import UNITS

CLOCK = "X_Value"
"""Column name for times in a file that states start and step of a clock instead; LabVIEW's name for times."""

NAMES = {",": "commas", ";": "semicolons", "\t": "tabs", " ": "spaces"}
"""Delimiters by their names; a space stands for any number of spaces and tabs."""

_DIGITS = 7

DECIMALS = {".": "points", ",": "commas"}


@dataclass(frozen=True, slots=True)
class TableFormat:
    """Format of a file; a field that is None is detected from the file.

    Attributes:
        delimiter: Delimiter of the cells of a text file; one of `NAMES`.
        decimal: Decimal mark of a text file; one of `DECIMALS`.
        encoding: Encoding of a text file, by its name in Python.
        skip_rows: Number of rows before the header.
        sheet: Sheet of a workbook, or group of a TDMS file.
    """

    delimiter: str | None = None
    decimal: str | None = None
    encoding: str | None = None
    skip_rows: int | None = None
    sheet: str | None = None


@dataclass(frozen=True, slots=True)
class TableLayout:
    """Place and format of the table in a file.

    Attributes:
        names: Names of the columns, as in the header; without a header #1, #2 and so on.
        units: Units of the columns as stated in a row or property of their own, else "".
        format: Format in which the file is read.
        guessed: Keys of ``format`` that were guessed from the numbers or the bytes; not those that the file states,
            such as its delimiter or a byte order mark.
        header_row: Row of the header, counted from 1; None without a header.
        first_row: Row of the first numbers, counted from 1.
        least: Least number of cells of a row; the greatest is the number of ``names``.
        clock: First time and step, s, of a file without a column of times; None if it has one.
        stamps: Indices of the columns with dates and times of day; they are read as seconds from the first.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    format: TableFormat
    guessed: tuple[str, ...] = ()
    header_row: int | None = 1
    first_row: int = 2
    least: int = 0
    clock: tuple[float, float] | None = None
    stamps: tuple[int, ...] = ()

    @property
    def all_names(self) -> tuple[str, ...]:
        """Names of the columns, preceded by that of the times if the file states a clock instead of a column."""
        return self.names if self.clock is None else (CLOCK, *self.names)

    def place(self, name: str) -> int | None:
        """Index of a column in `names`, by its name or its number (#2 is the second); None if there is none."""
        if name in self.names:
            return self.names.index(name)
        number = name[1:] if name.startswith("#") else ""
        # The limit on the length bounds the number.
        known = number.isascii() and number.isdigit() and len(number) < _DIGITS
        return int(number) - 1 if known and 1 <= int(number) <= len(self.names) else None

    @property
    def all_units(self) -> tuple[str, ...]:
        """Units of `all_names`; s for the times of a clock."""
        return self.units if self.clock is None else ("s", *self.units)


_DATE = r"\d\d?[./-]\d\d?[./-]\d{2,4}"
STAMP = re.compile(
    r"\d{4}-\d\d-\d\d[T ]\d\d:\d\d(?::\d\d(?:[.,]\d+)?)?(?:Z|[+-]\d\d:?\d\d)?"
    rf"|(?:(?:(?P<date>{_DATE}) )?(?P<clock>\d\d?:[0-5]\d:[0-5]\d(?:[.,]\d+|:\d{{3,6}})?)"
    rf"|(?P<day>{_DATE}) (?P<minutes>\d\d?:[0-5]\d))(?: ?(?P<half>[APap])[Mm])?"
)
"""A date with a time of day in the form of ISO 8601, or a time of day, of twelve hours too, alone or behind a date;
behind a date the seconds may be missing. Parts of a second may stand behind a colon."""

NUMBER = {
    ".": re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?"),
    ",": re.compile(r"[+-]?(\d+(,\d*)?|,\d+)([eE][+-]?\d+)?"),
}
"""Patterns of numbers by their decimal mark, without separators of thousands."""

_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2}(,\d{3})+")

_TEXT = 1.5
"""Number of numeric cells that outweigh a cell of text: our choice. A table has at most one column of remarks or
dates."""


def cells(line: str, delimiter: str) -> list[str]:
    """Cells of a line without surrounding spaces; a delimiter within quotes is part of its cell."""
    if delimiter == " ":
        return line.split()
    if '"' not in line:
        return [cell.strip() for cell in line.split(delimiter)]
    try:
        return [cell.strip() for cell in next(csv.reader([line.rstrip("\r\n")], delimiter=delimiter), [])]
    except csv.Error:
        return [cell.strip() for cell in line.split(delimiter)]


def blank(line: str, delimiter: str) -> bool:
    """True if a line counts as empty: only spaces and tabs, but no delimiters."""
    return not line.strip(" \r\t" if delimiter != "\t" else " \r")


def score(row: Sequence[str], decimal: str) -> float:
    """Score of a row as a row of numbers: above 0 if it looks like one."""
    filled = [cell for cell in row if cell]
    numbers = sum((NUMBER[decimal].fullmatch(cell) or STAMP.fullmatch(cell)) is not None for cell in filled)
    return numbers - _TEXT * (len(filled) - numbers)


def undecided_comma(rows: Sequence[Sequence[str]]) -> str | None:
    """A number whose comma may be decimal or mark thousands, if no number of the rows decides which; else None."""
    commas = [cell for row in rows for cell in row if "," in cell and NUMBER[","].fullmatch(cell)]
    return commas[0] if commas and all(_THOUSANDS.fullmatch(cell) for cell in commas) else None


class RowChunk(NamedTuple):
    """Some rows of a file.

    Attributes:
        rows: Numbers of the rows in the file, (n,), counted from 1.
        values: The requested columns, (k, n), in the requested order; all finite.
        share: Share of the file that has been read, 0 to 1.
        total: Number of rows of numbers in the file; for a text file estimated from its bytes.
        last: Values (k, 1) of a complete last row without a line end, whose last number may be cut; not part of
            ``values``; None without such a row.
        last_row: Number of the row of ``last`` in the file; 0 without such a row.
    """

    rows: Array
    values: Array
    share: float
    total: int
    last: Array | None = None
    last_row: int = 0


def places(path: Path, layout: TableLayout, names: Sequence[str]) -> list[int]:
    """Indices of columns in `TableLayout.names`; #2 is the second. Raises InputError for one missing or there twice."""
    header, indices = layout.names, []
    for name in names:
        if header.count(name) > 1:
            count = header.count(name)
            raise InputError(f"there {count} times", file=path, key=f"column {name}", remedy="must be there once")
        place = layout.place(name)
        if place is None:
            hint = " Columns are separated by commas, semicolons or tabs." if len(header) < 2 else ""
            column, colon, unit = name.rpartition(":")
            if colon and layout.place(column) is not None:
                hint = f" Of the column {column} it gives no known unit.{nearest(unit, chain(*UNITS.values()))}"
            hint = hint or nearest(name, set(header))
            problem = f"missing from the header '{', '.join(header)[:80]}' (row {layout.header_row}).{hint}"
            raise InputError(problem, file=path, key=f"column {name}")
        indices.append(place)
    return indices


@contextmanager
def library_file(path: Path, kind: str, library: str, extra: str) -> Iterator[None]:
    """Context in which ``library``, of the package's ``extra``, is imported and reads a file of a ``kind``.

    Raises InputError if the library is not installed, and in place of the library's own errors.
    """
    try:
        yield
    except (InputError, OSError):
        raise
    except ImportError:
        raise InputError(f'{kind} files need {library}: pip install "pneutouch[{extra}]"', file=path) from None
    except Exception as error:
        text = " ".join(str(error).split())[:120] or type(error).__name__
        raise InputError(
            f"no whole {kind} file: {text}", file=path, remedy="cut off, or another kind of file?"
        ) from None
