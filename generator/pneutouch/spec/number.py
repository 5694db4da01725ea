"""Numbers in texts, as people write them. Python also reads ``1_0`` as ten, ``nan`` and digits of other scripts."""

import math
import re
import sys
from collections.abc import Iterable

from pneutouch.errors import InputError

_NUMBER = re.compile(r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?")


def is_finite(value: object) -> bool:
    """True if a value is a number that a float holds. ``math.isfinite`` raises for whole numbers beyond that."""
    if isinstance(value, bool) or not isinstance(value, float | int):
        return False
    return abs(value) <= sys.float_info.max


def finite_numbers(values: Iterable[object], key: str) -> list[float]:
    """The values as floats: 0 and 0.0 are written differently. Raises InputError with ``key`` if one is no finite
    number."""
    numbers = []
    for value in values:
        if not is_finite(value):
            raise InputError("must be a finite number", key=key, value=value)
        numbers.append(float(value))  # type: ignore[arg-type]
    return numbers


def plain_number(text: str) -> float:
    """The finite number of a text: digits with a point and an exponent. Raises ValueError."""
    value = float(text) if _NUMBER.fullmatch(text.strip()) else math.nan
    if not math.isfinite(value):
        raise ValueError(f"{text} is no finite number")
    return value


def plain_numbers(text: str) -> list[float]:
    """The numbers of a text with commas between. Raises ValueError."""
    return [plain_number(part) for part in text.split(",")]
