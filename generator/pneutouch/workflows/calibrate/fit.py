"""Calibration of one sensor from a campaign and its design: fitted parameters with intervals, residuals and notes."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.calibrate.fit import CalibrationFit, CorrelatedParameters, Identifiability, fit, identify
from pneutouch.bench.calibrate.goodness import (
    ModelMisfit,
    ResponseGap,
    RunResiduals,
    misfit,
    misses,
    residuals,
    response_gap,
)
from pneutouch.bench.calibrate.notes import fit_notes, predict_held_out
from pneutouch.bench.calibrate.observations import Injection, Observations
from pneutouch.bench.calibrate.other_states import SuggestedTest
from pneutouch.bench.calibrate.parameters import (
    DEAD,
    FRICTION,
    KEYS,
    LOGARITHMIC,
    NAMES,
    UNITS,
    USUAL,
    outside_value,
    parameters,
)
from pneutouch.bench.record import MeasuredCurve
from pneutouch.catalogue import ResolvedDesign
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import sensor_of
from pneutouch.evaluation.resins import resin_of
from pneutouch.parts import assemble
from pneutouch.results.calibration import (
    CalibrationRecord,
    CorrelatedRecord,
    CorrelationRecord,
    EstimateRecord,
    FittedResponse,
    FurtherRecord,
    GoodnessRecord,
    HeldOutRecord,
    MissRecord,
    PriorRecord,
    ResidualRecord,
)
from pneutouch.spec.campaign import Campaign, CampaignRun, RunKind
from pneutouch.units import KPA, ML
from pneutouch.wording import finite


def _estimate(fitted: CalibrationFit, place: int) -> EstimateRecord:
    k = fitted.parameters.fitted[place]
    at, half = float(fitted.solution.at[place]), float(fitted.half_width[place])
    interval = None
    if np.isfinite(half):
        low = at - half if k not in (DEAD, FRICTION) else max(at - half, 0.0)
        high = at + half if k != FRICTION else min(at + half, float(fitted.parameters.high[k]))
        interval = outside_value(k, low), outside_value(k, high)
    spread = float(fitted.parameters.prior_spread[k]) / (ML if k == DEAD else 1.0)
    return EstimateRecord(
        parameter=NAMES[k],
        key=KEYS[k],
        unit=UNITS[k],
        value=outside_value(k, at),
        interval_95=interval,
        on_bound=bool(fitted.solution.bound[place]),
        designed=outside_value(k, float(fitted.parameters.start[k])),
        prior=PriorRecord(fitted.parameters.priors, spread, bool(LOGARITHMIC[k]), fitted.parameters.origin[k]),
    )


def _correlation(fitted: CalibrationFit) -> CorrelationRecord:
    spread = np.sqrt(np.diag(fitted.covariance.matrix))
    scaled = fitted.covariance.matrix / np.outer(spread, spread)
    return CorrelationRecord(fitted.parameters.names, tuple(tuple(finite(x) for x in row) for row in scaled))


def _goodness(fitted: CalibrationFit) -> GoodnessRecord:
    channels = ("force", "pressure", "injection")
    return GoodnessRecord(
        chi_squared=fitted.chi_squared,
        degrees_of_freedom=fitted.freedom,
        chi_squared_per_degree=fitted.chi_squared / fitted.freedom if fitted.freedom else None,
        points_used=int(fitted.solution.use.sum()),
        points_left_out=int(fitted.left_out.sum() + fitted.injections_left_out.sum()),
        scatter_over_stated=dict(zip(channels, map(float, fitted.channel_factor), strict=True)),
        model_leaves_out_share_of_reading=dict(zip(channels, map(float, fitted.sizes), strict=True)),
        considered=tuple(NAMES[k] for k in fitted.parameters.others),
        variance_of_runs_over_points=fitted.run_factor,
        interval_from_runs=fitted.covariance.clustered,
    )


def _response(gap: ResponseGap | None) -> tuple[FittedResponse, ...]:
    """Part of the curves that the fitted model leaves out, by driving pressure; empty without curves."""
    if gap is None:
        return ()
    correction = gap.correction
    errors = gap.sensitivity_errors.tolist(), gap.force_errors.tolist()
    rows = zip(gap.driving_pressures_kPa, correction.force_factors, correction.rise_factors, *errors, strict=True)
    return tuple(FittedResponse(*row) for row in rows)


def _correlated(group: CorrelatedParameters) -> CorrelatedRecord:
    return CorrelatedRecord(
        tuple(NAMES[k] for k in group.members),
        group.correlation,
        tuple(_leaving(k, x) for k, x in zip(group.members, group.alone, strict=True)),
        tuple(_leaving(k, x) for k, x in zip(group.members, group.given, strict=True)),
        group.combination,
    )


def _leaving(k: int, deviation: float) -> float | None:
    """Deviation in the unit of records: relative for logarithms, mL, mm, or 1; None if it is not finite."""
    return finite(float(deviation) / (ML if k == DEAD else 1.0))


FITTED_KINDS: tuple[RunKind, ...] = ("steps", "injection")
"""Kinds of runs that a calibration fits."""


@dataclass(frozen=True)
class Calibration:
    """Calibration of a sensor.

    Attributes:
        scene: Design that the sensor was made from.
        sensor, title: Name of the specimen and of the campaign.
        fit, residuals, misses, identified, held_out: Results of the functions of `bench.calibrate`.
        notes: Remarks on the data.
        further: Tests that would reduce the uncertainty; `with_further_tests` finds them."""

    scene: ResolvedDesign
    sensor: str
    title: str
    fit: CalibrationFit
    residuals: tuple[RunResiduals, ...]
    misses: list[MissRecord]
    identified: Identifiability
    held_out: tuple[HeldOutRecord, ...]
    notes: tuple[str, ...] = ()
    further: Sequence[SuggestedTest] = ()

    @cached_property
    def gap(self) -> ResponseGap | None:
        """Part of the curves that the fitted model leaves out; None if too few points are covered."""
        return response_gap(self.fit)

    @cached_property
    def misfit(self) -> ModelMisfit:
        """Misfit of all runs together."""
        return misfit(self.fit, self.residuals)

    @property
    def warnings(self) -> list[str]:
        """Reasons to doubt the calibration: one if the model describes the runs poorly, else none."""
        if not self.misfit.doubtful:
            return []
        return [
            f"the fitted model describes the runs poorly: it is off in {self.misfit.words}; check units, columns, "
            "driving pressures, design and contact"
        ]

    @property
    def notes_for_reader(self) -> list[str]:
        """Remarks on the data, then notes on the fit."""
        return [*self.notes, *fit_notes(self.fit, self.identified, self.further, self.misses, self.held_out)]

    @cached_property
    def record(self) -> CalibrationRecord:
        """The calibration as it is printed and written."""
        seen, fitted = self.fit.observations, self.fit.parameters.fitted
        names = [NAMES[k] for k in fitted]
        return CalibrationRecord(
            design=self.scene.name,
            sensor=self.sensor,
            campaign=self.title,
            runs=len(seen.curves),
            injections=len(seen.injections),
            driving_pressures_kPa=seen.driving_pressures_kPa,
            ambient_pressure_kPa=seen.ambient / KPA,
            estimates=tuple(_estimate(self.fit, place) for place in range(len(fitted))),
            correlation=_correlation(self.fit),
            fit=_goodness(self.fit),
            response=_response(self.gap),
            residuals=tuple(
                ResidualRecord(run.label, *map(finite, (run.driving_pressure_kPa, run.force_error, run.rise_error)))
                for run in self.residuals
            ),
            misses=tuple(self.misses),
            strongly_correlated=tuple(_correlated(group) for group in self.identified.ambiguities),
            unidentified=tuple(NAMES[k] for k in self.identified.unseen),
            further_tests=tuple(
                FurtherRecord(one.what, one.gain, dict(zip(names, map(_leaving, fitted, one.half_width), strict=True)))
                for one in self.further
            ),
            held_out=self.held_out,
            warnings=tuple(self.warnings),
            notes=tuple(self.notes_for_reader),
        )


def calibrate(
    observations: Observations,
    scene: ResolvedDesign,
    names: Sequence[str] = USUAL,
    *,
    priors: bool = True,
    hold_out_kPa: Sequence[float] = (),
    sensor: str = "",
    title: str = "",
    notes: Sequence[str] = (),
) -> Calibration:
    """Fit the parameters ``names`` of a design to observations; predict each of ``hold_out_kPa`` by a fit without it.

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


