"""Location of the table in the rows of a file: its header, a row of units, and the first numbers.

Sources: NI, Specification for the LabVIEW Measurement File (.lvm), ni.com/tutorial/4139; MTS Series 793 Application
manual, MultiPurpose TestWare, page 136, How to parse the MPT specimen data file."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from pneutouch.errors import InputError
from pneutouch.tables.layout import DECIMALS, NAMES, TableFormat, TableLayout, blank, cells, score
from pneutouch.tables.unit_words import unit_of

COMMENT = ("#", "%", "!")
"""Characters that begin a comment."""
_NO_UNIT = frozenset({"", "-", "%", "°C", "°F", "°", "V", "mV", "V/V", "1", "1/min", "Hz", "mm/min", "mm/s", "MPa/s"})
_SHORT = 8
"""Number of characters of the longest unit."""

_REMARK = "comment"
"""Name of the last column of a LabVIEW file, which has text in its first row at most."""


class Located(NamedTuple):
    """Indices, from 0, of the header (None without one) and of the first row of numbers; names and units of the
    columns."""

    header: int | None
    first: int
    names: list[str]
    units: list[str]


def width_of(rows: Sequence[Sequence[str]], decimal: str) -> tuple[int, float]:
    """Number of cells of the rows of numbers, and the total score of these rows; 0 and 0.0 if there is no such row."""
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
    """Location of the table in the first rows of a file; ``header`` is its index if known. None without numbers."""
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
    """Names, plus one for empty cells after the last, and the least number of cells of a row.

    A last column without a name, or LabVIEW's column of remarks, may be missing from the rows."""
    names, width = list(names), width_of(rows, decimal)[0]
    numbers = [row for row in rows if len(row) == width]
    if width == len(names) + 1 and numbers and not any(row[-1] for row in numbers):
        return [*names, ""], width
    if width == len(names) - 1 and names[-1].lower() in ("", _REMARK):
        return names, width
    return names, len(names)


def comment(line: str) -> bool:
    """True if a line is a comment."""
    return line.lstrip().startswith(COMMENT)


def _first(rows: Sequence[Sequence[str]], decimal: str, width: int) -> int | None:
    """Index of the first row of numbers that is the last row or followed by another of numbers; None without any."""
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
    # A header may have one cell less than the numbers, or one more that is empty.
    empty = [k for k in above if len(rows[k]) == width + 1 and rows[k][-1].lower() in ("", _REMARK)]
    near = [k for k in above if k in empty or len(rows[k]) in (width, width - 1)]
    if not near or near[-1] != above[-1]:
        return None, None
    if _are_units(rows[near[-1]]) and len(near) == 2:
        return near[0], near[1]
    return near[-1], None


def _are_units(row: Sequence[str]) -> bool:
    filled = [cell for cell in row if cell]
    known = [cell for cell in filled if unit_of(cell)]
    others = [cell.strip("()[]") for cell in filled if not unit_of(cell)]
    # Units of quantities that are unknown here may occur among as many known ones.
    alike = len(known) > 1 and len(known) >= len(others) and all(len(cell) <= _SHORT for cell in others)
    return alike or (bool(known) and all(cell in _NO_UNIT for cell in others))


_LVM, _END = "LabVIEW Measurement", "***End_of_Header***"
_LVM_DELIMITERS = {"Tab": "\t", "Comma": ",", "Semicolon": ";", "Space": " "}
_MTS, _MTS_DELIMITERS = "MTS793|", {"0": " ", "1": ",", "2": "\t"}
_MTS_FIELDS = 6


def stated_format(lines: Sequence[str], given: TableFormat) -> TableFormat:
    """Format ``given``, completed by the delimiter and decimal mark that an MTS file states in its first line."""
    fields = lines[0].split("|") if lines and lines[0].startswith(_MTS) else []
    if len(fields) < _MTS_FIELDS:
        return given
    delimiter, decimal = _MTS_DELIMITERS.get(fields[4]), fields[5] if fields[5] in DECIMALS else None
    return replace(given, delimiter=given.delimiter or delimiter, decimal=given.decimal or decimal)


