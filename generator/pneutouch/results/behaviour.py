"""Behaviour of a sensor beside its static figures: gauge, relaxation, speed, contact off the centre, ageing."""

from dataclasses import dataclass
from typing import Literal

from pydantic import Field

from pneutouch.spec.calibration import CalibrationSource


@dataclass(frozen=True, slots=True)
class GaugeState:
    """The smallest force at one driving pressure; null where it is not known."""

    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    smallest_force_N: float | None
    """Smallest force that is detected over the range: threshold over sensitivity."""
    smallest_force_at_first_contact_N: float | None
    """Smallest force that is detected at first contact, where the curve starts."""
    zero_drift_kPa_per_K: float
    """Change of the pressure without contact with temperature."""
    zero_drift_N_per_K: float | None
    """The same drift, read as a force."""
    warming_that_reads_as_smallest_force_K: float | None
    """Warming whose drift reads as the smallest force."""


@dataclass(frozen=True, slots=True)
class GaugeFigures:
    """The pressure gauge and the smallest force that it detects."""

    name: str | None
    """Name of the gauge; null where the one of the paper is assumed."""
    title: str
    """Name of the gauge in words."""
    reference: Literal["gauge", "absolute"]
    """Reference of the gauge: the air around it (gauge) or a vacuum (absolute)."""
    reads_from_kPa: float
    """Least gauge pressure that is read."""
    reads_to_kPa: float
    """Greatest gauge pressure that is read."""
    noise_kPa: float | None
    """Standard deviation of one reading; null: not known."""
    step_kPa: float | None
    """Smallest step of a reading; null: not known."""
    threshold_kPa: float | None
    """Pressure rise that counts as detected; null: not known."""
    rate_Hz: float | None
    """Readings a second; null: not known."""
    bandwidth_Hz: float | None
    """Half of the rate: faster changes are not followed; null: not known."""
    criterion: str
    """Criterion of detection, in words."""
    limited_by: str | None
    """Property of the gauge that sets the threshold, in words."""
    inner_volume_counted_mL: float | None
    """Gas inside the gauge that is counted in the dead volume."""
    states: tuple[GaugeState, ...]
    """One entry a driving pressure."""


@dataclass(frozen=True, slots=True)
class Hold:
    """Losses after the plate has stopped; or ``ended`` alone, the reason why there are none."""

    force_loss_percent: float | None = None
    """Fall of the force at constant travel from from_s to to_s, over its value at from_s."""
    force_loss_percent_per_decade: float | None = None
    """Fall of the force in a decade of time, by least squares over the logarithm of time, over its value at from_s."""
    pressure_rise_loss_percent: float | None = None
    """Fall of the pressure rise at constant travel from from_s to to_s, over its value at from_s."""
    pressure_rise_loss_percent_per_decade: float | None = None
    """Fall of the pressure rise in a decade of time, by least squares over log time, over its value at from_s."""
    from_s: float | None = None
    """Start of the time interval that is evaluated, from the end of the ramp."""
    to_s: float | None = None
    """End of that time interval, from the end of the ramp."""
    ended: str | None = None
    """Reason why the run ended early; then every other key is left out."""


