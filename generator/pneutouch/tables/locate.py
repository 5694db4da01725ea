"""Place of the table in the rows of a file: its header, a row of units, and the first numbers."""

from collections.abc import Sequence
from typing import NamedTuple

from pneutouch.tables.cells import score
from pneutouch.tables.unit_words import unit_of

_COMMENT = ("#", "%", "!")
_NO_UNIT = frozenset({"", "-", "%", "°C", "°F", "°", "V", "mV", "V/V", "1", "1/min", "Hz", "mm/min", "mm/s", "MPa/s"})
_SHORT = 8
"""Characters of the longest unit."""

_REMARK = "comment"
"""Last column of a LabVIEW file, which holds text in the first row at most."""


class Located(NamedTuple):
    """Indices of rows, counted from 0: of the header (None without) and of the first numbers; the names and units."""

    header: int | None
    first: int
    names: list[str]
    units: list[str]


def width_of(rows: Sequence[Sequence[str]], decimal: str) -> tuple[int, float]:
    """Number of cells of the rows of numbers, and their score in all; 0 and 0.0 where none is one of numbers."""
    scores: dict[int, float] = {}
    for row in rows:
        value = score(row, decimal)
        if value > 0:
            scores[len(row)] = scores.get(len(row), 0.0) + value
    if not scores:
        return 0, 0.0
    best = max(scores, key=lambda width: (scores[width], width))
    return best, scores[best]


def header_of(rows: Sequence[Sequence[str]], known: Sequence[str]) -> int | None:
    """Index of the first row that names all of the ``known`` columns; None if there is none, or no column is known."""
    if not known:
        return None
    return next((k for k, row in enumerate(rows) if all(name in row for name in known)), None)


def locate(rows: Sequence[Sequence[str]], decimal: str, header: int | None) -> Located | None:
    """The table in the first rows of a file; ``header`` where it is known. None if there are no numbers."""
    width = width_of(rows, decimal)[0]
    if header is None:
        first = _first(rows, decimal, width)
        if first is None:
            return None
        header, units = _above(rows, first, width)
        if header is None:
            return Located(None, first, [f"#{k + 1}" for k in range(width)], [""] * width)
    else:
        below = _next(rows, header + 1)
        units = below if below is not None and _are_units(rows[below]) else None
        first = header + 1 if units is None else units + 1
    names = list(rows[header])
    stated = list(rows[units]) if units is not None else []
    return Located(header, first, names, [*stated, *[""] * len(names)][: len(names)])


def fewest(names: Sequence[str], rows: Sequence[Sequence[str]], decimal: str) -> tuple[list[str], int]:
    """The names, with one more for cells that are empty behind the last, and the fewest cells of a row.

    A last column without a name, or of LabVIEW's remarks, may be missing from the rows."""
    names, width = list(names), width_of(rows, decimal)[0]
    numbers = [row for row in rows if len(row) == width]
    if width == len(names) + 1 and numbers and not any(row[-1] for row in numbers):
        return [*names, ""], width
    if width == len(names) - 1 and names[-1].lower() in ("", _REMARK):
        return names, width
    return names, len(names)


def comment(line: str) -> bool:
    """True if a line before the header is a comment."""
    return line.lstrip().startswith(_COMMENT)


def _first(rows: Sequence[Sequence[str]], decimal: str, width: int) -> int | None:
    """The first row of numbers that another follows, or that is the last."""
    alike = [k for k, row in enumerate(rows) if len(row) == width and score(row, decimal) > 0]
    for k in alike:
        after = _next(rows, k + 1)
        if after is None or after in alike:
            return k
    return alike[0] if alike else None


def _next(rows: Sequence[Sequence[str]], at: int) -> int | None:
    return next((k for k in range(at, len(rows)) if any(rows[k])), None)


def _above(rows: Sequence[Sequence[str]], first: int, width: int) -> tuple[int | None, int | None]:
    """Indices of the header and of the row of units above the first numbers, None for each that is missing."""
    above = [k for k in range(first) if any(rows[k])][-2:]
    near = [k for k in above if _fits(rows[k], width)]
    if not near or near[-1] != above[-1]:
        return None, None
    if _are_units(rows[near[-1]]) and len(near) == 2:
        return near[0], near[1]
    return near[-1], None


def _fits(row: Sequence[str], width: int) -> bool:
    """True if a row may be the header of rows of so many cells: one may be missing, or be left over and empty."""
    return len(row) in (width, width - 1) or (len(row) == width + 1 and row[-1].lower() in ("", _REMARK))


def _are_units(row: Sequence[str]) -> bool:
    filled = [cell for cell in row if cell]
    known = [cell for cell in filled if unit_of(cell)]
    others = [cell.strip("()[]") for cell in filled if not unit_of(cell)]
    # Units of other quantities, which are not known here, may stand among as many of ours.
    alike = len(known) > 1 and len(known) >= len(others) and all(len(cell) <= _SHORT for cell in others)
    return alike or (bool(known) and all(cell in _NO_UNIT for cell in others))
