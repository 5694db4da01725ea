"""The uncertainty of the figures of one state."""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class SourceRecord:
    """A source of uncertainty of one sensor: its standard uncertainty, and the figures that it counts for."""

    name: str
    """Name of the source."""
    acts_on: str
    """Input or figure that the source acts on."""
    standard_uncertainty: float
    """Standard uncertainty of the input or figure that the source acts on."""
    unit: str
    """Unit of the standard uncertainty."""
    distribution: str
    """Distribution of the deviation."""
    figures: tuple[str, ...]
    """Figures that the source counts for."""
    known: bool
    """True if the uncertainty is known, false if it is assumed."""
    origin: str
    """Origin of the uncertainty, in words."""


@dataclass(frozen=True, slots=True)
class IntervalRecord:
    """The ends of an interval of a figure."""

    low: float
    """Lower end."""
    high: float
    """Upper end."""


@dataclass(frozen=True, slots=True)
class SampledInterval(IntervalRecord):
    """The ends of an interval of a figure that was found by sampling the sources."""

    lost: float
    """Share of the samples in which the sensor does not have the figure."""


@dataclass(frozen=True, slots=True)
class FigureRecord:
    """A figure with its uncertainty, in its own unit."""

    value: float
    """Value of the figure."""
    expanded_uncertainty: float
    """Half the width of the interval."""
    low: float
    """Lower end of the interval."""
    high: float
    """Upper end of the interval."""
    standard_uncertainty_relative: float
    """Standard uncertainty of the figure's logarithm."""
    degrees_of_freedom: float | None
    """Effective degrees of freedom; null: infinite."""
    nonlinear: bool
    """True if the figure is not linear in its inputs over their uncertainties."""
    shares: Mapping[str, float]
    """Share of each source in the variance of the figure."""
    at_calibration: IntervalRecord | None = None
    """The interval on the day of the calibration; left out without a calibration."""


@dataclass(frozen=True, slots=True)
class SampleRecord:
    """Intervals of the figures by sampling the sources."""

    samples: int
    """Number of samples."""
    figures: Mapping[str, SampledInterval]
    """Sampled intervals by figure."""


@dataclass(frozen=True, slots=True)
class UncertaintyRecord:
    """The uncertainty of the figures of a state; or ``unknown`` alone, the reason why there is none."""

    unknown: str | None = None
    """Reason why the uncertainty is not known; then every other key is left out."""
    coverage_factor: float | None = None
    """Coverage factor of the intervals."""
    figures: Mapping[str, FigureRecord] | None = None
    """Figures by name."""
    sources: tuple[SourceRecord, ...] | None = None
    """Sources of uncertainty that count for this sensor."""
    elasticities: Mapping[str, Mapping[str, float]] | None = None
    """Relative change of a figure over that of an input, by figure and input."""
    notes: tuple[str, ...] | None = None
    """Notes in words."""
    summary: str | None = None
    """The uncertainty of the sensitivity in a sentence or two."""
    monte_carlo: SampleRecord | None = None
    """Intervals by sampling the sources; left out: not sampled."""

    @property
    def known(self) -> Mapping[str, FigureRecord]:
        """Figures with their uncertainty by name; empty where it is unknown."""
        return self.figures or {}
