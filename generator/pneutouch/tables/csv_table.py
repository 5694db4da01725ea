"""CSV files in chunks of bytes that end at a line end, so that every row and every fault has its row number."""

import codecs
import csv
import io
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import BinaryIO, NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import InputError
from pneutouch.tables.chunk import RowChunk, places

CHUNK = 4 * 2**20
"""Bytes parsed at once: about 100 000 rows; larger ones are not faster and take more memory."""

_LONGEST_LINE = 2**16
_SEPARATORS = (",", ";", "\t")
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_TOO_LONG = f"over {_LONGEST_LINE} bytes without a line end; not a CSV file of numbers"


class _Layout(NamedTuple):
    path: Path
    separator: str
    width: int
    names: Sequence[str]
    places: list[int]

    def fault(self, row: int, problem: str, remedy: str | None = None) -> InputError:
        return _fault(self.path, row, problem, remedy)


def _fault(path: Path, row: int, problem: str, remedy: str | None = None) -> InputError:
    return InputError(problem, file=path, key=f"row {row}", remedy=remedy)


def csv_chunks(path: Path, names: Sequence[str]) -> Iterator[RowChunk]:
    """Chunks of a UTF-8 file with commas, semicolons or tabs and decimal points; see `read.chunks`.

    Comment lines (``#``) before the header and a byte order mark are skipped, empty lines skipped but counted. A
    complete last row without a line end is returned as `RowChunk.last`, because its last number may be cut."""
    size = path.stat().st_size
    with path.open("rb") as stream:
        layout = _header(path, stream, names)
        row, rest, read = 2, b"", stream.seek(0, io.SEEK_CUR)
        while data := stream.read(CHUNK):
            read += len(data)
            data = rest + data
            end = data.rfind(b"\n") + 1
            data, rest = data[:end], data[end:]
            if len(rest) > _LONGEST_LINE:
                raise _fault(path, row, _TOO_LONG)
            if not data:
                continue
            rows, values, lines = _parse(data, row, layout)
            row += lines
            left = (size - read + len(rest)) * lines / len(data)
            yield RowChunk(rows, values, min((read - len(rest)) / size, 1.0), round(row - 2 + left))
        if rest.strip():
            last = _last(rest, row, layout)
            yield RowChunk(np.empty(0), np.empty((len(names), 0)), 1.0, row - 1, last)


def _header(path: Path, stream: BinaryIO, names: Sequence[str]) -> _Layout:
    start, columns = stream.read(4), f"as {','.join(names)}"
    if start[:2] in (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE):
        raise InputError("UTF-16 text", file=path, remedy="save it as UTF-8")
    stream.seek(3 if start.startswith(codecs.BOM_UTF8) else 0)
    while True:
        line = stream.readline(_LONGEST_LINE)
        text = _text(path, line, 1)
        if not line:
            raise InputError("no header row", file=path, remedy=f"must name the columns, {columns}")
        if not line.endswith(b"\n") and len(line) == _LONGEST_LINE:
            raise _fault(path, 1, _TOO_LONG)
        if text.strip() and not text.lstrip().startswith("#"):
            break
    if "\r" in text.rstrip("\r\n"):
        raise _fault(path, 1, "carriage returns within it", "rows must end in line feeds: save it as CSV again")
    headers = {separator: _cells(text, separator) for separator in _SEPARATORS}
    separator = max(_SEPARATORS, key=lambda key: (sum(name in headers[key] for name in names), len(headers[key])))
    header = headers[separator]
    if all(_NUMBER.fullmatch(name) for name in header):
        raise InputError(f"row 1 holds numbers; must be a header that names the columns, {columns}", file=path)
    return _Layout(path, separator, len(header), names, places(path, header, names))


def _text(path: Path, data: bytes, row: int) -> str:
    """Text of some lines, of which the first is ``row``."""
    if b"\0" in data:
        at = row + data.count(b"\n", 0, data.index(b"\0"))
        raise _fault(path, at, "holds a zero byte: a binary file", "must be CSV text")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        at = row + data.count(b"\n", 0, error.start)
        raise _fault(path, at, f"not UTF-8 text (byte 0x{data[error.start]:02x})") from None


