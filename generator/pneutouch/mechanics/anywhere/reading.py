"""Error of a force that is read by the central calibration while the contact is off the centre.

Also the input variables of the contact table for given sensors, and the limits of the table.
"""

from collections.abc import Sequence

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.mechanics.anywhere.table import RECIPE, ContactPlaces, DomeConditions, PlaceTable, shipped
from pneutouch.mechanics.atlas.press import SensorBatch, batch_of
from pneutouch.mechanics.prediction import SensorState
from pneutouch.mechanics.sensor import Sensor
from pneutouch.shape.hemisphere import no_hemisphere

_SLACK = 1e-9


def batch_conditions(batch: SensorBatch, limit_pressure: Array, cavity_volume: Array) -> DomeConditions:
    """Inputs of the table for n sensors, from their limit pressures (MPa) and their cavity volumes (mm3) at the driving
    pressures, (n,) each."""
    volume = (cavity_volume + batch.dead_volume) / batch.inner_radius**3
    gas = (batch.driving_pressure + batch.ambient_pressure) / batch.shear_modulus / volume
    return DomeConditions(batch.wall_ratio, batch.driving_pressure / limit_pressure, gas)


def state_conditions(sensor: Sensor, states: Sequence[SensorState], limit_pressure: float) -> DomeConditions:
    """Inputs of the table for one sensor in n predicted states; ``limit_pressure`` in MPa."""
    driving, cavity = (np.array([getattr(s, name) for s in states]) for name in ("driving_pressure", "cavity_volume"))
    return batch_conditions(batch_of(sensor, driving), np.full(driving.size, limit_pressure), cavity)


def covered(domes: DomeConditions) -> Flags:
    """Mask (n,) of the domes that lie inside the table."""
    inside = np.ones(domes.share.shape, dtype=bool)
    for values, nodes in _axes(domes):
        inside &= (values >= nodes[0] * (1 - _SLACK)) & (values <= nodes[-1] * (1 + _SLACK))
    return inside


def outside(sensor: Sensor, domes: DomeConditions) -> str | None:
    """Reason why the table does not cover a sensor in some of its states ``domes``; None if it covers all."""
    dome, wall = sensor.dome, sensor.wall
    reasons = [
        (sensor.protocol.other_contact is not None, str(sensor.protocol.other_contact)),
        (wall.grade is not None, "the wall is graded along its arc"),
        (wall.law is not None, "the resin has a law of its own, not the neo-Hookean one"),
        (wall.poisson_ratio != RECIPE.poisson_ratio, f"Poisson ratio {wall.poisson_ratio:g}, not 0.49"),
        (no_hemisphere(dome.shape) is not None, str(no_hemisphere(dome.shape))),
        (dome.flange is not None, "the flange is held as printed, not the base plane"),
        (dome.base is None, "the wall passes through its base plane"),
    ]
    names = ("wall of {:.3g} R0", "driving pressure of {:.3g} of the limit", "gas stiffness of {:.3g} mu/R0^3")
    for name, (values, nodes) in zip(names, _axes(domes), strict=True):
        off = (values < nodes[0] * (1 - _SLACK)) | (values > nodes[-1] * (1 + _SLACK))
        if off.any():
            bounds = f"{nodes[0]:g} to {nodes[-1]:g}"
            reasons.append((True, f"{name.format(float(values[off][0]))}, the table has {bounds}"))
    return next((why for applies, why in reasons if applies), None)


def _axes(domes: DomeConditions) -> list[tuple[Array, tuple[float, ...]]]:
    return [(domes.wall_ratio, RECIPE.walls), (domes.share, RECIPE.shares), (domes.gas, RECIPE.gases)]


SMALLEST_BALL, FARTHEST, STEEPEST_TILT = 0.3, 0.6, float(np.radians(20.0))
"""Ranges assumed for an unknown contact: smallest radius of a ball and greatest offset of its axis from the dome's,
both in R0, and the greatest tilt of a plate, rad."""

TABLE_ERROR = 0.05
"""Greatest error of the logarithm of the force, found in presses that were not used to make the table
(docs/background/off-axis.md)."""

_POINTS, _FEWER = 4, 3
_LEVELS = 8
_FIRST = 0.05
"""Least travel of the central plate, in R0, from which readings count."""


def ball_places(wall_ratio: Array, radius: Array, offset: Array) -> ContactPlaces:
    """Places of balls of radii (m,), inf for a plate, at offsets (m,), both in R0, on domes of wall ratios (n,)."""
    curvature = np.broadcast_to(1.0 / radius, (wall_ratio.size, radius.size))
    lean = offset * curvature / ((1.0 + wall_ratio)[:, None] * curvature + 1.0)
    return ContactPlaces(curvature, lean)


