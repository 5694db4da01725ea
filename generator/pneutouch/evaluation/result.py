"""A prediction as a record: states in boundary units, their uncertainty, and all else that is known of the sensor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from pneutouch.arrays import Array
from pneutouch.evaluation.contact_object import contact_document
from pneutouch.evaluation.dynamics import dynamics
from pneutouch.evaluation.relaxation import viscous
from pneutouch.evaluation.uncertainty import uncertainties
from pneutouch.mechanics.prediction import InflationCurve
from pneutouch.mechanics.response import tangent_stiffness
from pneutouch.results.behaviour import Aged, CalibratedBy
from pneutouch.results.prediction import (
    Curve,
    EventRecord,
    HeldRecord,
    InflationRecord,
    LimitPointRecord,
    LimitsRecord,
    OffAxisRecord,
    PredictionRecord,
    RatingFinding,
    RatingRecord,
    ShearRecord,
    StateRecord,
)
from pneutouch.units import KPA, ML
from pneutouch.wording import rounded

if TYPE_CHECKING:
    from pneutouch.evaluation.evaluate import Evaluation
    from pneutouch.mechanics.harmonic.press import OffAxisCurve, ShearCurve
    from pneutouch.mechanics.prediction import LimitPoint, Limits, SensorPrediction, SensorState
    from pneutouch.mechanics.rating import Rating
    from pneutouch.results.behaviour import ContactAnywhere, GaugeFigures

_DIGITS = 6
"""Significant digits: more than the figures have, fewer than differ between processors."""

MODEL_DIGITS = 12
"""Significant digits of the model's own figures: rounding of the last bits differs between processors."""

NOTHING = 1e-12
"""Forces and pressure rises below this (N, kPa) are rounding."""


def predicted(evaluation: Evaluation, samples: int = 0) -> PredictionRecord:
    """A prediction's record with rating and uncertainty of every state; ``samples`` > 0 adds sampled intervals."""
    uncertainty, filled = evaluation.uncertainty, evaluation.filled_uncertainty
    if samples:
        uncertainty = uncertainties(
            evaluation.prediction, evaluation.sensor, evaluation.scene, lambda: evaluation.resins, samples
        )
    record = by_model(evaluation.prediction)
    # Gas volume of connector, tube and gauge as drawn, if 0 is stated behind a tube.
    assembly = evaluation.assembly
    drawn_mL = float(rounded(assembly.drawn_volume / ML, MODEL_DIGITS)) if assembly.dead_volume_note else None
    return replace(
        record,
        states=tuple(replace(s, uncertainty=u) for s, u in zip(record.states, uncertainty, strict=True)),
        filled=tuple(replace(s, uncertainty=u) for s, u in zip(record.filled, filled, strict=True)),
        contact=contact_document(evaluation.scene).get("contact"),
        rating=rating_record(evaluation.rating, [s.driving_pressure for s in evaluation.prediction.all_states]),
        dead_volume_note=assembly.dead_volume_note or None,
        dead_volume_as_drawn_mL=drawn_mL,
        as_drawn=() if evaluation.as_drawn is None else by_model(evaluation.as_drawn).states,
        as_drawn_model=None if evaluation.as_drawn is None else evaluation.as_drawn.model,
        contact_anywhere=_anywhere(evaluation) if evaluation.scene.design.contact.anywhere else None,
    )


def _anywhere(evaluation: Evaluation) -> ContactAnywhere:
    # Its table of presses loads where a design asks for it.
    from pneutouch.evaluation.anywhere import contact_anywhere

    return contact_anywhere(evaluation.prediction, evaluation.sensor)


