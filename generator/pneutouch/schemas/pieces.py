"""Pieces of schemas, and the schema of a declared file: fields with unit, bounds, default and help.

Keywords of our own: `x-unit`, `x-registry` (what `pneutouch list` shows the names of), and `x-minimum` and `x-maximum`
of a sourced number.
"""

import math
import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any, Literal, NamedTuple

from pydantic import BaseModel, TypeAdapter
from pydantic.json_schema import GenerateJsonSchema

Schema = dict[str, Any]

_UNITS = {
    "kPa_kPa_per_N": "kPa/N",
    "kPa_per_N": "kPa/N",
    "N_per_mm": "N/mm",
    "N_per_K": "N/K",
    "kPa_per_K": "kPa/K",
    "percent_per_decade": "%/decade",
    "mm_per_s": "mm/s",
    "mm3_per_s": "mm³/s",
    "g_per_cm3": "g/cm³",
    "N_mm": "N mm",
    "Pa_s": "Pa s",
    "percent": "%",
    "kPa": "kPa",
    "MPa": "MPa",
    "Hz": "Hz",
    "mL": "mL",
    "mm2": "mm²",
    "mm3": "mm³",
    "mm": "mm",
    "um": "µm",
    "ms": "ms",
    "min": "min",
    "deg": "°",
    "days": "d",
    "N": "N",
    "K": "K",
    "V": "V",
    "C": "°C",
    "g": "g",
    "h": "h",
    "s": "s",
}
_SUFFIX = re.compile(rf"_({'|'.join(_UNITS)})(?:_\d+)?$")


def unit_of(key: str) -> str:
    """The unit that the name of a key ends with; "" without one."""
    match = _SUFFIX.search(key)
    return _UNITS[match[1]] if match else ""


TEXT: Schema = {"type": "string"}
NUMBER: Schema = {"type": "number"}
WHOLE: Schema = {"type": "integer", "minimum": 0}
FLAG: Schema = {"type": "boolean"}


def or_null(schema: Schema) -> Schema:
    """The schema, or null."""
    if isinstance(schema.get("type"), str):
        return {**schema, "type": [schema["type"], "null"]}
    description = {"description": schema["description"]} if "description" in schema else {}
    if "enum" in schema:
        return {**schema, "enum": [*schema["enum"], None]}
    return {
        "anyOf": [{key: one for key, one in schema.items() if key != "description"}, {"type": "null"}]
    } | description


def any_of(*schemas: Schema) -> Schema:
    """One of several schemas."""
    return {"anyOf": list(schemas)}


def items(schema: Schema) -> Schema:
    """A list without a description of its own."""
    return {"type": "array", "items": schema}


NUMBERS = items(NUMBER)
TEXTS = items(TEXT)
PAIR: Schema = {**NUMBERS, "minItems": 2, "maxItems": 2}


def mapping(schema: Schema) -> Schema:
    """A table with names of any kind as keys."""
    return {"type": "object", "additionalProperties": schema}


def described_by(help: str, schema: Schema) -> Schema:
    """The schema with a description."""
    return {**schema, "description": help}


def choice(*words: str) -> Schema:
    """One of a few words."""
    return {"enum": list(words)}


def record(help: str, keys: Mapping[str, Schema], optional: Iterable[str] = ()) -> Schema:
    """A table with these keys and no other; a key without a description gets the common one, and a number its unit."""
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
    """A kind of document that is read or written; ``where`` states where it lies or what takes it."""

    form: Literal["TOML", "JSON"]
    title: str
    where: str
    make: Callable[[], dict[str, Any]]


NULL = {"type": "null"}


class _Untitled(GenerateJsonSchema):
    """Without the titles that pydantic makes of the names of keys."""

    def field_title_should_be_set(self, schema: Any) -> bool:
        """No field has a title next to its key."""
        return False


def model_schema(model: Any) -> Schema:
    """The schema of a file's content by its model, or by a union of models for one that has several forms.

    TOML has no null: a key that may be left out is not required, and takes no null.
    """
    if isinstance(model, type) and issubclass(model, BaseModel):
        made = model.model_json_schema(by_alias=True, schema_generator=_Untitled)
    else:
        made = TypeAdapter(model).json_schema(by_alias=True, schema_generator=_Untitled)
    tidied: Schema = _tidied(made)
    return tidied


def _tidied(schema: Any) -> Any:
    """A schema without entries that pydantic alone reads; fields with unit, bounds and default in their description."""
    if isinstance(schema, list):
        return [_tidied(one) for one in schema]
    if not isinstance(schema, dict):
        return schema
    inner = {key: _entries(key, value, _tidied) for key, value in schema.items() if key != "discriminator"}
    return _field(_without_null(inner)) if "properties" not in inner else _table(inner)


def _entries(key: str, value: Any, change: Callable[[Any], Any]) -> Any:
    """A keyword's value changed: entry by entry where the keyword maps names to schemas."""
    if key in ("properties", "$defs") and isinstance(value, Mapping):
        return {name: change(one) for name, one in value.items()}
    return value if key in ("default", "enum", "const", "required") else change(value)


def _table(schema: Schema) -> Schema:
    schema.pop("title", None)
    if "description" in schema:
        schema["description"] = " ".join(schema["description"].replace("``", "`").split())
    return schema


def _without_null(schema: Schema) -> Schema:
    """The one alternative to null in place of both; without a default that is null."""
    kinds = [kind for kind in schema.get("anyOf", ()) if kind != NULL]
    if len(kinds) < len(schema.get("anyOf", ())):
        rest = {key: value for key, value in schema.items() if key != "anyOf"}
        schema = {**kinds[0], **rest} if len(kinds) == 1 else {"anyOf": kinds, **rest}
    if schema.get("default", schema) is None:
        del schema["default"]
    return schema


def _field(schema: Schema) -> Schema:
    """A field: bounds of a list are those of its numbers; what JSON cannot hold, a default of another table, is out."""
    low, high = schema.pop("low", None), schema.pop("high", None)
    unit, registry = schema.pop("unit", None), schema.pop("registry", None)
    if isinstance(schema.get("default"), dict | float) and not _is_plain(schema["default"]):
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


def _is_plain(default: Any) -> bool:
    return isinstance(default, float) and math.isfinite(default)
