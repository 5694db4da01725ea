"""Binary tables: sheets of a workbook, parquet in batches of rows, and TDMS, the format of LabVIEW."""

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

from pneutouch.arrays import Array
from pneutouch.errors import InputError, shown
from pneutouch.tables.layout import RowChunk, TableFormat, TableLayout, library_file, places
from pneutouch.tables.locate import Located, fewest, header_of, locate

MOST_ROWS, MOST_UNPACKED = 1_000_000_000, 2**30
"""Greatest number of rows of a file, a day at 10 kHz; and of bytes of an unpacked group of rows, held in memory."""

BATCH = 2**17
"""Rows per batch, about as many as in a chunk of a CSV file."""

_EXACT = 2.0**53


def parquet_layout(path: Path, given: TableFormat, known: Sequence[str]) -> TableLayout:
    """Layout of a parquet file, whose columns have names but no units. Raises InputError for an unreadable file."""
    with _opened_parquet(path) as file:
        names = tuple(str(name) for name in file.schema_arrow.names)
    return TableLayout(names, ("",) * len(names), given, least=len(names))


def parquet_chunks(path: Path, names: Sequence[str], layout: TableLayout) -> Iterator[RowChunk]:
    """Chunks of a parquet file; see `read.chunks`. Rows are numbered from 2, as in a CSV file."""
    import pyarrow as pa

    with _opened_parquet(path) as file:
        schema = file.schema_arrow
        columns = [layout.names[place] for place in places(path, layout, names)]
        for name in columns:
            kind = schema.field(name).type
            if not (pa.types.is_integer(kind) or pa.types.is_floating(kind)):
                raise InputError(f"holds {kind}", file=path, key=f"column {name}", remedy="must be numbers")
        _check_size(path, file.metadata)
        row, total = 2, file.metadata.num_rows
        for batch in file.iter_batches(BATCH, columns=columns, use_threads=False):
            rows = row + np.arange(batch.num_rows, dtype=float)
            values = np.stack([_floats(path, name, batch.column(name), row) for name in columns])
            if not np.isfinite(values).all():
                column, at = np.argwhere(~np.isfinite(values))[0]
                where = f"row {rows[at]:.0f}: column {columns[column]}"
                remedy = "must be a number; a recording may miss some rows: delete those without a reading"
                raise InputError("empty or no finite number", file=path, key=where, remedy=remedy)
            row += batch.num_rows
            yield RowChunk(rows, values, (row - 2) / total, total)


def _check_size(path: Path, stated: Any) -> None:
    """Raise InputError for too many rows or too large groups of rows: both can be compressed to almost nothing."""
    if stated.num_rows > MOST_ROWS:
        raise InputError(f"{stated.num_rows} rows; at most {MOST_ROWS}", file=path)
    # For the whole group: for a column's size pyarrow reads its statistics, and crashes if those are bad.
    size = max((stated.row_group(k).total_byte_size for k in range(stated.num_row_groups)), default=0)
    if size > MOST_UNPACKED:
        problem = f"{size / 1e6:.0f} MB in one group of rows; at most {MOST_UNPACKED >> 20} MiB"
        raise InputError(problem, file=path, remedy="write it in smaller groups of rows, or as CSV")


@contextmanager
def _opened_parquet(path: Path) -> Iterator[Any]:
    """The file, opened for reading. Raises InputError if it is no parquet file, or pyarrow is not installed."""
    with library_file(path, "parquet", "pyarrow", "parquet"):
        import pyarrow.parquet as pq

        with pq.ParquetFile(path, memory_map=False, pre_buffer=False) as file:
            yield file


def _floats(path: Path, name: str, column: Any, row: int) -> Array:
    """Column (n,) as floats, its first number in ``row``. Raises InputError for integers that a float cannot hold."""
    import pyarrow as pa

    try:
        return np.asarray(column.cast(pa.float64()).to_numpy(zero_copy_only=False))
    except pa.ArrowInvalid:
        rounded = column.cast(pa.float64(), safe=False).to_numpy(zero_copy_only=False)
        at = int(np.argmax(np.abs(rounded) > _EXACT))
        raise InputError(
            f"{column[at].as_py()} is beyond 2^53, up to which whole numbers are exact",
            file=path,
            key=f"row {row + at}: column {name}",
            remedy="must be counted from the run's begin, or be stored as floating point",
        ) from None


_UNIT_KEYS = ("unit_string", "NI_UnitDescription", "Unit", "unit")
"""Properties of a channel that may hold its unit; the first is that of LabVIEW's own library."""

_CHANNELS = 1000


def tdms_layout(path: Path, given: TableFormat, known: Sequence[str]) -> TableLayout:
    """Layout of the group that ``given`` names, else of the only one with all ``known`` channels, else of the only one
    with channels of numbers. Channels without a channel of times state start and step of their clock
    (wf_start_offset, wf_increment). Raises InputError if there is no such group, or several."""
    with _opened_tdms(path) as file:
        groups = {group.name: channels for group in file.groups() if (channels := _numeric(path, group))}
        if given.sheet is not None and given.sheet not in groups:
            has = ", ".join(groups)[:200]
            raise InputError(
                f"no group {shown(given.sheet)} of numbers", file=path, key="sheet", remedy=f"it has {has}"
            )
        named = [name for name, channels in groups.items() if known and set(known) <= {one.name for one in channels}]
        chosen = [given.sheet] if given.sheet is not None else named or list(groups)
        if not chosen:
            raise InputError("no channels of numbers", file=path)
        if len(chosen) > 1:
            raise _several(path, f"channels in {len(chosen)} groups", chosen)
        channels = groups[chosen[0]]
        names = tuple(channel.name for channel in channels)
        units = tuple(_unit(channel.properties) for channel in channels)
        clock = _clock(channels)
    return TableLayout(names, units, replace(given, sheet=chosen[0]), (), None, 1, len(names), clock)


