"""Read a TOML file into a model, or report which key is wrong and the correct form."""

import tomllib
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from pneutouch.errors import InputError, joined, nearest
from pneutouch.spec.explain import explained, is_one_of_list
from pneutouch.spec.fields import table_of
from pneutouch.spec.files import read_bytes
from pneutouch.spec.toml_errors import toml_problem
from pneutouch.spec.toml_text import toml_content, toml_value, value_text

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


def validate(model: type[Model], content: dict[str, Any], where: str) -> Model:
    """Validate ``content`` against ``model``; ``where`` names the file in the message."""
    try:
        return model.model_validate(content)
    except ValidationError as error:
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
