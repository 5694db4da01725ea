"""Explanation of a value that pydantic refuses: the problem, and what would be right."""

import math
import re
import tomllib
import typing
from collections.abc import Iterable, Mapping
from typing import Any

from pydantic import BaseModel

from pneutouch.errors import InputError, nearest, shown
from pneutouch.spec.fields import EntryError, declaration, entries_of, is_one_of_list, table_of
from pneutouch.spec.values import Quantity
from pneutouch.wording import counted, data_of

_WORDS: dict[str, dict[str, str]] = data_of(__file__)

_MOST_KEYS = 8
"""Greatest number of keys that a message shows as a table's form; a larger table is looked up."""


def table_form(owner: type[BaseModel] | None, key: str) -> str:
    """Form ``{ key = ... }`` of the table ``key`` of ``owner`` with required keys; empty without any, or too many."""
    table = None if owner is None else table_of(owner, key)
    if table is None:
        return ""
    needed = [name for name, field in table.model_fields.items() if field.is_required()]
    if issubclass(table, Quantity):
        # It takes a range in place of the value.
        needed = ["value", *needed]
    if not 0 < len(needed) <= _MOST_KEYS:
        return ""
    entries = (f"{name} = {_FORMS.get(table.model_fields[name].annotation, '...')}" for name in needed)
    return f"{{ {', '.join(entries)} }}"


_FORMS: dict[typing.Any, str] = {str: '"..."'}


def explained(model: type[BaseModel], detail: Any, where: str | None) -> InputError:
    """InputError for ``detail``, an error of pydantic on ``model``: key, value and remedy; ``where``: the file."""
    # Names in angle brackets distinguish the kinds of a value that may be of several; they are no keys.
    path = [str(step) for step in detail["loc"] if not isinstance(step, int) and not str(step).startswith("<")]
    owner: type[BaseModel] | None = model
    for step in path[:-1]:
        owner = table_of(owner, step) if owner else None
    key = _label(detail["loc"])
    if detail["type"] == "extra_forbidden" and owner is not None:
        kind = "table" if isinstance(detail["input"], dict) else "key"
        names, remark = [f.alias or k for k, f in owner.model_fields.items()], getattr(owner, "remark", "")
        return InputError(f"unknown {kind}.{nearest(path[-1], names)}{remark}", file=where, key=key)
    if detail["type"] == "missing":
        return InputError("missing", file=where, key=key, remedy=_addition(owner, path))
    if detail["type"] == "value_error":
        error = detail["ctx"]["error"]
        if isinstance(error, EntryError):
            return InputError(str(error), file=where, key=f"{key}[{error.index}]", value=error.value)
        if key.endswith("]") and not isinstance(detail["input"], Mapping):
            # One value may be written for a list of one, and the message holds it.
            key = key.rpartition("[")[0]
        named = [f"{key}.{field}" if key else field for field in getattr(error, "fields", ())]
        return InputError(str(error), file=where, key=key, fields=named)
    if not path:
        return InputError(str(detail["msg"]), file=where)
    if detail["type"] == "literal_error":
        known = str(detail["ctx"]["expected"]).replace("'", '"')
        return InputError(f"must be {known}", file=where, key=key, value=detail["input"])
    problem, remedy = _unlike(detail, owner, path)
    return InputError(problem, file=where, key=key, value=detail["input"], remedy=remedy)


def _unlike(detail: Any, owner: type[BaseModel] | None, path: list[str]) -> tuple[str, str | None]:
    """Problem with a value of the wrong type or beyond its bounds, and the remedy, None if it is not known."""
    kind, right = _expected(detail), _right(owner, path)
    if detail["type"] == "model_type" and (form := table_form(owner, path[-1])):
        kind = f"{kind}such as {form}, "
    remedy = None
    if detail["type"] in _OF_LISTS:
        kind, remedy = _expected_list(detail, owner, path)
        right = right.removeprefix("a list of ") if kind.startswith("a list of ") else right
        right = f"each {right}" if right.startswith("one of the ") else right
    if kind and _is_sentence(right):
        kind = f"{kind.rstrip(' ,:')}: "
    elif _is_sentence(right) and (bounds := _bounds(detail)):
        kind, right = bounds, ""
    right = kind.rstrip(" ,:") if right in ("", _ANY) and kind else f"{kind}{right}".strip()
    if remedy and not right.endswith(".."):
        right = right.removesuffix(".")
    return f"must be {right}" if right else str(detail["msg"]), remedy


def _is_sentence(right: str) -> bool:
    """True if a description of a valid value is a sentence (the help of a field without bounds), not a phrase."""
    return right[:1].isupper() or right.startswith("one ")


def _bounds(detail: Any) -> str:
    """Bounds of a number or a text that an error of pydantic names, in words; empty if it names none."""
    words = {"ge": "at least", "gt": "more than", "le": "at most", "lt": "less than"}
    given = detail.get("ctx", {})
    numbers = [f"{word} {given[key]:g}" for key, word in words.items() if isinstance(given.get(key), int | float)]
    if "max_length" in given:
        numbers.append(f"text of at most {counted(given['max_length'], 'character')}")
    return " and ".join(numbers)


