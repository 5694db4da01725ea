"""A measurement campaign before it is measured: its runs, their steps and the expected readings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from pneutouch.results.prediction import RatingRecord
from pneutouch.spec.campaign import RunKind


@dataclass(frozen=True, slots=True)
class PlannedStep:
    """One step of rig or hand."""

    action: str
    """Step of rig or hand."""
    value: float | None
    """Value that it sets; null: it sets none."""
    unit: str
    """Unit of the value."""
    seconds: float
    """Time that it takes, s."""


@dataclass(frozen=True, slots=True)
class ExpectedPoint:
    """A depth; the readings are null beyond the predicted range."""

    depth_mm: float
    """Plate travel after first contact."""
    force_N: float | None
    """Contact force; null beyond the predicted range."""
    pressure_rise_kPa: float | None
    """Cavity pressure less driving pressure."""
    cavity_pressure_kPa: float | None
    """Gauge pressure in the cavity."""


@dataclass(frozen=True, slots=True)
class InjectedVolume:
    """A volume of air that is pushed into the sensor."""

    volume_mL: float
    """Volume."""
    pressure_kPa: float
    """Pressure that is read."""
    without_dead_volume_kPa: float
    """Pressure if there were no dead volume."""
    with_more_dead_volume_kPa: float
    """Pressure with more dead volume."""


@dataclass(frozen=True, slots=True)
class PlannedInjection:
    """Air to inject, and the expected readings."""

    dead_volume_mL: float
    """Gas volume behind the cavity."""
    cavity_volume_mL: float
    """Gas under the inflated dome, before contact."""
    sensor_volume_mL: float | None
    """Air to be injected into the sensor; null: none of the round volumes fits."""
    sensor: tuple[InjectedVolume, ...]
    """Volumes that are pushed into the sensor in turn."""
    more_dead_volume_mL: float
    """Dead volume that is added."""
    line_volume_mL: float | None
    """Air to be injected into the line alone."""
    line_pressure_kPa: float | None
    """Pressure of the line alone after that volume."""


@dataclass(frozen=True, slots=True)
class PlannedState:
    """One driving pressure."""

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
    """Name of its material."""
    model: str
    """Model that computed it."""
    states: tuple[PlannedState, ...]
    """One entry a driving pressure."""
    injection: PlannedInjection
    """Injection of air, which gives the dead volume."""
    limit_kPa: float
    """Limit of the pressure."""
    limit_by: str
    """Limit that is met first."""
    rating: RatingRecord
    """Rated pressure and what it follows from."""
    leak_limit_kPa_per_min: float | None
    """Leak that is allowed."""


@dataclass(frozen=True, slots=True)
class PlannedTest:
    """A kind of run."""

    depths_mm: tuple[float, ...]
    """Plate travels."""
    hold_s: float
    """Hold at each travel."""
    rest_s: float
    """Rest before each press."""
    reset: bool
    """True if the pressure is set again before each press."""
    speed_mm_per_s: float
    """Speed of the plate."""
    duration_s: float
    """Time that it takes."""
    driving_pressures_kPa: tuple[float, ...]
    """Gauge pressures before contact."""
    runs: int
    """Number of runs at each pressure."""


@dataclass(frozen=True, slots=True)
class PlannedRun:
    """A run."""

    number: int
    """Number of the run in the plan."""
    kind: RunKind
    """Kind."""
    sensor: str
    """Name of the specimen."""
    resin: str
    """Name of its material."""
    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    run: int
    """Number of the repetition."""
    file: str
    """Path of the file."""
    steps: tuple[PlannedStep, ...]
    """Steps in order."""
    expected: tuple[ExpectedPoint, ...]
    """Expected readings, one entry a depth."""
    duration_s: float
    """Time that it takes."""


@dataclass(frozen=True, slots=True)
class PlannedSpecimen:
    """A specimen."""

    sensor: str
    """Name of the specimen."""
    resin: str
    """Name of its material."""


@dataclass(frozen=True, slots=True)
class PlanViolation:
    """Part of the plan that exceeds the rig or the sensor."""

    rule: str
    """Name of the rule."""
    message: str
    """In words."""
    resin: str
    """Name of its material; empty: every one."""
    driving_pressure_kPa: float | None
    """Gauge pressure before contact."""
    depth_mm: float | None
    """Plate travel after first contact."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannedCampaign:
    """A measurement campaign, run by run."""

    name: str
    """Name."""
    design: str
    """Name of the design."""
    title: str
    """Title."""
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
    """Distance of the plate before each press."""
    plate_diameter_mm: float
    """Diameter of the flat plate."""
    rig: Mapping[str, Any]
    """The rig."""
    sensors: tuple[PlannedSpecimen, ...]
    """Specimens."""
    resins: tuple[PlannedResin, ...]
    """Expected readings of each resin."""
    tests: Mapping[str, PlannedTest]
    """Kinds of runs by name."""
    runs: tuple[PlannedRun, ...]
    """Runs."""
    total_s: float
    """Time of the whole campaign."""
    warnings: tuple[PlanViolation, ...]
    """Parts where the rig cannot follow."""
    folder: str | None = None
    """Folder that it was written to; only in the output of the command."""
