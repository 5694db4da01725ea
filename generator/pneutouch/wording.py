"""Numbers as documents and texts give them: rounded, counted and listed; and the mark of simulated data.

They are rounded because the last bits differ between processors, and no figure needs them.
"""

import math
from collections.abc import Sequence
from dataclasses import fields, is_dataclass, replace
from typing import Any, TypeVar, cast

SIMULATED = "SIMULATED DATA"
"""Stands before every figure that no sensor was measured for, on screen and sheet."""

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


def markdown_escaped(text: str) -> str:
    """Text escaped so that Markdown sees no table, HTML or escape in it."""
    return text.replace("\\", "\\\\").replace("|", "\\|").replace("<", "&lt;")


def listed(names: Sequence[str], most: int) -> str:
    """The first ``most`` names, and how many more there are: ``a, b and 3 more``."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return f"{', '.join(names[:most])}{more}"


def enumerated(words: Sequence[str]) -> str:
    """Words in a row: ``a, b and c``."""
    return " and ".join(filter(None, [", ".join(words[:-1]), *words[-1:]]))


def counted(count: int, one: str, many: str = "") -> str:
    """``1 design``, ``2 designs``; ``many`` where the plural is not the singular with an s: ``2 bodies``."""
    return f"{count} {one if count == 1 else many or one + 's'}"
