"""Designs for a target: ranked, a grade for one, or those of several processes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class SolidCheck:
    """The solid's figures of the design."""

    sensitivity_kPa_per_N: float | None
    """Slope of the pressure rise over the contact force, first contact to range end."""
    within_expanded_uncertainty: bool
    """True if the solid's sensitivity lies in the interval."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FoundDesign:
    """A design that was found."""

    material: str
    """Material of the membrane."""
    mix: Mapping[str, Any] | None
    """Mix of two base resins; null: a resin."""
    inner_radius_mm: float
    """Inner radius R0 of the unloaded dome."""
    wall_thickness_mm: float
    """Wall thickness t0 of the unloaded dome."""
    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    outer_diameter_mm: float
    """Outer diameter of the unloaded dome."""
    footprint_mm: float
    """Greatest diameter of the whole sensor."""
    dead_volume_mL: float
    """Gas volume behind the cavity."""
    sensitivity_kPa_per_N: float
    """Slope of the pressure rise over the contact force, first contact to range end."""
    expanded_uncertainty_kPa_per_N: float | None
    """Expanded uncertainty of the sensitivity; null: not known."""
    expanded_uncertainty_relative: float | None
    """The same over the sensitivity."""
    coverage_factor: float
    """Coverage factor of the intervals."""
    place_uncertainty_relative: float | None = None
    """Uncertainty by object and place of contact."""
    r_squared: float
    """Coefficient of determination of the straight line."""
    force_range_N: tuple[float, float]
    """Least and greatest contact force of the range."""
    range_end_mm: float
    """Indentation up to which the figures hold."""
    range_ends_with: str
    """Event that ends the range, or the depth."""
    stiffness_N_per_mm: float
    """Mean slope of contact force over indentation, first contact to range end."""
    limit_point_kPa: float
    """Driving pressure of the limit point."""
    rated_pressure_kPa: float
    """Greatest driving pressure to be used."""
    above_rated_pressure: bool
    """True if it is driven above its rated pressure."""
    sensitivity_at_0kPa_and_rated_kPa_per_N: tuple[float | None, ...]
    """Sensitivity without driving pressure and at the rated pressure."""
    margins: Mapping[str, float | None]
    """Margins to each requirement, as shares; negative: not met."""
    binding: str
    """Limit that is met first."""
    model: str
    """Model that computed it."""
    plate_sensitivity_kPa_per_N: float | None = None
    """Sensitivity under the atlas's plate."""
    rounds: int | None = None
    """Rounds of the search."""
    solid: SolidCheck | None
    """The solid's figures of the design; null: not asked for."""
    set: tuple[str, ...]
    """Changes of the base design, TABLE.KEY=VALUE each."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RankedDesign(FoundDesign):
    """A design."""

    rank: int
    """Place in the order, from 1."""
    runner_up: bool
    """True if a design of this resin stands before it."""
    passes_check: bool | None
    """True if it passes the print rules; null: not checked."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NearestDesign(FoundDesign):
    """Design nearest to the target."""

    misses_percent: Mapping[str, float | None]
    """Distance from each requirement that is missed; null: not known."""


@dataclass(frozen=True, slots=True)
class RejectedChoice:
    """A design that breaks a rule."""

    rule: str | None
    """Name of the rule; null: it cannot be drawn or predicted."""
    reason: str
    """Reason, in words."""
    design: FoundDesign
    """The design."""


@dataclass(frozen=True, slots=True)
class DroppedChoice:
    """A requirement without which there would be a design."""

    requirement: str
    """The requirement."""
    attainable: str
    """Value that could be reached instead, in words."""
    field: str | None
    """Field of the target to change for it, TABLE.KEY; null for the rated pressure."""
    value: float | None
    """Its value; null for the rated pressure."""
    design: FoundDesign
    """The best design."""


@dataclass(frozen=True, slots=True)
class SingleChange:
    """A change of one field of the target with which a design meets it."""

    field: str
    """Field of the target, TABLE.KEY."""
    value: Any
    """Its value; for setting.assignments one TABLE.KEY=VALUE, besides those that are there."""
    design: FoundDesign
    """The best design found with it."""


