"""Numbers of a document rounded: the last bits differ between processors, and no figure needs them."""

import math
from typing import Any

_ROUNDING = 1e-9


def rounded(value: Any, digits: int, nothing: float = 0.0) -> Any:
    """A JSON value with every float to ``digits`` significant digits; those below ``nothing`` are 0."""
    if isinstance(value, float):
        return float(f"{value:.{digits}g}") + 0.0 if abs(value) >= nothing else 0.0
    if isinstance(value, dict):
        return {key: rounded(item, digits, nothing) for key, item in value.items()}
    return [rounded(item, digits, nothing) for item in value] if isinstance(value, list) else value


def tenths_below(value: float) -> float:
    """A value rounded down to a tenth, as a rated pressure is shown: what is shown is never above what is meant."""
    return math.floor(10.0 * value + _ROUNDING) / 10.0
