"""Pieces of schemas, and the schema of a file from its pydantic model: keys with unit, bounds, default and help.

Keywords of our own: `x-unit`; `x-registry`, the kind in `pneutouch list` that a name belongs to; `x-minimum` and
`x-maximum`, the bounds of a sourced number.
"""

import math
import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any, Literal, NamedTuple

from pydantic import BaseModel, TypeAdapter
from pydantic.json_schema import GenerateJsonSchema

from pneutouch.wording import data_of

Schema = dict[str, Any]

_UNITS = data_of(__file__)["units"]
_SUFFIX = re.compile(rf"_({'|'.join(_UNITS)})(?:_\d+)?$")


def unit_of(key: str) -> str:
    """Unit at the end of a key's name, ``kPa/N`` for ``..._kPa_per_N``; "" without one."""
    match = _SUFFIX.search(key)
    return _UNITS[match[1]] if match else ""


TEXT: Schema = {"type": "string"}
NUMBER: Schema = {"type": "number"}


def or_null(schema: Schema) -> Schema:
    """A schema that also allows null."""
    if isinstance(schema.get("type"), str):
        return {**schema, "type": [schema["type"], "null"]}
    description = {"description": schema["description"]} if "description" in schema else {}
    if "enum" in schema:
        return {**schema, "enum": [*schema["enum"], None]}
    return {
        "anyOf": [{key: one for key, one in schema.items() if key != "description"}, {"type": "null"}]
    } | description


def any_of(*schemas: Schema) -> Schema:
    """Schema of a value that fits at least one of several schemas."""
    return {"anyOf": list(schemas)}


def items(schema: Schema) -> Schema:
    """Schema of a list whose entries fit ``schema``; without a description."""
    return {"type": "array", "items": schema}


NUMBERS = items(NUMBER)
TEXTS = items(TEXT)


def mapping(schema: Schema) -> Schema:
    """Schema of a table with any names as keys, whose values fit ``schema``."""
    return {"type": "object", "additionalProperties": schema}


def described_by(help: str, schema: Schema) -> Schema:
    """The schema with ``help`` as its description."""
    return {**schema, "description": help}


def choice(*words: str) -> Schema:
    """Schema of a value that is one of ``words``."""
    return {"enum": list(words)}


def record(help: str, keys: Mapping[str, Schema], optional: Iterable[str] = ()) -> Schema:
    """Schema of a table with these keys, each with a description, and no other; numbers get the unit of their key."""
    may_be_left_out = set(optional)
    assert may_be_left_out <= set(keys), may_be_left_out - set(keys)
    return {
        "type": "object",
        "additionalProperties": False,
        "required": [key for key in keys if key not in may_be_left_out],
        "properties": {key: _with_unit(key, schema) for key, schema in keys.items()},
        "description": help,
    }


def _with_unit(key: str, schema: Schema) -> Schema:
    unit = unit_of(key)
    assert schema.get("description"), key
    return {**schema, "x-unit": unit} if unit and "x-unit" not in schema else schema


class DocumentKind(NamedTuple):
    """A kind of document, read or written; ``where``: where it lies or which command takes it; ``make``: its schema."""

    form: Literal["TOML", "JSON"]
    title: str
    where: str
    make: Callable[[], dict[str, Any]]


NULL = {"type": "null"}


class _Untitled(GenerateJsonSchema):
    """Generator of schemas without the titles that pydantic makes from the names of keys."""

    def field_title_should_be_set(self, schema: Any) -> bool:
        """No field has a title next to its key."""
        return False


def model_schema(model: Any) -> Schema:
    """The schema of a file from its model, or from a union of models if it has several forms.

    TOML has no null: a key that may be left out is not required, and may not be null.
    """
    if isinstance(model, type) and issubclass(model, BaseModel):
        made = model.model_json_schema(by_alias=True, schema_generator=_Untitled)
    else:
        made = TypeAdapter(model).json_schema(by_alias=True, schema_generator=_Untitled)
    tidied: Schema = _tidied(made)
    return tidied


def _tidied(schema: Any) -> Any:
    """Copy of a schema without nulls and what pydantic alone reads; units, bounds and registries become keywords."""
    if isinstance(schema, list):
        return [_tidied(one) for one in schema]
    if not isinstance(schema, dict):
        return schema
    inner = {key: _entries(key, value, _tidied) for key, value in schema.items() if key != "discriminator"}
    return _field(_without_null(inner)) if "properties" not in inner else _table(inner)


def _entries(key: str, value: Any, change: Callable[[Any], Any]) -> Any:
    """Value of a keyword, changed by ``change``: name by name if it maps names to schemas; plain values stay."""
    if key in ("properties", "$defs") and isinstance(value, Mapping):
        return {name: change(one) for name, one in value.items()}
    return value if key in ("default", "enum", "const", "required") else change(value)


def _table(schema: Schema) -> Schema:
    schema.pop("title", None)
    if "description" in schema:
        schema["description"] = " ".join(schema["description"].replace("``", "`").split())
    return schema


def _without_null(schema: Schema) -> Schema:
    """A schema with null, as alternative and as default, removed."""
    kinds = [kind for kind in schema.get("anyOf", ()) if kind != NULL]
    if len(kinds) < len(schema.get("anyOf", ())):
        rest = {key: value for key, value in schema.items() if key != "anyOf"}
        schema = {**kinds[0], **rest} if len(kinds) == 1 else {"anyOf": kinds, **rest}
    if schema.get("default", schema) is None:
        del schema["default"]
    return schema


def _field(schema: Schema) -> Schema:
    """A field with its bounds (a list's on its numbers), unit and registry, without a default that JSON cannot hold."""
    low, high = schema.pop("low", None), schema.pop("high", None)
    unit, registry = schema.pop("unit", None), schema.pop("registry", None)
    default = schema.get("default")
    if isinstance(default, dict) or (isinstance(default, float) and not math.isfinite(default)):
        del schema["default"]
    if low is not None and schema.get("type") == "array":
        innermost = schema["items"]
        while innermost.get("type") == "array":
            innermost = innermost["items"]
        innermost.update({"minimum": low, "maximum": high})
    elif low is not None and "$ref" in schema:
        # Of a sourced number, whose table bounds its value and the ends of its range likewise.
        schema |= {"x-minimum": low, "x-maximum": high}
    if unit:
        schema["x-unit"] = unit
    if registry:
        schema["x-registry"] = registry
    return schema
