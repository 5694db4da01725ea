"""A command line taken apart and run, with every outcome turned into an exit code.

Completion in bash, which takes ``DESIGN@NAME`` and ``TABLE.KEY=VALUE`` apart and completes the last piece alone.
"""

import io
import os
import re
import shlex
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, redirect_stdout
from typing import Any

from pneutouch.cli.app import app
from pneutouch.cli.terminal import notify, open_closed_streams

_BREAKS = "=@:"
"""Characters at which bash ends a word unless its user set COMP_WORDBREAKS, and which words of this program hold."""


def joined(pieces: Sequence[str], at: int) -> tuple[list[str], int, str]:
    """The words as typed, the place of the one to complete, and what of it stands before the piece that bash completes.

    ``pieces`` are COMP_WORDS, in which a run of such characters is a piece of its own; ``at`` is COMP_CWORD. Bash
    completes an @ with what follows it: it may begin the name of a host.
    """
    words: list[str] = []
    place, before, open_ = None, "", False
    for number, piece in enumerate(pieces):
        breaks = bool(piece) and not piece.strip(_BREAKS)
        begun = words.pop() if words and (breaks or open_) else ""
        if number == at:
            place, before = len(words), begun + piece if breaks else begun
        words.append(begun + piece)
        open_ = breaks
    return words, len(words) if place is None else place, before.removesuffix("@")


@contextmanager
def words_of_bash(write: Callable[[str], object]) -> Iterator[None]:
    """Complete whole words where bash requests completions in the block, and ``write`` the words that bash may
    insert."""
    requested = os.environ.get("_PNEUTOUCH_COMPLETE") == "complete_bash"
    try:
        pieces, at = shlex.split(os.environ["COMP_WORDS"]), int(os.environ["COMP_CWORD"])
    except (KeyError, ValueError):
        # A quote is open, or bash requests nothing.
        requested = False
    if not requested:
        yield
        return
    words, place, before = joined(pieces, at)
    os.environ |= {"COMP_WORDS": shlex.join(words), "COMP_CWORD": str(place)}
    offered = io.StringIO()
    try:
        with redirect_stdout(offered):
            yield
    finally:
        write("".join(f"{line.removeprefix(before)}\n" for line in offered.getvalue().splitlines()))


def invoked(words: list[str]) -> int:
    """Run the command of ``words`` and return its exit code; words that are no command end in one line and code 2."""
    open_closed_streams()
    try:
        with words_of_bash(sys.stdout.write):
            outcome = app(args=words or ["--help"], prog_name="pneutouch", standalone_mode=False)
    except Exception as error:
        # Typer has its own errors and click's, by its version; each formats its message.
        if not hasattr(error, "format_message"):
            raise
        notify(f"error: {_about(error)}")
        return getattr(error, "exit_code", 2)
    return outcome if isinstance(outcome, int) else 0


def _about(error: Any) -> str:
    """Problem with the words of a command line, and the command that lists its options."""
    message = re.sub(r"'(-[^' ]*)'", r"\1", error.format_message()).replace("'", '"').rstrip(".")
    message = re.sub(r"Input should be (a )?(valid )?", r"must be \1", message).split(", unable to parse")[0]
    message = message.replace("a integer", "a whole number")
    context = getattr(error, "ctx", None)
    command = context.command_path if context else "pneutouch"
    return f"{message[:1].lower()}{message[1:]}; {command} -h lists what it takes"
