"""Sensors as the atlas takes them."""

from collections.abc import Sequence

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.sensor import Sensor


def batch_of(sensor: Sensor, driving_pressures: Sequence[float] | Array) -> SensorBatch:
    """One sensor at n driving pressures (MPa).

    Its own law, Poisson ratio and flange are left aside: the atlas is neo-Hookean, at 0.49, clamped at the base.
    """
    size = len(driving_pressures)
    facts = (
        sensor.dome.inner_radius,
        sensor.dome.wall_thickness,
        sensor.wall.shear_modulus,
        sensor.gas.ambient_pressure,
        sensor.gas.dead_volume,
        np.asarray(driving_pressures, dtype=float),
        sensor.protocol.depth,
        sensor.protocol.plate_radius,
        sensor.gas.gauge_limit,
        np.inf if sensor.wall.break_stretch is None else sensor.wall.break_stretch,
    )
    return SensorBatch(*(np.array(np.broadcast_to(fact, size), dtype=float) for fact in facts))
