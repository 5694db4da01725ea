"""Format of a text file of numbers: encoding, delimiter, decimal mark and the rows before the header."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from pneutouch.errors import InputError
from pneutouch.tables.cells import blank, cells, undecided_comma
from pneutouch.tables.layout import DECIMALS, NAMES, TableFormat, TableLayout
from pneutouch.tables.locate import Located, comment, fewest, header_of, locate, width_of
from pneutouch.tables.stated import is_lvm, lvm_layout, stated_format
from pneutouch.tables.text import head_lines

LOOKED_AT = 600
"""Rows that are looked at: more than instruments write before their table."""

_STATE = "state it in the campaign file, or give `delimiter`, `decimal` or `skip_rows`"
_FORMAT = '[format]\ndelimiter = ";"  # or "," or "\\t" or " "\ndecimal = ","  # or "."\nskip_rows = 7'

_ORDER = ("\t", ";", ",", " ")
"""Delimiters in the order in which they are preferred where the rows look the same by several."""


def text_layout(path: Path, given: TableFormat, known: Sequence[str]) -> TableLayout:
    """Layout of a text file; its header is the first row that names the ``known`` columns, or stands above the numbers.

    Raises InputError if no table is found, and where a comma may be a decimal comma or one of thousands."""
    lines, encoding, guessed = head_lines(path, given.encoding)
    if not any(line.strip() for line in lines):
        raise InputError("no header row", file=path, remedy=f"must name the columns, as {','.join(known)}")
    stated = stated_format(lines, replace(given, encoding=encoding))
    layout = lvm_layout(path, lines, stated) if is_lvm(lines) else _of_rows(path, lines[:LOOKED_AT], stated, known)
    marks = [("encoding", guessed), ("decimal", stated.decimal is None and layout.format.decimal == ",")]
    return replace(layout, guessed=tuple(key for key, guess in marks if guess))


def _of_rows(path: Path, lines: Sequence[str], given: TableFormat, known: Sequence[str]) -> TableLayout:
    skip = given.skip_rows
    begin = skip if skip is not None else 0
    rows = lines[begin:]
    delimiter, header = _known_header(rows, given, known)
    if header is None and skip is not None:
        header = next((k for k, line in enumerate(rows) if line.strip() and not comment(line)), None)
    top = next((k for k, line in enumerate(rows) if line.strip()), 0) if header is None else header
    if rows and "\r" in rows[top]:
        problem, remedy = "carriage returns within it", "rows must end in line feeds: save it as CSV again"
        raise InputError(problem, file=path, key=f"row {begin + top + 1}", remedy=remedy)
    below = rows if header is None else rows[header + 1 :]
    delimiter, decimal = _written(below, replace(given, delimiter=delimiter))
    delimiter = delimiter or _of_header(rows, header)
    table = [_cells(line, delimiter) for line in rows]
    located = locate(table, decimal, header)
    if located is None:
        problem = f"no rows of numbers among the first {len(lines)}, and no header that names {', '.join(known)}"
        raise InputError(problem, file=path, remedy=f"{_STATE}:\n{_FORMAT}")
    _check_header(path, table, located, begin, delimiter)
    data = [row for row, line in zip(table[located.first :], rows[located.first :], strict=True) if line.strip()]
    if given.decimal is None and decimal == "," and (number := undecided_comma(data)):
        problem = f"{number}: a decimal comma, or one of thousands?"
        remedy = f'{_STATE} (without marks of thousands):\n[format]\ndecimal = ","'
        raise InputError(problem, file=path, key=f"row {begin + located.first + 1}", remedy=remedy)
    names, least = fewest(located.names, data, decimal)
    units = [*located.units, ""][: len(names)]
    at = None if located.header is None else begin + located.header + 1
    before = begin + (located.first if located.header is None else located.header)
    if skip is None and all(comment(line) or not line.strip() for line in rows[:before]):
        before = 0
    written = replace(given, delimiter=delimiter, decimal=decimal, skip_rows=before if skip is None else skip)
    return TableLayout(tuple(names), tuple(units), written, (), at, begin + located.first + 1, least)


def _cells(line: str, delimiter: str) -> list[str]:
    """Cells of a line; those of a comment without its mark, as numpy writes a header."""
    if blank(line, delimiter):
        return []
    return cells(line.lstrip().lstrip("#").strip() if comment(line) else line, delimiter)


def _known_header(rows: Sequence[str], given: TableFormat, known: Sequence[str]) -> tuple[str | None, int | None]:
    """The delimiter by which a row names all known columns, and the row's index, None if no row does."""
    for delimiter in (given.delimiter,) if given.delimiter else _ORDER:
        split = [_cells(line, delimiter) if all(name in line for name in known) else [] for line in rows]
        header = header_of(split, known)
        if header is not None:
            return delimiter, header
    return given.delimiter, None


def _written(rows: Sequence[str], given: TableFormat) -> tuple[str | None, str]:
    """Delimiter and decimal mark by which the rows have most numbers; None and a point where they have none."""
    best, chosen = 0.0, (given.delimiter, given.decimal or ".")
    for delimiter in (given.delimiter,) if given.delimiter else _ORDER:
        table = [_cells(line, delimiter) for line in rows]
        for decimal in (given.decimal,) if given.decimal else DECIMALS:
            score = width_of(table, decimal)[1] if decimal != delimiter else 0.0
            if score > best:
                best, chosen = score, (delimiter, decimal)
    return chosen


def _of_header(rows: Sequence[str], header: int | None) -> str:
    """The delimiter that gives a header most cells, where no number shows which it is."""
    text = "" if header is None else rows[header]
    return max((",", ";", "\t"), key=lambda delimiter: len(cells(text, delimiter)))


def _check_header(path: Path, table: Sequence[Sequence[str]], located: Located, begin: int, delimiter: str) -> None:
    """Check that a header stands above the numbers. Raises InputError if the row above them has other cells."""
    above = [k for k in range(located.first) if table[k]]
    if located.header is not None or not above:
        return
    width, row = len(table[located.first]), table[above[-1]]
    hint = " Decimal commas between commas cannot be distinguished." if delimiter == "," else ""
    problem = (
        f"{len(row)} cells, and {width} in the rows of numbers from row {begin + located.first + 1} on, by "
        f"{NAMES[delimiter]}.{hint}"
    )
    raise InputError(problem, file=path, key=f"row {begin + above[-1] + 1}", remedy=f"{_STATE}:\n{_FORMAT}")
