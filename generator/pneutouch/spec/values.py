"""A number with its source: nothing empirical enters the program without one.

Numbers in texts, as people write them. Python also reads ``1_0`` as ten, ``nan`` and digits of other scripts.

Names of designs, specimens, trays, sweeps and calibrations: one rule, for they name files and bodies of a 3MF.
"""

from __future__ import annotations

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
    def _is_not_empty(self) -> Quantity:
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
        """The number as a datasheet prints it: ``0.17``, ``1.3 to 1.8``, ``27.6 +- 1.0``."""
        if self.value is not None and self.spread is not None:
            return f"{self.value:.{digits}g} ± {self.spread:.{digits}g}"
        if self.value is not None:
            return f"{self.value:.{digits}g}"
        return f"{self.low:.{digits}g} to {self.high:.{digits}g}"


_NUMBER = re.compile(r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?")


def is_finite(value: object) -> bool:
    """True if a value is a number that a float holds. ``math.isfinite`` raises for whole numbers beyond that."""
    if isinstance(value, bool) or not isinstance(value, float | int):
        return False
    return abs(value) <= sys.float_info.max


def finite_numbers(values: Iterable[object], key: str) -> list[float]:
    """The values as floats: 0 and 0.0 are written differently. Raises InputError with ``key`` for no finite one."""
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


NAME_RULE = "use letters, digits, . _ and -, starting with a letter or digit, at most 100 characters"

_NAME = re.compile(r"[^\W_][\w.-]*")
_MOST = 100
_MOST_BYTES = 200
"""File systems take 255 bytes; endings such as ``-voxels`` and ``.3mf`` come on top."""


def plain_name(name: str, *, key: str | None = None, file: str | PathLike[str] | None = None) -> str:
    """Return a name that obeys the rule. Raises InputError."""
    if not (_NAME.fullmatch(name) and len(name) <= _MOST and len(name.encode()) <= _MOST_BYTES):
        raise InputError("cannot be a name", file=file, key=key, value=name, remedy=NAME_RULE)
    return name


def name_of(path: Path) -> str:
    """The name that a file gives its content: its own without suffix. Raises InputError if that is no name."""
    try:
        return plain_name(path.stem)
    except InputError:
        problem = f"the file's name without {path.suffix or 'a suffix'} is the name of its content"
        raise InputError(problem, file=path, remedy=f"rename the file: {NAME_RULE}") from None


def file_name(text: str) -> str:
    """A text as part of a file's name: on one line, no folder, not hidden, and not too long for a file system."""
    plain = "".join(c if c.isprintable() and c not in "/\\" else "-" for c in text).lstrip(".")[:_MOST]
    return plain.encode()[:_MOST_BYTES].decode(errors="ignore") or "unnamed"
