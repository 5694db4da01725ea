"""Sheets of Excel workbooks. Formulas are not evaluated: the values that were stored with them are read."""

import datetime
import warnings
import zipfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch.errors import InputError, shown
from pneutouch.tables.layout import RowChunk, TableFormat, TableLayout, library_file, places
from pneutouch.tables.locate import Located, fewest, header_of, locate

UNPACKED = 100e6
"""Bytes of a workbook once unpacked: some 600 000 rows of four columns, half a minute of reading."""

_PARTS, _SHEETS, _ROWS, _COLUMNS = 2000, 50, 2**20, 256
"""Most files in a workbook and sheets that are looked at; most rows of a sheet, as in Excel, and columns read."""

_EMPTY = 10_000
"""Empty rows together: a row whose number is spoilt leaves more."""

_LOOKED_AT = 500
_BATCH = 2**16
_CSV = "save the sheet as CSV"


def xlsx_layout(path: Path, given: TableFormat, known: Sequence[str]) -> TableLayout:
    """Layout of the sheet that ``given`` names, else of the only one with a table of numbers. Raises InputError."""
    with _workbook(path) as book:
        sheets = {sheet.title: sheet for sheet in book.worksheets[:_SHEETS]}
        if given.sheet is not None and given.sheet not in sheets:
            has = ", ".join(sheets)[:200]
            raise InputError(f"no sheet {shown(given.sheet)}", file=path, key="sheet", remedy=f"the workbook has {has}")
        chosen = [given.sheet] if given.sheet is not None else list(sheets)
        tables = {name: layout for name in chosen if (layout := _sheet_layout(sheets[name], given, known))}
    named = {name: layout for name, layout in tables.items() if known and set(known) <= set(layout.names)}
    tables = named or tables
    if not tables:
        raise InputError("no sheet with a table of numbers", file=path, remedy=_CSV)
    if len(tables) > 1:
        problem = f"tables of numbers in {len(tables)} sheets: {', '.join(tables)[:200]}"
        raise InputError(
            problem,
            file=path,
            key="sheet",
            remedy=f"state one in the campaign file, or give `sheet`:\n[format]\nsheet = {shown(next(iter(tables)))}",
        )
    return next(iter(tables.values()))


def xlsx_chunks(path: Path, names: Sequence[str], layout: TableLayout) -> Iterator[RowChunk]:
    """Chunks of a sheet; see `read.chunks`. Its rows are numbered as Excel numbers them."""
    at, row, count = places(path, layout, names), layout.first_row, 0
    with _workbook(path) as book:
        rows = _rows(book[layout.format.sheet], layout.first_row, max(at) + 1)
        while batch := list(islice(rows, _BATCH)):
            numbered = [(row + k, cells) for k, cells in enumerate(batch) if any(cell is not None for cell in cells)]
            row += len(batch)
            count += len(numbered)
            values = [
                [_number(path, line, name, cells, k) for line, cells in numbered]
                for name, k in zip(names, at, strict=True)
            ]
            lines = np.array([line for line, _ in numbered], float)
            yield RowChunk(lines, np.array(values, float).reshape(len(names), lines.size), 0.5, count)


def _sheet_layout(sheet: Any, given: TableFormat, known: Sequence[str]) -> TableLayout | None:
    skip = given.skip_rows or 0
    rows = [[_text(cell) for cell in cells] for cells in islice(_rows(sheet, skip + 1), _LOOKED_AT)]
    width = max((k + 1 for row in rows for k, cell in enumerate(row) if cell), default=0)
    rows = [[*row, *[""] * width][:width] for row in rows]
    header = header_of(rows, known)
    if header is None and given.skip_rows is not None:
        header = next((k for k, row in enumerate(rows) if any(row)), None)
    located = locate(rows, ".", header)
    if located is None or located.first >= len(rows):
        return None
    names, least = fewest(located.names, rows[located.first :], ".")
    return _layout(sheet.title, located, names, least, given, skip)


def _layout(title: str, located: Located, names: list[str], least: int, given: TableFormat, skip: int) -> TableLayout:
    before = skip + (located.first if located.header is None else located.header)
    written = replace(given, sheet=title, skip_rows=before if given.skip_rows is None else skip)
    at = None if located.header is None else skip + located.header + 1
    units = tuple([*located.units, ""][: len(names)])
    return TableLayout(tuple(names), units, written, (), at, skip + located.first + 1, least)


@contextmanager
def _workbook(path: Path) -> Iterator[Any]:
    """The workbook, for reading. Raises InputError if it is no workbook, too large, or openpyxl is not installed."""
    with library_file(path, "Excel", "openpyxl", "xlsx"):
        from openpyxl import load_workbook

        with zipfile.ZipFile(path) as packed:
            parts = packed.infolist()
        size = sum(part.file_size for part in parts)
        if len(parts) > _PARTS or size > UNPACKED:
            problem = f"{len(parts)} parts of {size / 1e6:.0f} MB unpacked; at most {_PARTS} of {UNPACKED / 1e6:.0f} MB"
            raise InputError(problem, file=path, remedy=_CSV)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            book = load_workbook(path, read_only=True, data_only=True, keep_links=False)
            try:
                yield book
            finally:
                book.close()


def _rows(sheet: Any, first: int, columns: int = _COLUMNS) -> Iterator[tuple[Any, ...]]:
    """Cells of the rows from ``first`` on. Raises ValueError for more than Excel has, or many empty ones."""
    # What a sheet states of its size may be wrong.
    sheet.reset_dimensions()
    empty = 0
    for k, row in enumerate(sheet.iter_rows(min_row=first, max_col=columns, values_only=True)):
        empty = 0 if any(cell is not None for cell in row) else empty + 1
        if first + k > _ROWS or empty > _EMPTY:
            raise ValueError(f"more than {_ROWS} rows, or {_EMPTY} empty ones together")
        yield row


def _text(cell: Any) -> str:
    if cell is None:
        return ""
    if isinstance(cell, int | float) and not isinstance(cell, bool):
        return repr(float(cell))
    return str(cell).strip()[:200]


def _number(path: Path, row: int, name: str, cells: Sequence[Any], place: int) -> float:
    cell = cells[place] if place < len(cells) else None
    if isinstance(cell, int | float) and not isinstance(cell, bool) and np.isfinite(cell):
        return float(cell)
    if cell is None:
        problem, remedy = "empty", "must be a number; of a formula its value is read, which Excel stores on saving"
    elif isinstance(cell, datetime.date | datetime.time | datetime.timedelta):
        problem, remedy = f"{cell} is a date or a time of day", "must be seconds or another unit of time, as a number"
    else:
        problem, remedy = f"{shown(str(cell)[:40])} is no finite number", "must be a number, not text"
    raise InputError(f"column {name}: {problem}", file=path, key=f"row {row}", remedy=remedy)
