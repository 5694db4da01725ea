"""Numbers of a document rounded: the last bits differ between processors, and no figure needs them."""

import math
from dataclasses import fields, is_dataclass, replace
from typing import Any, TypeVar, cast

_ROUNDING = 1e-9

_Json = TypeVar("_Json")


def rounded(value: _Json, digits: int, nothing: float = 0.0) -> _Json:
    """A JSON value with every float to ``digits`` significant digits; those below ``nothing`` are 0."""
    result: Any = value
    if isinstance(value, float):
        result = float(f"{value:.{digits}g}") + 0.0 if abs(value) >= nothing else 0.0
    elif isinstance(value, dict):
        result = {key: rounded(item, digits, nothing) for key, item in value.items()}
    elif isinstance(value, list | tuple):
        result = type(value)(rounded(item, digits, nothing) for item in value)
    elif is_dataclass(value) and not isinstance(value, type):
        held = {f.name: rounded(getattr(value, f.name), digits, nothing) for f in fields(value)}
        result = replace(value, **held)
    return cast("_Json", result)


def tenths_below(value: float) -> float:
    """A value rounded down to a tenth, so that a shown rated pressure is never above the true one."""
    return math.floor(10.0 * value + _ROUNDING) / 10.0
