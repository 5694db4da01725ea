"""The result of every table reader: rows in chunks, and columns located by their names."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from pneutouch.arrays import Array
from pneutouch.errors import InputError, nearest
from pneutouch.tables.layout import TableLayout


class RowChunk(NamedTuple):
    """Some rows of a file.

    Attributes:
        rows: Their numbers in the file, (n,), counted from 1.
        values: The requested columns, (k, n), in the requested order; all finite.
        share: Share of the file that has been read, 0 to 1.
        total: Number of rows of numbers in the file; of a text file as estimated from its bytes.
        last: A complete last row without a line end, whose last number may be cut: its values (k, 1), not among
            ``values``; else None.
        last_row: Its number in the file.
    """

    rows: Array
    values: Array
    share: float
    total: int
    last: Array | None = None
    last_row: int = 0


def places(path: Path, layout: TableLayout, names: Sequence[str]) -> list[int]:
    """Indices of the columns in a table; #2 is the second one whatever its name.

    Raises InputError for a column that is missing or there twice."""
    header, indices = layout.names, []
    for name in names:
        if header.count(name) > 1:
            count = header.count(name)
            raise InputError(f"there {count} times", file=path, key=f"column {name}", remedy="must be there once")
        place = layout.place(name)
        if place is None:
            hint = " Columns are separated by commas, semicolons or tabs." if len(header) < 2 else ""
            hint = hint or nearest(name, set(header))
            problem = f"missing from the header '{', '.join(header)[:80]}' (row {layout.header_row}).{hint}"
            raise InputError(problem, file=path, key=f"column {name}")
        indices.append(place)
    return indices
