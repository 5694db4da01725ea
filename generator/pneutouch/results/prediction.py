"""A prediction as the program states it: figures, curves, limits and rating of a sensor, in boundary units."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

from pneutouch.results.behaviour import Aged, CalibratedBy, ContactAnywhere, Dynamics, GaugeFigures, Viscous
from pneutouch.results.uncertainty import UncertaintyRecord


@dataclass(frozen=True, slots=True)
class SensitivityError:
    """The known error of a model in sensitivity."""

    relative: float | None
    """Greatest relative error; None if it is unknown."""
    basis: str
    """Reference that the error was found against."""
    summary: str
    """Errors and their basis in a sentence."""
    by_pressure: tuple[float | None, ...] = ()
    """Relative errors at 0 and 22 kPa, where the paper measured them."""


@dataclass(frozen=True, slots=True)
class ErrorEstimate:
    """Stated errors of a prediction: relative ones as fractions, and a summary in sentences."""

    limit_pressure_relative: float
    """Known relative error of the limit pressure."""
    sensitivity_relative: float | None
    """Greatest known error of the sensitivity; null: not known."""
    sensitivity_basis: str = ""
    """Reference that the error of the sensitivity was found against."""
    sensitivity_relative_0kPa_22kPa: tuple[float | None, ...] = ()  # noqa: N815
    """Errors of the sensitivity without driving pressure and at 22 kPa."""
    sensitivity_discretisation_relative: float | None = None
    """Error of the sensitivity by the mesh of the solid."""
    sensitivity_tabulation_relative: float | None = None
    """Error of the sensitivity by interpolation in the atlas."""
    limit_apex_height_relative: float | None = None
    """Known error of the apex height at the limit point."""
    apex_height_relative: float | None = None
    """Known error of the apex heights."""
    model_choice: str | None = None
    """Reason why ``auto`` took this model."""
    summary: tuple[str, ...] = ()
    """The errors, in sentences."""

    def with_sensitivity(self, error: SensitivityError) -> "ErrorEstimate":
        """Copy with the known error of the sensitivity, its sentence added to the summary."""
        return replace(
            self,
            sensitivity_relative=error.relative,
            sensitivity_basis=error.basis,
            sensitivity_relative_0kPa_22kPa=error.by_pressure,
            summary=(*self.summary, error.summary),
        )


@dataclass(frozen=True, slots=True)
class CurvePoints:
    """A loading curve, lists of one length."""

    indentation_mm: tuple[float, ...]
    """Travel of the object after first contact."""
    contact_force_N: tuple[float, ...]
    """Force on the object."""
    pressure_rise_kPa: tuple[float, ...]
    """Cavity pressure less driving pressure."""


@dataclass(frozen=True, slots=True)
class Curve(CurvePoints):
    """A loading curve with the contact and the wall at its points."""

    contact_radius_mm: tuple[float, ...]
    """Radius of the edge of contact."""
    max_stretch: tuple[float, ...]
    """Greatest principal stretch in the wall."""
    tangent_stiffness_N_per_mm: tuple[float, ...]
    """Local slope of contact force over indentation."""
    max_von_mises_MPa: tuple[float, ...] = ()
    """Greatest von Mises stress in the wall."""


@dataclass(frozen=True, slots=True)
class EventRecord:
    """An event on a loading curve."""

    kind: str
    """Kind of the event."""
    indentation_mm: float
    """Travel of the object after first contact."""
    ends_range: bool
    """True if figures hold up to there alone."""
    message: str
    """The event in words."""


@dataclass(frozen=True, slots=True)
class ShearRecord:
    """An object that moves sideways after pressing: lists of one length, and figures, null if they are not reached."""

    shear_mm: tuple[float, ...]
    """Travel sideways at constant height."""
    contact_force_N: tuple[float, ...]
    """Force on the object."""
    sideways_force_N: tuple[float, ...]
    """Force of the dome on the object towards the offset."""
    moment_N_mm: tuple[float, ...]
    """Moment of the dome on the object about the centre of the base plane."""
    pressure_rise_kPa: tuple[float, ...]
    """Cavity pressure less driving pressure."""
    sliding_percent: tuple[float, ...]
    """Share of the contact that slips."""
    stiffness_N_per_mm: float | None
    """Initial slope of the force against the travel sideways, while every point sticks."""
    peak_sideways_force_N: float | None
    """Sideways force where it is greatest; null: not reached."""
    slips_throughout_mm: float | None
    """First travel at which every point of the contact slips; null: not reached."""
    ended: str | None
    """Reason why the travel ended early; null: it did not."""


@dataclass(frozen=True, slots=True)
class OffAxisRecord:
    """Additions of contact off the axis to a curve: lists as long as the curve."""

    harmonics: int
    """Greatest order of the harmonics that were taken."""
    last_change_percent: float
    """Change of the results by the last increase of their order."""
    sideways_force_N: tuple[float, ...]
    """Force of the dome on the object towards the offset."""
    moment_N_mm: tuple[float, ...]
    """Moment of the dome on the object about the centre of the base plane."""
    shear: ShearRecord | None = None
    """Movement sideways after the press; left out: none."""


@dataclass(frozen=True, slots=True)
class HeldRecord:
    """Filling of a sensor that is given by its gas or its height, and what holds its state before contact."""

    injected_volume_mL: float
    """Gas injected into the vented sensor, as a volume at ambient pressure."""
    stable_regulated: bool
    """True if a regulator that keeps the pressure holds the state."""
    stable_sealed: bool
    """True if gas that is shut in, as by a syringe, holds the state."""


@dataclass(frozen=True, slots=True)
class StateRecord:
    """A sensor at one driving pressure; figures are null where no line can be fitted."""

    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    apex_height_inner_mm: float
    """Apex height of the inner surface, inflated, before contact."""
    apex_height_outer_mm: float
    """Apex height of the outer surface, inflated, before contact."""
    cavity_volume_mL: float
    """Gas under the inflated dome, before contact."""
    range_end_mm: float
    """Indentation up to which the figures hold."""
    sensitivity_kPa_per_N: float | None
    """Slope of the pressure rise over the contact force, first contact to range end."""
    sensitivity_through_origin_kPa_per_N: float | None
    """Slope of a line through the origin, pressure rise over contact force."""
    r_squared: float | None
    """Coefficient of determination of the straight line."""
    nonlinearity_percent: float | None
    """Greatest distance from the straight line over the full-scale rise."""
    stiffness_N_per_mm: float | None
    """Mean slope of contact force over indentation, first contact to range end."""
    force_range_N: tuple[float, float] | None
    """Least and greatest contact force of the range."""
    saturation_force_N: float | None
    """Force at which the local slope falls below half of the fitted one; null: there is none."""
    curve: Curve
    """Loading curve, lists of one length."""
    events: tuple[EventRecord, ...]
    """Events along the curve."""
    off_axis: OffAxisRecord | None = None
    """Additions of contact off the axis to the curve."""
    uncertainty: UncertaintyRecord | None = None
    """Uncertainty of the figures, or the reason why there is none."""
    stiffness_at_1mm_N_per_mm: float | None = None
    """Slope of contact force over indentation at 1 mm; left out where the range ends before."""
    stiffness_at_3mm_N_per_mm: float | None = None
    """Slope of contact force over indentation at 3 mm; left out where the range ends before."""
    held: HeldRecord | None = None
    """Filling of a state that is given by it; left out for one at a driving pressure."""


@dataclass(frozen=True, slots=True)
class LimitPointRecord:
    """The limit point of free inflation; stretches by the membrane theory alone."""

    driving_pressure_kPa: float
    """Greatest gauge pressure of the inflation."""
    apex_height_inner_mm: float
    """Apex height of the inner surface at the limit point."""
    apex_height_outer_mm: float
    """Apex height of the outer surface at the limit point."""
    membrane_stretch: float | None = None
    """Stretch of the wall's middle surface at the pole."""
    thickness_stretch: float | None = None
    """Wall thickness over the unloaded one at the pole."""


