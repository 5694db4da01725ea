"""A comparison as it leaves the program: the document that ``compare`` writes, and the source of its page and its
text."""

from typing import Any, Literal, NotRequired, TypedDict

CurveKey = Literal["indentation_mm", "contact_force_N", "pressure_rise_kPa"]
"""The quantities of a curve that is drawn."""

CURVE_KEYS: tuple[CurveKey, ...] = ("indentation_mm", "contact_force_N", "pressure_rise_kPa")


class CurvePoints(TypedDict):
    """A loading curve, lists of one length."""

    indentation_mm: list[float]
    contact_force_N: list[float]
    pressure_rise_kPa: list[float]


class ComparedCurve(CurvePoints):
    """A curve that is drawn: a predicted one, or a measured run."""

    label: str
    measured: bool
    driving_pressure_kPa: float


class ColumnRecord(TypedDict):
    """One column of a comparison."""

    label: str
    name: str
    kind: str
    source: str
    simulated: bool
    driving_pressures_kPa: list[float]


class ValueRecord(TypedDict):
    """A figure and the ends of its interval, None if unknown."""

    value: float
    low: float | None
    high: float | None


class DifferenceRecord(TypedDict):
    """A difference from the first column with its interval; None if unknown."""

    difference: float
    percent: float | None
    low_percent: float | None
    high_percent: float | None
    exceeds: bool | None


class RowRecord(TypedDict):
    """A figure at a driving pressure (None: of the whole sensor): a value a column, a difference a column but one."""

    figure: str
    name: str
    unit: str
    driving_pressure_kPa: float | None
    values: list[ValueRecord | None]
    differences: list[DifferenceRecord | None]


class ComparisonRecord(TypedDict):
    """A comparison; ``inputs`` are those that differ, a value a column."""

    pneutouch: NotRequired[str]
    compared: list[ColumnRecord]
    inputs: dict[str, list[Any]]
    driving_pressures_kPa: list[float]
    coverage_factor: float
    criterion: str
    figures: list[RowRecord]
    notes: list[str]
    curves: list[ComparedCurve]
