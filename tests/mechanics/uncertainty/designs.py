"""Ten designs that differ in resin, wall, size, pressure and dead volume, and their budgets."""

from __future__ import annotations

from typing import Any, NamedTuple

from pneutouch.catalogue import Library
from pneutouch.mechanics.atlas.press import SensorBatch, batch_of
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.uncertainty.document import budget
from pneutouch.mechanics.uncertainty.propagate import Budget
from pneutouch.mechanics.uncertainty.sources.model_error import model_errors
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer

NUMERICAL = {"sensitivity_kPa_per_N": 0.011, "limit_pressure_kPa": 0.002}


class Case(NamedTuple):
    resin: str
    driving_pressure: float
    near_paper: bool
    sensor: dict[str, float]


TEN = (
    Case("TangoPlus", 0.0, True, {}),
    Case("TangoPlus", 0.022, True, {}),
    Case("TangoPlus", 0.008, False, {"dead_volume": 1470.0}),
    Case("FLX9940", 0.022, True, {}),
    Case("FLX9950", 0.03, False, {"wall_thickness": 0.8, "dead_volume": 500.0}),
    Case("FLX9960", 0.0, False, {"wall_thickness": 2.2}),
    Case("FLX9970", 0.022, True, {"dead_volume": 200.0}),
    Case("FLX9985", 0.05, False, {"inner_radius": 6.0, "wall_thickness": 1.0, "depth": 3.0, "dead_volume": 300.0}),
    Case("FLX9995", 0.0, True, {}),
    Case("Agilus30", 0.005, False, {"inner_radius": 12.0, "wall_thickness": 1.2, "depth": 6.0, "dead_volume": 3e3}),
)


def materials(library: Library) -> dict[str, Material]:
    return {name: m for name, m in library.all("materials", Material).items() if m.kind == "elastomer"}


def batch_for(library: Library, case: Case) -> SensorBatch:
    sensor = material_sensor(materials(library)[case.resin]).replace(**case.sensor)
    return batch_of(sensor, [case.driving_pressure])


def budget_for(library: Library, batch: SensorBatch, resin: str, near_paper: bool, **more: Any) -> Budget:
    paths = materials(library)
    printer: Printer = library.load("printers", "objet260-connex")
    errors = model_errors(paths[resin], paths.values())
    return budget(batch, paths[resin], printer, near_paper=near_paper, errors=errors, numerical=NUMERICAL, **more)
