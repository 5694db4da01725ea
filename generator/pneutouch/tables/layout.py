"""Layout of a table in a file: given by the user, and used by the reader."""

from dataclasses import dataclass

CLOCK = "X_Value"
"""Name of the times of a file that states begin and step of its clock in place of a column; LabVIEW's name of times."""

NAMES = {",": "commas", ";": "semicolons", "\t": "tabs", " ": "spaces"}
"""Delimiters; a space stands for any number of spaces and tabs."""

_DIGITS = 7

DECIMALS = {".": "points", ",": "commas"}


@dataclass(frozen=True, slots=True)
class TableFormat:
    """Format of a file; None is found from the file.

    Attributes:
        delimiter: Between the cells of a text file; one of `NAMES`.
        decimal: Decimal mark of a text file; one of `DECIMALS`.
        encoding: Of a text file, as Python calls it.
        skip_rows: Rows before the header.
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
        names: Of the columns, as in the header; a table without header has #1, #2 and so on.
        units: Of the columns as a row or a property of their own states them, "" where none does.
        format: Format in which the file is read.
        guessed: Keys of ``format`` that were found by the look of the numbers or of the bytes; what the file states,
            such as its delimiter or a byte order mark, is not among them.
        header_row: Row of the header, counted from 1; None without header.
        first_row: Row of the first numbers.
        least: Fewest cells of a row; the most are those of ``names``.
        clock: First time and step of a file without a column of times, in the unit of `CLOCK`.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    format: TableFormat
    guessed: tuple[str, ...] = ()
    header_row: int | None = 1
    first_row: int = 2
    least: int = 0
    clock: tuple[float, float] | None = None

    @property
    def all_names(self) -> tuple[str, ...]:
        """Names of the columns, and of the times that the file gives in place of a column."""
        return self.names if self.clock is None else (CLOCK, *self.names)

    def place(self, name: str) -> int | None:
        """Index of a column in `names`, by its name or its number (#2 is the second); None if there is none."""
        if name in self.names:
            return self.names.index(name)
        number = name[1:] if name.startswith("#") else ""
        # The length bounds what is read as a number.
        known = number.isascii() and number.isdigit() and len(number) < _DIGITS
        return int(number) - 1 if known and 1 <= int(number) <= len(self.names) else None

    @property
    def all_units(self) -> tuple[str, ...]:
        """Units of `all_names`."""
        return self.units if self.clock is None else ("s", *self.units)
