"""Output to people: text wrapped to their terminal, severities in colour there, and streams that may be closed.

In a pipe a line stays whole, so that ``grep`` finds it, and nothing is coloured unless FORCE_COLOR requires it.

Tables fitted to the width of the terminal; whole lines if stdout is no terminal.

The last line of a command between a target and a measured sensor: the command that comes next.

Progress of a command: a bar on a terminal, one line a stage elsewhere, on stderr both.
"""

import contextlib
import io
import os
import re
import shlex
import shutil
import sys
import textwrap
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Protocol, TextIO

from pneutouch.errors import ComputationError, one_line

_SEVERITIES = {"error": "1;31", "warning": "33", "note": "36", "next": "32"}
_SEVERITY = re.compile(rf"^({'|'.join(_SEVERITIES)})(?=: )", re.MULTILINE)
_COPIED = re.compile(r"next: |\w+ = \{")
_NARROWEST = 40


def echo(text: str) -> None:
    """Write lines for people to stdout."""
    put(_fitted(text, sys.stdout) + "\n")


def notify(text: str) -> None:
    """Write lines for people to stderr."""
    _write(sys.stderr, _fitted(text, sys.stderr) + "\n")


def put(text: str) -> None:
    """Write text as it is to stdout. Raises ComputationError if there is no space for it."""
    try:
        _write(sys.stdout, text)
    except OSError as error:
        raise ComputationError(f"standard output cannot be written: {error.strerror}") from None


def width(stream: TextIO) -> int | None:
    """Columns of the terminal behind a stream; None in a pipe or a file, where lines stay whole."""
    return max(shutil.get_terminal_size().columns, _NARROWEST) if stream.isatty() else None


def open_closed_streams() -> None:
    """Lead closed standard streams nowhere: the next file opened would get their number, and messages with it."""
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            handle = os.open(os.devnull, os.O_RDWR)
            if handle != number:
                os.dup2(handle, number)
                os.close(handle)
            setattr(sys, name, open(number, "w" if number else "r", encoding="utf-8", closefd=False))  # noqa: SIM115


def _write(stream: TextIO, text: str) -> None:
    """Write and flush; a reader that went away ends the output and not the command, and stderr never ends it."""
    try:
        stream.write(text)
        stream.flush()
    except UnicodeEncodeError:
        encoding = stream.encoding or "ascii"
        _write(stream, text.encode(encoding, "backslashreplace").decode(encoding))
    except OSError as error:
        with contextlib.suppress(OSError):
            # What is buffered goes nowhere as well, or it would fail again when the program ends.
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
        if not isinstance(error, BrokenPipeError) and stream is not sys.stderr:
            raise


def _fitted(text: str, stream: TextIO) -> str:
    """Lines that fit the terminal behind a stream, with severities in colour."""
    columns = width(stream)
    if columns is not None:
        text = "\n".join(_wrapped(line, columns) for line in text.split("\n"))
    if not _is_coloured(stream):
        return text
    return _SEVERITY.sub(lambda word: f"\x1b[{_SEVERITIES[word[1]]}m{word[1]}\x1b[0m", text)


def _wrapped(line: str, columns: int) -> str:
    """A line over as many as it takes, the further ones indented. Commands and TOML, which people copy, stay on one
    line."""
    if len(line) <= columns or _COPIED.match(line):
        return line
    indent = line[: len(line) - len(line.lstrip())] + "  "
    return "\n".join(
        textwrap.wrap(
            line,
            columns,
            subsequent_indent=indent,
            break_long_words=False,
            break_on_hyphens=False,
            drop_whitespace=True,
            replace_whitespace=False,
        )
    )


def _is_coloured(stream: TextIO) -> bool:
    """NO_COLOR forbids colour, FORCE_COLOR or CLICOLOR_FORCE require it, else a terminal that is able to has it."""
    if os.environ.get("NO_COLOR"):
        return False
    if any(os.environ.get(name, "0") not in ("", "0") for name in ("FORCE_COLOR", "CLICOLOR_FORCE")):
        return True
    return stream.isatty() and os.environ.get("TERM") != "dumb" and os.environ.get("CLICOLOR") != "0"


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
        lines = _lines_of(head, rows, most - len(indent))
    return "\n".join(f"{indent}{line}" for line in lines)


def _lines_of(head: Sequence[str], rows: Sequence[Sequence[str]], columns: int) -> list[str]:
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
        here = _lines_of(head[:end], [row[:end] for row in rows], columns)
        return [*here, "", *_lines_of([*head[:1], *head[end:]], [[row[0], *row[end:]] for row in rows], columns)]
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


def report_next(*words: object, first: str = "") -> None:
    """Print ``next: pneutouch WORDS`` on stderr, quoted so that it works as it stands; ``first`` is done by hand."""
    command = shlex.join(["pneutouch", *map(str, words)])
    notify(f"{first}, then: {command}" if first else f"next: {command}")


def set_words(assignments: Iterable[str] | None, calibration: str | None = None) -> list[str]:
    """The ``--set`` options and the ``--calibration`` of a command, to be given to the next one."""
    named = [] if calibration is None else ["--calibration", calibration]
    return [*(word for text in assignments or () for word in ("--set", text)), *named]


def report_written(path: Path) -> None:
    """Report a design file that was written, and that it is to be checked: by its name where that is found."""
    from pneutouch.catalogue import Library

    echo(f"\nwritten: {path}")
    known = Library.default().paths("designs").get(path.stem)
    report_next("check", path.stem if known is not None and known.resolve() == path.resolve() else path)


class ProgressCallback(Protocol):
    """Receives how many of all are done and, where it changes, the current task."""

    def __call__(self, done: int, total: int, what: str | None = None) -> None:
        """Move the bar."""


@contextlib.contextmanager
def bar(what: str, *, unit: str = "") -> Iterator[ProgressCallback]:
    """A stage, such as "reading runs", or "" where the callback names its stages; a bar that moves by the callback.

    ``unit`` is that of the counts at the bar, where they are not of things."""
    if not _moves():
        yield _lines(what)
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    counts = (MofNCompleteColumn(), TextColumn(unit)) if unit else (MofNCompleteColumn(),)
    columns = (TextColumn("{task.description}"), BarColumn(), *counts, TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as shown:
        task = shown.add_task(what, total=None)

        def report(done: int, total: int, what: str | None = None) -> None:
            shown.update(task, description=what if what is None else one_line(what), completed=done, total=total)

        yield report


def _moves() -> bool:
    """True if a bar can move on stderr."""
    return sys.stderr.isatty()


def _lines(what: str) -> ProgressCallback:
    """One line a stage, the first at once."""
    last = what
    if what:
        notify(f"{one_line(what)} ...")

    def report(done: int, total: int, what: str | None = None) -> None:
        nonlocal last
        if what is not None and what != last:
            last = what
            notify(f"{one_line(what)} ...")

    return report
