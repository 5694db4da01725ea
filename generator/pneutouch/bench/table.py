"""Columns of a measured file, CSV or parquet, in chunks: a recording of any length never stands whole in memory."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from pneutouch.errors import InputError, nearest
from pneutouch.meridian.segments import Array


class Chunk(NamedTuple):
    """Some rows of a file.

    Attributes:
        rows: Their numbers in the file, (n,); the header is row 1, comments before it do not count.
        values: The columns asked for, (k, n), in the order asked for; all finite.
        share: How much of the file has been read with them, 0 to 1.
        total: How many rows the file has; of a CSV file as estimated from its bytes.
        cut: Whether a last row was left out because the file ends without a line end, so that it may be cut in a number.
    """

    rows: Array
    values: Array
    share: float
    total: int
    cut: bool = False


def chunks(path: Path, names: Sequence[str]) -> Iterator[Chunk]:
    """The columns ``names`` of a CSV or (suffix .parquet) parquet file, chunk by chunk, at least one row in all.

    Raises InputError, naming file, column and row, for a file that cannot be read, is cut off or holds no rows, for a
    missing or doubled column, and for a cell that is no finite number.
    """
    from pneutouch.bench.csv_table import csv_chunks
    from pneutouch.bench.parquet_table import parquet_chunks

    rows = 0
    source = parquet_chunks if path.suffix.lower() == ".parquet" else csv_chunks
    try:
        if path.is_dir():
            raise InputError(f"{path}: this is a folder; give a CSV or parquet file")
        if path.stat().st_size == 0:
            raise InputError(f"{path}: empty file; must have a header row and rows of numbers")
        for chunk in source(path, names):
            rows += chunk.rows.size
            yield chunk
    except FileNotFoundError:
        raise InputError(f"{path}: no such file") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from None
    if not rows:
        raise InputError(f"{path}: has a header but no rows of numbers")


def whole(path: Path, names: Sequence[str]) -> tuple[Array, Array]:
    """Row numbers (n,) and columns (k, n) of a small file. Raises InputError as `chunks`."""
    parts = list(chunks(path, names))
    return np.concatenate([part.rows for part in parts]), np.concatenate([part.values for part in parts], axis=1)


def places(path: Path, header: Sequence[str], names: Sequence[str]) -> list[int]:
    """Where the columns stand in a header. Raises InputError for a column that is missing or there twice."""
    found = []
    for name in names:
        if header.count(name) > 1:
            raise InputError(f"{path}: column {name}: there {header.count(name)} times; must be there once")
        if name not in header:
            told = ", ".join(header)[:80]
            hint = (
                " Columns are separated by commas, semicolons or tabs."
                if len(header) < 2
                else nearest(name, set(header))
            )
            raise InputError(f"{path}: column {name}: missing from the header '{told}' (row 1).{hint}")
        found.append(header.index(name))
    return found
