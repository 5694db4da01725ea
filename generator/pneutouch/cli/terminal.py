"""Output to people: text wrapped to their terminal, severities in colour there, and streams that may be closed.

In a pipe a line stays whole, so that ``grep`` finds it, and nothing is coloured unless FORCE_COLOR requires it. Tables
fit the width of the terminal; their lines stay whole if stdout is no terminal. Commands that lead from a target to a
measured sensor end by naming the next one. Progress goes to stderr: a bar on a terminal, else one line for each stage.
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
from typing import Any, Protocol, TextIO

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
    """Write text as it is to stdout. Raises ComputationError if it cannot be written, such as on a full disk."""
    try:
        _write(sys.stdout, text)
    except OSError as error:
        raise ComputationError(f"standard output cannot be written: {error.strerror}") from None


def filled_text(template: str, **values: Any) -> str:
    """Text of one of the command line's templates, filled with ``values``; its filter ``f`` formats a value."""
    from pneutouch.export import templates

    environment = templates(Path(__file__).parent / "templates", autoescape=False)
    environment.filters["f"] = format
    text = environment.get_template(template).render(**values).removesuffix("\n")
    return "\n".join(line.rstrip() for line in text.split("\n"))


def width(stream: TextIO) -> int | None:
    """Columns of the terminal behind a stream; None in a pipe or a file, where lines stay whole."""
    return max(shutil.get_terminal_size().columns, _NARROWEST) if stream.isatty() else None


def open_closed_streams() -> None:
    """Open closed standard streams on the null device: else the next file opened would take their place."""
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            handle = os.open(os.devnull, os.O_RDWR)
            if handle != number:
                os.dup2(handle, number)
                os.close(handle)
            setattr(sys, name, open(number, "w" if number else "r", encoding="utf-8", closefd=False))  # noqa: SIM115


def _write(stream: TextIO, text: str) -> None:
    """Write and flush; a reader that goes away ends the output, not the command; no error of stderr ends it."""
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
    """A line wrapped to ``columns``, further lines indented; commands and TOML, which people copy, stay on one."""
    if len(line) <= columns or _COPIED.match(line):
        return line
    indent = line[: len(line) - len(line.lstrip())] + "  "
    kept: Any = dict.fromkeys(("break_long_words", "break_on_hyphens", "replace_whitespace"), False)
    return "\n".join(textwrap.wrap(line, columns, subsequent_indent=indent, **kept))


def _is_coloured(stream: TextIO) -> bool:
    """True if text is coloured: never by NO_COLOR, always by FORCE_COLOR or CLICOLOR_FORCE, else by the terminal."""
    if os.environ.get("NO_COLOR"):
        return False
    if any(os.environ.get(name, "0") not in ("", "0") for name in ("FORCE_COLOR", "CLICOLOR_FORCE")):
        return True
    return stream.isatty() and os.environ.get("TERM") != "dumb" and os.environ.get("CLICOLOR") != "0"


_NARROW = 16
"""Greatest number of letters of a figure or a name, which are not broken; longer cells are text."""

_APART = 2
"""Spaces between columns."""


def table_text(
    head: Sequence[str], rows: Sequence[Sequence[str]], columns: int | None = None, *, indent: str = ""
) -> str:
    """Left-aligned columns two spaces apart, under a head if there is one; "" without rows and head.

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
    """Lines of a table too wide for ``columns``. Cells up to `_NARROW` letters stay whole, longer ones are wrapped;
    columns that do not fit follow below, beside the first one again."""
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
    """The lines of a table whose cells are folded, except in the columns that are ``whole``."""
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
    """Print ``next: pneutouch WORDS`` on stderr, quoted for a shell; ``first`` is a step by hand before it."""
    command = shlex.join(["pneutouch", *map(str, words)])
    notify(f"{first}, then: {command}" if first else f"next: {command}")


def set_words(assignments: Iterable[str] | None, calibration: str | None = None) -> list[str]:
    """The ``--set`` options and the ``--calibration`` of a command, to be given to the next one."""
    named = [] if calibration is None else ["--calibration", calibration]
    return [*(word for text in assignments or () for word in ("--set", text)), *named]


def report_written(path: Path) -> None:
    """Report a written design file, and as the next command its check, by name if the catalogue finds it so."""
    from pneutouch.catalogue import Library

    echo(f"\nwritten: {path}")
    known = Library.default().paths("designs").get(path.stem)
    report_next("check", path.stem if known is not None and known.resolve() == path.resolve() else path)


class ProgressCallback(Protocol):
    """Callback for progress: how many of a total are done and, if it changes, the current task."""

    def __call__(self, done: int, total: int, what: str | None = None) -> None:
        """Move the bar."""


@contextlib.contextmanager
def bar(what: str, *, unit: str = "") -> Iterator[ProgressCallback]:
    """Bar for a stage, such as "reading runs", or "" if the callback names the stages; yields the callback.

    ``unit`` is the unit of the counts at the bar; "" for counts of things."""
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
    """Callback that prints one line for each stage; the line of the first stage is printed at once."""
    last = what
    if what:
        notify(f"{one_line(what)} ...")

    def report(done: int, total: int, what: str | None = None) -> None:
        nonlocal last
        if what is not None and what != last:
            last = what
            notify(f"{one_line(what)} ...")

    return report
