"""Ellipsoids and thimbles by CalculiX (an optional peer, found on PATH): inflated, then pressed by a plate.

CalculiX's pressure during the press is the solid's, so the force is what is compared, as in the tests' press.
"""

from __future__ import annotations

import shutil
from dataclasses import replace
from typing import Any

import numpy as np
from tests.mechanics.solid.calculix_presses import calculix_inflated, calculix_press

from benchmarks.scenes import PAPER
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.solid.indent import PressSettings, indent
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.shape.round import Ellipsoid, Thimble
from pneutouch.units import KPA

CELLS, DRIVING_KPA, DEPTH = (48, 2), (10.0, 20.0), 3.0
"""CalculiX's cells along the arc and through the wall, driving pressures, and the depth of the press in mm."""


def row(sensor: Sensor, driving: float) -> dict[str, Any]:
    """CalculiX over the solid on its default mesh, less 1: height and volume, then force by depth (mm)."""
    solid = SolidModel(dome(sensor.dome.shape), neo_hookean(sensor.wall.shear_modulus, sensor.wall.poisson_ratio))
    free = state_at(solid, driving)
    press = indent(solid, free, PressSettings(DEPTH, 6, 2 * sensor.protocol.plate_radius, gauge_range=np.inf))
    depth, force, pressure = (press.column(name) for name in ("indentation", "force", "pressure"))
    theirs = calculix_press(sensor, 0.0, depth, pressure, CELLS, free.outer_apex)[2::2]
    known = zip(calculix_inflated(sensor, driving, CELLS), (free.inner_apex, free.volume), strict=True)
    return {
        "shape": sensor.dome.shape.key,
        "driving_kPa": driving / KPA,
        "free": [found / ours - 1.0 for found, ours in known],
        "press": np.stack([depth[2::2], force[2::2], theirs / force[2::2] - 1.0], axis=1).tolist(),
    }


def shapes_calculix() -> list[dict[str, Any]]:
    """Both shapes at both pressures, with the wall, the modulus and the radius of the paper; empty without CalculiX."""
    if shutil.which("ccx") is None:
        return []
    radius, wall = PAPER.dome.inner_radius, PAPER.dome.wall_thickness
    forms = Ellipsoid(radius, wall, 11.5), Thimble(radius, wall, 4.5, radius)
    sensors = [replace(PAPER, dome=replace(PAPER.dome, shape=form)) for form in forms]
    return [row(sensor, kpa * KPA) for sensor in sensors for kpa in DRIVING_KPA]
