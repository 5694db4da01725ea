"""The press with friction by CalculiX in three dimensions (an optional peer, found on PATH).

``python -m benchmarks.calculix_friction_half`` presses the paper's dome in FLX9960 centrally with the axisymmetric solid and
with half a dome of C3D20R cells, each with its own gas. Stores docs/background/friction-calculix.json. CalculiX counts slip from the beginning of its computation (tests/mechanics/solid/calculix_presses.py): the coefficient is one at
which nearly all points slip.
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np

from benchmarks.calculix_half import HalfPress
from benchmarks.scenes import paper
from benchmarks.store import store
from pneutouch.mechanics.harmonic.surface import PlacedObject
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.solid.indent import PressSettings, indent
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.object_contact import Plate
from pneutouch.units import KPA

SENSOR = paper(0.91)
DEPTH, STEPS = 2.4, 2
CELLS = (36, 2, 6)
COEFFICIENTS = (0.3,)
_COLUMNS = ("indentation", "force", "pressure")
_FINER = 8
"""Steps of the solid to one depth that is compared."""
_PLATE = 15.0


def compared(friction: float, cells: tuple[int, int, int]) -> list[dict[str, float]]:
    """The press by the solid on its default mesh and by CalculiX, one row a depth that CalculiX reaches."""
    wall = neo_hookean(SENSOR.wall.shear_modulus, SENSOR.wall.poisson_ratio)
    solid = SolidModel(dome(SENSOR.dome.shape), wall)
    settings = PressSettings(DEPTH, _FINER * STEPS, friction=friction, gauge_range=np.inf)
    states = indent(solid, state_at(solid, 0.0), settings).states[::_FINER]
    depths, forces, pressures = (np.array([getattr(s, name) for s in states]) for name in _COLUMNS)
    top = 1.0 + SENSOR.dome.wall_thickness / SENSOR.dome.inner_radius
    half = HalfPress(
        surface=PlacedObject(Plate(top, np.inf, 1.0)),
        edges=(np.array([-_PLATE, _PLATE]), np.array([-2.0, _PLATE])),
        driving=0.0,
        depths=depths,
        cells=cells,
        friction=friction,
        increment=0.25,
        wall=(SENSOR.wall.shear_modulus, SENSOR.wall.poisson_ratio),
    )
    return [
        {
            "depth_mm": round(stop.depth, 9),
            "solid_force_N": float(force),
            "calculix_force_N": stop.force,
            "solid_rise_kPa": float(pressure) / KPA,
            "calculix_rise_kPa": stop.pressure / KPA,
        }
        for stop, force, pressure in zip(half.run(pressures)[0], forces[1:], pressures[1:], strict=False)
    ]


def differences(data: dict[str, Any], figure: str) -> list[float]:
    """CalculiX over the solid, less 1, in every row."""
    return [row[f"calculix_{figure}"] / row[f"solid_{figure}"] - 1.0 for row in data["rows"]]


def main(*cells: int) -> None:
    """All coefficients, and one table."""
    mesh = (cells[0], cells[1], cells[2]) if cells else CELLS
    rows = [{"friction": friction, **row} for friction in COEFFICIENTS for row in compared(friction, mesh)]
    data = {"cells": list(mesh), "rows": rows}
    store("friction-calculix", data)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