def edge_places(wall_ratio: Array, radius: Array, offset: Array) -> ContactPlaces:
    """Places of bars with edges of radii (m,), may be inf, and middle planes at offsets (m,), both in R0, on domes of
    wall ratios (n,). The cross-section of a bar touches like that of a ball of the same radius."""
    return ball_places(wall_ratio, radius, offset)._replace(lying=True)


def plate_places(wall_ratio: Array, tilt: Array) -> ContactPlaces:
    """Places of plates that lean by angles (m,), rad, on domes of wall ratios (n,)."""
    lean = np.broadcast_to(np.sin(tilt), (wall_ratio.size, tilt.size))
    return ContactPlaces(np.zeros_like(lean), lean)


def force_logs(domes: DomeConditions, places: ContactPlaces, levels: Array, table: PlaceTable | None = None) -> Array:
    """Logarithm (n, m, k) of the force under an object over that under the central plate at the same reading. The
    readings are those of the plate at travels ``levels`` (n, k) in R0; NaN if not reached by 0.75 R0 of travel.
    A force that is read by the central calibration is exp(-logarithm) times the true one. ``table`` None: shipped."""
    table = table or shipped()
    nodes, known = np.array(table.recipe.levels), table.logs(domes, places)
    at = np.clip(levels, nodes[0], nodes[-1])
    k = np.clip(np.searchsorted(nodes, at, side="right") - 1, 0, nodes.size - 2)
    share = ((at - nodes[k]) / (nodes[k + 1] - nodes[k]))[:, None]
    low, high = (np.take_along_axis(known, index[:, None], axis=2) for index in (k, k + 1))
    reached = levels[:, None] <= table.reach(domes, places)[..., None]
    return np.asarray(np.where(reached, low + share * (high - low), np.nan))


def place_uncertainty(domes: DomeConditions, range_end: Array) -> Array:
    """Standard uncertainty (n,) of the logarithm of a force that is read by the central calibration while object and
    place of contact are unknown; NaN outside the table.

    A Type B evaluation (JCGM 100, 4.3.7) with two independent parts. A ball: curvature uniform from 0 to that of radius
    0.3 R0, axis uniform over the disc of radius 0.6 R0. A leaning plate: angle uniform from 0 to 20 degrees. Each part
    is a root mean square over readings at equal steps of the central plate's travel, from first contact to
    ``range_end`` (n,) in R0, as far as the object reaches them. The mean error is not corrected: it counts in full.
    """
    inside = covered(domes) & (range_end > _FIRST)
    result = np.full(range_end.shape, np.nan)
    if not inside.any():
        return result
    domes = DomeConditions(*(values[inside] for values in domes))
    levels = _FIRST + (range_end[inside, None] - _FIRST) * np.linspace(0.0, 1.0, _LEVELS)
    result[inside] = np.sqrt(sum(_mean_square(domes, *unknown, levels) for unknown in (_balls(domes), _tilts(domes))))
    return result


def _balls(domes: DomeConditions) -> tuple[ContactPlaces, Array]:
    """Quadrature points (n, m) over the assumed balls and their offsets, with their weights (m,)."""
    curvature, by_curvature = _even(_POINTS, 1.0 / SMALLEST_BALL)
    disc, by_disc = _even(_FEWER, 1.0)
    radius, offset = np.repeat(1.0 / curvature, _FEWER), np.tile(FARTHEST * np.sqrt(disc), _POINTS)
    return ball_places(domes.wall_ratio, radius, offset), np.outer(by_curvature, by_disc).ravel()


def _tilts(domes: DomeConditions) -> tuple[ContactPlaces, Array]:
    """Quadrature points (n, m) over the assumed tilt of a plate, with their weights (m,)."""
    tilt, weight = _even(_FEWER, STEEPEST_TILT)
    return plate_places(domes.wall_ratio, tilt), weight


def _even(count: int, end: float) -> tuple[Array, Array]:
    """Gauss-Legendre points from 0 to ``end`` and their weights, which sum to 1, (count,) each."""
    points, weights = np.polynomial.legendre.leggauss(count)
    return 0.5 * end * (points + 1.0), 0.5 * weights


def _mean_square(domes: DomeConditions, places: ContactPlaces, weight: Array, levels: Array) -> Array:
    square = force_logs(domes, places, levels) ** 2
    counts = weight[:, None] * np.isfinite(square)
    return np.asarray((weight[:, None] * np.nan_to_num(square)).sum(axis=(1, 2)) / counts.sum(axis=(1, 2)))
