"""Designs for a target: ranked designs, a graded membrane, or the designs of several processes."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class SolidCheck:
    """The solid's figures of the design."""

    sensitivity_kPa_per_N: float | None
    """Slope of the pressure rise over the contact force, first contact to range end."""
    within_expanded_uncertainty: bool
    """True if the solid's sensitivity lies in the interval of the sensitivity stated."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FoundDesign:
    """A design that the search found."""

    material: str
    """Name of the membrane's resin or mix."""
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
    """Expanded uncertainty over the sensitivity; null: not known."""
    coverage_factor: float
    """Coverage factor of the expanded uncertainty."""
    place_uncertainty_relative: float | None = None
    """Relative standard uncertainty of the sensitivity by an unknown object and place of contact."""
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
    """Sensitivity without driving pressure and at the rated pressure; null: not known."""
    margins: Mapping[str, float | None]
    """Relative margin to each requirement and limit; negative: not kept; null: not known."""
    binding: str
    """Requirement or limit with the least margin, the sensitivity left out."""
    model: str
    """Model that computed it."""
    stiffness_at_1mm_N_per_mm: float | None = None
    """Slope of contact force over indentation at 1 mm; left out where the range ends before."""
    stiffness_at_3mm_N_per_mm: float | None = None
    """Slope of contact force over indentation at 3 mm; left out where the range ends before."""
    plate_sensitivity_kPa_per_N: float | None = None
    """Sensitivity by the atlas, under a plate without friction; left out if that is the contact."""
    rounds: int | None = None
    """Rounds of the search with the solid; left out without it."""
    solid: SolidCheck | None
    """The solid's figures of the design; null: not asked for."""
    set: tuple[str, ...]
    """Changes of the base design, TABLE.KEY=VALUE each."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RankedDesign(FoundDesign):
    """A design that meets the target, with its rank."""

    rank: int
    """Place in the order, from 1."""
    runner_up: bool
    """True if another design in this resin ranks higher."""
    passes_check: bool | None
    """True if it passes the print rules; null: not checked."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NearestDesign(FoundDesign):
    """The design that comes nearest to the target."""

    misses_percent: Mapping[str, float | None]
    """Distance from each requirement or limit that is missed, over its value; null: not known."""


@dataclass(frozen=True, slots=True)
class RejectedChoice:
    """A design that breaks a print rule, or cannot be drawn or predicted."""

    rule: str | None
    """Name of the rule; null: it cannot be drawn or predicted."""
    reason: str
    """Reason, in words."""
    design: FoundDesign
    """The design that is rejected."""


@dataclass(frozen=True, slots=True)
class DroppedChoice:
    """A requirement without which there would be a design."""

    requirement: str
    """Name of the requirement."""
    attainable: str
    """Value that could be reached instead, in words."""
    field: str | None
    """Field of the target to change, TABLE.KEY; null for the rated pressure."""
    value: float | None
    """Value of that field with which a design meets the target; null for the rated pressure."""
    design: FoundDesign
    """The best design without the requirement."""


@dataclass(frozen=True, slots=True)
class SingleChange:
    """A change of one field of the target with which a design meets it."""

    field: str
    """Field of the target, TABLE.KEY."""
    value: Any
    """Value to give it; for setting.assignments one TABLE.KEY=VALUE to be added."""
    design: FoundDesign
    """The best design found with it."""