def _label(steps: Iterable[int | str]) -> str:
    """The key of a value with the indices of the lists in it: ``entry.over.membrane.material[0]``."""
    label = ""
    for step in steps:
        if isinstance(step, int):
            label = f"{label}[{step}]"
        elif not str(step).startswith("<"):
            label = f"{label}.{step}" if label else str(step)
    return label


def _addition(owner: type[BaseModel] | None, path: list[str]) -> str:
    """Remedy for a missing key: the form of its table, if it is one, and its meaning."""
    right, form = _right(owner, path) or f"a table [{'.'.join(path)}]", table_form(owner, path[-1])
    if form and owner is not None and entries_of(owner, path[-1]) is not None:
        form = f"[{form}]"
    if form:
        return f"give {path[-1]} = {form}: {right}"
    # The help of a field without bounds is a sentence of its own.
    return f"add it: {right}" if right[:1].isupper() else f"give {right}"


def _expected(detail: Any) -> str:
    """Type that a field takes, in words, for an error on the type of a value; empty for other errors."""
    if detail["type"] == "string_too_short":
        return f"text of at least {counted(detail['ctx']['min_length'], 'character')}: "
    return _WORDS["expected"].get(detail["type"], "")


_OF_LISTS = ("list_type", "too_short", "too_long")
"""Types of pydantic's errors on a list: no list, too few entries, too many."""


def _expected_list(detail: Any, owner: type[BaseModel] | None, path: list[str]) -> tuple[str, str | None]:
    """The right list in words for an error of `_OF_LISTS`, and a remedy: the value written as a list, else None."""
    table = owner if owner is not None and path[-1] in owner.model_fields else None
    within = next((k for k, step in enumerate(reversed(detail["loc"])) if not isinstance(step, int)), 0)
    held = None if table is None else entries_of(table, path[-1], within)
    if held == "tables" and detail["type"] == "list_type":
        return "a list of tables: ", f"write each as [[{'.'.join(path)}]]"
    ends = ", " if held in ("numbers", "names") else ": "
    if detail["type"] == "list_type":
        given = detail["input"]
        is_plain = isinstance(given, str | float | int) and not isinstance(given, bool)
        fits = is_plain if table is None else not within and _is_entry(table, path[-1], given)
        return f"a list of {held}{ends}" if held else "a list: ", f"write {shown([given])}" if fits else None
    least = detail["type"] == "too_short"
    count = detail["ctx"]["min_length" if least else "max_length"]
    entries = "one entry" if count == 1 else f"{count} entries"
    return f"a list with at {'least' if least else 'most'} {entries}{' ' if held == 'numbers' else ends}", None


def _is_entry(table: type[BaseModel], key: str, value: Any) -> bool:
    """True if the list ``[value]`` would be valid for ``key``, as far as the declaration states."""
    known = declaration(table, key)
    low, high = (-math.inf if known.low is None else known.low), (math.inf if known.high is None else known.high)
    return is_one_of_list(table, key, value) and (isinstance(value, str) or low <= value <= high)


_ANY = "a valid value"
"""Description of a valid value if no declaration has one."""


def _right(owner: type[BaseModel] | None, path: list[str]) -> str:
    written = {} if owner is None else {field.alias or key: key for key, field in owner.model_fields.items()}
    if owner is None or not path or path[-1] not in written:
        return _ANY
    return declaration(owner, written[path[-1]]).right


_PLACE = re.compile(
    r"^(?P<problem>.*) \(at (?:line (?P<line>\d+), column (?P<column>\d+)|end of document)\)$", re.DOTALL
)

_WIDEST = 100


def toml_problem(text: str, error: tomllib.TOMLDecodeError) -> str:
    """Problem with its line number, the line itself, and a caret under the column where reading stopped."""
    place = _PLACE.match(str(error))
    if place is None:
        return f"not valid TOML: {error}"
    problem, lines = _plain(place["problem"]), text.splitlines() or [""]
    number = int(place["line"]) if place["line"] else len(lines)
    line = lines[min(number, len(lines)) - 1]
    column = int(place["column"]) - 1 if place["column"] else len(line)
    first = max(0, column - _WIDEST + 1)
    shown = "".join(c if c.isprintable() else " " for c in line[first : first + _WIDEST])
    return f"line {number}, column {column + 1}: {problem}\n  {shown}\n  {' ' * (column - first)}^"


def _plain(problem: str) -> str:
    """The parser's message in words that a user of the file understands; unchanged if there are none."""
    whole, beginnings = _WORDS["whole"], _WORDS["beginning"].items()
    return whole.get(problem) or next((plain for one, plain in beginnings if problem.startswith(one)), problem)
