"""The JSON schema of a declared file: fields with unit, bounds, default and help, as `spec` declares them.

Keywords of our own: `x-unit`, `x-registry` (what `pneutouch list` shows the names of), and `x-minimum` and `x-maximum`
of a sourced number.
"""

import math
from collections.abc import Callable, Mapping
from typing import Any

from pydantic import BaseModel, TypeAdapter
from pydantic.json_schema import GenerateJsonSchema

Schema = dict[str, Any]

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
