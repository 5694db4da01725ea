"""A campaign and a design to the sensor in hand: modulus, wall, dead volume and contact offset, each uncertain."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.calibrate import (
    NAMES,
    CalibrationFit,
    HeldOutPrediction,
    Injection,
    Observations,
    fit,
    parameters,
    predict_held_out,
)
from pneutouch.bench.calibrate.further import SuggestedTest
from pneutouch.bench.calibrate.goodness import RunResiduals, SystematicDeviation, misses, residuals
from pneutouch.bench.calibrate.identify import CorrelatedParameters, Identifiability, identify
from pneutouch.bench.calibrate.notes import fit_notes
from pneutouch.bench.calibrate.parameters import DEAD, KEYS, LOGARITHMIC, UNITS, outside_value
from pneutouch.bench.calibrate.response import ResponseGap, response_gap
from pneutouch.bench.record import MeasuredCurve
from pneutouch.catalogue import ResolvedDesign
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import sensor_of
from pneutouch.parts import assemble
from pneutouch.spec.campaign import Campaign, CampaignRun
from pneutouch.units import KPA, ML


@dataclass(frozen=True)
class Calibration:
    """A sensor calibrated.

    Attributes:
        scene: The design it was made to.
        sensor, title: Name of the specimen and of the campaign.
        fit, residuals, misses, identified, held_out: See `bench.calibrate`.
        notes: Remarks on what was read.
        further: Tests that would reduce the uncertainty; `with_further_tests` finds them.
    """

    scene: ResolvedDesign
    sensor: str
    title: str
    fit: CalibrationFit
    residuals: tuple[RunResiduals, ...]
    misses: list[SystematicDeviation]
    identified: Identifiability
    held_out: tuple[HeldOutPrediction, ...]
    notes: tuple[str, ...] = ()
    further: Sequence[SuggestedTest] = ()

    @cached_property
    def gap(self) -> ResponseGap | None:
        """What the fitted model leaves out of the curves; None without curves."""
        return response_gap(self.fit)

    @property
    def notes_for_reader(self) -> list[str]:
        """Notes for the reader in addition to the numbers."""
        return [*self.notes, *fit_notes(self.fit, self.identified, self.further, self.misses, self.held_out)]

    @property
    def estimates(self) -> list[dict[str, Any]]:
        """One entry a fitted parameter: value, 95 % interval or None, prior; in the unit it leaves with."""
        return [_estimate(self.fit, place) for place in range(len(self.fit.parameters.fitted))]

    @property
    def document(self) -> dict[str, Any]:
        """The calibration as data."""
        return {
            "design": self.scene.name,
            "sensor": self.sensor,
            "campaign": self.title,
            "runs": len(self.fit.observations.curves),
            "injections": len(self.fit.observations.injections),
            "driving_pressures_kPa": list(self.fit.observations.driving_pressures_kPa),
            "ambient_pressure_kPa": self.fit.observations.ambient / KPA,
            "estimates": self.estimates,
            "correlation": _correlation(self.fit),
            "fit": _goodness(self.fit),
            "response": [] if self.gap is None else _response(self.gap),
            "residuals": [_residual(run) for run in self.residuals],
            "misses": [_miss(m) for m in self.misses],
            "strongly_correlated": [_ambiguity(group) for group in self.identified.ambiguities],
            "unidentified": [NAMES[k] for k in self.identified.unseen],
            "further_tests": [_further(self.fit, test) for test in self.further],
            "held_out": [_held_out(one) for one in self.held_out],
            "notes": self.notes_for_reader,
        }


def calibrate(
    observations: Observations,
    scene: ResolvedDesign,
    names: Sequence[str] = NAMES,
    *,
    priors: bool = True,
    hold_out_kPa: Sequence[float] = (),
    sensor: str = "",
    title: str = "",
    notes: Sequence[str] = (),
) -> Calibration:
    """Fit the parameters ``names`` of a design to observations, and predict pressures ``hold_out_kPa`` by the others.

    Raises InputError for what cannot be fitted, ComputationError where no fit is found.
    """
    built = sensor_of(assemble(scene))
    # The depth is the design's; what the atlas has of the measured travels is decided point by point.
    built = built.replace(
        ambient_pressure=observations.ambient, depth=min(built.protocol.depth, 0.75 * built.dome.inner_radius)
    )
    chosen = parameters(built, scene.membrane_material, scene.printer, names, priors=priors)
    fitted = fit(observations, built, chosen)
    held = tuple(predict_held_out(observations, built, chosen, pressure_kPa) for pressure_kPa in hold_out_kPa)
    judged = residuals(fitted), misses(fitted), identify(fitted)
    return Calibration(scene, sensor, title, fitted, *judged, held, tuple(notes))


def observations_of(
    campaign: Campaign,
    curves: Sequence[MeasuredCurve],
    injections: Sequence[tuple[CampaignRun, Array, Array]],
    scene: ResolvedDesign,
    sensor: str | None = None,
) -> tuple[str, Observations, list[str]]:
    """The sensor's name, its runs of kinds steps and injection, and remarks.

    Raises InputError where the campaign holds several sensors and none is named, or not the one named, or nothing of
    it.
    """
    known = sorted({run.sensor for run in campaign.runs})
    if sensor is None and len(known) > 1:
        raise InputError(f"the campaign holds {', '.join(known)}", key="sensor", remedy="name one")
    chosen = known[0] if sensor is None else sensor
    if chosen not in known:
        remedy = f"there are {', '.join(known)}"
        raise InputError("no such sensor in the campaign", key="sensor", value=chosen, remedy=remedy)
    steps = tuple(curve for curve in curves if curve.run.sensor == chosen and curve.run.kind == "steps")
    pushed = [fitted for fitted in injections if fitted[0].sensor == chosen]
    for run, _, _ in pushed:
        if run.driving_pressure_kPa:
            given = f"driving_pressure_kPa = {run.driving_pressure_kPa:g}"
            raise InputError(f"{given}: an injection must begin at ambient pressure, 0", file=run.file)
    if not steps and not pushed:
        missing = "no readable run of kind steps or injection"
        raise InputError(missing, key="sensor", value=chosen, remedy="there must be at least one")
    given_kPa = campaign.ambient_pressure_kPa
    ambient = (scene.design.pneumatics.ambient_pressure_kPa if given_kPa is None else given_kPa) * KPA
    blown = tuple(Injection(run.label, volume, pressure) for run, volume, pressure in pushed)
    return chosen, Observations(steps, blown, ambient, campaign.rig), _remarks(campaign, scene, chosen)


def _remarks(campaign: Campaign, scene: ResolvedDesign, sensor: str) -> list[str]:
    resin = next(run.resin for run in campaign.runs if run.sensor == sensor)
    fitted = ["the campaign's files are simulated, not measured"] if campaign.simulated else []
    if resin != scene.design.membrane.material:
        fitted.append(
            f"the campaign states {sensor} to be of {resin}, the design states {scene.design.membrane.material}: the "
            "design's resin gives the start and the prior of the modulus"
        )
    return fitted


def _estimate(fitted: CalibrationFit, place: int) -> dict[str, Any]:
    k = fitted.parameters.fitted[place]
    at, half = float(fitted.solution.at[place]), float(fitted.half_width[place])
    interval = None
    if np.isfinite(half):
        low = at - half if k != DEAD else max(at - half, 0.0)
        interval = [outside_value(k, low), outside_value(k, at + half)]
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


def _correlation(fitted: CalibrationFit) -> dict[str, Any]:
    matrix = fitted.covariance.matrix
    spread = np.sqrt(np.diag(matrix))
    scaled = matrix / np.outer(spread, spread)
    return {
        "parameters": list(fitted.parameters.names),
        "matrix": [[float(x) if np.isfinite(x) else None for x in row] for row in scaled],
    }


def _goodness(fitted: CalibrationFit) -> dict[str, Any]:
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


def _response(gap: ResponseGap) -> list[dict[str, float]]:
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


def _miss(miss: SystematicDeviation) -> dict[str, Any]:
    place = {"driving_pressure_kPa": miss.driving_pressure_kPa, "channel": miss.channel}
    return {**place, "from_mm": miss.start, "to_mm": miss.end, "share": miss.share}


def _residual(run: RunResiduals) -> dict[str, Any]:
    return {
        "run": run.label,
        "driving_pressure_kPa": _number(run.driving_pressure_kPa),
        "force_share_of_full_scale": _number(run.force_error),
        "pressure_share_of_full_scale": _number(run.rise_error),
    }


def _ambiguity(group: CorrelatedParameters) -> dict[str, Any]:
    return {
        "parameters": [NAMES[k] for k in group.members],
        "correlation": group.correlation,
        "standard_deviation_alone": [_leaving(k, x) for k, x in zip(group.members, group.alone, strict=True)],
        "standard_deviation_others_known": [_leaving(k, x) for k, x in zip(group.members, group.given, strict=True)],
        "modulus_times_wall_to_the": group.combination,
    }


def _further(fitted: CalibrationFit, test: SuggestedTest) -> dict[str, Any]:
    widths = zip(fitted.parameters.fitted, test.half_width, strict=True)
    return {
        "test": test.what,
        "widest_interval_shrinks": test.gain,
        "expected_half_widths": {NAMES[k]: _leaving(k, width) for k, width in widths},
    }


def _held_out(one: HeldOutPrediction) -> dict[str, Any]:
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
