"""What can go wrong, said so that a user can act.

Every error carries the exit code of the command line: 1 a rule or a target is not met, 2 the input is
wrong, 3 a computation could not be completed.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable


class PneutouchError(Exception):
    """Base of every error a user may see; its text is the whole message."""

    exit_code = 3


class RuleBrokenError(PneutouchError):
    """A printability rule or a mechanical limit is broken."""

    exit_code = 1


class InputError(PneutouchError):
    """Something the user wrote is wrong: names the file, the key, the value and what would be right."""

    exit_code = 2


class ComputationError(PneutouchError):
    """A computation stopped: says where, why, and what to try."""

    exit_code = 3


class BeyondLimitError(ComputationError):
    """A driving pressure beyond the limit point: ``pressure`` asked for and ``limit``, MPa."""

    def __init__(self, pressure: float, limit: float, message: str) -> None:
        super().__init__(message)
        self.pressure, self.limit = pressure, limit


def nearest(word: str, known: Iterable[str]) -> str:
    """Return ``" Did you mean X?"`` for the known word nearest to ``word``, or the known words."""
    candidates = sorted(known)
    folded = {candidate.lower(): candidate for candidate in candidates}
    match = difflib.get_close_matches(word.lower(), list(folded), n=1, cutoff=0.5)
    if match:
        return f" Did you mean {folded[match[0]]}?"
    return f" Known: {', '.join(candidates)}." if candidates else ""
