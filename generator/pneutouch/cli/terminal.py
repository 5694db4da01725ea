"""Output to people: text wrapped to their terminal, severities in colour there, and streams that may be closed.

In a pipe a line stays whole, so that ``grep`` finds it, and nothing is coloured unless FORCE_COLOR requires it.
"""

import contextlib
import os
import re
import shutil
import sys
import textwrap
from typing import TextIO

from pneutouch.errors import ComputationError

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