def chosen_sensor(campaign: Campaign, sensor: str | None) -> str:
    """The sensor named, or the only one. Raises InputError for an unknown name, or None among several."""
    known = sorted({run.sensor for run in campaign.runs})
    if sensor is None and len(known) > 1:
        raise InputError(f"the campaign holds {', '.join(known)}", key="sensor", remedy="name one")
    chosen = known[0] if sensor is None else sensor
    if chosen not in known:
        remedy = f"there are {', '.join(known)}"
        raise InputError("no such sensor in the campaign", key="sensor", value=chosen, remedy=remedy)
    return chosen


def observations_of(
    campaign: Campaign,
    curves: Sequence[MeasuredCurve],
    injections: Sequence[tuple[CampaignRun, Array, Array]],
    scene: ResolvedDesign,
    sensor: str | None = None,
) -> tuple[str, Observations, list[str]]:
    """Sensor's name, its steps and injections, and remarks. Raises InputError as `chosen_sensor`, without runs to fit,
    and for an injection that does not begin at ambient pressure."""
    chosen = chosen_sensor(campaign, sensor)
    steps = tuple(curve for curve in curves if curve.run.sensor == chosen and curve.run.kind == "steps")
    pushed = [fitted for fitted in injections if fitted[0].sensor == chosen]
    for run, _, _ in pushed:
        if run.driving_pressure_kPa:
            given = f"driving_pressure_kPa = {run.driving_pressure_kPa:g}"
            raise InputError(f"{given}: an injection must begin at ambient pressure, 0", file=run.file)
    if not steps and not pushed:
        missing = f"no run of kind {' or '.join(FITTED_KINDS)}"
        raise InputError(missing, key="sensor", value=chosen, remedy="there must be at least one")
    given_kPa = campaign.ambient_pressure_kPa
    ambient = (scene.design.pneumatics.ambient_pressure_kPa if given_kPa is None else given_kPa) * KPA
    blown = tuple(Injection(run.label, volume, pressure) for run, volume, pressure in pushed)
    return chosen, Observations(steps, blown, ambient, campaign.rig), _remarks(campaign, scene, chosen)


def _remarks(campaign: Campaign, scene: ResolvedDesign, sensor: str) -> list[str]:
    resin = next(run.resin for run in campaign.runs if run.sensor == sensor)
    fitted = ["the campaign's files are simulated, not measured"] if campaign.simulated else []
    if resin != resin_of(scene):
        fitted.append(
            f"the campaign states {sensor} to be of {resin}, the design states {scene.design.membrane.material}: the "
            "design's resin gives the start and the prior of the modulus"
        )
    return fitted
