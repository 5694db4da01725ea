"""Columns of a CSV or parquet file, in chunks: a recording of any length is never in memory as a whole."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import InputError
from pneutouch.tables.chunk import RowChunk
from pneutouch.tables.csv_table import csv_chunks
from pneutouch.tables.parquet_table import parquet_chunks


def chunks(path: Path, names: Sequence[str]) -> Iterator[RowChunk]:
    """The columns ``names`` of a CSV or (suffix .parquet) parquet file in chunks, at least one row in all (it may be
    `RowChunk.last`).

    Raises InputError, naming file, column and row, for a file that cannot be read, is cut off or has no rows, for a
    missing or doubled column, and for a cell that is not a finite number.
    """
    rows = 0
    source = parquet_chunks if path.suffix.lower() == ".parquet" else csv_chunks
    try:
        if path.is_dir():
            raise InputError("this is a folder", file=path, remedy="give a CSV or parquet file")
        if path.stat().st_size == 0:
            raise InputError("empty file", file=path, remedy="must have a header row and rows of numbers")
        for chunk in source(path, names):
            rows += chunk.rows.size + (chunk.last is not None)
            yield chunk
    except FileNotFoundError:
        raise InputError("no such file", file=path) from None
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror or error}", file=path) from None
    if not rows:
        raise InputError("has a header but no rows of numbers", file=path)


def whole(path: Path, names: Sequence[str]) -> tuple[Array, Array]:
    """Row numbers (n,) and columns (k, n) of a small file. Raises InputError as `chunks`.

    A complete last row without a line end is kept: a table typed by hand often ends so, and its last row is often the
    greatest."""
    rows, values = [], []
    for part in chunks(path, names):
        rows.append(part.rows)
        values.append(part.values)
        if part.last is not None:
            rows.append(np.array([part.total + 1.0]))
            values.append(part.last)
    return np.concatenate(rows), np.concatenate(values, axis=1)
