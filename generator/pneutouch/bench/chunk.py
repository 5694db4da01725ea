"""What every kind of table is read into: rows in chunks, and columns found by their names."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from pneutouch.arrays import Array
from pneutouch.errors import InputError, nearest


class RowChunk(NamedTuple):
    """Some rows of a file.

    Attributes:
        rows: Their numbers in the file, (n,); the header is row 1, comments before it do not count.
        values: The columns asked for, (k, n), in the order asked for; all finite.
        share: How much of the file has been read with them, 0 to 1.
        total: How many rows the file has; of a CSV file as estimated from its bytes.
        last: A last row that is whole but has no line end, so that its last number may be cut: its values (k, 1), not among
            ``values``; else None.
    """

    rows: Array
    values: Array
    share: float
    total: int
    last: Array | None = None


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
