"""Read a TOML file into a model, or report which key is wrong and the correct form.

Explanation of an error in a TOML file, in plain words, with the line and a caret under the place.
"""

import re
import tomllib
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from pneutouch.errors import InputError, joined, nearest
from pneutouch.spec.fields import is_one_of_list, table_of
from pneutouch.spec.files import read_bytes
from pneutouch.spec.toml_text import toml_content, toml_value, value_text

_PLAIN = {
    "Invalid value": "this is no value; text stands in double quotes, and true and false are in small letters",
    "Invalid statement": "this is neither a key nor a table; write key = value, or [table]",
    "Expected '=' after a key in a key/value pair": "a key is followed by = and a value",
    "Expected newline or end of document after a statement": "only one key = value stands on a line",
    "Expected ']' at the end of a table declaration": "the name of a table ends with ]",
    "Expected ']]' at the end of an array declaration": "the name of a list of tables ends with ]]",
    "Invalid initial character for a key part": "a key has letters, digits, - and _, or stands in double quotes",
    "Unclosed array": "a list ends with ], its values with commas between",
    "Unclosed inline table": "a table on one line ends with }, its keys with commas between",
    "Unterminated string": "text ends with the quote that it begins with, on the same line",
    "Unescaped '\\' in a string": "a backslash in text is written twice",
    "Invalid hex value": "a code after \\u has four hexadecimal digits, after \\U eight",
    "Escaped character is not a Unicode scalar value": "this code is no character",
    "Invalid date or datetime": "there is no such date",
    "Cannot overwrite a value": "this key or table is there twice",
}
_BEGINNINGS = {
    "Cannot declare": "this table is there twice",
    "Cannot redefine namespace": "this table is there twice",
    "Cannot mutate immutable namespace": "this key is there twice",
    "Duplicate inline table key": "this key is there twice",
    "Found invalid character": "this character cannot stand in a file of text",
    "Illegal character": "text is on one line, without control characters",
    "Expected": "a character is missing",
}
_PLACE = re.compile(
    r"^(?P<problem>.*) \(at (?:line (?P<line>\d+), column (?P<column>\d+)|end of document)\)$", re.DOTALL
)
_WIDEST = 100


def toml_problem(text: str, error: tomllib.TOMLDecodeError) -> str:
    """The problem with its line, the line itself, and a caret under the column where reading stopped."""
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
    """The parser's words as a user of the file would put them."""
    if problem in _PLAIN:
        return _PLAIN[problem]
    return next((plain for start, plain in _BEGINNINGS.items() if problem.startswith(start)), problem)


Model = TypeVar("Model", bound=BaseModel)


def read_toml(path: Path) -> dict[str, Any]:
    """Return the content of a TOML file; raises InputError for a folder, a bad file or broken TOML."""
    text = ""
    try:
        text = read_bytes(path).decode("utf-8-sig")
        return toml_content(text)
    except UnicodeDecodeError as error:
        raise InputError(f"not UTF-8 text (byte {error.start})", file=path, remedy="a TOML file is UTF-8") from None
    except tomllib.TOMLDecodeError as error:
        raise InputError(toml_problem(text, error), file=path) from None
    except RecursionError:
        raise InputError("nested too deep", file=path, remedy="a TOML file of this kind has tables of values") from None
    except ValueError as error:
        raise InputError(f"holds a value that cannot be read: {error}", file=path) from None


_MOST_PROBLEMS = 20
"""Problems of one file that are reported: a user mends some and tries again, and each costs a search for its key."""


def validate(model: type[Model], content: dict[str, Any], where: str | None) -> Model:
    """Validate ``content`` against ``model``; ``where`` names the file in the message, None: no file."""
    try:
        return model.model_validate(content)
    except ValidationError as error:
        # The words for what is wrong load where something is.
        from pneutouch.spec.explain import explained

        # What is missing comes last: it may be there under a wrong name.
        details = sorted(error.errors(), key=lambda detail: detail["type"] == "missing")
        problems = [explained(model, detail, where) for detail in details[:_MOST_PROBLEMS]]
        more = error.error_count() - _MOST_PROBLEMS
        if more > 0:
            problems.append(InputError(f"and {more} more problem{'s' if more > 1 else ''}", file=where))
        raise joined(problems) from None


Changes = Mapping[str, Any]
"""Fields of a file to be changed, each ``table.key`` or a key outside the tables, and their values.

A key outside the tables whose value is None is taken out. A single number or text in place of a list of them is a list
of one."""


def override(content: Mapping[str, Any], changes: Changes, model: type[BaseModel]) -> dict[str, Any]:
    """Return ``content`` with fields changed. Raises InputError for a table or a key that ``model`` has not."""
    result = {key: dict(value) if isinstance(value, dict) else value for key, value in content.items()}
    for name, value in changes.items():
        table_name, _, key = name.partition(".")
        table = table_of(model, table_name)
        if table is None and not key and table_name in model.model_fields:
            result[name] = value
            if value is None:
                del result[name]
            continue
        if table is None:
            raise InputError(
                f"unknown table {table_name}.{nearest(table_name, model.model_fields)}", key=name, value=value
            )
        if key not in table.model_fields:
            raise InputError(f"unknown key {name}.{nearest(key, table.model_fields)}", key=name, value=value)
        section = result.setdefault(table_name, {})
        if not isinstance(section, dict):
            raise InputError("must be a table", key=table_name, value=section)
        section[key] = [value] if is_one_of_list(table, key, value) else value
    return result


def parse_changes(assignments: Iterable[str], keys: Collection[str] = ("calibration",)) -> dict[str, Any]:
    """Changes from texts ``table.key=value``, whose values are TOML or bare words. Raises InputError.

    ``keys`` are those outside the tables, written without one.
    """
    changes = {}
    for text in assignments:
        key, equals, value = (part.strip() for part in text.partition("="))
        if not equals or (key.count(".") != 1 and key not in keys):
            raise InputError("write table.key=value, such as membrane.material=FLX9960", key="set", value=text)
        changes[key] = _bare_list(value)
    return changes


def _bare_list(text: str) -> Any:
    """A value of TOML or a bare word; numbers with commas between are a list without its brackets."""
    value = toml_value(text)
    if value != text or "," not in text:
        # A text in quotes is a text, whatever it holds.
        return value
    listed = toml_value(f"[{value}]")
    is_numbers = isinstance(listed, list) and all(type(item) in (int, float) for item in listed)
    return listed if is_numbers else value


def assignments(changes: Changes) -> list[str]:
    """Changes as texts that `parse_changes` reads, words bare where they can be."""
    return [f"{key}={value if _is_bare(value) else value_text(value)}" for key, value in changes.items()]


def _is_bare(value: Any) -> bool:
    """True if a text reads as itself without quotes."""
    return isinstance(value, str) and value == value.strip() and _bare_list(value) == value
