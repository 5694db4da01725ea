"""Cross-validation: fit without a driving pressure, predict it, compare."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.calibrate.fit import fit
from pneutouch.bench.calibrate.model import AtlasModel
from pneutouch.bench.calibrate.observations import Observations, points_of
from pneutouch.bench.calibrate.parameters import CalibrationParameters
from pneutouch.errors import InputError
from pneutouch.mechanics.response import lines
from pneutouch.mechanics.sensor import Sensor
from pneutouch.units import KPA


@dataclass(frozen=True, slots=True)
class HeldOutPrediction:
    """A driving pressure (kPa) as predicted by a fit to the others, mean over its runs.

    Attributes:
        pressure: Held out.
        measured, predicted: Sensitivity on the same travels, kPa/N.
        force_error, rise_error: Root mean square error of the curves over full scale.
        force_worst, rise_worst: Greatest error over full scale.
        points, left_out: Points compared, and those beyond the model's range.
    """

    pressure: float
    measured: float
    predicted: float
    force_error: float
    rise_error: float
    force_worst: float
    rise_worst: float
    points: int
    left_out: int

    @property
    def error(self) -> float:
        """Relative error of the predicted sensitivity."""
        return self.predicted / self.measured - 1.0


def predict_held_out(
    observations: Observations, sensor: Sensor, parameters: CalibrationParameters, pressure: float
) -> HeldOutPrediction:  # fmt: skip
    """Leave out a driving pressure (kPa), fit to the rest, predict it.

    Raises InputError for a pressure that was not measured, where nothing is left to fit, and where the model has too few of
    its points to compare.
    """
    known = observations.pressures
    if pressure not in known:
        problem = f"no run at this driving pressure; measured: {_listed(known)} kPa"
        raise InputError(problem, key="hold_out_kPa", value=pressure)
    rest = observations.without(pressure)
    if not rest.curves and not rest.injections:
        problem, remedy = "all runs are at this driving pressure", "there must be runs at another to fit"
        raise InputError(problem, key="hold_out_kPa", value=pressure, remedy=remedy)
    fitted = fit(rest, sensor, parameters)
    points = points_of(observations.only(pressure))
    model = AtlasModel(sensor.replace(ambient_pressure=observations.ambient), points)
    values, ok = model.values(fitted.full[None])
    shape = points.there.shape
    use = ok[0][: points.there.size].reshape(shape) & points.there
    if (use.sum(axis=1) < 2).any():
        problem = (
            "the model fitted to the rest has fewer than two points of a run at this pressure (beyond its limit point or "
            "buckled)"
        )
        raise InputError(problem, key="hold_out_kPa", value=pressure, remedy="hold out another")
    force, rise = (part.reshape(shape) for part in (values[0][: use.size], values[0][use.size : 2 * use.size]))
    rows = [_row(points.travel[i], points.force[i], points.rise[i], force[i], rise[i], use[i]) for i in range(len(use))]
    mean = np.mean(rows, axis=0)
    worst = np.max(rows, axis=0)
    return HeldOutPrediction(
        pressure, float(mean[0]), float(mean[1]), float(mean[2]), float(mean[3]), float(worst[4]), float(worst[5]),
        int(use.sum()), int((points.there & ~use).sum()),
    )  # fmt: skip


def _row(travel: Array, force: Array, rise: Array, model_force: Array, model_rise: Array, use: Array) -> list[float]:
    """Both sensitivities, root mean square and greatest errors over full scale; the origin belongs to both curves."""
    x, f, r, mf, mr = (np.concatenate([[0.0], part[use]]) for part in (travel, force, rise, model_force, model_rise))
    measured, predicted = (float(lines(x, a, b / KPA).sensitivity) for a, b in ((f, r), (mf, mr)))
    df, dr = (mf - f)[1:] / np.abs(f).max(), (mr - r)[1:] / np.abs(r).max()
    rms = [float(np.sqrt(np.mean(part**2))) for part in (df, dr)]
    return [measured, predicted, *rms, float(np.abs(df).max()), float(np.abs(dr).max())]


def _listed(pressures: tuple[float, ...]) -> str:
    return ", ".join(f"{p:g}" for p in pressures) or "none"
