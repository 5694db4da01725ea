"""Columns of a measured file, CSV or parquet, in chunks: a recording of any length never stands whole in memory."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.chunk import RowChunk
from pneutouch.bench.csv_table import csv_chunks
from pneutouch.bench.parquet_table import parquet_chunks
from pneutouch.errors import InputError


def chunks(path: Path, names: Sequence[str]) -> Iterator[RowChunk]:
    """The columns ``names`` of a CSV or (suffix .parquet) parquet file, chunk by chunk, at least one row in all (it may be `RowChunk.last`).

    Raises InputError, naming file, column and row, for a file that cannot be read, is cut off or holds no rows, for a
    missing or doubled column, and for a cell that is no finite number.
    """
    rows = 0
    source = parquet_chunks if path.suffix.lower() == ".parquet" else csv_chunks
    try:
        if path.is_dir():
            raise InputError(f"{path}: this is a folder; give a CSV or parquet file")
        if path.stat().st_size == 0:
            raise InputError(f"{path}: empty file; must have a header row and rows of numbers")
        for chunk in source(path, names):
            rows += chunk.rows.size + (chunk.last is not None)
            yield chunk
    except FileNotFoundError:
        raise InputError(f"{path}: no such file") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from None
    if not rows:
        raise InputError(f"{path}: has a header but no rows of numbers")


def whole(path: Path, names: Sequence[str]) -> tuple[Array, Array]:
    """Row numbers (n,) and columns (k, n) of a small file. Raises InputError as `chunks`.

    A last row without a line end is kept where it is whole: a table typed by hand often ends so, and its last row is
    often the greatest.
    """
    rows, values = [], []
    for part in chunks(path, names):
        rows.append(part.rows)
        values.append(part.values)
        if part.last is not None:
            rows.append(np.array([part.total + 1.0]))
            values.append(part.last)
    return np.concatenate(rows), np.concatenate(values, axis=1)