@dataclass(frozen=True, slots=True)
class LimitsRecord:
    """The limits of the driving pressure, and which binds."""

    limit_point_kPa: float | None
    """Driving pressure of the limit point; null: there is none."""
    break_strain_kPa: float | None
    """Driving pressure at which the resin may tear; null: not before the limit point."""
    gauge_range_kPa: float
    """Greatest gauge pressure that the gauge reads."""
    binding: str
    """Name of the limit that is met first."""
    law_range_kPa: float | None = None
    """Driving pressure at which the wall leaves the stretches that its law was fitted to; left out: none."""


@dataclass(frozen=True, slots=True)
class InflationRecord:
    """Free inflation without contact, lists of one length."""

    apex_height_inner_mm: tuple[float, ...]
    """Apex height of the inner surface."""
    apex_height_outer_mm: tuple[float, ...]
    """Apex height of the outer surface."""
    cavity_volume_mL: tuple[float, ...]
    """Gas under the dome."""
    driving_pressure_kPa: tuple[float, ...]
    """Gauge pressure in the cavity."""


@dataclass(frozen=True, slots=True)
class RatingFinding:
    """A driving pressure above the rated pressure."""

    severity: Literal["error", "warning"]
    """Severity of the finding."""
    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    message: str
    """The finding in words."""


