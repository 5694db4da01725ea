"""What comes out of measured coupons: quantities of profiles, figures to be told, and remarks."""

from __future__ import annotations

import datetime
from dataclasses import dataclass, field
from typing import Any, Literal

MARK = "measured on coupons"
"""What the source of every quantity says that a coupon gave."""


@dataclass(frozen=True, slots=True)
class ProfileChange:
    """A quantity of a profile as measured: kind and name of the profile, the keys that lead to it, its content."""

    kind: Literal["materials", "printers"]
    name: str
    keys: tuple[str, ...]
    content: dict[str, Any]


@dataclass(frozen=True, slots=True)
class MeasuredFigure:
    """A figure for people: what it is of, its name with unit, value, standard deviation and count."""

    about: str
    name: str
    value: float
    spread: float | None = None
    count: int | None = None


@dataclass
class CouponFindings:
    """Changes, figures and remarks, gathered coupon by coupon."""

    changes: list[ProfileChange] = field(default_factory=list)
    figures: list[MeasuredFigure] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class ReadingSource:
    """Where readings are from: ``where`` is the results file for messages, lab and date go into every source."""

    where: str
    lab: str
    date: datetime.date

    def source(self, how: str, count: int) -> str:
        """The source of a measured quantity."""
        return f"{MARK}: {how}; n = {count}; {self.lab}, {self.date.isoformat()}"


def rounded(value: float) -> float:
    """Four significant digits: more than a reading has."""
    return float(f"{value:.4g}")
