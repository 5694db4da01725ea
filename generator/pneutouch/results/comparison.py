"""A comparison of sensors: the content of ``comparison.json``, from which its page and its text are made."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from pneutouch.results.prediction import CurvePoints


@dataclass(frozen=True, slots=True, kw_only=True)
class ComparedCurve(CurvePoints):
    """A curve that is drawn: a predicted one, or a measured run."""

    label: str
    """Label of the column that the curve belongs to."""
    measured: bool
    """True if it is a measured run."""
    driving_pressure_kPa: float
    """Gauge pressure before contact."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ColumnRecord:
    """One column of a comparison."""

    label: str
    """Label of the column: the sensor's name, or what distinguishes it."""
    name: str
    """Name of the sensor."""
    kind: str
    """Origin of the figures, such as design, or measured."""
    source: str
    """File or folder that the column comes from."""
    simulated: bool
    """True if a program made the runs behind it."""
    driving_pressures_kPa: tuple[float, ...]
    """Gauge pressures before contact."""


@dataclass(frozen=True, slots=True)
class ValueRecord:
    """A figure and the ends of its interval."""

    value: float
    """Value of the figure."""
    low: float | None
    """Lower end of the interval; null: not known."""
    high: float | None
    """Upper end of the interval; null: not known."""


@dataclass(frozen=True, slots=True)
class DifferenceRecord:
    """A difference from the first column with its interval; null if unknown."""

    difference: float
    """Value of the column less that of the first one."""
    percent: float | None
    """The difference over the value of the first column."""
    low_percent: float | None
    """Lower end of the interval of that percentage."""
    high_percent: float | None
    """Upper end of the interval of that percentage."""
    exceeds: bool | None
    """True if the difference exceeds its uncertainty; null: not known."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RowRecord:
    """A figure: a value for every column, and for every column but the first the difference from it."""

    figure: str
    """Key of the figure, which ends in its unit."""
    name: str
    """Name of the figure in words."""
    unit: str
    """Unit of the values."""
    driving_pressure_kPa: float | None
    """Gauge pressure before contact; null: a figure of the whole sensor."""
    values: tuple[ValueRecord | None, ...]
    """One value a column; null: not known."""
    differences: tuple[DifferenceRecord | None, ...]
    """One difference for every column but the first; null: not known."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ComparisonRecord:
    """A comparison; ``inputs`` holds the input fields that differ between columns, one value for each column."""

    pneutouch: str
    """Version of the program."""
    compared: tuple[ColumnRecord, ...]
    """Columns, the one that the others are compared with first."""
    inputs: Mapping[str, tuple[Any, ...]]
    """Input fields that differ, each with a value for every column."""
    driving_pressures_kPa: tuple[float, ...]
    """Gauge pressures before contact that all columns share."""
    coverage_factor: float
    """Coverage factor of the intervals."""
    criterion: str
    """Criterion by which a difference exceeds its uncertainty, in words."""
    figures: tuple[RowRecord, ...]
    """Figures that at least two columns have."""
    notes: tuple[str, ...]
    """Notes in words."""
    curves: tuple[ComparedCurve, ...]
    """Curves that are drawn."""
    folder: str | None = None
    """Folder that it was written to; only in the output of the command."""