def is_lvm(lines: Sequence[str]) -> bool:
    """True if the lines are the first ones of a LabVIEW measurement file."""
    return bool(lines) and lines[0].startswith(_LVM)


def lvm_layout(path: Path, lines: Sequence[str], given: TableFormat) -> TableLayout:
    """Layout of a LabVIEW file. Raises InputError for an incomplete header, or times that differ between channels."""
    ends = [k for k, line in enumerate(lines) if line.startswith(_END)]
    heads, top = ("Separator", "Decimal_Separator", "X_Columns"), lines[: ends[0]] if ends else lines
    # The text after a tag begins with the delimiter; that of the delimiter's usually ends with its name.
    tags = {head: line[len(head) :] for line in top for head in heads if line.startswith(head)}
    text = tags.get("Separator", "")
    named = _LVM_DELIMITERS.get(text[1:].strip(" ,;\t")) or (text[0] if text and text[0] in NAMES else "\t")
    delimiter = given.delimiter or named
    mark = tags.get("Decimal_Separator", "\t.")[1:].strip() or "."
    decimal = given.decimal or (mark[0] if mark[0] in DECIMALS else ".")
    names = [k for k in range(ends[1] + 1, len(lines)) if not blank(lines[k], "\t")] if len(ends) > 1 else []
    if not names:
        problem = f"a LabVIEW measurement file without its two lines {_END} and a header"
        raise InputError(problem, file=path, remedy="cut off, or written without headers?")
    if tags.get("X_Columns", "")[1:].strip() == "Multi":
        problem = "each channel has times of its own (X_Columns Multi)"
        raise InputError(problem, file=path, remedy="write the file again with one column of times")
    segment = {row[0]: row[1:] for line in lines[ends[0] + 1 : ends[1]] if (row := cells(line, delimiter)) and row[0]}
    header, written = names[0], replace(given, delimiter=delimiter, decimal=decimal, skip_rows=names[0])
    columns = cells(lines[header], delimiter)
    units = [*segment.get("Y_Unit_Label", []), *[""] * len(columns)][: len(columns) - 1]
    time = "s" if segment.get("X_Dimension", ["Time"])[0] in ("Time", "") else ""
    layout = TableLayout(tuple(columns), (time, *units), written, (), header + 1, header + 2)
    numbers = [cells(line, delimiter) for line in lines[header + 1 :] if not blank(line, delimiter)]
    layout = replace(layout, least=_least(columns, numbers, decimal))
    return _with_clock(path, layout, segment, numbers) if tags.get("X_Columns", "")[1:].strip() == "No" else layout


def _least(columns: Sequence[str], numbers: Sequence[Sequence[str]], decimal: str) -> int:
    """Least number of cells of a row: one less than ``columns`` if rows omit the last one, of remarks."""
    short = any(len(row) == len(columns) - 1 and score(row, decimal) > 0 for row in numbers)
    return len(columns) - 1 if short and len(columns) > 1 else len(columns)


def _with_clock(
    path: Path, layout: TableLayout, segment: dict[str, list[str]], numbers: Sequence[Sequence[str]]
) -> TableLayout:
    """Layout with the clock that all channels share. Raises InputError if they have different clocks."""
    clock = []
    for tag in ("X0", "Delta_X"):
        values = {text for text in segment.get(tag, []) if text}
        try:
            (text,) = values
            clock.append(float(text.replace(",", ".")))
        except ValueError:
            problem = f"no column of times (X_Columns No), and {tag} is not one number for all channels"
            raise InputError(problem, file=path, remedy="write the file again with one column of times") from None
    first = numbers[0] if numbers else []
    # The cell of the times is either empty or missing.
    if first and first[0]:
        kept = replace(layout, names=layout.names[1:], units=layout.units[1:], least=max(layout.least - 1, 1))
    else:
        kept = replace(layout, names=("", *layout.names[1:]))
    return replace(kept, clock=(clock[0], clock[1]))
