"""Tables and paragraphs wrapped to the width of the terminal; whole lines where stdout is none."""

import io
import shutil
import sys
import textwrap
from collections.abc import Sequence

_LEAST, _WHOLE = 40, 100_000


def width() -> int:
    """Columns of the terminal; where stdout is none, more than any line has."""
    return max(_LEAST, shutil.get_terminal_size().columns) if sys.stdout.isatty() else _WHOLE


def paragraph(text: str, columns: int | None = None) -> str:
    """A text in lines of at most ``columns`` letters (None: the terminal's)."""
    return textwrap.fill(text, columns or width(), break_long_words=False, break_on_hyphens=False)


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
    Console(file=stream, width=columns or width(), no_color=True, highlight=False, legacy_windows=False).print(table)
    return "\n".join(line.rstrip() for line in stream.getvalue().splitlines())
