"""Lines to cells, and which cells are numbers."""

import csv
import re
from collections.abc import Sequence

NUMBER = {
    ".": re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?"),
    ",": re.compile(r"[+-]?(\d+(,\d*)?|,\d+)([eE][+-]?\d+)?"),
}
"""Numbers by their decimal mark; none has separators of thousands."""

_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2}(,\d{3})+")

_TEXT = 1.5
"""Number of cells of numbers that outweigh a cell of text: our choice. A table has a column of remarks or dates at
most."""


def cells(line: str, delimiter: str) -> list[str]:
    """Cells of a line without the spaces about them; a delimiter within quotes is part of its cell."""
    if delimiter == " ":
        return line.split()
    if '"' not in line:
        return [cell.strip() for cell in line.split(delimiter)]
    try:
        return [cell.strip() for cell in next(csv.reader([line.rstrip("\r\n")], delimiter=delimiter), [])]
    except csv.Error:
        return [cell.strip() for cell in line.split(delimiter)]


def blank(line: str, delimiter: str) -> bool:
    """True if a line counts as empty: one of spaces and tabs alone, but not of delimiters."""
    return not line.strip(" \r\t" if delimiter != "\t" else " \r")


def score(row: Sequence[str], decimal: str) -> float:
    """Score of a row as one of numbers: above 0 if it looks like one."""
    filled = [cell for cell in row if cell]
    numbers = sum(NUMBER[decimal].fullmatch(cell) is not None for cell in filled)
    return numbers - _TEXT * (len(filled) - numbers)


def undecided_comma(rows: Sequence[Sequence[str]]) -> str | None:
    """A number whose comma may be a decimal comma or one of thousands, where no number of the rows decides."""
    commas = [cell for row in rows for cell in row if "," in cell and NUMBER[","].fullmatch(cell)]
    return commas[0] if commas and all(_THOUSANDS.fullmatch(cell) for cell in commas) else None
