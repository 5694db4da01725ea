"""Numbers in texts, as people write them. Python also reads ``1_0`` as ten, ``nan`` and digits of other scripts."""

import math
import re

_NUMBER = re.compile(r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?")


def plain_number(text: str) -> float:
    """The finite number of a text: digits with a point and an exponent. Raises ValueError."""
    value = float(text) if _NUMBER.fullmatch(text.strip()) else math.nan
    if not math.isfinite(value):
        raise ValueError(f"{text} is no finite number")
    return value


def plain_numbers(text: str) -> list[float]:
    """The numbers of a text with commas between. Raises ValueError."""
    return [plain_number(part) for part in text.split(",")]
