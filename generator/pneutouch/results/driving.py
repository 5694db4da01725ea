"""Driving pressures for the tasks of a sensor, as the program states them."""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class UnknownLeak:
    """A leak that was not measured."""

    unknown: str
    """Reason why the leak is not known, and the tests that would measure it."""


@dataclass(frozen=True, slots=True)
class MeasuredLeak:
    """A measured leak."""

    rate_kPa_per_min: float
    """Fall of the pressure per minute."""
    at_kPa: float
    """Gauge pressure at which that fall was measured."""
    measured: str
    """Place or file of the measurement."""


@dataclass(frozen=True, slots=True)
class FigureReach:
    """Least and greatest value of a figure over the driving pressures, in the figure's unit, and where they lie."""

    low: float
    """Least value."""
    low_at_kPa: float
    """Driving pressure of the least value."""
    high: float
    """Greatest value."""
    high_at_kPa: float
    """Driving pressure of the greatest value."""
    rated_low: float | None = None
    """Least value up to the rated pressure."""
    rated_low_at_kPa: float | None = None
    """Driving pressure of that value."""
    rated_high: float | None = None
    """Greatest value up to the rated pressure."""
    rated_high_at_kPa: float | None = None
    """Driving pressure of that value."""


@dataclass(frozen=True, slots=True)
class PressureInterval:
    """Driving pressures at which the real sensor may have a figure, within its expanded uncertainty (k = 2)."""

    low_kPa: float
    """Lower end."""
    high_kPa: float
    """Upper end."""
    open_low: bool
    """True if it may lie below the lower end."""
    open_high: bool
    """True if it may lie above the upper end."""


@dataclass(frozen=True, slots=True)
class TaskSolution:
    """A driving pressure that meets a task, and the sensor there."""

    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    band: PressureInterval | None
    """Pressures at which the real sensor may meet it; null: not known."""
    above_rating: bool
    """True if it is above the rated pressure."""
    apex_height_outer_mm: float
    """Apex height of the outer surface, inflated, before contact."""
    cavity_volume_mL: float
    """Gas under the inflated dome, before contact."""
    sensitivity_kPa_per_N: float
    """Slope of the pressure rise over the contact force, first contact to range end."""
    stiffness_N_per_mm: float
    """Mean slope of contact force over indentation, first contact to range end."""
    force_range_N: float
    """Contact force at the end of the range."""


@dataclass(frozen=True, slots=True)
class TaskGas:
    """The sealed gas of a task: its volume, and what changes its pressure."""

    injected_mL: float
    """Air at ambient pressure to be injected into the vented sensor."""
    moved_mL: float
    """Air at ambient pressure to be injected, coming from the task before; negative: let out."""
    by_temperature_kPa_per_K: float
    """Change of the sealed pressure with temperature."""
    figure_by_temperature_percent_per_K: float | None
    """Change of the figure with temperature; null: the pressure is at a jump of the figure."""
    figure_by_pressure_percent_per_kPa: float | None
    """Change of the figure with the driving pressure; null: the pressure is at a jump of the figure."""
    hold_percent: float
    """Change of the figure that counts as held."""
    step_kPa: float | None
    """Change of the driving pressure that changes the figure by hold_percent; null: an extremum or a jump."""
    loss_kPa_per_min: float | None
    """Fall of the pressure by the leak; null: the leak is not known."""
    hold_s: float | None
    """Time in which the leak changes the figure by hold_percent; null: not known, or never."""


@dataclass(frozen=True, slots=True)
class OfflineChange:
    """A change of one input of the design by which a task comes nearer to being met."""

    what: str
    """Name of the input, with its unit."""
    before: float
    """Value of the design."""
    after: float
    """Value that is needed."""
    predicted: float
    """The required figure with that change, by the model."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TaskRecord:
    """A task of a design."""

    task: str | None
    """Name of the task; null: it has none."""
    requirement: str
    """Key of the required figure."""
    value: float
    """Required value, in the unit of the key."""
    reached: bool
    """True if a driving pressure meets the task."""
    solutions: tuple[TaskSolution, ...]
    """Driving pressures that meet it, the preferred one first."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ReachedTask(TaskRecord):
    """A task that a driving pressure meets."""

    gas: TaskGas
    """Gas of the preferred solution."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MissedTask(TaskRecord):
    """A task that no driving pressure meets."""

    possible_band: PressureInterval | None
    """Pressures at which the real sensor may still meet it, by its uncertainty; null: there are none."""
    offline: tuple[OfflineChange, ...]
    """Changes of the design, one input each, that bring the figure nearer to the value, the least first."""


@dataclass(frozen=True, slots=True)
class DrivingRecord:
    """The driving pressures for the tasks of a design."""

    design: str
    """Name of the design."""
    model: str
    """Model that computed it."""
    rated_pressure_kPa: float
    """Greatest driving pressure to be used."""
    highest_kPa: float
    """Highest driving pressure that was computed."""
    limit: str
    """Limit of the driving pressure that is met first."""
    is_fitted: bool
    """True if a calibration can cover the sensor."""
    is_calibrated: bool
    """True if the sensor is predicted with a calibration."""
    dead_volume_mL: float
    """Gas volume behind the cavity."""
    ambient_pressure_kPa: float
    """Absolute pressure around the sensor."""
    temperature_C: float
    """Temperature of the gas."""
    leak: MeasuredLeak | UnknownLeak
    """Leak of the sensor."""
    reach: Mapping[str, FigureReach | None]
    """Reach of the driving pressure by figure; null: the figure is not known at any."""
    tasks: tuple[ReachedTask | MissedTask, ...]
    """Tasks in their order."""
