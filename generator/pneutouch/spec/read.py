"""Read a TOML file into a model, or report which key is wrong and the correct form."""

import re
import tomllib
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from pneutouch.errors import InputError, joined, nearest
from pneutouch.spec.fields import is_one_of_list, table_of
from pneutouch.spec.files import read_bytes

Model = TypeVar("Model", bound=BaseModel)

_LONG = re.compile(r"[0-9a-fA-F_]{16}|[01_]{60}")
"""Pattern of digits that may be a whole number of over 64 bits: TOML has none, Python reads it, a float overflows."""

_LONG_KEY = re.compile(r"""(?:(?:(?<![\w-])[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+){32}""")
"""Pattern of a key of more than 32 parts: tomllib's time grows with the square of their number, an hour for 1 MB."""

_QUOTED = re.compile(r""""(?:\\.|[^"\\])*"|'[^']*'""")

_ODD_NUMBER = re.compile(r"(?<![\w.-])[+-]?(?:\d[\d.eE+-]*_[\d_.eE+-]*|0[xob]\w+)(?![\w-])")
"""Pattern of TOML numbers with underscores or not decimal: on a command line ``1_0`` is a typing error, not ten."""


def toml_content(text: str) -> dict[str, Any]:
    """Content of a TOML text. Raises ValueError (such as TOMLDecodeError), or RecursionError if nested too deep."""
    if _LONG_KEY.search(text):
        raise ValueError("a key of more than 32 parts with points between")
    content = tomllib.loads(text)
    if _LONG.search(text) and not _is_64_bit(content):
        raise ValueError("a whole number of more than 64 bits")
    return content


def toml_value(text: str) -> Any:
    """Value of a text as TOML; the text itself if it is no TOML value, or holds a number with ``_`` or not decimal."""
    if _ODD_NUMBER.search(_QUOTED.sub("", text)):
        return text
    try:
        content = toml_content(f"value = {text}")
    except (ValueError, RecursionError):
        return text
    return content["value"] if set(content) == {"value"} else text


def _is_64_bit(value: Any) -> bool:
    if isinstance(value, Mapping):
        return all(map(_is_64_bit, value.values()))
    if isinstance(value, list):
        return all(map(_is_64_bit, value))
    return not isinstance(value, int) or -(2**63) <= value < 2**63


def read_toml(path: Path) -> dict[str, Any]:
    """Return the content of a TOML file; raises InputError for a folder, a bad file or broken TOML."""
    text = ""
    try:
        text = read_bytes(path).decode("utf-8-sig")
        return toml_content(text)
    except UnicodeDecodeError as error:
        raise InputError(f"not UTF-8 text (byte {error.start})", file=path, remedy="a TOML file is UTF-8") from None
    except tomllib.TOMLDecodeError as error:
        from pneutouch.spec.explain import toml_problem

        raise InputError(toml_problem(text, error), file=path) from None
    except RecursionError:
        raise InputError("nested too deep", file=path, remedy="a TOML file of this kind has tables of values") from None
    except ValueError as error:
        raise InputError(f"holds a value that cannot be read: {error}", file=path) from None


_MOST_PROBLEMS = 20
"""Greatest number of problems reported for a file: a user mends a few at a time; each costs a search for its key."""


def validate(model: type[Model], content: dict[str, Any], where: str | None) -> Model:
    """Validate ``content`` against ``model``. Raises InputError; ``where`` names the file in it, None: no file."""
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
    """Copy of ``content`` with fields changed. Raises InputError for a table or a key that ``model`` does not have."""
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
            hint = nearest(key, table.model_fields) + getattr(table, "remark", "")
            raise InputError(f"unknown key {name}.{hint}", key=name, value=value)
        section = result.setdefault(table_name, {})
        if not isinstance(section, dict):
            raise InputError("must be a table", key=table_name, value=section)
        section[key] = [value] if is_one_of_list(table, key, value) else value
    return result


def parse_changes(assignments: Iterable[str], keys: Collection[str] = ("calibration",)) -> dict[str, Any]:
    """Changes from texts ``table.key=value``, read by `bare_value`; ``keys`` need no table. Raises InputError."""
    changes = {}
    for text in assignments:
        key, equals, value = (part.strip() for part in text.partition("="))
        if not equals or (key.count(".") != 1 and key not in keys):
            raise InputError("write table.key=value, such as membrane.material=FLX9960", key="set", value=text)
        changes[key] = bare_value(value)
    return changes


def bare_value(text: str) -> Any:
    """Value of a text as TOML, else the text itself; numbers separated by commas are a list, without brackets."""
    value = toml_value(text)
    if value != text or "," not in text:
        # A text in quotes is a text, whatever it holds.
        return value
    listed = toml_value(f"[{value}]")
    is_numbers = isinstance(listed, list) and all(type(item) in (int, float) for item in listed)
    return listed if is_numbers else value