@dataclass(frozen=True, slots=True)
class GaugeTrial:
    """A gauge that was tried."""

    gauge: str
    """Name of the gauge."""
    title: str
    """Title."""
    chosen: bool
    """True if it was chosen."""
    why: str
    """Reason."""
    smallest_force_N: float | None
    """Smallest force that the best design detects with it; null: its noise is not known."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SelectionRecord:
    """Ranked designs."""

    target: Mapping[str, Any]
    """The target."""
    base: str
    """The design that gives everything else."""
    dead_volume_note: str | None = None
    """Note on a stated dead volume that is an idealisation."""
    contact: Mapping[str, Any] | None = None
    """Object that presses the sensor; left out for a frictionless plate."""
    met: bool
    """True if the target is met."""
    candidates: int
    """Number of candidates."""
    designs: tuple[RankedDesign, ...]
    """Designs, the best first."""
    nearest: NearestDesign | None
    """The design that misses least if none meets the target; else null."""
    dropped_requirements: tuple[DroppedChoice, ...]
    """Requirements without which there would be a design."""
    single_changes: tuple[SingleChange, ...]
    """Changes outside the requirements, each of which alone makes a design possible."""
    rejected: tuple[RejectedChoice, ...]
    """Designs that a print rule refuses."""
    left_out: Mapping[str, str]
    """Resins left out, and the reasons."""
    gauges: tuple[GaugeTrial, ...] = ()
    """Gauges that were tried."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessRecord(SelectionRecord):
    """Ranked designs of one process."""

    profile: str
    """The printer profile."""


@dataclass(frozen=True, slots=True)
class ProcessesRecord:
    """The designs of several processes."""

    met: bool
    """True if the target is met."""
    processes: Mapping[str, ProcessRecord]
    """Selections by process."""
    left_out: Mapping[str, str]
    """Processes left out, and the reasons."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GradeFigures:
    """Figures of a membrane at the driving pressures of the target."""

    driving_pressures_kPa: tuple[float, ...]
    """Gauge pressures before contact."""
    sensitivity_kPa_per_N: tuple[float | None, ...]
    """Slope of the pressure rise over the contact force, first contact to range end."""
    difference_percent: float | None
    """Difference of the sensitivities."""
    force_range_end_N: tuple[float | None, ...]
    """Contact force at the end of the range."""
    range_ends_with: tuple[str, ...]
    """Event that ends the range, or the depth."""
    rated_pressure_kPa: float | None
    """Greatest driving pressure to be used."""
    above_rated_pressure: bool
    """True if it is driven above its rated pressure."""
    meets: bool
    """True if it meets the target."""
    reason: str | None
    """Reason, in words; null: nothing to state."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FoundGrade(GradeFigures):
    """The grade."""

    material: Mapping[str, Any]
    """Material of the membrane."""
    inner_radius_mm: float
    """Inner radius R0 of the unloaded dome."""
    wall_thickness_mm: float
    """Wall thickness t0 of the unloaded dome."""
    dead_volume_mL: float
    """Gas volume behind the cavity."""
    share_used: Mapping[str, float]
    """Share of each tolerance or limit that is used; at most 1 where it is kept."""
    passes_check: bool | None
    """True if it passes the print rules; null: not checked."""
    set: tuple[str, ...]
    """Changes of the base design, TABLE.KEY=VALUE each."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ConstantMembrane(GradeFigures):
    """A constant mix."""

    name: str
    """Name."""
    fraction: float | None
    """Volume fraction of the stiff resin."""


@dataclass(frozen=True, slots=True)
class SearchCost:
    """Work done."""

    solid_solves: int
    """Presses that the solid solved."""
    grades_tried: int
    """Grades that were tried."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GradedRecord:
    """A graded membrane."""

    target: Mapping[str, Any]
    """The target."""
    base: str
    """The design that gives everything else."""
    contact: Mapping[str, Any] | None = None
    """Object that presses the sensor; left out for a frictionless plate."""
    met: bool
    """True if the target is met."""
    design: FoundGrade
    """The best grade."""
    rejected: str | None
    """Reason for which the print rules refuse it; null: they do not."""
    constant: tuple[ConstantMembrane, ...]
    """Constant mixes, for comparison."""
    nearest_constant_mix: str
    """The constant mix that comes nearest."""
    cost: SearchCost
    """Work done."""
    model: str
    """Model that computed it."""
    left_out: Mapping[str, str]
    """Resins left out, and the reasons."""