def predicted_in_full(evaluation: Evaluation, samples: int = 0) -> PredictionRecord:
    """`predicted` with relaxation and speed, and with gauge, mixing curves, calibration and ageing if there are any."""
    if evaluation.curves:
        # Few designs are of a mix.
        from pneutouch.evaluation.subject import by_mixing_curve
    return replace(
        predicted(evaluation, samples),
        viscous=viscous(evaluation.viscous_runs),
        dynamics=dynamics(evaluation.bandwidth),
        gauge=None if evaluation.scene.gauge is None else _gauge(evaluation),
        mixing_curves=by_mixing_curve(evaluation.curves) if evaluation.curves else (),
        calibration=_calibrated_by(evaluation),
        aged=_aged(evaluation) if evaluation.options.aged else None,
    )


def _gauge(evaluation: Evaluation) -> GaugeFigures:
    # Most designs name no gauge.
    from pneutouch.evaluation.gauge import gauge_record

    return gauge_record(evaluation)


def by_model(prediction: SensorPrediction, *, curves: bool = True) -> PredictionRecord:
    """A prediction's record without rating and uncertainty; with ``curves`` False also without inflation and without
    the curves of central contact, which take the most time, and not rounded."""
    inflation = prediction.inflation if curves else InflationCurve(*[np.empty(0)] * 4)
    record = PredictionRecord(
        design=prediction.design,
        model=prediction.model,
        closure=prediction.closure,
        error_estimate=prediction.error_estimate,
        limit_point=None if prediction.limit_point is None else _limit_point(prediction.limit_point),
        limits=_limits(prediction.limits),
        dead_volume_mL=prediction.dead_volume / ML,
        inflation=InflationRecord(
            apex_height_inner_mm=_numbers(inflation.apex_inner),
            apex_height_outer_mm=_numbers(inflation.apex_outer),
            cavity_volume_mL=_numbers(inflation.volume / ML),
            driving_pressure_kPa=_numbers(inflation.pressure / KPA),
        ),
        states=tuple(_state(state, curves=curves) for state in prediction.states),
        assumptions=prediction.assumptions,
        filled=tuple(_state(state, curves=curves) for state in prediction.filled),
    )
    return rounded(record, MODEL_DIGITS, NOTHING) if curves else record


def _state(state: SensorState, *, curves: bool) -> StateRecord:
    f = state.figures
    without = not curves and state.beyond_axis is None
    return StateRecord(
        driving_pressure_kPa=state.driving_pressure / KPA,
        apex_height_inner_mm=state.apex_inner,
        apex_height_outer_mm=state.apex_outer,
        cavity_volume_mL=state.cavity_volume / ML,
        range_end_mm=state.range_end,
        sensitivity_kPa_per_N=f.sensitivity if f else None,
        sensitivity_through_origin_kPa_per_N=f.sensitivity_through_origin if f else None,
        r_squared=f.r_squared if f else None,
        nonlinearity_percent=100 * f.nonlinearity if f else None,
        stiffness_N_per_mm=f.stiffness if f else None,
        force_range_N=f.force_range if f else None,
        saturation_force_N=_finite(f and f.saturation_force),
        curve=Curve(*[()] * 7) if without else _curve(state),
        events=tuple(EventRecord(e.kind, e.indentation, e.ends_range, e.message) for e in state.events),
        off_axis=None if state.beyond_axis is None else off_axis(state.beyond_axis),
        stiffness_at_1mm_N_per_mm=_finite(f and f.stiffness_1mm),
        stiffness_at_3mm_N_per_mm=_finite(f and f.stiffness_3mm),
        held=None if state.held is None else HeldRecord(state.held.injected / ML, *state.held[1:]),
    )


def _finite(value: float | None) -> float | None:
    return value if value is not None and np.isfinite(value) else None


def _curve(state: SensorState) -> Curve:
    return Curve(
        indentation_mm=_numbers(state.indentation),
        contact_force_N=_numbers(state.force),
        pressure_rise_kPa=_numbers(state.pressure_rise / KPA),
        contact_radius_mm=_numbers(state.contact_radius),
        max_stretch=_numbers(state.max_stretch),
        tangent_stiffness_N_per_mm=_numbers(tangent_stiffness(state.indentation, state.force)),
        max_von_mises_MPa=() if state.max_von_mises is None else _numbers(state.max_von_mises),
    )


