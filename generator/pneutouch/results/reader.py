"""A reader of force from the pressure of one sensor, and a sensor's model for a simulator."""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ForceTable:
    """Pressure rise and contact force over driving pressures (rows) and equal shares of the indentation (columns)."""

    driving_pressure_kPa: tuple[float, ...]
    """Gauge pressure before contact, equal steps, one a row; rows below zero serve other conditions alone."""
    pressure_rise_kPa: tuple[tuple[float, ...], ...]
    """Gauge pressure less driving pressure, one list a row; ascending along a row from 0."""
    contact_force_N: tuple[tuple[float, ...], ...]
    """Force at these rises, one list a row; ascending along a row from 0."""
    indentation_mm: tuple[float, ...]
    """Indentation of the last column, by row."""
    pressure_factor: tuple[float, ...]
    """Pressure rise of the sensor over that of the gas law, by row: 1 without a calibration."""
    force_uncertainty_relative: tuple[tuple[float, ...], ...] | None
    """Relative standard uncertainty (k = 1) of the force, without the gauge's noise, by row; null: unknown."""
    force_uncertainty_unknown: str | None
    """Reason why the uncertainty is unknown; null: it is known."""
    force_uncertainty_age_days: float
    """Time since the calibration, else since the print, whose ageing the uncertainty counts."""


@dataclass(frozen=True, slots=True)
class GasTable:
    """Gas volume without contact, over the driving pressure."""

    driving_pressure_kPa: tuple[float, ...]
    """Gauge pressure before contact, equal steps."""
    volume_mL: tuple[float, ...]
    """Cavity and dead volume at these pressures."""


@dataclass(frozen=True, slots=True)
class ReaderBox:
    """Bounds of the readings that hold; outside a reader returns a status in place of a force."""

    driving_pressure_kPa: tuple[float, ...]
    """Least and greatest driving pressure."""
    driving_pressure_margin_kPa: float
    """Distance below the least driving pressure within which one still counts as inside."""
    contact_force_N: tuple[float, float]
    """Zero, and the greatest force over all driving pressures; at one of them it ends with the row."""
    pressure_rise_kPa: tuple[float, float]
    """Zero, and the greatest pressure rise over all driving pressures."""
    indentation_mm: tuple[float, float]
    """Zero, and the greatest indentation over all driving pressures."""
    ambient_pressure_kPa: tuple[float, ...]
    """Least and greatest ambient pressure, absolute."""
    temperature_change_K: float
    """Greatest change of the gas temperature since the tare, up or down. The wall is taken as unchanged."""


@dataclass(frozen=True, slots=True)
class ReaderRating:
    """The rated pressure."""

    driving_pressure_kPa: float
    """Greatest driving pressure to be used."""
    basis: str
    """Derivation of the rated pressure, in words."""


@dataclass(frozen=True, slots=True)
class ReadGauge:
    """The gauge whose pressure is read."""

    name: str | None
    """Gauge of the design; null: none is named."""
    range_kPa: tuple[float, ...]
    """Least and greatest gauge pressure that it reads; outside it is saturated."""


@dataclass(frozen=True, slots=True)
class ZeroDrift:
    """Bounds of the drift of the zero that a reader follows."""

    drift_kPa_per_K: float
    """Drift of the sealed gas without contact; the greatest of the box."""
    temperature_rate_K_per_h: float
    """Fastest change of the air's temperature."""
    drift_rate_kPa_per_s: float
    """Drift at that fastest change: a faster change of the pressure is no drift."""
    drift_most_kPa: float
    """Greatest drift since the tare that is followed."""
    noise_least_kPa: float
    """Noise that the gauge is taken to have at least."""
    noise_most_kPa: float
    """Scatter of readings without contact up to which they count as a tare."""
    filter_s: float
    """Time constant of the mean that is compared with the zero."""


