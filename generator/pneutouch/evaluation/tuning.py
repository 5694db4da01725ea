"""A sensor's sensitivity over the driving pressure, with its interval, by the atlas."""

from collections.abc import Sequence

import numpy as np

from pneutouch.arrays import Array
from pneutouch.evaluation.chart_data import TuningCurve
from pneutouch.evaluation.uncertainty import known
from pneutouch.mechanics import Sensor, SensorState
from pneutouch.mechanics.atlas.respond import OUTSIDE, respond
from pneutouch.mechanics.atlas.table import shipped
from pneutouch.mechanics.limits import RATED_SHARE
from pneutouch.mechanics.uncertainty import FIGURES, ContactModel, batch_of
from pneutouch.spec.calibration import SensorCalibration
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer
from pneutouch.units import KPA

POINTS = 41
"""Driving pressures of a curve."""

_BUDGETS = 7
"""Driving pressures at which the interval is worked out; its logarithm is straight between them."""

_SENSITIVITY = FIGURES.index("sensitivity_kPa_per_N")


def curve(sensor: Sensor, highest: float, label: str) -> TuningCurve | None:
    """The curve from no driving pressure to ``highest`` (MPa), or to `RATED_SHARE` of the limit point if that comes
    first.

    The sensor must lie in the atlas. Pressures at which it has no answer are left out; None if fewer than two are
    left.
    """
    limit = (
        float(shipped().slices(np.array([sensor.dome.wall_thickness / sensor.dome.inner_radius]), ()).limit_pressure[0])
        * sensor.wall.shear_modulus
    )
    pressures = np.linspace(0.0, min(highest, RATED_SHARE * limit), POINTS)
    response = respond(batch_of(sensor, pressures.tolist()), sensor.protocol.steps)
    kept = np.isfinite(response.lines.sensitivity_kPa_per_N) & (response.ends != OUTSIDE)
    if kept.sum() < 2:
        return None
    factor = np.array([sensor.correction.sensitivity_factor(pressure) for pressure in pressures[kept].tolist()])
    return TuningCurve(label, pressures[kept] / KPA, factor * response.lines.sensitivity_kPa_per_N[kept])


def under_contact(sensor: Sensor, drawn: TuningCurve, states: Sequence[SensorState]) -> TuningCurve:
    """A curve of the sensor under a plate without friction made that of the sensor under its own contact.

    ``states`` are the solid's, at a few driving pressures; the ratio is straight in its logarithm between them.
    Pressures that it cannot be solved at are left out.
    """
    contact = ContactModel(sensor, tuple((drawn.driving_pressure_kPa * KPA).tolist()), states)
    ratio = contact.ratio[_SENSITIVITY]
    kept = np.isfinite(ratio)
    sensitivity_kPa_per_N = np.exp(ratio[kept]) * drawn.sensitivity_kPa_per_N[kept]
    return TuningCurve(drawn.label, drawn.driving_pressure_kPa[kept], sensitivity_kPa_per_N)


def interval(
    sensor: Sensor,
    drawn: TuningCurve,
    material: Material,
    materials: Sequence[Material],
    printer: Printer,
    model: str,
    calibration: SensorCalibration | None = None,
    states: Sequence[SensorState] = (),
    *,
    anywhere: bool = False,
) -> tuple[Array, Array]:
    """Lower and upper end of a curve's k = 2 interval, kPa/N, (n,) each.

    ``materials`` are all that there are; ``model`` gives the numerical error. ``states`` are the solid's of another
    contact than a plate without friction.
    """
    at = np.linspace(drawn.driving_pressure_kPa[0], drawn.driving_pressure_kPa[-1], _BUDGETS)
    estimate = known(
        sensor, (at * KPA).tolist(), material, materials, printer, model, calibration, states, anywhere=anywhere
    )
    widths = estimate.budget.expanded[_SENSITIVITY]
    good = np.isfinite(widths)
    width = np.interp(drawn.driving_pressure_kPa, at[good], widths[good])
    return drawn.sensitivity_kPa_per_N * np.exp(-width), drawn.sensitivity_kPa_per_N * np.exp(width)
