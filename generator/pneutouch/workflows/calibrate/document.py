"""The parts of a calibration as records."""

import numpy as np

from pneutouch.bench.calibrate import NAMES, CalibrationFit, HeldOutPrediction
from pneutouch.bench.calibrate.further import SuggestedTest
from pneutouch.bench.calibrate.goodness import RunResiduals, SystematicDeviation
from pneutouch.bench.calibrate.identify import CorrelatedParameters
from pneutouch.bench.calibrate.parameters import DEAD, FRICTION, KEYS, LOGARITHMIC, UNITS, outside_value
from pneutouch.bench.calibrate.response import ResponseGap
from pneutouch.units import KPA, ML
from pneutouch.workflows.calibrate.record import (
    CorrelatedRecord,
    CorrelationRecord,
    EstimateRecord,
    FitRecord,
    FurtherRecord,
    GoodnessRecord,
    HeldOutRecord,
    MissRecord,
    ResidualRecord,
    ResponseRecord,
)


def fit_document(fitted: CalibrationFit) -> FitRecord:
    """Record of the fit: its parameters, its data and its goodness."""
    seen = fitted.observations
    return {
        "runs": len(seen.curves),
        "injections": len(seen.injections),
        "driving_pressures_kPa": list(seen.driving_pressures_kPa),
        "ambient_pressure_kPa": seen.ambient / KPA,
        "estimates": [_estimate(fitted, place) for place in range(len(fitted.parameters.fitted))],
        "correlation": _correlation(fitted),
        "fit": _goodness(fitted),
    }


def _estimate(fitted: CalibrationFit, place: int) -> EstimateRecord:
    k = fitted.parameters.fitted[place]
    at, half = float(fitted.solution.at[place]), float(fitted.half_width[place])
    interval = None
    if np.isfinite(half):
        low = at - half if k not in (DEAD, FRICTION) else max(at - half, 0.0)
        high = at + half if k != FRICTION else min(at + half, float(fitted.parameters.high[k]))
        interval = [outside_value(k, low), outside_value(k, high)]
    prior_spread = float(fitted.parameters.prior_spread[k])
    return {
        "parameter": NAMES[k],
        "key": KEYS[k],
        "unit": UNITS[k],
        "value": outside_value(k, at),
        "interval_95": interval,
        "on_bound": bool(fitted.solution.bound[place]),
        "designed": outside_value(k, float(fitted.parameters.start[k])),
        "prior": {
            "counted": fitted.parameters.priors,
            "standard_deviation": prior_spread / (ML if k == DEAD else 1.0),
            "relative": bool(LOGARITHMIC[k]),
            "source": fitted.parameters.origin[k],
        },
    }


def _correlation(fitted: CalibrationFit) -> CorrelationRecord:
    matrix = fitted.covariance.matrix
    spread = np.sqrt(np.diag(matrix))
    scaled = matrix / np.outer(spread, spread)
    return {
        "parameters": list(fitted.parameters.names),
        "matrix": [[float(x) if np.isfinite(x) else None for x in row] for row in scaled],
    }


def _goodness(fitted: CalibrationFit) -> GoodnessRecord:
    force, rise, injection = (float(x) for x in fitted.channel_factor)
    return {
        "chi_squared": fitted.chi_squared,
        "degrees_of_freedom": fitted.freedom,
        "chi_squared_per_degree": fitted.chi_squared / fitted.freedom if fitted.freedom else None,
        "points_used": int(fitted.solution.use.sum()),
        "points_left_out": int(fitted.left_out.sum() + fitted.injections_left_out.sum()),
        "scatter_over_stated": {"force": force, "pressure": rise, "injection": injection},
        "model_leaves_out_share_of_reading": dict(
            zip(("force", "pressure", "injection"), (float(x) for x in fitted.sizes), strict=True)
        ),
        "considered": [NAMES[k] for k in fitted.parameters.others],
        "variance_of_runs_over_points": fitted.run_factor,
        "interval_from_runs": fitted.covariance.clustered,
    }


def response_records(gap: ResponseGap) -> list[ResponseRecord]:
    """Records of the part of the curves that the fitted model leaves out, by driving pressure."""
    correction = gap.correction
    return [
        {
            "driving_pressure_kPa": pressure_kPa,
            "force_factor": correction.force_factors[k],
            "pressure_factor": correction.rise_factors[k],
            "sensitivity_error_relative": float(gap.sensitivity_errors[k]),
            "force_error_relative": float(gap.force_errors[k]),
        }
        for k, pressure_kPa in enumerate(gap.driving_pressures_kPa)
    ]


def miss_record(miss: SystematicDeviation) -> MissRecord:
    """A stretch of travel where the fitted model deviates in one direction."""
    return {
        "driving_pressure_kPa": miss.driving_pressure_kPa,
        "channel": miss.channel,
        "from_mm": miss.start,
        "to_mm": miss.end,
        "share": miss.share,
    }


def residual_record(run: RunResiduals) -> ResidualRecord:
    """Record of the distance of a run from the fitted model."""
    return {
        "run": run.label,
        "driving_pressure_kPa": _number(run.driving_pressure_kPa),
        "force_share_of_full_scale": _number(run.force_error),
        "pressure_share_of_full_scale": _number(run.rise_error),
    }


def correlated_record(group: CorrelatedParameters) -> CorrelatedRecord:
    """Parameters that the runs determine together better than each."""
    return {
        "parameters": [NAMES[k] for k in group.members],
        "correlation": group.correlation,
        "standard_deviation_alone": [_leaving(k, x) for k, x in zip(group.members, group.alone, strict=True)],
        "standard_deviation_others_known": [_leaving(k, x) for k, x in zip(group.members, group.given, strict=True)],
        "modulus_times_wall_to_the": group.combination,
    }


def further_record(fitted: CalibrationFit, test: SuggestedTest) -> FurtherRecord:
    """A test that would reduce the uncertainty."""
    widths = zip(fitted.parameters.fitted, test.half_width, strict=True)
    return {
        "test": test.what,
        "widest_interval_shrinks": test.gain,
        "expected_half_widths": {NAMES[k]: _leaving(k, width) for k, width in widths},
    }


def held_out_record(one: HeldOutPrediction) -> HeldOutRecord:
    """A driving pressure as predicted from the others."""
    return {
        "driving_pressure_kPa": one.driving_pressure_kPa,
        "sensitivity_measured_kPa_per_N": one.measured_kPa_per_N,
        "sensitivity_predicted_kPa_per_N": one.predicted_kPa_per_N,
        "sensitivity_error": one.error,
        "force_rms_share": one.force_error,
        "force_greatest_share": one.force_worst,
        "pressure_rms_share": one.rise_error,
        "pressure_greatest_share": one.rise_worst,
        "points": one.points,
        "points_left_out": one.left_out,
    }


def _leaving(k: int, deviation: float) -> float | None:
    """A deviation as it leaves: relative (of the logarithm), mL, or mm."""
    return _number(float(deviation) / (ML if k == DEAD else 1.0))


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
