"""The uncertainty of the figures of one state."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class SourceRecord:
    """A source for one sensor: its standard uncertainty in ``unit``, and the figures that it counts for."""

    name: str
    """Name of the source."""
    acts_on: str
    """Input or figure that the source acts on."""
    standard_uncertainty: float
    """Standard uncertainty."""
    unit: str
    """Unit of the standard uncertainty."""
    distribution: str
    """Distribution."""
    figures: tuple[str, ...]
    """Figures that the source counts for."""
    known: bool
    """True if the value is known, false if it is assumed."""
    origin: str
    """Origin of the value."""


@dataclass(frozen=True, slots=True)
class IntervalRecord:
    """The ends of an expanded interval."""

    low: float
    """Lower end."""
    high: float
    """Upper end."""


@dataclass(frozen=True, slots=True)
class SampledInterval(IntervalRecord):
    """The ends of a sampled interval."""

    lost: float
    """Share of the samples without the figure."""


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
    """True if the figure is not linear within the uncertainties."""
    shares: Mapping[str, float]
    """Shares of the variance by source."""
    at_calibration: IntervalRecord | None = None
    """The interval on the day of the calibration."""


@dataclass(frozen=True, slots=True)
class SampleRecord:
    """Intervals of the figures by sampling the sources."""

    samples: int
    """Number of samples."""
    figures: Mapping[str, SampledInterval]
    """Intervals by figure."""


@dataclass(frozen=True, slots=True)
class UncertaintyRecord:
    """The uncertainty of a state; or ``unknown`` alone, the reason why there is none."""

    unknown: str | None = None
    """Reason why the uncertainty is not known."""
    coverage_factor: float | None = None
    """Coverage factor of the intervals."""
    figures: Mapping[str, FigureRecord] | None = None
    """Figures by name."""
    sources: tuple[SourceRecord, ...] | None = None
    """Sources that count for this sensor."""
    elasticities: Mapping[str, Mapping[str, float]] | None = None
    """Relative change of a figure by that of an input, by figure and input."""
    notes: tuple[str, ...] | None = None
    """Notes."""
    summary: str | None = None
    """The uncertainty of the sensitivity in a sentence or two."""
    monte_carlo: SampleRecord | None = None
    """Intervals by sampling."""

    @property
    def known(self) -> Mapping[str, FigureRecord]:
        """Figures by name; none where the uncertainty is unknown."""
        return self.figures or {}
