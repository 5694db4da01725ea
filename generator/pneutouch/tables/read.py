"""Columns of a measured file, in chunks: a recording of any length is never in memory as a whole."""

import stat
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import InputError
from pneutouch.tables.binary_tables import (
    parquet_chunks,
    parquet_layout,
    tdms_chunks,
    tdms_layout,
    xlsx_chunks,
    xlsx_layout,
)
from pneutouch.tables.csv_table import csv_chunks
from pneutouch.tables.layout import CLOCK, RowChunk, TableFormat, TableLayout
from pneutouch.tables.text import text_layout

_ANY = TableFormat()

MOST_NUMBERS = 20_000_000
"""Greatest number of cells of a table that is held in memory as a whole: 160 MB."""


class _Kind(NamedTuple):
    """Functions for a kind of file: one finds its layout, the other reads its rows."""

    layout: Callable[[Path, TableFormat, Sequence[str]], TableLayout]
    chunks: Callable[[Path, Sequence[str], TableLayout], Iterator[RowChunk]]


_TEXT = _Kind(text_layout, csv_chunks)
_KINDS = {
    ".parquet": _Kind(parquet_layout, parquet_chunks),
    ".xlsx": _Kind(xlsx_layout, xlsx_chunks),
    ".xlsm": _Kind(xlsx_layout, xlsx_chunks),
    ".tdms": _Kind(tdms_layout, tdms_chunks),
}
"""Kinds of file by their suffix; a file with any other suffix is text."""


def layout_of(path: Path, given: TableFormat = _ANY, known: Sequence[str] = ()) -> TableLayout:
    """Layout of the table in a file; fields of ``given`` that are None are detected from the file.

    A row that names all of the ``known`` columns is the header. Raises InputError for a file that cannot be read, and
    if its content does not decide a part of the format."""
    with _readable(path):
        return _kind(path).layout(path, given, known)


def chunks(path: Path, names: Sequence[str], layout: TableLayout | None = None) -> Iterator[RowChunk]:
    """Columns ``names`` of a file in chunks, with at least one row in total (it may be `RowChunk.last`).

    Without ``layout`` it is detected, with ``names`` as the known columns. The suffix determines the kind: .parquet,
    .xlsx, .tdms, else text. Raises InputError, naming file, column and row, for a file that cannot be read, is cut off
    or has no rows, for a missing or doubled column, and for a cell that is not a finite number.
    """
    layout = layout or layout_of(path, known=names)
    rows = 0
    with _readable(path):
        source = _kind(path).chunks
        clocked = layout.clock is not None and CLOCK in names
        for chunk in _clocked(path, names, layout) if clocked else source(path, names, layout):
            rows += chunk.rows.size + (chunk.last is not None)
            yield chunk
    if not rows:
        raise InputError("has a header but no rows of numbers", file=path)


def whole(path: Path, names: Sequence[str], layout: TableLayout | None = None) -> tuple[Array, Array]:
    """Row numbers (n,) and columns (k, n) of a small file. Raises InputError as `chunks`, or for over `MOST_NUMBERS`.

    A complete last row without a line end is included: a table typed by hand often ends so, and its last row often has
    the greatest values."""
    rows, values, count = [], [], 0
    for part in chunks(path, names, layout):
        count += part.values.size
        if count > MOST_NUMBERS:
            raise InputError(
                f"more than {MOST_NUMBERS} numbers", file=path, remedy="give a shorter recording, or fewer samples"
            )
        rows.append(part.rows)
        values.append(part.values)
        if part.last is not None:
            rows.append(np.array([float(part.last_row)]))
            values.append(part.last)
    return np.concatenate(rows), np.concatenate(values, axis=1)


def _kind(path: Path) -> _Kind:
    return _KINDS.get(path.suffix.lower(), _TEXT)


def _clocked(path: Path, names: Sequence[str], layout: TableLayout) -> Iterator[RowChunk]:
    """Chunks of the columns ``names``, with times of the file's clock for the column `CLOCK`."""
    assert layout.clock is not None
    place, (first, step), done = list(names).index(CLOCK), layout.clock, 0
    for part in _kind(path).chunks(path, [name for name in names if name != CLOCK], layout):
        # A file may state any step: invalid or too great times are refused where they are scaled.
        with np.errstate(over="ignore", invalid="ignore"):
            times = first + step * np.arange(done, done + part.rows.size)
        done += part.rows.size
        values, last = np.insert(part.values, place, times, axis=0), part.last
        if last is not None:
            last = np.insert(last, place, first + step * done, axis=0)
        yield part._replace(values=values, last=last)


@contextmanager
def _readable(path: Path) -> Iterator[None]:
    """Context that turns OSError into InputError; raises it also for a folder, a device or an empty file."""
    try:
        if path.is_dir():
            raise InputError("this is a folder", file=path, remedy="give a file of numbers")
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):
            raise InputError("a device or a pipe", file=path, remedy="must be a file")
        if status.st_size == 0:
            raise InputError("empty file", file=path, remedy="must have a header row and rows of numbers")
        yield
    except FileNotFoundError:
        raise InputError("no such file", file=path) from None
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror or error}", file=path) from None
