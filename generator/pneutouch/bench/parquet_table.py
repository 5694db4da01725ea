"""Parquet files in batches of rows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.chunk import RowChunk, places
from pneutouch.errors import InputError

BATCH = 2**17
"""Rows at once: as many as a chunk of a CSV file holds."""

_EXACT = 2.0**53


def parquet_chunks(path: Path, names: Sequence[str]) -> Iterator[RowChunk]:
    """Chunks of a parquet file; see `table.chunks`. Its rows are numbered from 2, as in a CSV file.

    Raises InputError where pyarrow, an optional library, is not there.
    """
    try:
        import pyarrow as pa
        import pyarrow.parquet as pq
    except ImportError:
        raise InputError(f'{path}: parquet files need pyarrow: pip install "pneutouch[parquet]"') from None
    try:
        with pq.ParquetFile(path, memory_map=False, pre_buffer=False) as file:
            schema = file.schema_arrow
            places(path, list(schema.names), names)
            for name in names:
                kind = schema.field(name).type
                if not (pa.types.is_integer(kind) or pa.types.is_floating(kind)):
                    raise InputError(f"{path}: column {name}: holds {kind}; must be numbers")
            row, total = 2, file.metadata.num_rows
            for batch in file.iter_batches(BATCH, columns=list(names), use_threads=False):
                rows = row + np.arange(batch.num_rows, dtype=float)
                values = np.stack([_floats(path, name, batch.column(name), row) for name in names])
                if not np.isfinite(values).all():
                    column, at = np.argwhere(~np.isfinite(values))[0]
                    told = "empty or no finite number"
                    raise InputError(f"{path}: row {rows[at]:.0f}: column {names[column]}: {told}; must be a number")
                row += batch.num_rows
                yield RowChunk(rows, values, (row - 2) / total, total)
    except pa.ArrowException as error:
        told = str(error).splitlines()[0][:120]
        raise InputError(f"{path}: no whole parquet file: {told}; cut off, or another kind of file?") from None


def _floats(path: Path, name: str, column: Any, row: int) -> Array:
    """A column (n,) of which the first number stands in ``row``. Raises InputError for whole numbers that a float cannot hold."""
    import pyarrow as pa

    try:
        found: Array = column.cast(pa.float64()).to_numpy(zero_copy_only=False)
    except pa.ArrowInvalid:
        rounded = column.cast(pa.float64(), safe=False).to_numpy(zero_copy_only=False)
        at = int(np.argmax(np.abs(rounded) > _EXACT))
        raise InputError(
            f"{path}: row {row + at}: column {name}: {column[at].as_py()} is beyond 2^53, up to which whole numbers are exact; "
            "must be counted from the run's begin, or be stored as floating point"
        ) from None
    return found
