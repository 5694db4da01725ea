"""The simulated signal of the gauge under a load, as the program states it."""

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, slots=True)
class StateResponse:
    """The signal at one driving pressure."""

    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    relaxation_source: str | None
    """Source of the relaxation data that are used; null: none is known."""
    file: str
    """Name of the signal's file in the folder."""
    slow_pressure_rise_kPa: float
    """Greatest pressure rise if the same load is applied slowly."""
    greatest_reading_kPa: float
    """Greatest pressure at the gauge, above the driving pressure."""
    last_reading_kPa: float
    """Pressure at the gauge at the end, above the driving pressure."""
    first_resonance_Hz: float | None
    """First resonance; null: there is none."""
    resonance_gain: float | None
    """Gain at the resonance; null: there is none."""
    bandwidth_3_dB_Hz: float | None
    """Frequency up to which the gain is within 3 dB; null: none found."""
    within_5_percent_Hz: float | None
    """Frequency up to which the gain is within 5 %; null: none found."""
    within_5_percent_limited_by: str | None
    """Effect that limits that frequency; null: none."""
    gain: float | None = None
    """Amplitude of the reading over that of a slow press; left out for a step."""
    phase_lag_deg: float | None = None
    """Phase of the reading behind that of a slow press; left out for a step."""
    samples_file: str | None = None
    """Name of the file of the gauge's samples; left out: nothing is sampled."""


@dataclass(frozen=True, slots=True)
class LoadResponse:
    """Readings of the gauge under a force or an indentation that changes in time."""

    design: str
    """Name of the design."""
    model: str
    """Model that computed it."""
    simulated: bool
    """True: a program made the files."""
    signal: Literal["step", "sine"]
    """Form of the load in time."""
    sine_Hz: float | None
    """Frequency of the load; null: a step."""
    duration_s: float
    """Length of the signal."""
    seed: int
    """Seed of the random numbers."""
    gauge: str | None
    """Name of the design's gauge; null: none is named."""
    gauge_rate_Hz: float | None
    """Readings of the gauge a second; null: not known."""
    notes: tuple[str, ...]
    """Notes in words."""
    states: tuple[StateResponse, ...]
    """One entry a driving pressure."""
    basis: tuple[str, ...]
    """Assumptions of the simulation, in sentences."""
    peak_N: float | None = None
    """Greatest force; left out if peak_mm is given."""
    peak_mm: float | None = None
    """Greatest indentation; left out if peak_N is given."""
    folder: str | None = None
    """Folder that it was written to; only in the output of the command."""

    @property
    def peak(self) -> str:
        """Greatest force or indentation, with its unit."""
        return f"{self.peak_N:g} N" if self.peak_mm is None else f"{self.peak_mm:g} mm"
