"""A scan of a texture specimen as the program states it, and domes that separate two patterns."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, slots=True)
class BarsRecord:
    """A row of bars in the specimen."""

    name: str
    """Name."""
    pitch_mm: float
    """Pitch of the bars."""
    width_mm: float
    """Width."""
    height_mm: float
    """Height."""
    depth_mm: float
    """Depth of the upper faces below the scanned surface."""
    from_mm: float
    """Start of the stretch of travel."""
    to_mm: float
    """End of the stretch of travel."""
    frequency_Hz: float
    """Speed of the scan over the pitch."""
    bending_length_mm: float | None
    """Length over which a bar spreads a load; null: the modulus of its material is not known."""
    noise_amplitude_kPa: float
    """Reading of noise alone at this frequency."""


@dataclass(frozen=True, slots=True)
class SoughtPattern:
    """A row of bars looked for in a signal; model amplitudes only if it is simulated."""

    name: str
    """Name."""
    true_frequency_Hz: float
    """Frequency that the specimen and the speed give."""
    detected: bool
    """True if the pattern is detected."""
    model_amplitude_kPa: float | None = None
    """Amplitude of the pressure by the model, without noise."""
    sinking_amplitude_um: float | None = None
    """Amplitude of the sinking of the specimen's surface under the preload."""
    relief_equivalent_um: float | None = None
    """Amplitude of a rigid relief that would read the same."""
    detected_frequency_Hz: float | None = None
    """Frequency of the highest amplitude near the true one."""
    amplitude_kPa: float | None = None
    """Pressure amplitude at the detected frequency, averaged over time."""
    noise_floor_kPa: float | None = None
    """Amplitude without the pattern."""
    detection_figure: float | None = None
    """Amplitude over noise floor."""
    threshold: float | None = None
    """Amplitude over noise floor that noise alone passes in the stated share of records."""
    p_value: float | None = None
    """Share of noise records with the same amplitude over floor or more."""
    level: float | None = None
    """Greatest p-value of a detection."""
    frequency_error_relative: float | None = None
    """Detected frequency over the true one, less one."""


@dataclass(frozen=True, slots=True)
class SignalRecord:
    """A measured signal."""

    label: str
    """In words."""
    signal: str
    """File of the signal."""
    duration_s: float
    """Length of the signal."""
    patterns: tuple[SoughtPattern, ...]
    """Patterns, in order."""


@dataclass(frozen=True, slots=True)
class SimulatedSignal(SignalRecord):
    """A simulated signal, and the contact that it was simulated with."""

    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    contact_radius_mm: float
    """Radius of the edge of contact."""
    indentation_mm: float
    """Travel of the object after first contact."""
    stiffness_N_per_mm: float
    """Mean slope of contact force over indentation, first contact to range end."""
    pressure_slope_kPa_per_mm: float
    """Change of the cavity pressure with indentation."""
    pressure_kPa: float
    """Pressure that is read."""
    model: str
    """Model that computed it."""
    specimen_compliance_mm_per_N: float
    """Mean sinking of the specimen's surface over the force."""
    clipped: bool
    """True if the pressure passes the gauge's range."""
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
    """Start and end of the path of the apex."""
    sampling_Hz: float
    """Samples a second of the simulated gauge."""
    kept_Hz: float
    """Samples a second in the files of the signals."""
    noise_kPa: float
    """Standard deviation of one reading."""
    seed: int
    """Seed of the random numbers."""
    range_kPa: float
    """Full range of the gauge."""
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
    """A pattern to be distinguished."""

    pitch_mm: float
    """Pitch of the bars."""
    depth_mm: float
    """Depth of the upper faces below the scanned surface."""
    frequency_Hz: float
    """Speed of the scan over the pitch."""
    noise_amplitude_kPa: float
    """Reading of noise alone at this frequency."""


@dataclass(frozen=True, slots=True)
class FavouringState:
    """A driving pressure that favours one of the patterns."""

    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    for_pattern: int
    """Number of the pattern, from 1."""
    amplitudes_kPa: tuple[float, ...]
    """Amplitude of each pattern."""


@dataclass(frozen=True, slots=True)
class SeparatingDome:
    """A dome that distinguishes the patterns by two driving pressures."""

    rank: int
    """Place in the order, from 1."""
    resin: str
    """Name of its material."""
    inner_radius_mm: float
    """Inner radius R0 of the unloaded dome."""
    wall_thickness_mm: float
    """Wall thickness t0 of the unloaded dome."""
    contrast: float
    """Ratio of the amplitudes in the first state over that in the second."""
    states: tuple[FavouringState, ...]
    """One entry a pattern."""


@dataclass(frozen=True, slots=True)
class SeparationRecord:
    """Domes that separate two patterns, best first."""

    patterns: tuple[TellablePattern, ...]
    """Patterns, in order."""
    candidates: int
    """Number of candidates."""
    preload_N: float
    """Force before the scan."""
    domes: tuple[SeparatingDome, ...]
    """Domes, the best first."""