@dataclass(frozen=True, slots=True)
class ReaderConditions:
    """Object and conditions for which the table of the force was computed."""

    driving_pressures_kPa: tuple[float, ...]
    """Driving pressures of the design."""
    ambient_pressure_kPa: float
    """Absolute pressure around the sensor."""
    dead_volume_mL: float
    """Gas volume behind the cavity."""
    contact: str
    """Object that presses the sensor, and its place: under another one the force read is wrong."""
    assumptions: tuple[str, ...]
    """Assumptions, in sentences."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ReaderTables:
    """Tables, box and conditions of a reader."""

    design: str
    """Name of the design."""
    calibration: str | None
    """Name of the calibration; null: the design as drawn."""
    model: str
    """Model that computed the table of the force."""
    units: Mapping[str, str]
    """Units by quantity."""
    grid: ForceTable
    """Table of the force."""
    gas: GasTable
    """Table of the gas."""
    box: ReaderBox
    """Bounds of the readings that hold."""
    rating: ReaderRating
    """Rated pressure."""
    gauge: ReadGauge
    """Gauge that is read."""
    zero: ZeroDrift
    """Drift of the zero that is followed."""
    conditions: ReaderConditions
    """Object and conditions for which the table of the force was computed."""


@dataclass(frozen=True, slots=True)
class TableError:
    """Largest difference of the force read from the full model, at random states between those of the table."""

    nominal_N: float
    """Difference under the conditions of the tare."""
    nominal_percent: float
    """The same difference over full scale."""
    other_conditions_N: float
    """Difference at other temperatures of the gas and other ambient pressures."""
    other_conditions_percent: float
    """The same difference over full scale."""
    states: int
    """Number of states compared under the conditions of the tare."""


@dataclass(frozen=True, slots=True)
class ReaderSource:
    """Inputs and program that a reader was made from."""

    sha256: str
    """Digest of the design with all that it names, the calibration, the options and the version."""
    version: str
    """Version of the program."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ReaderRecord(ReaderTables):
    """A reader: the contact force from the gauge pressure of one sensor."""

    difference: TableError
    """Largest difference of the force read from the full model."""
    source: ReaderSource
    """Inputs and program that it was made from."""


@dataclass(frozen=True, slots=True)
class SimulatedState:
    """A driving pressure of a sensor in a simulator."""

    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    apex_height_outer_mm: float
    """Apex height of the outer surface, inflated, before contact."""
    range_end_mm: float
    """Indentation up to which the figures hold."""
    contact_force_N: float
    """Force at that indentation."""
    pressure_kPa: float
    """Gauge pressure at that indentation."""
    greatest_stiffness_N_per_mm: float
    """Greatest slope of the force over the indentation."""


@dataclass(frozen=True, slots=True)
class SimulatorRecord:
    """A sensor written as a model for a simulator."""

    design: str
    """Name of the design."""
    simulator: str
    """Format of the model: mujoco or urdf."""
    model: str
    """Model that computed it."""
    version: str
    """Version of the program."""
    mass_g: float
    """Mass of the sensor."""
    centre_of_mass_mm: tuple[float, ...]
    """Centre of mass in the design frame."""
    inertia_about_centre_g_mm2: tuple[tuple[float, ...], ...]
    """Inertia tensor about the centre of mass, row by row."""
    states: tuple[SimulatedState, ...]
    """One entry a driving pressure."""


@dataclass(frozen=True, slots=True)
class DomePress:
    """The press at one driving pressure, lists of one length over the indentation; lengths in m, pressures in kPa."""

    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    apex_m: float
    """Apex height of the outer surface, inflated, before contact."""
    indentation_m: tuple[float, ...]
    """Travel of the object after first contact."""
    force_N: tuple[float, ...]
    """Force on the object."""
    force_slope_N_per_m: tuple[float, ...]
    """Slope of the force over the indentation."""
    pressure_kPa: tuple[float, ...]
    """Gauge pressure in the cavity."""
    pressure_slope_kPa_per_m: tuple[float, ...]
    """Slope of the pressure over the indentation."""


@dataclass(frozen=True, slots=True)
class DomeTable:
    """Table of the module that applies the force of the dome to a joint of a simulator."""

    name: str
    """Name of the design."""
    radius_m: float
    """Radius of the sphere that stands for the dome."""
    inertia_share: float
    """Inertia of the joint over greatest stiffness times time step squared."""
    damping_share: float
    """Damping of the joint over greatest stiffness times time step."""
    states: tuple[DomePress, ...]
    """One entry a driving pressure."""
