"""Sourced numbers, numbers in texts, and the rule for names.

No empirical number enters the program without a source. Numbers in texts are plain decimal ones; Python's ``float``
also reads ``1_0`` as ten, ``nan``, and digits of other scripts. Designs, specimens, trays, sweeps and calibrations
share one rule for names, because these name files and bodies of a 3MF too.
"""

import math
import re
import sys
from collections.abc import Iterable
from os import PathLike
from pathlib import Path

from pydantic import Field, model_validator

from pneutouch.errors import InputError
from pneutouch.spec.fields import Table


class Quantity(Table):
    """A sourced number: a value, or the range a source gives, or both; ``spread`` is one standard deviation."""

    value: float | None = Field(
        default=None, description="The number, in the unit of its key; may be left out if there is a range."
    )
    low: float | None = Field(default=None, description="Lower end of the range.")
    high: float | None = Field(default=None, description="Upper end of the range.")
    spread: float | None = Field(default=None, ge=0, description="One standard deviation.")
    source: str = Field(min_length=8, description="Table, page or DOI; how far it was verified.")

    @model_validator(mode="after")
    def _is_not_empty(self) -> "Quantity":
        if self.value is None and (self.low is None or self.high is None):
            raise ValueError("give value, or low and high")
        if self.low is not None and self.high is not None and self.low > self.high:
            raise ValueError("low must not exceed high")
        return self

    @property
    def nominal(self) -> float:
        """The value, else the middle of the range."""
        if self.value is not None:
            return self.value
        assert self.low is not None and self.high is not None
        return 0.5 * (self.low + self.high)

    @property
    def least(self) -> float:
        """The lower end of the range where there is one, else the value."""
        return self.low if self.low is not None else self.nominal

    @property
    def most(self) -> float:
        """The upper end of the range where there is one, else the value."""
        return self.high if self.high is not None else self.nominal

    def text(self, digits: int = 4) -> str:
        """Number as a datasheet prints it, to ``digits`` significant digits: ``0.17``, ``1.3 to 1.8``, ``27.6 ± 1``."""
        if self.value is not None and self.spread is not None:
            return f"{self.value:.{digits}g} ± {self.spread:.{digits}g}"
        if self.value is not None:
            return f"{self.value:.{digits}g}"
        return f"{self.low:.{digits}g} to {self.high:.{digits}g}"


_NUMBER = re.compile(r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?")


def is_finite(value: object) -> bool:
    """True for a number, not a bool, that a float can hold; ``math.isfinite`` raises for greater whole numbers."""
    if isinstance(value, bool) or not isinstance(value, float | int):
        return False
    return abs(value) <= sys.float_info.max


def finite_numbers(values: Iterable[object], key: str) -> list[float]:
    """The values as floats, so that 0 and 0.0 are written alike. Raises InputError on ``key`` if one is not finite."""
    numbers = []
    for value in values:
        if not is_finite(value):
            raise InputError("must be a finite number", key=key, value=value)
        numbers.append(float(value))  # type: ignore[arg-type]
    return numbers


def plain_number(text: str) -> float:
    """Finite number in a text of sign, digits, decimal point and exponent. Raises ValueError for any other text."""
    value = float(text) if _NUMBER.fullmatch(text.strip()) else math.nan
    if not math.isfinite(value):
        raise ValueError(f"{text} is no finite number")
    return value


def plain_numbers(text: str) -> list[float]:
    """Numbers in a text, separated by commas. Raises ValueError as `plain_number` does."""
    return [plain_number(part) for part in text.split(",")]


NAME_RULE = "use letters, digits, . _ and -, starting with a letter or digit, at most 100 characters"

_NAME = re.compile(r"[^\W_][\w.-]*")
_MOST = 100
_MOST_BYTES = 200
"""File systems take 255 bytes; endings such as ``-voxels`` and ``.3mf`` come on top."""


def plain_name(name: str, *, key: str | None = None, file: str | PathLike[str] | None = None) -> str:
    """Return ``name`` if it obeys `NAME_RULE`. Raises InputError with ``file`` and ``key`` if it does not."""
    if not (_NAME.fullmatch(name) and len(name) <= _MOST and len(name.encode()) <= _MOST_BYTES):
        raise InputError("cannot be a name", file=file, key=key, value=name, remedy=NAME_RULE)
    return name


def name_of(path: Path) -> str:
    """Name of a file's content: that of the file without suffix. Raises InputError if it breaks `NAME_RULE`."""
    try:
        return plain_name(path.stem)
    except InputError:
        problem = f"the file's name without {path.suffix or 'a suffix'} is the name of its content"
        raise InputError(problem, file=path, remedy=f"rename the file: {NAME_RULE}") from None


def file_name(text: str) -> str:
    """Text made fit for part of a file's name: printable, no slashes, no leading points, neither long nor empty."""
    plain = "".join(c if c.isprintable() and c not in "/\\" else "-" for c in text).lstrip(".")[:_MOST]
    return plain.encode()[:_MOST_BYTES].decode(errors="ignore") or "unnamed"