def tdms_chunks(path: Path, names: Sequence[str], layout: TableLayout) -> Iterator[RowChunk]:
    """Chunks of the group in ``layout.format.sheet``; see `read.chunks`. Rows are numbered from 1."""
    with _opened_tdms(path) as file:
        channels = [file[layout.format.sheet].channels()[place] for place in places(path, layout, names)]
        total = _length(path, channels)
        sources, row = [_Pieces(channel) for channel in channels], 0
        while row < total:
            size = min(BATCH, total - row)
            values = np.stack([source.take(size) for source in sources])
            if values.shape[1] < size:
                problem = f"ends after {row + values.shape[1]} of {total} values"
                raise InputError(problem, file=path, remedy="cut off?")
            if not np.isfinite(values).all():
                column, at = np.argwhere(~np.isfinite(values))[0]
                where = f"row {row + at + 1}: column {names[column]}"
                raise InputError("no finite number", file=path, key=where, remedy="must be a number")
            rows = np.arange(row + 1, row + size + 1, dtype=float)
            row += size
            yield RowChunk(rows, values, row / total, total)


class _Pieces:
    """Values of a channel in parts of any size, independent of the pieces in which they were written."""

    def __init__(self, channel: Any) -> None:
        self._source, self._held = iter(channel.data_chunks()), np.empty(0)

    def take(self, size: int) -> Array:
        """The next ``size`` values, fewer at the end."""
        parts, held = [self._held], self._held.size
        while held < size and (piece := next(self._source, None)) is not None:
            parts.append(np.asarray(piece[:], float))
            held += parts[-1].size
        values = np.concatenate(parts)
        self._held = values[size:]
        return values[:size]


def _length(path: Path, channels: Sequence[Any]) -> int:
    lengths = {len(channel) for channel in channels}
    if len(lengths) > 1:
        text = ", ".join(f"{channel.name} {len(channel)}" for channel in channels)
        raise InputError(f"channels of unlike length: {text}", file=path, remedy="must be sampled together")
    (length,) = lengths or {0}
    size, least = path.stat().st_size, sum(channel.dtype.itemsize for channel in channels)
    if length * least > size:
        problem = f"states {length} values a channel, more than its {size} bytes hold"
        raise InputError(problem, file=path, remedy="cut off, or another kind of file?")
    return length


def _numeric(path: Path, group: Any) -> list[Any]:
    channels = group.channels()
    if len(channels) > _CHANNELS:
        raise InputError(f"{len(channels)} channels in group {group.name}; at most {_CHANNELS}", file=path)
    return channels if any(channel.dtype.kind in "iuf" and len(channel) for channel in channels) else []


def _unit(properties: Any) -> str:
    return next((str(properties[key]) for key in _UNIT_KEYS if properties.get(key)), "")


def _clock(channels: Sequence[Any]) -> tuple[float, float] | None:
    """First time and step of all channels, s; None if they have no clock, or not the same."""
    clocks = {
        (float(one.properties.get("wf_start_offset", 0.0)), float(one.properties.get("wf_increment", 0.0)))
        for one in channels
    }
    (first, step) = next(iter(clocks))
    return (first, step) if len(clocks) == 1 and step > 0 else None


@contextmanager
def _opened_tdms(path: Path) -> Iterator[Any]:
    """The file, opened for reading. Raises InputError if it is no TDMS file, or npTDMS is not installed."""
    with library_file(path, "TDMS", "npTDMS", "tdms"):
        from nptdms import TdmsFile

        with warnings.catch_warnings(), path.open("rb") as stream:
            warnings.simplefilter("ignore")
            with TdmsFile.open(stream) as file:
                yield file


UNPACKED = 100e6
"""Greatest size in bytes of an unpacked workbook: some 600 000 rows of four columns, half a minute of reading."""

_PARTS, _SHEETS, _ROWS, _COLUMNS = 2000, 50, 2**20, 256
"""Greatest numbers of files in a workbook, of sheets examined, of rows of a sheet (as in Excel) and of columns read."""

_EMPTY = 10_000
"""Greatest number of consecutive empty rows: a corrupted row number leaves more."""

_LOOKED_AT = 500
_BATCH = 2**16
_CSV = "save the sheet as CSV"


def xlsx_layout(path: Path, given: TableFormat, known: Sequence[str]) -> TableLayout:
    """Layout of the sheet in ``given``, or with all ``known`` columns, or of numbers. Raises InputError if not one."""
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
        raise _several(path, f"tables of numbers in {len(tables)} sheets", list(tables))
    return next(iter(tables.values()))


def _several(path: Path, problem: str, names: Sequence[str]) -> InputError:
    remedy = f"state one in the campaign file, or give `sheet`:\n[format]\nsheet = {shown(names[0])}"
    return InputError(f"{problem}: {', '.join(names)[:200]}", file=path, key="sheet", remedy=remedy)


def xlsx_chunks(path: Path, names: Sequence[str], layout: TableLayout) -> Iterator[RowChunk]:
    """Chunks of the sheet in ``layout.format.sheet``; see `read.chunks`. Rows are numbered as in Excel."""
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
    """The workbook, opened for reading. Raises InputError if it is none, is too large, or openpyxl is missing."""
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
    """Cells of rows from ``first`` on. Raises ValueError for more rows than Excel has, or many empty ones together."""
    # The size that a sheet states may be wrong.
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
