"""The table's variables of sensors, and the limits of the table."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.mechanics.anywhere.recipe import RECIPE
from pneutouch.mechanics.anywhere.table import DomeConditions
from pneutouch.mechanics.atlas.batches import batch_of
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.prediction import SensorState
from pneutouch.mechanics.sensor import Sensor

_SLACK = 1e-9


def batch_conditions(batch: SensorBatch, limit_pressure: Array, cavity_volume: Array) -> DomeConditions:
    """Conditions of n sensors with their limit pressures (MPa) and the cavity volumes at their driving pressures
    (mm3)."""
    volume = (cavity_volume + batch.dead_volume) / batch.inner_radius**3
    gas = (batch.driving_pressure + batch.ambient_pressure) / batch.shear_modulus / volume
    return DomeConditions(batch.wall_ratio, batch.driving_pressure / limit_pressure, gas)


def state_conditions(sensor: Sensor, states: Sequence[SensorState], limit_pressure: float) -> DomeConditions:
    """Conditions of one sensor in n predicted states; its limit pressure in MPa."""
    driving, cavity = (np.array([getattr(s, name) for s in states]) for name in ("driving_pressure", "cavity_volume"))
    return batch_conditions(batch_of(sensor, driving), np.full(driving.size, limit_pressure), cavity)


def covered(domes: DomeConditions) -> Flags:
    """True for those of n domes that lie inside the table."""
    inside = np.ones(domes.share.shape, dtype=bool)
    for values, nodes in _axes(domes):
        inside &= (values >= nodes[0] * (1 - _SLACK)) & (values <= nodes[-1] * (1 + _SLACK))
    return inside


def outside(sensor: Sensor, domes: DomeConditions) -> str | None:
    """Reason why the table does not cover a sensor in some of its states, or None if it covers all."""
    dome, wall = sensor.dome, sensor.wall
    reasons = [
        (sensor.protocol.other_contact is not None, str(sensor.protocol.other_contact)),
        (wall.grade is not None, "the wall is graded along its arc"),
        (wall.law is not None, "the resin has a law of its own, not the neo-Hookean one"),
        (wall.poisson_ratio != RECIPE.poisson_ratio, f"Poisson ratio {wall.poisson_ratio:g}, not 0.49"),
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
