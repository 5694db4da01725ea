"""Accuracy by which readings at several driving pressures tell an object and its force."""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ToldObject:
    """An object pressed by a force, and how well it is told; intervals hold 95 % of the posterior probability."""

    object: str
    """The object in words."""
    ball_radius_mm: float | None
    """Radius of the ball; null: a plate or a block."""
    modulus_MPa: float | None
    """Modulus of the block; null: a rigid object."""
    force_N: float
    """Force that presses it."""
    force_half_width_percent: float
    """Half of the interval of the force, over the force, by all readings."""
    curvature_interval_per_mm: tuple[float, float] | None
    """Interval of the curvature, by all readings; null: the modulus is told."""
    compliance_interval_per_MPa: tuple[float, float] | None
    """Interval of the inverse of the modulus, by all readings; null: the radius is told."""
    area_ratio: float
    """Area of the 95 % region of force and object by all readings, over that by the best single pressure of all."""
    force_ratio: float
    """Width of the interval of the force by all readings, over that by the best single pressure of all."""
    correlation: float
    """Correlation of the logarithm of the force and curvature or compliance, by all readings; near +-1: confounded."""


@dataclass(frozen=True, slots=True)
class PlannedReading:
    """A set of driving pressures and what it tells."""

    driving_pressures_kPa: tuple[float, ...]
    """Driving pressures, one for each reading."""
    area_ratio: float
    """Mean area of the 95 % region over that of the best single pressure; geometric mean over objects and forces."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DiscriminationRecord:
    """Readings of plates, balls or soft blocks, pressed centrally by an unknown force, at several driving pressures."""

    design: str
    """Name of the design."""
    driving_pressures_kPa: tuple[float, ...]
    """Driving pressures of the readings."""
    noise_kPa: float
    """Standard deviation of a pressure rise that is read."""
    error_percent: float
    """Standard deviation of the errors of the sensor that readings do not share, over the rise."""
    least_radius_mm: float | None
    """Radius of the smallest ball that may press; null: blocks press."""
    least_modulus_MPa: float | None
    """Modulus of the softest block that may press; null: balls press."""
    travel_noise_mm: float | None
    """Standard deviation of a travel that is read; null: none is."""
    greatest_force_N: float
    """Greatest force that every reading holds under a plate."""
    told: tuple[ToldObject, ...]
    """Objects and forces."""
    area_ratio: float
    """Geometric mean of the area ratios of all."""
    best_single_kPa: float
    """Driving pressure that tells most by itself."""
    classes: tuple[str, ...]
    """Objects that are to be told apart, in words."""
    confusion: tuple[tuple[float, ...], ...]
    """Probability that an object (row) is told as another (column), by all readings, its force being unknown."""
    confusion_single: tuple[tuple[float, ...], ...]
    """The same by the best single reading."""
    plan: PlannedReading | None
    """Driving pressures that tell most; null: none were planned."""
    assumptions: Mapping[str, str]
    """Assumptions by subject."""
