"""Sensors as the atlas takes them."""

from __future__ import annotations

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
        sensor.inner_radius, sensor.wall_thickness, sensor.shear_modulus, sensor.ambient_pressure, sensor.dead_volume,
        np.asarray(driving_pressures, dtype=float), sensor.depth, sensor.plate_radius, sensor.gauge_limit,
        np.inf if sensor.break_stretch is None else sensor.break_stretch,
    )  # fmt: skip
    return SensorBatch(*(np.array(np.broadcast_to(fact, size), dtype=float) for fact in facts))
