"""Cross-validation: fit without a driving pressure, predict it, compare."""

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.calibrate.fit import fit
from pneutouch.bench.calibrate.observations import Observations, points_of
from pneutouch.bench.calibrate.parameters import CalibrationParameters
from pneutouch.bench.calibrate.response import response_gap
from pneutouch.errors import InputError
from pneutouch.mechanics.response import lines
from pneutouch.mechanics.sensor import Sensor
from pneutouch.units import KPA


@dataclass(frozen=True, slots=True)
class HeldOutPrediction:
    """A driving pressure (kPa) as predicted by a fit to the others, mean over its runs.

    Attributes:
        driving_pressure_kPa: Held out.
        measured_kPa_per_N, predicted_kPa_per_N: Sensitivity on the same travels, kPa/N.
        force_error, rise_error: Root mean square error of the curves over full scale.
        force_worst, rise_worst: Greatest error over full scale.
        points, left_out: Points compared, and those beyond the model's range.
    """

    driving_pressure_kPa: float
    measured_kPa_per_N: float
    predicted_kPa_per_N: float
    force_error: float
    rise_error: float
    force_worst: float
    rise_worst: float
    points: int
    left_out: int

    @property
    def error(self) -> float:
        """Relative error of the predicted sensitivity."""
        return self.predicted_kPa_per_N / self.measured_kPa_per_N - 1.0


def predict_held_out(
    observations: Observations, sensor: Sensor, parameters: CalibrationParameters, driving_pressure_kPa: float
) -> HeldOutPrediction:
    """Leave out a driving pressure (kPa), fit to the rest, predict it by that fit and its correction.

    Raises InputError for a pressure that was not measured, where nothing is left to fit, and where the model has too
    few of its points to compare."""
    known_kPa = observations.driving_pressures_kPa
    if driving_pressure_kPa not in known_kPa:
        problem = f"no run at this driving pressure; measured: {_listed(known_kPa)} kPa"
        raise InputError(problem, key="hold_out_kPa", value=driving_pressure_kPa)
    rest = observations.without(driving_pressure_kPa)
    if not rest.curves and not rest.injections:
        problem, remedy = "all runs are at this driving pressure", "there must be runs at another to fit"
        raise InputError(problem, key="hold_out_kPa", value=driving_pressure_kPa, remedy=remedy)
    fitted = fit(rest, sensor, parameters)
    points = points_of(observations.only(driving_pressure_kPa))
    values, ok = fitted.model_at(points).values(fitted.full[None])
    shape = points.there.shape
    use = ok[0][: points.there.size].reshape(shape) & points.there
    if (use.sum(axis=1) < 2).any():
        problem = (
            "the model fitted to the rest has fewer than two points of a run at this pressure (beyond its limit "
            "point or buckled)"
        )
        raise InputError(problem, key="hold_out_kPa", value=driving_pressure_kPa, remedy="hold out another")
    gap = response_gap(fitted)
    # Every run of a held-out pressure has that pressure; its reading differs by a reset's scatter.
    factors = (1.0, 1.0) if gap is None else gap.correction.at(driving_pressure_kPa * KPA)
    parts = values[0][: use.size], values[0][use.size : 2 * use.size]
    force, rise = (factor * part.reshape(shape) for factor, part in zip(factors, parts, strict=True))
    rows = [
        _row(
            travel=points.travel[i],
            force=points.force[i],
            rise=points.rise[i],
            model_force=force[i],
            model_rise=rise[i],
            use=use[i],
        )
        for i in range(len(use))
    ]
    measured_kPa_per_N, predicted_kPa_per_N, *errors = (float(x) for x in np.mean(rows, axis=0)[:4])
    errors += [float(x) for x in np.max(rows, axis=0)[4:]]
    sensitivities = measured_kPa_per_N, predicted_kPa_per_N
    counts = int(use.sum()), int((points.there & ~use).sum())
    return HeldOutPrediction(driving_pressure_kPa, *sensitivities, errors[0], errors[1], errors[2], errors[3], *counts)


def _row(travel: Array, force: Array, rise: Array, model_force: Array, model_rise: Array, use: Array) -> list[float]:
    """Both sensitivities, root mean square and greatest errors over full scale; the origin belongs to both curves."""
    x, f, r, mf, mr = (np.concatenate([[0.0], part[use]]) for part in (travel, force, rise, model_force, model_rise))
    measured_kPa_per_N, predicted_kPa_per_N = (
        float(lines(x, a, b / KPA).sensitivity_kPa_per_N) for a, b in ((f, r), (mf, mr))
    )
    df, dr = (mf - f)[1:] / np.abs(f).max(), (mr - r)[1:] / np.abs(r).max()
    rms = [float(np.sqrt(np.mean(part**2))) for part in (df, dr)]
    return [measured_kPa_per_N, predicted_kPa_per_N, *rms, float(np.abs(df).max()), float(np.abs(dr).max())]


def _listed(pressures_kPa: tuple[float, ...]) -> str:
    return ", ".join(f"{p:g}" for p in pressures_kPa) or "none"
