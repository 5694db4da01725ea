"""Tables wrapped to the width of the terminal; whole lines where stdout is none."""

import io
import sys
from collections.abc import Sequence

from pneutouch.cli.terminal import width

_WHOLE = 100_000
"""Columns where stdout is no terminal: more than any line has."""


def table_text(head: Sequence[str], rows: Sequence[Sequence[str]], columns: int | None = None) -> str:
    """Left-aligned columns under a head, cells wrapped so that no line has more than ``columns`` letters (None: the
    terminal's)."""
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, pad_edge=False, show_edge=False, padding=(0, 2, 0, 0), header_style="")
    for name in head:
        table.add_column(Text(name), overflow="fold")
    for row in rows:
        table.add_row(*(Text(cell) for cell in row))
    stream = io.StringIO()
    fit = columns or width(sys.stdout) or _WHOLE
    Console(file=stream, width=fit, no_color=True, highlight=False, legacy_windows=False).print(table)
    return "\n".join(line.rstrip() for line in stream.getvalue().splitlines())