@dataclass(frozen=True, slots=True)
class Loop:
    """Loading and unloading at one speed, where the run ended early."""

    speed_mm_per_s: float
    """Speed of the plate."""
    ended: str | None = None
    """Reason why the run ended early; left out: it did not."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WholeLoop(Loop):
    """Loading and unloading at one speed."""

    width_percent: float
    """Width of the loop at half travel, over full scale."""
    area_percent: float
    """Area of the loop over the area under the loading curve."""
    contact_lost_at_mm: float | None
    """Travel at which the object leaves the sensor on the way back; null: it does not before the start."""


@dataclass(frozen=True, slots=True)
class BySource:
    """Relaxation and hysteresis by one source of relaxation data."""

    relaxation: Hold
    """Losses after the plate has stopped."""
    hysteresis: tuple[WholeLoop | Loop, ...]
    """Loops of loading and unloading, one entry a speed."""


@dataclass(frozen=True, slots=True)
class ViscousState:
    """Relaxation and hysteresis at one driving pressure."""

    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    by_source: tuple[BySource, ...]
    """One entry a source of relaxation data."""


@dataclass(frozen=True, slots=True)
class Viscous:
    """Relaxation and hysteresis; or ``unknown`` alone, the reason why there is none."""

    unknown: str | None = None
    """Reason why there is none; then every other key is left out."""
    depth_mm: float | None = None
    """Plate travel, after first contact, at which the plate stops or turns."""
    ramp_speed_mm_per_s: float | None = None
    """Speed of the plate before the hold."""
    sources: tuple[str, ...] = ()
    """Sources of relaxation data."""
    basis: tuple[str, ...] = ()
    """Assumptions, in sentences: the model, its relaxation, and what is known of the resin."""
    states: tuple[ViscousState, ...] = ()
    """One entry a driving pressure."""


@dataclass(frozen=True, slots=True)
class LinePiece:
    """One piece of the gas line."""

    part: str
    """Name of the piece: gap, channel, port, tube or adaptor."""
    length_mm: float
    """Length."""
    inner_diameter_mm: float
    """Inside diameter."""
    volume_mL: float
    """Volume."""


@dataclass(frozen=True, slots=True)
class DynamicRecord:
    """Speed of the reading at one driving pressure, by one source of relaxation data."""

    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    relaxation_source: str | None
    """Source of the relaxation data that are used; null: none is known."""
    first_resonance_Hz: float | None
    """First resonance; null: there is none."""
    resonance_gain: float | None
    """Gain at the resonance; null: there is none."""
    bandwidth_3_dB_Hz: float | None
    """Frequency up to which the gain is within 3 dB, at most half of the gauge's rate; null: none found."""
    bandwidth_limited_by: str | None
    """Effect that limits that frequency; null: none."""
    within_5_percent_Hz: float | None
    """Frequency up to which the gain is within 5 %; null: none found."""
    within_5_percent_limited_by: str | None
    """Effect that limits that frequency; null: none."""
    delay_ms: float
    """Time from a step of force to half of the reading."""
    rise_time_ms: float
    """Time from 10 to 90 % of the reading."""
    overshoot_percent: float
    """Greatest reading over the final one, less 100 %."""
    fast_gas_over_slow: float
    """Stiffness of the gas for a sudden change over that for a slow one."""
    fast_wall_over_slow: float | None
    """Stiffness of the wall for a sudden change over that for a slow one."""
    first_resonance_low_Hz: float | None = None
    """First resonance with 0.15 mL in a gauge whose volume is not known; left out where it is known."""
    resonance_gain_low: float | None = None
    """Lower end of the gain at the resonance; left out where the gas in the gauge is known."""


@dataclass(frozen=True, slots=True)
class Dynamics:
    """Speed of the reading."""

    basis: tuple[str, ...]
    """Assumptions, in sentences."""
    line: tuple[LinePiece, ...]
    """Pieces from the cavity to the gauge."""
    end_volume_mL: float
    """Gas volume behind the last piece."""
    gauge_rate_Hz: float | None
    """Readings of the gauge a second; null: not known."""
    states: tuple[DynamicRecord, ...]
    """One entry for each driving pressure and source of relaxation data."""
    note: str | None = None
    """A note if the stated dead volume is less than that of the line as drawn."""


@dataclass(frozen=True, slots=True)
class ContactPlace:
    """One contact off the centre."""

    object: str
    """Object that presses the sensor: plate, ball, cone, ring, profile, edge or cylinder."""
    radius_mm: float | None
    """Radius of the object; null: a plate."""
    offset_mm: float
    """Distance of the contact from the axis."""
    tilt_deg: float
    """Angle that the plate leans by."""


@dataclass(frozen=True, slots=True)
class ContactErrors:
    """Errors of the force read at one driving pressure."""

    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    pressure_rise_kPa: tuple[float, ...]
    """Readings for which the errors are stated: cavity pressure less driving pressure."""
    contact_force_N: tuple[float, ...]
    """Force of the central plate at each of these readings."""
    force_error_percent: tuple[tuple[float | None, ...], ...]
    """Error of the force read, over the true one: a list for each contact; null: reading not reached."""
    standard_uncertainty_relative: float | None
    """Relative standard uncertainty of the force read while object and place are unknown."""


@dataclass(frozen=True, slots=True)
class ContactAnywhere:
    """Errors of the force read where object and place of contact are unknown; or ``unknown`` alone."""

    unknown: str | None = None
    """Reason why there is none; then every other key is left out."""
    contacts: tuple[ContactPlace, ...] = ()
    """Objects and places of contact, in the order of the errors."""
    states: tuple[ContactErrors, ...] = ()
    """One entry a driving pressure."""
    plate_offset_without_effect_mm: float | None = None
    """Offset up to which a plate presses as a central one does."""
    table_error_relative: float | None = None
    """Known error of the table from which the errors are read."""


@dataclass(frozen=True, slots=True)
class Aged:
    """The modulus after a year over the fresh one, and what that assumes."""

    modulus_ratio: float
    """Modulus after a year over the fresh one."""
    assumes: str
    """Assumption behind that ratio."""


class CalibratedBy(CalibrationSource):
    """The calibration that a prediction uses, with the measurement behind it."""

    name: str = Field(description="Name of the calibration.")
    title: str = Field(description="Title of the calibration.")
