"""A comparison: the content of ``comparison.json``, and the source of its page and its text."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class CurvePoints:
    """A loading curve, lists of one length."""

    indentation_mm: tuple[float, ...]
    """Travel of the object after first contact."""
    contact_force_N: tuple[float, ...]
    """Force on the object."""
    pressure_rise_kPa: tuple[float, ...]
    """Cavity pressure less driving pressure."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ComparedCurve(CurvePoints):
    """A curve that is drawn: a predicted one, or a measured run."""

    label: str
    """In words."""
    measured: bool
    """True if it is a measured run."""
    driving_pressure_kPa: float
    """Gauge pressure before contact."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ColumnRecord:
    """One column of a comparison."""

    label: str
    """In words."""
    name: str
    """Name."""
    kind: str
    """Kind."""
    source: str
    """Source of the limit."""
    simulated: bool
    """True if a program made the files."""
    driving_pressures_kPa: tuple[float, ...]
    """Gauge pressures before contact."""


@dataclass(frozen=True, slots=True)
class ValueRecord:
    """A figure and the ends of its interval, None if unknown."""

    value: float
    """Value."""
    low: float | None
    """Lower end of the interval."""
    high: float | None
    """Upper end of the interval."""


@dataclass(frozen=True, slots=True)
class DifferenceRecord:
    """A difference from the first column with its interval; None if unknown."""

    difference: float
    """Difference from the first column."""
    percent: float | None
    """The same over the first column."""
    low_percent: float | None
    """Lower end of its interval."""
    high_percent: float | None
    """Upper end of its interval."""
    exceeds: bool | None
    """True if the difference exceeds its uncertainty; null: not known."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RowRecord:
    """A figure at a driving pressure (None: of the whole sensor): a value a column, a difference a column but one."""

    figure: str
    """Name of the figure."""
    name: str
    """Name."""
    unit: str
    """Unit of the value."""
    driving_pressure_kPa: float | None
    """Gauge pressure before contact."""
    values: tuple[ValueRecord | None, ...]
    """One value a column; null: not known."""
    differences: tuple[DifferenceRecord | None, ...]
    """One difference a column but the first."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ComparisonRecord:
    """A comparison; ``inputs`` holds the input fields that differ between columns, one value for each column."""

    pneutouch: str
    """Version of the program."""
    compared: tuple[ColumnRecord, ...]
    """Columns."""
    inputs: Mapping[str, tuple[Any, ...]]
    """Fields that differ, with a value a column."""
    driving_pressures_kPa: tuple[float, ...]
    """Gauge pressures before contact."""
    coverage_factor: float
    """Coverage factor of the intervals."""
    criterion: str
    """Criterion, in words."""
    figures: tuple[RowRecord, ...]
    """Figures by name."""
    notes: tuple[str, ...]
    """Notes in words."""
    curves: tuple[ComparedCurve, ...]
    """Curves that are drawn."""
    folder: str | None = None
    """Folder that it was written to; only in the output of the command."""