def off_axis(curve: OffAxisCurve) -> OffAxisRecord:
    """Additions of contact off the axis to a loading curve, in boundary units."""
    return OffAxisRecord(
        harmonics=curve.order,
        last_change_percent=100 * curve.last_change,
        sideways_force_N=_numbers(curve.sideways),
        moment_N_mm=_numbers(curve.moment),
        shear=None if curve.shear is None else _shear(curve.shear),
    )


def _shear(curve: ShearCurve) -> ShearRecord:
    return ShearRecord(
        shear_mm=_numbers(curve.travel),
        contact_force_N=_numbers(curve.force),
        sideways_force_N=_numbers(curve.sideways),
        moment_N_mm=_numbers(curve.moment),
        pressure_rise_kPa=_numbers(curve.rise / KPA),
        sliding_percent=_numbers(100 * curve.sliding),
        stiffness_N_per_mm=curve.stiffness,
        peak_sideways_force_N=curve.peak,
        slips_throughout_mm=curve.slips_from,
        ended=curve.ended,
    )


def _limit_point(point: LimitPoint) -> LimitPointRecord:
    return LimitPointRecord(
        point.driving_pressure / KPA,
        point.apex_inner,
        point.apex_outer,
        membrane_stretch=point.membrane_stretch,
        thickness_stretch=point.thickness_stretch,
    )


def _limits(limits: Limits) -> LimitsRecord:
    return LimitsRecord(
        limit_point_kPa=None if limits.limit_point is None else limits.limit_point / KPA,
        break_strain_kPa=None if limits.break_strain is None else limits.break_strain / KPA,
        gauge_range_kPa=limits.gauge / KPA,
        binding=limits.binding,
        law_range_kPa=None if limits.law_range is None else limits.law_range / KPA,
    )


def rating_record(rating: Rating, driving_pressures: Sequence[float]) -> RatingRecord:
    """The rating in boundary units, with its findings on driving pressures (MPa)."""
    from pneutouch.mechanics.rating import RATED_SHARE
    from pneutouch.mechanics.uncertainty.propagate import COVERAGE

    limit, remedy = rating.limit, rating.remedy
    record = RatingRecord(
        rated_pressure_kPa=rating.pressure / KPA,
        share=RATED_SHARE,
        coverage_factor=COVERAGE,
        limit=limit.name,
        limit_kPa=limit.nominal / KPA,
        limit_low_kPa=limit.low / KPA,
        limit_high_kPa=limit.high / KPA,
        basis=rating.basis,
        rated_pressure_with_measured_modulus_kPa=None if remedy is None else rating.measured / KPA,
        remedy=remedy,
        findings=tuple(
            RatingFinding(severity, pressure / KPA, rating.excess(pressure))
            for pressure in driving_pressures
            if (severity := rating.severity(pressure)) is not None
        ),
        least_pressure_kPa=None if rating.vacuum is None else rating.least / KPA,
        least_pressure_basis=rating.vacuum_basis or None,
    )
    return rounded(record, _DIGITS)


def _calibrated_by(evaluation: Evaluation) -> CalibratedBy | None:
    calibration, name = evaluation.scene.calibration, evaluation.scene.design.calibration
    if calibration is None:
        return None
    assert name is not None
    return CalibratedBy(name=name, title=calibration.title, **calibration.source.model_dump())


def _aged(evaluation: Evaluation) -> Aged:
    from pneutouch.mechanics.viscous.describe import AGED, ageing_ratio

    calibration = evaluation.scene.calibration
    remaining = 1.0 if calibration is None else calibration.remaining_year
    return Aged(rounded(ageing_ratio(evaluation.scene.membrane_material) ** remaining, _DIGITS), AGED)


def _numbers(values: Array) -> tuple[float, ...]:
    return tuple(values.tolist())
