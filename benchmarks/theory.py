"""Every model beside the paper's measurements (Table S1), nothing fitted."""

from __future__ import annotations

import json
from dataclasses import dataclass

from pneutouch.catalogue import Library
from pneutouch.evaluation.table_s1 import PRESSURES, SHIPPED, compute_errors, fingerprint, measured
from pneutouch.mechanics import predict
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.spec.material import Material
from pneutouch.units import KPA, ML

METHODS = {
    "variational": ("membrane", "variational"),
    "printed": ("membrane", "printed"),
    "solid": ("solid", "variational"),
}


@dataclass(frozen=True)
class Cell:
    """One cell of Table S1: measured sensitivity (kPa/N), and each method's relative error and what ended its range."""

    material: str
    pressure: float
    measured: float
    errors: dict[str, float]
    ends: str
    range_end: float

    def value(self, method: str) -> float:
        """The predicted sensitivity, kPa/N."""
        return self.measured * (1 + self.errors[method])


def resins(library: Library) -> list[Material]:
    """The resins of Table S1, softest first."""
    found = [m for m in library.all("materials", Material).values() if measured(m)]
    return sorted(found, key=lambda m: m.shear_modulus_MPa.nominal if m.shear_modulus_MPa else 0.0)


def table_s1(library: Library, dead_volume_ml: float = 0.0, flange: tuple[float, float] | None = None) -> list[Cell]:
    """All fourteen cells on the paper's sensor: plate to three quarters of R0; ``flange`` as in Sensor."""
    cells = []
    for material in resins(library):
        truth = measured(material)
        assert truth is not None
        sensor = material_sensor(material).replace(dead_volume=dead_volume_ml * ML, flange=flange)
        runs = {
            name: predict("", sensor, [p * KPA for p in PRESSURES], model=model, closure=closure).states
            for name, (model, closure) in METHODS.items()
        }
        for k, pressure in enumerate(PRESSURES):
            errors = {
                name: s[k].figures.sensitivity_kPa_per_N / truth[k] - 1 for name, s in runs.items() if s[k].figures
            }
            state = runs["solid"][k]
            ends = next((event.kind for event in state.events if event.ends_range), "depth")
            cells.append(Cell(material.title, pressure, truth[k], errors, ends, state.range_end))
    return sorted(cells, key=lambda cell: (cell.pressure, -cell.measured))


def ship_errors(library: Library) -> None:
    """Write the file that predictions with the solid read their error in sensitivity from."""
    found = {
        fingerprint(m): [None if e is None else round(e, 4) for e in compute_errors(m, "solid", "variational")]
        for m in resins(library)
    }
    SHIPPED.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
