"""Cells of the solid that follow the object that presses a sensor."""

import numpy as np

from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.solid.indenter import CELLS_PER_RADIUS
from pneutouch.mechanics.solid.mesh import arc_cells

MOST_CELLS = 192
"""Most cells along the arc for the sake of an object; beyond, a prediction takes minutes."""


def object_cells(sensor: Sensor) -> int | None:
    """Cells along the arc that follow the object pressing a sensor; None if the default does, as for a plate."""
    if sensor.protocol.body is None:
        return None
    dome, smallest = sensor.dome, sensor.protocol.body.smallest
    arc = 0.5 * np.pi * (dome.inner_radius + dome.wall_thickness)
    cells = int(np.ceil(CELLS_PER_RADIUS * arc / smallest))
    return cells if cells > arc_cells(dome.wall_thickness / dome.inner_radius) else None
