"""Pieces of schemas; every key of a record is described.

Kind of a document: its form, its title, its place, and the function that makes its schema.
"""

import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any, Literal, NamedTuple

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