@dataclass(frozen=True, slots=True)
class GaugeTrial:
    """A gauge that was tried for the target."""

    gauge: str
    """Name of the gauge."""
    title: str
    """Name of the gauge in words."""
    chosen: bool
    """True if it was chosen."""
    why: str
    """Reason for the choice or against it."""
    smallest_force_N: float | None
    """Smallest force that the best design detects with it; null: its noise is not known."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SelectionRecord:
    """Ranked designs for a target."""

    target: Mapping[str, Any]
    """The target."""
    base: str
    """Design, as given, that sets everything but what is searched."""
    dead_volume_note: str | None = None
    """Note on a stated dead volume that is an idealisation."""
    contact: Mapping[str, Any] | None = None
    """Object that presses the sensor; left out for a frictionless plate."""
    met: bool
    """True if the target is met."""
    candidates: int
    """Number of candidates that were computed."""
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
    """Name of the printer profile."""


@dataclass(frozen=True, slots=True)
class ProcessesRecord:
    """The designs of several processes for one target."""

    met: bool
    """True if a process meets the target."""
    processes: Mapping[str, ProcessRecord]
    """Selections by process."""
    left_out: Mapping[str, str]
    """Processes left out, and the reasons."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ShapeRecord:
    """The best design of a shape, with the figures of the solid."""

    shape: str
    """Shape of the dome."""
    material: str
    """Resin of the membrane."""
    inner_radius_mm: float
    """Inner radius at the base."""
    wall_thickness_mm: float
    """Wall."""
    sizes: Mapping[str, Any]
    """Sizes that the shape has besides radius and wall, by their key in a design file."""
    height_mm: float
    """Height of the unloaded dome over its flange."""
    footprint_mm: float
    """Diameter of the whole sensor, a port at its side left out."""
    driving_pressure_kPa: float
    """Gauge pressure before contact at which the figures hold."""
    rated_pressure_kPa: float
    """Greatest driving pressure to be used."""
    sensitivity_kPa_per_N: float
    """Slope of the pressure rise over the contact force, first contact to range end."""
    stiffness_N_per_mm: float
    """Mean stiffness over the range."""
    force_range_end_N: float
    """Contact force at the end of the range."""
    travel_mm: float
    """Travel of the plate from first contact to the end of the range."""
    ball_reading_ratio: float | None
    """Pressure rise under a ball of 5 mm radius over the plate's, at the greatest force that both reach; null: none."""


@dataclass(frozen=True, slots=True)
class ShapesRecord:
    """The best design of each shape for one target, best first."""

    met: bool
    """True if a shape meets the target."""
    designs: tuple[ShapeRecord, ...]
    """The best design of each shape."""
    missed: Mapping[str, str]
    """Shapes without a design, and the reasons."""
    left_out: Mapping[str, str]
    """Resins left out, and the reasons."""
    solves: int
    """Number of presses that the solid solved."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GradeFigures:
    """Figures of a membrane at the driving pressures of the target."""

    driving_pressures_kPa: tuple[float, ...]
    """Gauge pressures before contact."""
    sensitivity_kPa_per_N: tuple[float | None, ...]
    """Slope of the pressure rise over the contact force, first contact to range end."""
    difference_percent: float | None
    """Sensitivity at the last pressure over that at the first, less 100 %; null: not known."""
    force_range_end_N: tuple[float | None, ...]
    """Contact force at the end of the range; null: not known."""
    range_ends_with: tuple[str, ...]
    """Event that ends the range, or the depth."""
    rated_pressure_kPa: float | None
    """Greatest driving pressure to be used."""
    above_rated_pressure: bool
    """True if it is driven above its rated pressure."""
    meets: bool
    """True if it meets the target."""
    reason: str | None
    """Reason why there are no figures, in words; null: there are."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FoundGrade(GradeFigures):
    """The graded membrane that was found."""

    material: Mapping[str, Any]
    """Mix of the membrane, as a design file states it."""
    inner_radius_mm: float
    """Inner radius R0 of the unloaded dome."""
    wall_thickness_mm: float
    """Wall thickness t0 of the unloaded dome."""
    dead_volume_mL: float
    """Gas volume behind the cavity."""
    share_used: Mapping[str, float]
    """Share of each tolerance or limit that it uses; at most 1 where it is kept."""
    passes_check: bool | None
    """True if it passes the print rules; null: not checked."""
    set: tuple[str, ...]
    """Changes of the base design, TABLE.KEY=VALUE each."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ConstantMembrane(GradeFigures):
    """A membrane of the same mix, or resin, everywhere."""

    name: str
    """Name of the mix or resin."""
    fraction: float | None
    """Volume fraction of the stiff resin; null: a resin of the catalogue."""


@dataclass(frozen=True, slots=True)
class SearchCost:
    """Work that the search took."""

    solid_solves: int
    """Presses that were computed with the solid."""
    grades_tried: int
    """Grades that were tried."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GradedRecord:
    """A graded membrane for a target."""

    target: Mapping[str, Any]
    """The target."""
    base: str
    """Design, as given, that sets everything but what is searched."""
    contact: Mapping[str, Any] | None = None
    """Object that presses the sensor; left out for a frictionless plate."""
    met: bool
    """True if the target is met."""
    design: FoundGrade
    """The best grade."""
    rejected: str | None
    """Reason for which the print rules reject the grade; null: they do not."""
    constant: tuple[ConstantMembrane, ...]
    """Constant mixes, for comparison."""
    nearest_constant_mix: str
    """Name of the constant mix that comes nearest to the target."""
    cost: SearchCost
    """Work that the search took."""
    model: str
    """Model that computed it."""
    left_out: Mapping[str, str]
    """Resins left out, and the reasons."""
