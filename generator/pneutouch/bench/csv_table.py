"""CSV files in chunks of bytes that end at a line end, so that every row keeps its number and every fault its place."""

from __future__ import annotations

import codecs
import csv
import io
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import BinaryIO, NamedTuple

import numpy as np

from pneutouch.bench.table import Chunk, places
from pneutouch.errors import InputError
from pneutouch.meridian.segments import Array

CHUNK = 4 * 2**20
"""Bytes parsed at once: about 100 000 rows; larger ones are not faster and take more memory."""

_LONGEST_LINE = 2**16
_SEPARATORS = (",", ";", "\t")
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")


class _Layout(NamedTuple):
    path: Path
    separator: str
    width: int
    names: Sequence[str]
    places: list[int]


def csv_chunks(path: Path, names: Sequence[str]) -> Iterator[Chunk]:
    """Chunks of a UTF-8 file with commas, semicolons or tabs and decimal points; see `table.chunks`.

    Comment lines (``#``) before the header and a byte order mark are passed over, empty lines skipped but counted. A
    last row without a line end is left out where it is whole, for its last number may be cut.
    """
    size = path.stat().st_size
    with path.open("rb") as stream:
        layout = _header(path, stream, names)
        row, rest, read = 2, b"", stream.tell()
        while data := stream.read(CHUNK):
            read += len(data)
            data = rest + data
            end = data.rfind(b"\n") + 1
            data, rest = data[:end], data[end:]
            if len(rest) > _LONGEST_LINE:
                raise InputError(
                    f"{path}: row {row}: over {_LONGEST_LINE} bytes without a line end; not a CSV file of numbers"
                )
            if not data:
                continue
            rows, values, lines = _parse(data, row, layout)
            row += lines
            left = (size - read + len(rest)) * lines / len(data)
            yield Chunk(rows, values, min((read - len(rest)) / size, 1.0), round(row - 2 + left))
        if rest.strip():
            _check_end(rest, row, layout)
            yield Chunk(np.empty(0), np.empty((len(names), 0)), 1.0, row - 2, cut=True)


def _header(path: Path, stream: BinaryIO, names: Sequence[str]) -> _Layout:
    start = stream.read(4)
    if start[:2] in (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE):
        raise InputError(f"{path}: UTF-16 text; save it as UTF-8")
    stream.seek(3 if start.startswith(codecs.BOM_UTF8) else 0)
    while True:
        line = stream.readline(_LONGEST_LINE)
        text = _text(path, line, 1)
        if not line:
            raise InputError(f"{path}: no header row; must name the columns, as {','.join(names)}")
        if not line.endswith(b"\n") and len(line) == _LONGEST_LINE:
            raise InputError(f"{path}: row 1: over {_LONGEST_LINE} bytes without a line end; not a CSV file")
        if text.strip() and not text.lstrip().startswith("#"):
            break
    headers = {separator: _cells(text, separator) for separator in _SEPARATORS}
    separator = max(_SEPARATORS, key=lambda key: (sum(name in headers[key] for name in names), len(headers[key])))
    header = headers[separator]
    if all(_NUMBER.fullmatch(name) for name in header):
        raise InputError(f"{path}: row 1 holds numbers; must be a header that names the columns, as {','.join(names)}")
    return _Layout(path, separator, len(header), names, places(path, header, names))


def _text(path: Path, data: bytes, row: int) -> str:
    """Text of some lines, of which the first is ``row``."""
    if b"\0" in data:
        at = row + data.count(b"\n", 0, data.index(b"\0"))
        raise InputError(f"{path}: row {at}: holds a zero byte: a binary file; must be CSV text")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        at = row + data.count(b"\n", 0, error.start)
        raise InputError(f"{path}: row {at}: not UTF-8 text (byte 0x{data[error.start]:02x})") from None


def _cells(line: str, separator: str) -> list[str]:
    return [cell.strip() for cell in next(csv.reader([line], delimiter=separator), [])]


def _parse(data: bytes, row: int, layout: _Layout) -> tuple[Array, Array, int]:
    """Row numbers, values and number of lines of whole lines that begin with ``row``.

    The default conversion of pandas is used: it is the fastest of its three here and off by a few units in the last
    place of a double at most, far below any sensor's resolution.
    """
    import pandas as pd

    if not data.isascii() or b"\0" in data:
        _text(layout.path, data, row)
    lines = data.count(b"\n")
    # The parser passes over superfluous fields in silence, so they are counted here.
    uneven = data.count(layout.separator.encode()) != lines * (layout.width - 1)
    kept = _check_widths(data, row, layout) if uneven or b'"' in data or layout.width == 1 else None
    rows = row + (np.arange(lines, dtype=float) if kept is None else kept)
    if not rows.size:
        return rows, np.empty((len(layout.places), 0)), lines
    try:
        frame = pd.read_csv(
            io.BytesIO(data), sep=layout.separator, header=None, names=list(range(layout.width)), index_col=False,
            usecols=layout.places, dtype="float64", engine="c", encoding="utf-8",
        )  # fmt: skip
        values = np.stack([frame[place].to_numpy() for place in layout.places])
    except (ValueError, pd.errors.ParserError):
        values = np.full((len(layout.places), rows.size), np.nan)
    if values.shape[1] != rows.size or not np.isfinite(values).all():
        _tell_fault(data, row, layout)
    return rows, values, lines


def _check_widths(data: bytes, row: int, layout: _Layout) -> Array:
    """Places of the lines that are not empty. Raises InputError for one with too few or too many fields."""
    kept = []
    for k, line in enumerate(data.decode("utf-8").splitlines()):
        if not line.strip():
            continue
        count = len(_cells(line, layout.separator)) if '"' in line else line.count(layout.separator) + 1
        if count != layout.width:
            comma = " Decimals must have a point." if count > layout.width and layout.separator == "," else ""
            raise InputError(f"{layout.path}: row {row + k}: {count} fields; the header has {layout.width}.{comma}")
        kept.append(k)
    return np.array(kept, float)


def _tell_fault(data: bytes, row: int, layout: _Layout) -> None:
    """Reads slowly what could not be read quickly, for the row and the cell."""
    lines = data.decode("utf-8").splitlines()
    for k, line in enumerate(lines):
        if not line.strip():
            continue
        cells = _cells(line, layout.separator)
        for name, place in zip(layout.names, layout.places, strict=True):
            text = cells[place]
            if not _NUMBER.fullmatch(text) or not np.isfinite(float(text)):
                told = f"'{text[:40]}' is no finite number" if text else "empty"
                raise InputError(
                    f"{layout.path}: row {row + k}: column {name}: {told}; must be a number with a decimal point"
                )
    raise InputError(f"{layout.path}: rows {row} to {row + len(lines) - 1}: cannot be read as columns of numbers")


def _check_end(rest: bytes, row: int, layout: _Layout) -> None:
    cells = _cells(_text(layout.path, rest, row), layout.separator)
    whole = len(cells) >= layout.width and all(_NUMBER.fullmatch(cells[place]) for place in layout.places)
    if not whole:
        raise InputError(
            f"{layout.path}: row {row}: the file ends within this row, '{rest[:60].decode().strip()}'; it is cut off: "
            "copy it anew, or delete its last row"
        )
