"""True values of a simulated campaign."""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ParameterValue:
    """A parameter of the simulation."""

    value: float | tuple[float, ...] | None
    """Value of the parameter; null: infinite."""
    unit: str
    """Unit of the value."""
    reason: str
    """Reason for the value."""


@dataclass(frozen=True, slots=True)
class SimulatedSpecimen:
    """A simulated specimen and its true values."""

    resin: str
    """Name of the membrane's resin."""
    age_days: float
    """Age of the print."""
    shear_modulus_MPa: float
    """Shear modulus of the wall."""
    pressures: Mapping[str, Mapping[str, float | str | None]]
    """Figures without noise, and end of the range, by driving pressure in kPa."""
    wall_thickness_mm: float
    """True wall thickness of the unloaded dome."""
    dead_volume_mL: float
    """Gas volume behind the cavity."""
    model: str
    """Model that computed it."""


@dataclass(frozen=True, slots=True)
class SimulatedPopulation:
    """All possible sensors of one resin and age at one driving pressure."""

    resin: str
    """Name of the membrane's resin."""
    age_days: float
    """Age of the print."""
    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    figures: Mapping[str, float | None]
    """Mean figures over the specimens that were drawn; null: not known."""
    spread: Mapping[str, float]
    """Standard deviation of each figure over these specimens."""
    count: int
    """Number of these specimens."""
    basis: str
    """Derivation of the figures, in words."""


@dataclass(frozen=True, slots=True)
class CampaignTruth:
    """True values of the simulated specimens, without noise."""

    simulated: bool
    """True: a program made the files."""
    design: str
    """Name of the design."""
    model: str
    """Model that presses the specimens, as it was asked for."""
    seed: int
    """Seed of scatter and noise."""
    rate_Hz: float
    """Samples a second."""
    rest_s: float | None
    """Longest rest before each press; null: the protocol's."""
    parameters: Mapping[str, Mapping[str, Mapping[str, ParameterValue]]]
    """Parameters of the simulation by resin, part of the simulation, and name."""
    specimens: Mapping[str, SimulatedSpecimen]
    """True values of the specimens by name."""
    populations: tuple[SimulatedPopulation, ...]
    """Figures of all possible sensors of one resin and age at one driving pressure."""
    notes: tuple[str, ...]
    """Notes in words."""
