"""The grammar of ``table.key=VALUES``: values with commas between, or a range ``from:to:count``."""

from collections.abc import Sequence
from typing import Any

from pneutouch.errors import InputError
from pneutouch.spec.toml_text import toml_value
from pneutouch.spec.values import is_finite

MAX_VALUES = 10_000

_OPENING = ("[", "{", "'", '"')


def parse_over(texts: Sequence[str]) -> dict[str, list[Any]]:
    """Values by key. Raises InputError for a text that is not of the grammar and for a key given twice."""
    varied: dict[str, list[Any]] = {}
    for text in texts:
        key, equals, values = (part.strip() for part in text.partition("="))
        if not equals or not values:
            example = "membrane.material=TangoPlus,FLX9940 or membrane.wall_thickness_mm=1:2:5"
            raise InputError(f"write table.key=VALUES, such as {example}", key="over", value=text)
        if key in varied:
            raise InputError(f"{key} is given twice", key="over", value=text)
        varied[key] = _values(key, values, text)
    return varied


def spread(where: str, key: str, start: Any, stop: Any, count: Any) -> list[float | int]:
    """``count`` values at equal distances, both ends included; whole numbers where all of them are."""
    shown = f"from {start} to {stop} count {count}"
    ends = (start, stop)
    if not all(map(is_finite, ends)):
        raise InputError(f"{shown}: the ends must be finite numbers", file=where, key=key)
    if isinstance(count, bool) or not isinstance(count, int) or not 2 <= count <= MAX_VALUES:
        raise InputError(f"{shown}: the count must be a whole number from 2 to {MAX_VALUES}", file=where, key=key)
    # Twelve digits: the values are read and selected by people, and 1.1 must be 1.1.
    inner = [float(f"{start + (stop - start) * (k / (count - 1)):.12g}") for k in range(1, count - 1)]
    values: list[float | int] = [start, *inner, stop]
    if isinstance(start, int) and isinstance(stop, int) and all(float(v).is_integer() for v in values):
        return [int(v) for v in values]
    return [float(v) for v in values]


def _values(key: str, text: str, given: str) -> list[Any]:
    """A range; or TOML values and bare words, separated by the commas outside brackets and quotes."""
    parts = [] if text.startswith(_OPENING) else text.split(":")
    if len(parts) == 3:
        return spread("over", key, *(toml_value(part.strip()) for part in parts))
    if len(parts) == 2:
        raise InputError("a range is written from:to:count, such as 1:2:5", key="over", value=given)
    pieces = text.removesuffix(",").split(",")
    values = []
    while pieces:
        word = pieces.pop(0).strip()
        if word.startswith(_OPENING):
            while toml_value(word) is word and pieces:
                word = f"{word},{pieces.pop(0)}".rstrip()
            if toml_value(word) is word:
                remedy = "write lists as [1, 2] and texts as 'A, B'"
                raise InputError(f"{word} is not closed, or not TOML", key="over", value=given, remedy=remedy)
        values.append(toml_value(word))
    return values
