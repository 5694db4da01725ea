"""The membrane theory beside the paper's measurements (Table S1) and the exact membrane, nothing fitted."""

from __future__ import annotations

from dataclasses import dataclass

from pneutouch.catalogue import Library
from pneutouch.mechanics import predict
from pneutouch.pipeline.evaluate import material_sensor
from pneutouch.spec.material import Material
from pneutouch.units import KPA


@dataclass(frozen=True)
class Cell:
    """One cell of Table S1: measured and predicted sensitivity, kPa/N."""

    material: str
    pressure: float
    measured: float
    variational: float
    printed: float

    @property
    def errors(self) -> tuple[float, float]:
        return self.variational / self.measured - 1, self.printed / self.measured - 1


def table_s1(library: Library) -> list[Cell]:
    """All fourteen cells on the paper's sensor: no dead volume, plate to three quarters of R0."""
    cells = []
    for material in library.all("materials", Material).values():
        if material.measured is None:
            continue
        measured = material.measured.sensitivity_0kPa_kPa_per_N, material.measured.sensitivity_22kPa_kPa_per_N
        sensor = material_sensor(material)
        states = [predict("", sensor, [0.0, 22 * KPA], closure=c).states for c in ("variational", "printed")]
        for k, pressure in enumerate((0.0, 22.0)):
            one, other = (found[k].figures for found in states)
            assert one is not None and other is not None
            cells.append(Cell(material.title, pressure, measured[k].nominal, one.sensitivity, other.sensitivity))
    return sorted(cells, key=lambda cell: (cell.pressure, -cell.measured))
