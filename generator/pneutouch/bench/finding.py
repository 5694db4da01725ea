"""Results of measured coupons: quantities of profiles, figures for the reader, and notes."""

import datetime
from dataclasses import dataclass, field
from typing import Any, Literal

MARK = "measured on coupons"
"""Part of the source of every quantity that was measured on a coupon."""


@dataclass(frozen=True, slots=True)
class ProfileChange:
    """A measured quantity of a profile: kind and name of the profile, the keys of the quantity, its content."""

    kind: Literal["materials", "printers"]
    name: str
    keys: tuple[str, ...]
    content: dict[str, Any]


@dataclass(frozen=True, slots=True)
class MeasuredFigure:
    """A figure for the reader: its subject, its name with unit, value, standard deviation and count."""

    about: str
    name: str
    value: float
    spread: float | None = None
    count: int | None = None


@dataclass
class CouponFindings:
    """Changes, figures and notes, collected coupon by coupon."""

    changes: list[ProfileChange] = field(default_factory=list)
    figures: list[MeasuredFigure] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def change(self, kind: Literal["materials", "printers"], name: str, keys: tuple[str, ...], **content: Any) -> None:
        """Add a quantity of a profile."""
        self.changes.append(ProfileChange(kind, name, keys, content))

    def figure(
        self, about: str, name: str, value: float, spread: float | None = None, count: int | None = None
    ) -> None:
        """Add a figure."""
        self.figures.append(MeasuredFigure(about, name, value, spread, count))


@dataclass(frozen=True, slots=True)
class ReadingSource:
    """Origin of readings: ``where`` is the results file for messages, lab and date are part of every source."""

    where: str
    lab: str
    date: datetime.date

    def source(self, how: str, count: int) -> str:
        """The source of a measured quantity."""
        return f"{MARK}: {how}; n = {count}; {self.lab}, {self.date.isoformat()}"


def rounded(value: float) -> float:
    """Round to four significant digits, more than a reading has."""
    return float(f"{value:.4g}")
