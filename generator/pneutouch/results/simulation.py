"""True values of a simulated campaign."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ParameterValue:
    """A parameter of the simulation."""

    value: float | tuple[float, ...] | None
    """Value; null: infinite."""
    unit: str
    """Unit of the value."""
    reason: str
    """Reason for the value."""


@dataclass(frozen=True, slots=True)
class SimulatedSpecimen:
    """A simulated specimen."""

    resin: str
    """Name of its material."""
    age_days: float
    """Age of the print."""
    shear_modulus_MPa: float
    """Shear modulus of the wall."""
    pressures: Mapping[str, Mapping[str, float | str | None]]
    """Figures without noise, by driving pressure in kPa."""
    wall_thickness_mm: float
    """Wall thickness t0 of the unloaded dome."""
    dead_volume_mL: float
    """Gas volume behind the cavity."""
    model: str
    """Model that computed it."""


@dataclass(frozen=True, slots=True)
class SimulatedPopulation:
    """Sensors of one resin, age and driving pressure."""

    resin: str
    """Name of its material."""
    age_days: float
    """Age of the print."""
    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    figures: Mapping[str, float | None]
    """Mean figures over specimens."""
    spread: Mapping[str, float]
    """Standard deviation of each figure over specimens."""
    count: int
    """Number of specimens."""
    basis: str
    """Basis of the figures."""


@dataclass(frozen=True, slots=True)
class CampaignTruth:
    """True values of the simulated specimens, without noise."""

    simulated: bool
    """True if a program made the files."""
    design: str
    """Name of the design."""
    model: str
    """Model that computed it."""
    seed: int
    """Seed of the noise."""
    rate_Hz: float
    """Samples a second."""
    rest_s: float | None
    """Longest rest before each press; null: the protocol's."""
    parameters: Mapping[str, Mapping[str, Mapping[str, ParameterValue]]]
    """Parameters of the simulation by resin, part and name."""
    specimens: Mapping[str, SimulatedSpecimen]
    """Specimens by name."""
    populations: tuple[SimulatedPopulation, ...]
    """Figures of all sensors of one resin, age and driving pressure."""
    notes: tuple[str, ...]
    """Notes in words."""
