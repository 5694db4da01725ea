"""Coupons as they are printed, and what a laboratory measured on them."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class PrintedCoupon:
    """A piece of a coupon on a printer's tray."""

    coupon: str
    """Name of the coupon."""
    piece: str
    """Name of the piece."""
    material: str
    """Title of its material."""
    printer: str
    """Printer."""
    copies: int
    """Number of copies."""
    places_mm: tuple[tuple[float, ...], ...]
    """Place of each copy on the printer's tray."""
    size_mm: tuple[float, ...]
    """Lengths along x, y and z."""
    exact_volume_mm3: float
    """Volume of the exact solid."""
    volume_mm3: float
    """Volume of the mesh."""
    measured_deviation_mm: float
    """Greatest distance of the mesh from the exact surface."""


@dataclass(frozen=True, slots=True)
class CouponSet:
    """A set of coupons that was built."""

    name: str
    """Name of the set."""
    coupons: tuple[PrintedCoupon, ...]
    """Pieces of every coupon."""
    folder: str
    """Folder that it was written to."""


@dataclass(frozen=True, slots=True)
class MeasuredFigure:
    """A figure for the reader: its subject, its name with unit, value, standard deviation and count."""

    about: str
    """Subject of the figure."""
    name: str
    """Name of the figure, with its unit."""
    value: float
    """Value of the figure."""
    spread: float | None
    """Standard deviation; null: not known."""
    count: int | None
    """Number of readings; null: a figure that was not measured."""


@dataclass(frozen=True, slots=True)
class ChangedQuantity:
    """A measured quantity of a profile and the one that it replaces, as tables of the profile's file."""

    file: str
    """Path of the profile."""
    key: str
    """Keys of the quantity, with points between."""
    before: Mapping[str, Any] | None
    """The quantity before; null: there was none."""
    after: Mapping[str, Any]
    """The measured quantity."""


@dataclass(frozen=True, slots=True)
class CouponReport:
    """Measured coupons, and the profiles that were written from them."""

    lab: str
    """Who measured."""
    date: str
    """Day of the measurement."""
    written: tuple[str, ...]
    """Files that were written."""
    changes: tuple[ChangedQuantity, ...]
    """Quantities that the profiles change."""
    figures: tuple[MeasuredFigure, ...]
    """Measured figures."""
    notes: tuple[str, ...]
    """Notes in words."""
