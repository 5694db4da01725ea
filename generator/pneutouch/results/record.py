"""Records as plain data.

A record is a frozen dataclass: its fields are the keys of a document, in their order, and the text below a field is its
help. A field without a default is always written; one with a default is left out of a document while it has that value.
Standard dataclasses, not pydantic's: records are made by this program alone and need no validation.
"""

import dataclasses
from collections.abc import Mapping
from typing import Any, TypeVar

from pydantic import BaseModel

SENSITIVITY_KEY, STIFFNESS_KEY = "sensitivity_kPa_per_N", "stiffness_N_per_mm"
"""Keys of the two slopes of a sensor in every document, dataset and table of figures."""

Extended = TypeVar("Extended")


def plain(value: Any) -> Any:
    """JSON data of a record, a mapping, a sequence, an array or a plain value, with all that it holds."""
    if dataclasses.is_dataclass(value):
        return {
            f.name: plain(held) for f in dataclasses.fields(value) if not left_out(f, held := getattr(value, f.name))
        }
    if isinstance(value, Mapping):
        return {key: plain(held) for key, held in value.items()}
    if isinstance(value, list | tuple):
        return [plain(held) for held in value]
    if isinstance(value, BaseModel):
        return value.model_dump(mode="json")
    # An array: numpy is not loaded for this, as names are completed without it.
    return value.tolist() if hasattr(value, "tolist") else value


def left_out(field: dataclasses.Field[Any], held: Any) -> bool:
    """True if a document leaves out ``field``, because its value ``held`` is its default."""
    if field.default is dataclasses.MISSING:
        return False
    return held is field.default or (isinstance(held, tuple | str) and held == field.default)


def extended(kind: type[Extended], base: Any, /, **more: Any) -> Extended:
    """Record of a ``kind`` that has all fields of the record ``base``, with their values, and ``more``."""
    return kind(**{f.name: getattr(base, f.name) for f in dataclasses.fields(base)} | more)