@dataclass(frozen=True, slots=True)
class RatingRecord:
    """The rated pressure and what it follows from."""

    rated_pressure_kPa: float
    """Greatest driving pressure to be used."""
    share: float
    """Share of the lower end of the limit's interval that is allowed."""
    coverage_factor: float
    """Coverage factor of the limit's interval."""
    limit: str
    """Name of the limit that the rated pressure follows from."""
    limit_kPa: float
    """Pressure of that limit."""
    limit_low_kPa: float
    """Lower end of the limit's interval."""
    limit_high_kPa: float
    """Upper end of the limit's interval."""
    basis: str
    """Derivation of the rated pressure, in words."""
    rated_pressure_with_measured_modulus_kPa: float | None
    """The rated pressure if coupons confirmed the modulus; null: the same."""
    remedy: str | None
    """Advice that would raise the rated pressure; null: none."""
    findings: tuple[RatingFinding, ...]
    """Driving pressures above the rated pressure, or below the least one."""
    least_pressure_kPa: float | None = None
    """Least driving pressure to be used, below ambient; left out: no driving pressure is, or no dome buckles."""
    least_pressure_basis: str | None = None
    """Derivation of the least driving pressure, in words."""


@dataclass(frozen=True, slots=True)
class MixState:
    """The sensor by one mixing curve at one driving pressure."""

    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    sensitivity_kPa_per_N: float | None
    """Slope of the pressure rise over the contact force, first contact to range end."""
    force_range_end_N: float | None
    """Contact force at the end of the range."""


@dataclass(frozen=True, slots=True)
class ByMixingCurve:
    """The sensor by one mixing curve of its mix."""

    curve: str
    """Name of the mixing curve."""
    place: Literal["softer", "in use", "stiffer"]
    """Place relative to the curve in use."""
    shear_modulus_MPa: float
    """Small-strain shear modulus by this curve."""
    beyond_last_point: bool
    """True if a fraction is beyond the curve's last point."""
    rated_pressure_kPa: float | None
    """Greatest driving pressure to be used; null: nothing could be computed."""
    states: tuple[MixState, ...]
    """One entry a driving pressure."""


@dataclass(frozen=True, slots=True)
class PredictionRecord:
    """A prediction: the sensor as a whole, and its states in order of driving pressure."""

    design: str
    """Name of the design."""
    model: str
    """Model that computed it."""
    closure: str | None
    """Contact closure of the membrane model; null for other models."""
    error_estimate: ErrorEstimate
    """Stated errors, relative ones as fractions."""
    limit_point: LimitPointRecord | None
    """Limit point of the inflation; null: there is none."""
    limits: LimitsRecord
    """Limits of the driving pressure."""
    dead_volume_mL: float
    """Gas volume behind the cavity."""
    inflation: InflationRecord
    """Inflation before contact, lists of one length."""
    states: tuple[StateRecord, ...]
    """One entry a driving pressure."""
    assumptions: tuple[str, ...]
    """Assumptions, in sentences."""
    filled: tuple[StateRecord, ...] = ()
    """States given by injected volume or apex height, which can be beyond the limit point; left out: none."""
    rating: RatingRecord | None = None
    """Rated pressure and what it follows from."""
    contact: Mapping[str, Any] | None = None
    """Object that presses the sensor, by the keys of [contact]; left out for a frictionless plate."""
    dead_volume_note: str | None = None
    """Note on a stated dead volume that is an idealisation."""
    dead_volume_as_drawn_mL: float | None = None
    """Gas volume of connector, tube and gauge as drawn, where the stated one is an idealisation."""
    as_drawn: tuple[StateRecord, ...] = ()
    """The same states with that gas volume; empty where ``as_drawn_model`` has none."""
    as_drawn_model: str | None = None
    """Model that computed ``as_drawn``."""
    contact_anywhere: ContactAnywhere | None = None
    """Errors of the force read where object and place are unknown."""
    viscous: Viscous | None = None
    """Relaxation and hysteresis, or the reason why they are unknown."""
    dynamics: Dynamics | None = None
    """Speed of the reading."""
    gauge: GaugeFigures | None = None
    """Pressure gauge of the design; left out: none is named."""
    mixing_curves: tuple[ByMixingCurve, ...] = ()
    """The sensor by every mixing curve of its mix, the softest first."""
    calibration: CalibratedBy | None = None
    """Calibration of the sensor in hand; left out: the design as drawn."""
    aged: Aged | None = None
    """Ageing that the prediction counts; left out: none."""
