"""A scan of a texture specimen as the program states it, and domes that separate two patterns."""

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, slots=True)
class BarsRecord:
    """A row of bars in the specimen."""

    name: str
    """Name of the pattern."""
    pitch_mm: float
    """Pitch of the bars."""
    width_mm: float
    """Width of a bar along the path."""
    height_mm: float
    """Height of a bar."""
    depth_mm: float
    """Depth of the upper faces below the scanned surface."""
    from_mm: float
    """Start of the first bar along the path."""
    to_mm: float
    """End of the last bar along the path."""
    frequency_Hz: float
    """Speed of the scan over the pitch."""
    bending_length_mm: float | None
    """Length over which a bar spreads a load; null: the modulus of its material is not known."""
    noise_amplitude_kPa: float
    """Amplitude that noise alone shows at this frequency."""


@dataclass(frozen=True, slots=True)
class SoughtPattern:
    """A row of bars that is looked for in a signal; amplitudes by the model only if the signal is simulated."""

    name: str
    """Name of the pattern."""
    true_frequency_Hz: float
    """Frequency that the specimen and the speed give."""
    detected: bool
    """True if the pattern is detected."""
    model_amplitude_kPa: float | None = None
    """Amplitude of the pressure by the model, without noise."""
    sinking_amplitude_um: float | None = None
    """Amplitude, along the path, of the sinking of the surface under the preload."""
    relief_equivalent_um: float | None = None
    """Amplitude of a rigid relief that would give the same reading."""
    detected_frequency_Hz: float | None = None
    """Frequency of the greatest amplitude near the true one."""
    amplitude_kPa: float | None = None
    """Pressure amplitude at the detected frequency, averaged over time."""
    noise_floor_kPa: float | None = None
    """Amplitude expected without the pattern."""
    detection_figure: float | None = None
    """Amplitude over noise floor."""
    threshold: float | None = None
    """Amplitude over noise floor that noise alone passes in the stated share of records."""
    p_value: float | None = None
    """Share of noise records whose amplitude over noise floor is as great or greater."""
    level: float | None = None
    """Greatest p-value that counts as a detection."""
    frequency_error_relative: float | None = None
    """Detected frequency over the true one, less one."""


@dataclass(frozen=True, slots=True)
class SignalRecord:
    """A signal, and the patterns that were looked for in it."""

    label: str
    """Name of the signal in words."""
    signal: str
    """File of the signal."""
    duration_s: float
    """Length of the signal."""
    patterns: tuple[SoughtPattern, ...]
    """Patterns, in order."""


@dataclass(frozen=True, slots=True)
class SimulatedSignal(SignalRecord):
    """A simulated signal, and the contact at the preload that it was simulated with."""

    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    contact_radius_mm: float
    """Radius of the edge of contact at the preload."""
    indentation_mm: float
    """Indentation at the preload."""
    stiffness_N_per_mm: float
    """Slope of the force over the indentation at the preload, gas included."""
    pressure_slope_kPa_per_mm: float
    """Slope of the cavity pressure over the indentation at the preload."""
    pressure_kPa: float
    """Gauge pressure at the preload."""
    model: str
    """Model that computed it."""
    specimen_compliance_mm_per_N: float
    """Sinking of the specimen's surface over the force, mean along the path."""
    clipped: bool
    """True if the signal goes beyond the gauge's range."""
    notes: tuple[str, ...]
    """Notes in words."""


@dataclass(frozen=True, slots=True)
class ScanRecord:
    """A texture specimen scanned by a sensor."""

    specimen: str
    """Name of the specimen."""
    design: str
    """Name of the design."""
    control: Literal["height", "force"]
    """Quantity held while the sensor moves: its height or the force."""
    preload_N: float
    """Force before the scan."""
    speed_mm_per_s: float
    """Speed of the sensor."""
    path_mm: tuple[float, float]
    """Start and end of the apex along the path."""
    sampling_Hz: float
    """Samples a second of the simulated gauge."""
    kept_Hz: float
    """Samples a second in the files of the signals."""
    noise_kPa: float
    """Standard deviation of a simulated sample."""
    seed: int
    """Seed of the random numbers."""
    range_kPa: float
    """Greatest gauge pressure that is read."""
    patterns: tuple[BarsRecord, ...]
    """Patterns, in order."""
    states: tuple[SimulatedSignal | SignalRecord, ...]
    """One entry a signal."""
    assumptions: tuple[str, ...]
    """Assumptions, in sentences."""
    folder: str | None = None
    """Folder that it was written to; only in the output of the command."""


@dataclass(frozen=True, slots=True)
class TellablePattern:
    """A pattern of bars that is to be distinguished from another one."""

    pitch_mm: float
    """Pitch of the bars."""
    depth_mm: float
    """Depth of the upper faces below the scanned surface."""
    frequency_Hz: float
    """Speed of the scan over the pitch."""
    noise_amplitude_kPa: float
    """Amplitude that noise alone shows at this frequency."""


@dataclass(frozen=True, slots=True)
class FavouringState:
    """A driving pressure at which one of the two patterns reads stronger than at the other pressure."""

    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    for_pattern: int
    """Number of the favoured pattern, from 1."""
    amplitudes_kPa: tuple[float, ...]
    """Amplitude of each pattern at this pressure."""


@dataclass(frozen=True, slots=True)
class SeparatingDome:
    """A dome that distinguishes the two patterns by two driving pressures."""

    rank: int
    """Place in the order, from 1."""
    resin: str
    """Name of the membrane's resin."""
    inner_radius_mm: float
    """Inner radius R0 of the unloaded dome."""
    wall_thickness_mm: float
    """Wall thickness t0 of the unloaded dome."""
    contrast: float
    """Ratio of the two amplitudes in the first state over the same ratio in the second."""
    states: tuple[FavouringState, ...]
    """Its driving pressures, one entry a pattern."""


@dataclass(frozen=True, slots=True)
class SeparationRecord:
    """Domes that separate two patterns, best first."""

    patterns: tuple[TellablePattern, ...]
    """The two patterns, in order."""
    candidates: int
    """Number of combinations of dome and pressure that were computed."""
    preload_N: float
    """Force before the scan."""
    domes: tuple[SeparatingDome, ...]
    """Domes, the best first."""
