"""Completion in bash, which takes ``DESIGN@NAME`` and ``TABLE.KEY=VALUE`` apart and completes the last piece alone."""

import io
import os
import shlex
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, redirect_stdout

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
