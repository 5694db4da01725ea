"""The errors that the package raises: problem, place, value and remedy are fields, from which the message is composed.

Every class has the exit code of the command line: 1 a rule or a target is not met, 2 the input is wrong, 3 a
computation could not be completed. To raise an error, give the problem and all that is known about it::

    raise InputError("unknown material", file="a.toml", key="membrane.material", value="Tanga", remedy="give TangoPlus")
    # a.toml: membrane.material = "Tanga": unknown material; give TangoPlus

For a wrong parameter of a Python function, ``key`` is its name and there is no file. Inside a problem or a remedy the
name of a parameter stands in backquotes (``give `design` ``). The command line replaces both by the names of its
options. Values inside a problem or a remedy are written by `shown`: as in a TOML file, not as by Python's ``repr``.
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
"""Greatest number of characters of a value in a message: enough to find the value again."""

_DEEPEST = 20
"""Greatest depth of nested tables and lists in a message: a value may be nested deeper than Python's recursion goes."""

_LINE = 4000
"""Greatest number of characters in a line of a message: the package's own lines are shorter."""


class PneutouchError(Exception):
    """Base class of the three kinds of errors that a user may see.

    problem: what is wrong. file: the file with the problem. key: the key in that file, or the function's parameter.
    value: the wrong value. remedy: what to do. All but the problem may be None.
    fields: keys (``table.key``) concerned by a problem with a table or a whole file. others: further errors (`joined`).
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
        """Message with those of `others`; ``option`` gives the reader's name of a parameter, or None to keep it."""
        known = option(self.key) if self.key and not self.file else None
        place = known or self.key or ""
        if self.value is not None:
            # An option takes its value after a space, a field of a file after an equals sign.
            equals = "" if not place else " = " if not known else "=" if " " in known else " "
            place = f"{place}{equals}{_typed(self.value) if known else shown(self.value)}"
        text = self.problem if not self.remedy else f"{self.problem}; {self.remedy}"
        text = re.sub(r"`([\w.]+)`", lambda name: option(name[1]) or name[0], text)
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
        """Pickle the error with all its attributes, also if a subclass takes other parameters."""
        return _restored, (type(self), self.args), self.__dict__


class RuleBrokenError(PneutouchError):
    """A broken printability rule or mechanical limit, or a target that is not met."""

    exit_code = 1


class InputError(PneutouchError):
    """Wrong input: a file, a key in it, or a parameter of a function."""

    exit_code = 2


class ComputationError(PneutouchError):
    """A computation that could not be completed."""

    exit_code = 3


class BeyondLimitError(ComputationError):
    """A driving pressure beyond the limit point; ``pressure`` and ``limit`` are both in MPa."""

    def __init__(self, pressure: float, limit: float, problem: str) -> None:
        super().__init__(problem)
        self.pressure, self.limit = pressure, limit


class StatedPressureError(InputError):
    """A driving pressure in a design file beyond the limit point; ``pressure`` and ``limit`` are both in MPa."""

    def __init__(self, pressure: float, limit: float, problem: str, **place: Any) -> None:
        super().__init__(problem, **place)
        self.pressure, self.limit = pressure, limit


def joined(errors: Sequence[PneutouchError]) -> PneutouchError:
    """The first of ``errors``, changed so that its message goes on with those of the others, each on its own line."""
    first = errors[0]
    first.others = tuple(errors[1:])
    return first


_EVERYDAY = {
    "inner_radius_mm": "radius diameter",
    "wall_thickness_mm": "wall thickness",
    "driving_pressures_kPa": "pressure pressures",
    "plate_diameter_mm": "plate",
    "material": "resin",
}
"""Everyday names of keys that others resemble more."""


def nearest(word: str, known: Iterable[str]) -> str:
    """Hint ``" Did you mean X?"`` for a known word of that everyday name, ending in ``_word``, or similar to it; else
    the known words."""
    words = list(known)
    everyday = word.lower().removesuffix("_mm").removesuffix("_kpa")
    if meant := [key for key, names in _EVERYDAY.items() if everyday in names.split() and key in words]:
        return f" Did you mean {meant[0]}{', half of it' if everyday == 'diameter' else ''}?"
    if longer := [one for one in words if one.endswith(f"_{word}")]:
        return f" Did you mean {longer[0]}?"
    candidates = sorted(words)
    folded = {candidate.lower(): candidate for candidate in candidates}
    match = difflib.get_close_matches(word.lower(), list(folded), n=1, cutoff=0.5)
    if match:
        return f" Did you mean {folded[match[0]]}?"
    return f" Known: {', '.join(candidates)}." if candidates else ""


def shown(value: Any) -> str:
    """A value as it is written in a TOML file, on one line and cut after 200 characters.

    Text stands in double quotes with control characters escaped. None is ``nothing``; other objects are named by type.
    """
    return _cut(_toml(value))


def one_line(text: str) -> str:
    """Text of any origin on one line: control characters are escaped, and it is cut after 200 characters."""
    return _cut(_escaped(text))


def _restored(kind: type[PneutouchError], args: tuple[Any, ...]) -> PneutouchError:
    return kind.__new__(kind, *args)


def _typed(value: Any) -> str:
    """A value as it is typed on a command line: text without quotes, a float with up to six digits."""
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
    """The text with control characters, which could move the cursor, as TOML escapes; those in ``keep`` stay."""
    return "".join(
        c if c.isprintable() or c in keep else f"\\u{ord(c):04X}" if ord(c) < 0x10000 else f"\\U{ord(c):08X}"
        for c in text
    )


def _cut(text: str) -> str:
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}..."
