"""Limits of the driving pressure of a sensor: limit point, break strain of the resin, range of the gauge."""

from dataclasses import dataclass

import numpy as np

from pneutouch.mechanics.membrane import LIMIT_HEIGHT, LIMIT_PRESSURE, pressure, thickness_stretch
from pneutouch.mechanics.sensor import Sensor

RATED_SHARE = 0.9
"""Rated pressure over the binding limit; above it a warning is given: the dome grows fast near the limit point."""


LAW_RANGE = "law range"
"""Name of the limit and event beyond which the wall is stretched further than the data its law was fitted to."""


@dataclass(frozen=True, slots=True)
class LimitPoint:
    """The maximum of the inflation curve: apex heights in mm, driving pressure in MPa."""

    apex_inner: float
    apex_outer: float
    driving_pressure: float
    thickness_stretch: float

    @property
    def membrane_stretch(self) -> float:
        """In-plane stretch."""
        return float(self.thickness_stretch**-0.5)


@dataclass(frozen=True, slots=True)
class Limits:
    """Driving pressures (MPa) at which each limit is met; None if it is not met before the limit point.

    ``law_range``: pressure at which the wall leaves the stretches that its law was fitted over, if the law states them.
    """

    limit_point: float | None
    break_strain: float | None
    gauge: float
    law_range: float | None = None

    @property
    def binding(self) -> str:
        """Name of the limit met first."""
        return min(self.named(), key=lambda item: item[1])[0]

    @property
    def lowest(self) -> float:
        """The driving pressure at which the first limit is met, MPa."""
        return min(value for _, value in self.named())

    def named(self) -> list[tuple[str, float]]:
        """The limits that are met, with their names."""
        pairs = [
            ("limit point", self.limit_point),
            ("break strain", self.break_strain),
            (LAW_RANGE, self.law_range),
            ("gauge range", self.gauge),
        ]
        return [(name, value) for name, value in pairs if value is not None]


def limit_point(sensor: Sensor) -> LimitPoint:
    """The limit point of the paper's membrane: the same stretch for every resin and size."""
    stretch = float(thickness_stretch(np.array(LIMIT_HEIGHT)))
    apex = LIMIT_HEIGHT * sensor.dome.inner_radius
    scale = sensor.wall.shear_modulus * sensor.dome.wall_thickness / sensor.dome.inner_radius
    return LimitPoint(apex, apex + stretch * sensor.dome.wall_thickness, LIMIT_PRESSURE * scale, stretch)


def limits(sensor: Sensor) -> Limits:
    """Driving pressures at which free inflation, without contact, reaches each limit.

    The break strain is a uniaxial elongation at break; comparing it with the equibiaxial stretch is an assumption,
    stated with the figures.
    """
    broken = None
    if sensor.wall.break_stretch is not None:
        height = np.sqrt(2 * sensor.wall.break_stretch**2 - 1)
        if height < LIMIT_HEIGHT:
            dome = sensor.dome
            broken = float(pressure(height, dome.inner_radius, dome.wall_thickness, sensor.wall.shear_modulus))
    return Limits(limit_point(sensor).driving_pressure, broken, sensor.gas.gauge_limit)
