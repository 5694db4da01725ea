"""The rung ``membrane``: the paper's theory run for a sensor, states I and II."""

from __future__ import annotations

import numpy as np

from pneutouch.mechanics.contact import Pressed, press
from pneutouch.mechanics.events import events, range_end
from pneutouch.mechanics.gas import TrappedGas
from pneutouch.mechanics.inflation import (
    EXACT_LIMIT_HEIGHT,
    EXACT_LIMIT_PRESSURE,
    LIMIT_HEIGHT,
    LIMIT_PRESSURE,
    relative_height,
    thickness_stretch,
)
from pneutouch.mechanics.laws import LAWS
from pneutouch.mechanics.prediction import State
from pneutouch.mechanics.response import figures
from pneutouch.mechanics.sensor import Sensor
from pneutouch.meridian.segments import Array
from pneutouch.units import KPA

ERROR_AGAINST_EXACT_MEMBRANE = {
    "limit_pressure_relative": LIMIT_PRESSURE / EXACT_LIMIT_PRESSURE - 1,
    "limit_apex_height_relative": LIMIT_HEIGHT / EXACT_LIMIT_HEIGHT - 1,
}
"""What the assumption of constant curvature costs at the limit point."""


_FINE = 8
"""Events are looked for on a grid this many times finer than the steps."""


def membrane_states(sensor: Sensor, driving_pressures: Array, closure: str) -> tuple[State, ...]:
    """Inflate to every driving pressure (MPa, ascending) and press in ``sensor.steps`` equal steps.

    Figures are fitted on as many equal steps up to the first event that ends the range, so that they do not
    jump when an event passes a step.
    """
    x = relative_height(driving_pressures, sensor.inner_radius, sensor.wall_thickness, sensor.shear_modulus)
    apex = x * sensor.inner_radius
    volume = np.pi / 6 * apex * (3 * sensor.inner_radius**2 + apex**2)
    gas = TrappedGas(driving_pressures[:, None], volume[:, None], sensor.dead_volume, sensor.ambient_pressure)

    def pressed(indentation: Array) -> Pressed:
        return press(sensor, LAWS["neo-hookean"], gas, apex[:, None], indentation, closure)

    fine = np.linspace(0.0, sensor.depth, _FINE * sensor.steps + 1)
    way = pressed(fine)
    happened = [events(sensor, fine, way.row(k), closure) for k in range(len(apex))]
    ends = np.array([range_end(found, sensor.depth) for found in happened])
    grid = np.linspace(0.0, 1.0, sensor.steps + 1) * ends[:, None]
    fitted = pressed(grid)
    wall = thickness_stretch(x) * sensor.wall_thickness
    return tuple(
        State(
            driving_pressure=float(p), apex_inner=float(apex[k]), apex_outer=float(apex[k] + wall[k]),
            cavity_volume=float(volume[k]), range_end=float(ends[k]),
            figures=figures(grid[k], fitted.force[k], (fitted.pressure[k] - p) / KPA),
            indentation=fine[::_FINE], force=way.force[k, ::_FINE], pressure_rise=way.pressure[k, ::_FINE] - p,
            contact_radius=way.contact_radius[k, ::_FINE],
            membrane_stretch=way.thickness_stretch[k, ::_FINE] ** -0.5, events=tuple(happened[k]),
        )
        for k, p in enumerate(driving_pressures)
    )  # fmt: skip
