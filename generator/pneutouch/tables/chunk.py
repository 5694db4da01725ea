"""The result of every table reader: rows in chunks, and columns located by their names."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from pneutouch.arrays import Array
from pneutouch.errors import InputError, nearest


class RowChunk(NamedTuple):
    """Some rows of a file.

    Attributes:
        rows: Their numbers in the file, (n,); the header is row 1, comments before it do not count.
        values: The requested columns, (k, n), in the requested order; all finite.
        share: Share of the file that has been read, 0 to 1.
        total: Number of rows in the file; of a CSV file as estimated from its bytes.
        last: A complete last row without a line end, whose last number may be cut: its values (k, 1), not among
            ``values``; else None.
    """

    rows: Array
    values: Array
    share: float
    total: int
    last: Array | None = None


def places(path: Path, header: Sequence[str], names: Sequence[str]) -> list[int]:
    """Indices of the columns in a header. Raises InputError for a column that is missing or there twice."""
    for name in names:
        if header.count(name) > 1:
            count = header.count(name)
            raise InputError(f"there {count} times", file=path, key=f"column {name}", remedy="must be there once")
        if name not in header:
            separators = " Columns are separated by commas, semicolons or tabs."
            hint = separators if len(header) < 2 else nearest(name, set(header))
            problem = f"missing from the header '{', '.join(header)[:80]}' (row 1).{hint}"
            raise InputError(problem, file=path, key=f"column {name}")
    return [header.index(name) for name in names]
