"""Tables fitted to the width of the terminal; whole lines if stdout is no terminal."""

import io
import sys
from collections.abc import Sequence

from pneutouch.cli.terminal import width

_NARROW = 16
"""Letters of a figure or a name that is not broken; longer cells are text."""

_APART = 2
"""Spaces between columns."""


def table_text(
    head: Sequence[str], rows: Sequence[Sequence[str]], columns: int | None = None, *, indent: str = ""
) -> str:
    """Left-aligned columns two spaces apart, under a head where there is one; "" without rows and head.

    Cells are wrapped so that no line has more than ``columns`` letters (None: the terminal's).
    """
    table = [head, *rows] if head else list(rows)
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    lines = ["  ".join(map(str.ljust, row, widths)).rstrip() for row in table]
    most = columns or width(sys.stdout)
    if most is not None and any(len(indent) + len(line) > most for line in lines):
        lines = _wrapped(head, rows, most - len(indent))
    return "\n".join(f"{indent}{line}" for line in lines)


def _wrapped(head: Sequence[str], rows: Sequence[Sequence[str]], columns: int) -> list[str]:
    """The lines of the table. Figures and names stay whole, texts take as many lines as they need; columns that do not
    fit follow below, behind the first one."""
    table = [head, *rows] if head else list(rows)
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    least = [min(each, _NARROW) for each in widths]
    end, taken = 1, least[0]
    while end < len(widths) and taken + _APART + least[end] <= columns:
        taken += _APART + least[end]
        end += 1
    if end < len(widths) and end > 1:
        here = _wrapped(head[:end], [row[:end] for row in rows], columns)
        return [*here, "", *_wrapped([*head[:1], *head[end:]], [[row[0], *row[end:]] for row in rows], columns)]
    # Where not even the first two columns fit, every cell is folded: a column that stays whole would be cut off.
    fits = end == len(widths)
    return _folded(head, rows, [fits and each <= _NARROW for each in widths], columns)


def _folded(head: Sequence[str], rows: Sequence[Sequence[str]], whole: Sequence[bool], columns: int) -> list[str]:
    """The lines of a table whose cells are folded, but for the columns that stay whole."""
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, pad_edge=False, padding=(0, _APART, 0, 0), header_style="", show_edge=False)
    table.show_header = bool(head)
    for name, kept in zip(head or rows[0], whole, strict=True):
        table.add_column(Text(name) if head else "", overflow="fold", no_wrap=kept)
    for row in rows:
        table.add_row(*(Text(cell) for cell in row))
    stream = io.StringIO()
    Console(file=stream, width=columns, no_color=True, highlight=False, legacy_windows=False).print(table)
    return [line.rstrip() for line in stream.getvalue().splitlines()]