def _cells(line: str, separator: str) -> list[str]:
    if '"' not in line:
        return [cell.strip() for cell in line.split(separator)]
    try:
        return [cell.strip() for cell in next(csv.reader([line.rstrip("\r\n")], delimiter=separator), [])]
    except csv.Error:
        return [cell.strip() for cell in line.split(separator)]


def _blank(line: str, separator: str) -> bool:
    """Whether the parser skips a line: one of spaces and tabs alone, but not of separators."""
    return not line.strip(" \r\t" if separator != "\t" else " \r")


def _parse(data: bytes, row: int, layout: _Layout) -> tuple[Array, Array, int]:
    """Row numbers, values and number of lines of whole lines that begin with ``row``.

    The default conversion of pandas is used: it is the fastest of its three here and off by a few units in the last
    place of a double at most, far below any sensor's resolution.
    """
    import pandas as pd

    if not data.isascii() or b"\0" in data:
        _text(layout.path, data, row)
    lines = data.count(b"\n")
    # The parser ignores superfluous fields without an error, so they are counted here.
    uneven = data.count(layout.separator.encode()) != lines * (layout.width - 1)
    kept = _check_widths(data, row, layout) if uneven or b'"' in data or layout.width == 1 else None
    rows = row + (np.arange(lines, dtype=float) if kept is None else kept)
    if not rows.size:
        return rows, np.empty((len(layout.places), 0)), lines
    try:
        frame = pd.read_csv(
            io.BytesIO(data),
            sep=layout.separator,
            header=None,
            names=list(range(layout.width)),
            index_col=False,
            usecols=layout.places,
            dtype="float64",
            engine="c",
        )
        values = np.stack([frame[place].to_numpy() for place in layout.places])
    except (ValueError, pd.errors.ParserError):
        values = np.full((len(layout.places), rows.size), np.nan)
    if values.shape[1] != rows.size or not np.isfinite(values).all():
        _raise_fault(data, row, layout)
    return rows, values, lines


def _check_widths(data: bytes, row: int, layout: _Layout) -> Array:
    """Indices of the lines that are not empty. Raises InputError for one with too few or too many fields."""
    kept = []
    # Line feeds end rows: the other line ends of Unicode belong to the cell.
    for k, line in enumerate(data.decode("utf-8").split("\n")[:-1]):
        if _blank(line, layout.separator):
            continue
        if "\r" in line.rstrip("\r"):
            raise layout.fault(row + k, "a carriage return within it", "rows must end in line feeds")
        _check_width(len(_cells(line, layout.separator)), row + k, layout)
        kept.append(k)
    return np.array(kept, float)


def _check_width(count: int, row: int, layout: _Layout) -> None:
    if count != layout.width:
        comma = " Decimals must have a point." if count > layout.width and layout.separator == "," else ""
        raise layout.fault(row, f"{count} fields; the header has {layout.width}.{comma}")


def _raise_fault(data: bytes, row: int, layout: _Layout) -> None:
    """Find the row and the cell that the fast parser could not read, cell by cell."""
    lines = data.decode("utf-8").split("\n")[:-1]
    for k, line in enumerate(lines):
        if _blank(line, layout.separator):
            continue
        cells = _cells(line, layout.separator)
        for name, place in zip(layout.names, layout.places, strict=True):
            text = cells[place]
            if not _NUMBER.fullmatch(text) or not np.isfinite(float(text)):
                problem = f"column {name}: '{text[:40]}' is no finite number" if text else f"column {name}: empty"
                raise layout.fault(row + k, problem, "must be a number with a decimal point")
    raise InputError(f"rows {row} to {row + len(lines) - 1}: cannot be read as columns of numbers", file=layout.path)


def _last(rest: bytes, row: int, layout: _Layout) -> Array:
    """Values (k, 1) of a last row without a line end. Raises InputError where it is not complete."""
    text = _text(layout.path, rest, row)
    cells = _cells(text, layout.separator)
    if len(cells) < layout.width or not all(_NUMBER.fullmatch(cells[place]) for place in layout.places):
        problem = f"the file ends within this row, '{text.strip()[:60]}'; it is cut off"
        raise layout.fault(row, f"{problem}: copy it again, or delete its last row")
    _check_width(len(cells), row, layout)
    values = np.array([[float(cells[place])] for place in layout.places])
    if not np.isfinite(values).all():
        _raise_fault(rest + b"\n", row, layout)
    return values
