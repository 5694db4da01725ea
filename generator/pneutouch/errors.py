"""Errors of the program, in fields, so that a program can act on them and a message can be composed from them.

Every error carries the exit code of the command line: 1 a rule or a target is not met, 2 the input is
wrong, 3 a computation could not be completed. To raise one, give the problem and what is known about it::

    raise InputError("unknown material", file="a.toml", key="membrane.material", value="Tanga", remedy="give TangoPlus")
    # a.toml: membrane.material = "Tanga": unknown material; give TangoPlus

A parameter of a Python function is named by ``key``, without a file. Inside a problem or a remedy it
stands in backquotes (``give `design` ``). The command line alone turns both into its options.

A value inside a problem or a remedy is written by `shown`: as a user types it, never as Python shows it.
"""

import datetime
import difflib
import json
import math
import numbers
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from os import PathLike, fspath
from typing import Any

_LONGEST = 200
"""Characters of a value that a message shows: enough to find it again."""

_DEEPEST = 20
"""Tables and lists within one another that a message shows: a value may be nested deeper than Python calls go."""

_LINE = 4000
"""Characters of a line of a message: none that is the project's own is as long."""


class PneutouchError(Exception):
    """Base of the three errors that a user may see.

    problem: what is wrong.  file: where it is written.  key: the key in that file, or the parameter of the function.
    value:   what was given there.  remedy: what to do about it.  All but the problem may be None.
    fields:  the keys, ``table.key``, that a problem with a table or a whole file is about.
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
        fields: Sequence[str] = (),
    ) -> None:
        super().__init__(problem)
        self.problem, self.key, self.value, self.remedy = problem, key, value, remedy
        self.file = None if file is None else str(file)
        self.fields = tuple(fields)
        self.others: tuple[PneutouchError, ...] = ()

    def message(self, option: Callable[[str], str | None] = lambda parameter: None) -> str:
        """The whole message; ``option`` translates a parameter's name into the name that the reader uses, or None."""
        known = option(self.key) if self.key and not self.file else None
        place = known or self.key or ""
        if self.value is not None:
            # An option takes its value after a space, a field of a file after an equals sign.
            equals = "" if not place else " = " if not known else "=" if " " in known else " "
            place = f"{place}{equals}{_typed(self.value) if known else shown(self.value)}"
        text = self.problem if not self.remedy else f"{self.problem}; {self.remedy}"
        text = re.sub(r"`(\w+)`", lambda name: option(name[1]) or name[0], text)
        first = ": ".join(
            part for part in (_escaped(self.file or ""), _escaped(place), _escaped(text, keep="\n")) if part
        )
        # A word without end comes from what was given, as does a line without end.
        first = re.sub(rf"\S{{{2 * _LONGEST},}}", lambda word: _cut(word[0]), first)
        first = "\n".join(line if len(line) < _LINE else f"{line[:_LINE]}..." for line in first.split("\n"))
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
    """A computation stopped; the message says where, why, and a remedy."""

    exit_code = 3


class BeyondLimitError(ComputationError):
    """A driving pressure beyond the limit point: that ``pressure`` and the ``limit``, MPa."""

    def __init__(self, pressure: float, limit: float, problem: str) -> None:
        super().__init__(problem)
        self.pressure, self.limit = pressure, limit


class StatedPressureError(InputError):
    """A driving pressure of a design beyond the limit point: that ``pressure`` and the ``limit``, MPa."""

    def __init__(self, pressure: float, limit: float, problem: str, **place: Any) -> None:
        super().__init__(problem, **place)
        self.pressure, self.limit = pressure, limit


def joined(errors: Sequence[PneutouchError]) -> PneutouchError:
    """The first of ``errors``, whose message goes on with the others', one a line."""
    first = errors[0]
    first.others = tuple(errors[1:])
    return first


def nearest(word: str, known: Iterable[str]) -> str:
    """Return ``" Did you mean X?"`` for the first known word that ends in ``word``, or the nearest; else the words."""
    words = list(known)
    if longer := [one for one in words if one.endswith(f"_{word}")]:
        return f" Did you mean {longer[0]}?"
    candidates = sorted(words)
    folded = {candidate.lower(): candidate for candidate in candidates}
    match = difflib.get_close_matches(word.lower(), list(folded), n=1, cutoff=0.5)
    if match:
        return f" Did you mean {folded[match[0]]}?"
    return f" Known: {', '.join(candidates)}." if candidates else ""


def shown(value: Any) -> str:
    """A value in the form in which a user types it into a TOML file, on one line and cut where it is long.

    Text stands in double quotes with control characters escaped; what TOML has no form for is named by its type.
    """
    return _cut(_toml(value))


def one_line(text: str) -> str:
    """A text of others on one line: control characters escaped, and cut where it is long."""
    return _cut(_escaped(text))


def _restored(kind: type[PneutouchError], args: tuple[Any, ...]) -> PneutouchError:
    return kind.__new__(kind, *args)


def _typed(value: Any) -> str:
    """A value as it is typed on a command line: text bare, a number in its shortest form."""
    if isinstance(value, float):
        return f"{value:g}"
    return _cut(_escaped(value)) if isinstance(value, str) else shown(value)


def _toml(value: Any, deep: int = 0) -> str:
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str | PathLike):
        return _escaped(json.dumps(fspath(value), ensure_ascii=False))
    if isinstance(value, numbers.Real):
        return _number(value)
    if deep > _DEEPEST:
        return "..."
    if isinstance(value, Mapping):
        entries = (f"{_escaped(str(key))} = {_toml(item, deep + 1)}" for key, item in value.items() if item is not None)
        return f"{{ {', '.join(entries)} }}" if value else "{}"
    if isinstance(value, set | frozenset):
        return _toml(sorted(value, key=str), deep)
    if isinstance(value, list | tuple):
        return f"[{', '.join(_toml(item, deep + 1) for item in value)}]"
    if isinstance(value, datetime.date | datetime.time):
        return value.isoformat()
    return "nothing" if value is None else f"a Python object of type {type(value).__name__}"


def _number(value: numbers.Real) -> str:
    if isinstance(value, numbers.Integral):
        # Python writes no integer of more than 4300 digits.
        return str(int(value)) if abs(int(value)) < 10**_LONGEST else "a number of more than 200 digits"
    return repr(float(value)) if math.isfinite(value) else f"{float(value)}"


def _escaped(text: str, keep: str = "") -> str:
    """The text with control characters, which move the cursor, ring or colour, written as TOML escapes them."""
    return "".join(c if c.isprintable() or c in keep else _code(c) for c in text)


def _code(character: str) -> str:
    return f"\\u{ord(character):04X}" if ord(character) < 0x10000 else f"\\U{ord(character):08X}"


def _cut(text: str) -> str:
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}..."
