"""A budget as it leaves the program: the form in which a state's uncertainty is written."""

from typing import NotRequired, TypedDict


class SourceRecord(TypedDict):
    """A source for one sensor: its standard uncertainty in ``unit``, and the figures that it counts for."""

    name: str
    acts_on: str
    standard_uncertainty: float
    unit: str
    distribution: str
    figures: list[str]
    known: bool
    origin: str


class IntervalRecord(TypedDict):
    """The ends of an expanded interval, and of a sampled one the share of samples without the figure."""

    low: float
    high: float
    lost: NotRequired[float]


class FigureRecord(TypedDict):
    """A figure with its uncertainty, in its own unit; ``shares`` of its variance are by source."""

    value: float
    expanded_uncertainty: float
    low: float
    high: float
    standard_uncertainty_relative: float
    degrees_of_freedom: float | None
    nonlinear: bool
    shares: dict[str, float]
    at_calibration: NotRequired[IntervalRecord]


class SampleRecord(TypedDict):
    """Intervals of the figures by sampling the sources."""

    samples: int
    figures: dict[str, IntervalRecord]


class UncertaintyRecord(TypedDict, total=False):
    """The uncertainty of a state, figures by name; or ``unknown`` alone, the reason why there is none."""

    unknown: str
    coverage_factor: float
    figures: dict[str, FigureRecord]
    sources: list[SourceRecord]
    elasticities: dict[str, dict[str, float]]
    notes: list[str]
    summary: str
    monte_carlo: SampleRecord
