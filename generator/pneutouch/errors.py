"""What can go wrong, in fields, so that a program can act on it and a message can be composed from it.

Every error carries the exit code of the command line: 1 a rule or a target is not met, 2 the input is
wrong, 3 a computation could not be completed. To raise one, give the problem and what is known about it::

    raise InputError("unknown material", file="a.toml", key="membrane.material", value="Tanga", remedy="give TangoPlus")
    # a.toml: membrane.material = 'Tanga': unknown material; give TangoPlus

A parameter of a Python function is named by ``key``, without a file. Inside a problem or a remedy it
stands in backquotes (``give `design` ``). The command line alone turns both into its options.
"""

import difflib
import re
from collections.abc import Callable, Iterable, Sequence
from os import PathLike
from typing import Any


class PneutouchError(Exception):
    """Base of the three errors that a user may see.

    problem: what is wrong.  file: where it is written.  key: the key in that file, or the parameter of the function.
    value:   what was given there.  remedy: what to do about it.  All but the problem may be None.
    """

    exit_code = 3

    def __init__(
        self,
        problem: str,
        *,
        file: str | PathLike[str] | None = None,
        key: str | None = None,
        value: Any = None,
        remedy: str | None = None,
    ) -> None:
        super().__init__(problem)
        self.problem, self.key, self.value, self.remedy = problem, key, value, remedy
        self.file = None if file is None else str(file)
        self.others: tuple[PneutouchError, ...] = ()

    def message(self, option: Callable[[str], str | None] = lambda parameter: None) -> str:
        """The whole message; ``option`` translates a parameter's name into the name that the reader uses, or None."""
        known = option(self.key) if self.key and not self.file else None
        if known:
            value = f"{self.value:g}" if isinstance(self.value, float) else self.value
            place = known if value is None else f"{known} {value}"
        else:
            place = self.key or "" if self.value is None else f"{self.key} = {_short(self.value)}"
        text = self.problem if not self.remedy else f"{self.problem}; {self.remedy}"
        text = re.sub(r"`(\w+)`", lambda name: option(name[1]) or name[0], text)
        first = ": ".join(part for part in (self.file, place, text) if part)
        return "\n".join((first, *(error.message(option) for error in self.others)))

    def __str__(self) -> str:
        return self.message()

    def __reduce__(self) -> tuple[Any, ...]:
        """Let errors pass between processes, with any parameters of a subclass."""
        return _restored, (type(self), self.args), self.__dict__


class RuleBrokenError(PneutouchError):
    """A printability rule or a mechanical limit is broken."""

    exit_code = 1


class InputError(PneutouchError):
    """Something that was given is wrong: a file, a key in it, or a parameter."""

    exit_code = 2


class ComputationError(PneutouchError):
    """A computation stopped; the message states where, why, and a remedy."""

    exit_code = 3


class BeyondLimitError(ComputationError):
    """A driving pressure beyond the limit point: the requested ``pressure`` and the ``limit``, MPa."""

    def __init__(self, pressure: float, limit: float, problem: str) -> None:
        super().__init__(problem)
        self.pressure, self.limit = pressure, limit


def joined(errors: Sequence[PneutouchError]) -> PneutouchError:
    """The first of ``errors``, whose message goes on with the others', one a line."""
    first = errors[0]
    first.others = tuple(errors[1:])
    return first


def nearest(word: str, known: Iterable[str]) -> str:
    """Return ``" Did you mean X?"`` for the known word nearest to ``word``, or the known words."""
    candidates = sorted(known)
    folded = {candidate.lower(): candidate for candidate in candidates}
    match = difflib.get_close_matches(word.lower(), list(folded), n=1, cutoff=0.5)
    if match:
        return f" Did you mean {folded[match[0]]}?"
    return f" Known: {', '.join(candidates)}." if candidates else ""


def _restored(kind: type[PneutouchError], args: tuple[Any, ...]) -> PneutouchError:
    return kind.__new__(kind, *args)


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
