"""Parquet files in batches of rows."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import InputError
from pneutouch.tables.layout import RowChunk, TableFormat, TableLayout, library_file, places

MOST_ROWS, MOST_UNPACKED = 1_000_000_000, 2**30
"""Rows of a file, a day at 10 kHz; and bytes of one group of rows once unpacked, which is in memory."""

BATCH = 2**17
"""Rows at once: as many as a chunk of a CSV file holds."""

_EXACT = 2.0**53


def parquet_layout(path: Path, given: TableFormat, known: Sequence[str]) -> TableLayout:
    """Layout of a parquet file, whose columns have names and no units of their own. Raises InputError."""
    with _opened(path) as file:
        names = tuple(str(name) for name in file.schema_arrow.names)
    return TableLayout(names, ("",) * len(names), given, least=len(names))


def parquet_chunks(path: Path, names: Sequence[str], layout: TableLayout) -> Iterator[RowChunk]:
    """Chunks of a parquet file; see `read.chunks`. Its rows are numbered from 2, as in a CSV file."""
    import pyarrow as pa

    with _opened(path) as file:
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
                raise InputError("empty or no finite number", file=path, key=where, remedy="must be a number")
            row += batch.num_rows
            yield RowChunk(rows, values, (row - 2) / total, total)


def _check_size(path: Path, stated: Any) -> None:
    """Raise InputError for more rows, or larger groups of them, than are read: both pack to almost nothing."""
    if stated.num_rows > MOST_ROWS:
        raise InputError(f"{stated.num_rows} rows; at most {MOST_ROWS}", file=path)
    # Of the whole group: with a column's size pyarrow reads its statistics, and ends the process where those are bad.
    size = max((stated.row_group(k).total_byte_size for k in range(stated.num_row_groups)), default=0)
    if size > MOST_UNPACKED:
        problem = f"{size / 1e6:.0f} MB in one group of rows; at most {MOST_UNPACKED >> 20} MiB"
        raise InputError(problem, file=path, remedy="write it in smaller groups of rows, or as CSV")


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    """The file, for reading. Raises InputError if it is no parquet file, or pyarrow is not installed."""
    with library_file(path, "parquet", "pyarrow", "parquet"):
        import pyarrow.parquet as pq

        with pq.ParquetFile(path, memory_map=False, pre_buffer=False) as file:
            yield file


def _floats(path: Path, name: str, column: Any, row: int) -> Array:
    """A column (n,) whose first number is in ``row``. Raises InputError for whole numbers that a float cannot hold."""
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
