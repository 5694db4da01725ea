"""A measurement campaign before it is measured: its runs, their steps and the expected readings."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from pneutouch.results.prediction import RatingRecord
from pneutouch.spec.campaign import RunKind


@dataclass(frozen=True, slots=True)
class PlannedStep:
    """One step of a run, by rig or hand."""

    action: str
    """Name of the step, such as move or wait."""
    value: float | None
    """Value that it sets; null: it sets none."""
    unit: str
    """Unit of the value; empty without one."""
    seconds: float
    """Time that it takes, s."""


@dataclass(frozen=True, slots=True)
class ExpectedPoint:
    """The readings expected at a depth; null beyond the predicted range."""

    depth_mm: float
    """Plate travel after first contact."""
    force_N: float | None
    """Contact force; null beyond the predicted range."""
    pressure_rise_kPa: float | None
    """Cavity pressure less driving pressure; null beyond the predicted range."""
    cavity_pressure_kPa: float | None
    """Gauge pressure in the cavity; null beyond the predicted range."""


@dataclass(frozen=True, slots=True)
class InjectedVolume:
    """A volume of air that is pushed into the vented sensor, and the pressures that it gives."""

    volume_mL: float
    """Volume of room air, in all."""
    pressure_kPa: float
    """Expected gauge pressure, with the dead volume of the design."""
    without_dead_volume_kPa: float
    """Pressure if there were no dead volume."""
    with_more_dead_volume_kPa: float
    """Pressure if more_dead_volume_mL were added to the dead volume."""


@dataclass(frozen=True, slots=True)
class PlannedInjection:
    """Air to inject, and the expected readings."""

    dead_volume_mL: float
    """Gas volume behind the cavity."""
    cavity_volume_mL: float
    """Gas under the unloaded dome."""
    sensor_volume_mL: float | None
    """Air to be injected into the sensor, in all; null: no round volume fits."""
    sensor: tuple[InjectedVolume, ...]
    """Volumes that are pushed into the sensor in turn; empty: none fits."""
    more_dead_volume_mL: float
    """Dead volume that is added in with_more_dead_volume_kPa."""
    line_volume_mL: float | None
    """Air to be injected into the closed line alone; null: no round volume fits."""
    line_pressure_kPa: float | None
    """Pressure of the line alone after that volume; null: none is injected."""


@dataclass(frozen=True, slots=True)
class PlannedState:
    """Expected readings at one driving pressure."""

    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    points: tuple[ExpectedPoint, ...]
    """Expected readings, one entry a depth."""
    range_end_mm: float
    """Indentation up to which the figures hold."""
    range_ends_by: str | None
    """Event that ends the range; null: the depth."""


@dataclass(frozen=True, slots=True)
class PlannedResin:
    """Expected readings of one resin."""

    resin: str
    """Name of the membrane's resin."""
    model: str
    """Model that computed the readings."""
    states: tuple[PlannedState, ...]
    """One entry a driving pressure."""
    injection: PlannedInjection
    """Injection of air, which measures the dead volume."""
    limit_kPa: float
    """Least limit of the driving pressure."""
    limit_by: str
    """Name of that limit."""
    rating: RatingRecord
    """Rated pressure and what it follows from."""
    leak_limit_kPa_per_min: float | None
    """Greatest leak that is allowed; null: not known."""


@dataclass(frozen=True, slots=True)
class PlannedTest:
    """A kind of run: its movements, driving pressures and repetitions."""

    depths_mm: tuple[float, ...]
    """Plate travels after first contact at which the plate stops, in order."""
    hold_s: float
    """Hold at each travel."""
    rest_s: float
    """Rest before each press."""
    reset: bool
    """True if the pressure is set again before each press."""
    speed_mm_per_s: float
    """Speed of the plate."""
    duration_s: float
    """Time that one run takes."""
    driving_pressures_kPa: tuple[float, ...]
    """Gauge pressures before contact."""
    runs: int
    """Number of runs at each pressure."""


@dataclass(frozen=True, slots=True)
class PlannedRun:
    """A run of the plan."""

    number: int
    """Number of the run in the plan."""
    kind: RunKind
    """Kind of the run."""
    sensor: str
    """Name of the specimen."""
    resin: str
    """Name of the membrane's resin."""
    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    run: int
    """Number of the repetition."""
    file: str
    """Path of the file to be measured."""
    steps: tuple[PlannedStep, ...]
    """Steps in order."""
    expected: tuple[ExpectedPoint, ...]
    """Expected readings, one entry a depth."""
    duration_s: float
    """Time that the run takes."""


@dataclass(frozen=True, slots=True)
class PlannedSpecimen:
    """A specimen of the plan."""

    sensor: str
    """Name of the specimen."""
    resin: str
    """Name of the membrane's resin."""


@dataclass(frozen=True, slots=True)
class PlanViolation:
    """Part of the plan that exceeds the rig or the sensor."""

    rule: str
    """Name of the rule."""
    message: str
    """Problem, in words."""
    resin: str
    """Name of the membrane's resin; empty: every one."""
    driving_pressure_kPa: float | None
    """Gauge pressure before contact; null: every one."""
    depth_mm: float | None
    """Plate travel after first contact."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannedCampaign:
    """A measurement campaign, run by run."""

    name: str
    """Name of the plan."""
    design: str
    """Name of the design."""
    title: str
    """Title of the design."""
    inner_radius_mm: float
    """Inner radius R0 of the unloaded dome."""
    wall_thickness_mm: float
    """Wall thickness t0 of the unloaded dome."""
    ambient_pressure_kPa: float
    """Absolute pressure around the sensor."""
    driving_pressures_kPa: tuple[float, ...]
    """Gauge pressures before contact."""
    dead_volume_mL: float
    """Gas volume behind the cavity."""
    dead_volume_note: str | None = None
    """Note on a stated dead volume that is an idealisation."""
    contact: Mapping[str, Any] | None = None
    """Object that presses the sensor; left out for a frictionless plate."""
    clearance_mm: float
    """Distance between plate and dome before and after each press."""
    plate_diameter_mm: float
    """Diameter of the flat plate."""
    rig: Mapping[str, Any]
    """Abilities of the rig, and the file that states them."""
    sensors: tuple[PlannedSpecimen, ...]
    """Specimens to be measured."""
    resins: tuple[PlannedResin, ...]
    """Expected readings of each resin."""
    tests: Mapping[str, PlannedTest]
    """Kinds of runs by name."""
    runs: tuple[PlannedRun, ...]
    """Runs in order."""
    total_s: float
    """Time of the whole campaign."""
    warnings: tuple[PlanViolation, ...]
    """Parts that the rig or the sensor cannot follow."""
    folder: str | None = None
    """Folder that it was written to; only in the output of the command."""
