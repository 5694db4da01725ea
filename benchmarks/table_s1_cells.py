"""The cells of the paper's Table S1 under what the paper leaves open: friction, base, dead volume and fitted range."""

from __future__ import annotations

import itertools
import os
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from benchmarks.paper import resins
from benchmarks.validation import PRINTED_FLANGE
from pneutouch.catalogue import Library
from pneutouch.errors import ComputationError
from pneutouch.evaluation.table_s1 import PRESSURES, measured
from pneutouch.mechanics import Sensor, predict
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.solid.rigid_base import RigidBase
from pneutouch.spec.material import Material
from pneutouch.units import KPA, ML

FRICTIONS = (0.0, 0.3, 0.6, 1.0, np.inf)
RIMS = ("base plane", "as printed", "no base")
DEAD_VOLUMES_ML = (0.0, 0.2)
RANGES = ("gauge", "depth")


class Assumptions(NamedTuple):
    """What the paper leaves open: coefficient of friction, how the rim is held, dead volume, end of the fitted range.

    The rim: clamped at the base plane on which the wall may lie down; clamped as printed, on a flange in a groove;
    clamped at the base plane through which the wall passes. The range ends at the first event that ends a prediction's
    range ("gauge"), or goes on beyond the gauge's 100 kPa ("depth").
    """

    friction: float = 0.0
    rim: str = "base plane"
    dead_volume_mL: float = 0.0
    range: str = "gauge"

    def change(self) -> str:
        """What differs from the default, as text; "default" for none."""
        names = {
            "friction": "friction {}",
            "rim": "rim {}",
            "dead_volume_mL": "dead volume {} mL",
            "range": "range to {}",
        }
        parts = [
            names[key].format("grip" if value == np.inf else value)
            for key, value in self._asdict().items()
            if value != getattr(Assumptions(), key)
        ]
        return ", ".join(parts) or "default"


ALL = tuple(Assumptions(*parts) for parts in itertools.product(FRICTIONS, RIMS, DEAD_VOLUMES_ML, RANGES))


@dataclass(frozen=True)
class CellRow:
    """A cell of Table S1, kPa/N, with its repeatability, and for each of the assumptions computed the
    sensitivity, kPa/N (NaN: no figure), the end of the fitted range, mm, and the event there ("depth" for none)."""

    material: str
    pressure_kPa: float
    measured: float
    repeatability: float
    sensitivity: dict[Assumptions, float]
    ends: dict[Assumptions, tuple[float, str]]


def scene(sensor: Sensor, assumed: Assumptions) -> Sensor:
    """The paper's sensor under assumptions."""
    base, flange = {
        "base plane": (RigidBase(), None),
        "as printed": (RigidBase(), PRINTED_FLANGE),
        "no base": (None, None),
    }[assumed.rim]
    limit = sensor.gas.gauge_limit if assumed.range == "gauge" else np.inf
    return sensor.replace(
        friction=assumed.friction,
        base=base,
        flange=flange,
        dead_volume=assumed.dead_volume_mL * ML,
        gauge_limit=limit,
        waves=0,
    )


def cells(library: Library, assumptions: Iterable[Assumptions] = ALL, workers: int | None = None) -> list[CellRow]:
    """Every cell of Table S1 under the assumptions; resins softest first, both pressures of each."""
    wanted = tuple(assumptions)
    with ProcessPoolExecutor(workers or os.cpu_count()) as pool:
        jobs = [pool.submit(resin_rows, material, wanted) for material in resins(library)]
        return [row for job in jobs for row in job.result()]


def resin_rows(material: Material, assumptions: tuple[Assumptions, ...]) -> list[CellRow]:
    """The cells of one resin, one for each driving pressure."""
    truth, sensor = measured(material), material_sensor(material)
    assert truth is not None and material.measured is not None
    repeatability = material.measured.repeatability_kPa_per_N.nominal
    rows = [CellRow(material.title, p, s, repeatability, {}, {}) for p, s in zip(PRESSURES, truth, strict=True)]
    for assumed in assumptions:
        for row in rows:
            row.sensitivity[assumed], *end = _figure(scene(sensor, assumed), row.pressure_kPa)
            row.ends[assumed] = (end[0], end[1])
    return rows


def _figure(sensor: Sensor, pressure_kPa: float) -> tuple[float, float, str]:
    """Sensitivity, kPa/N, end of its range, mm, and the event there."""
    try:
        (state,) = predict("", sensor, [pressure_kPa * KPA]).states
    except ComputationError as error:
        return float("nan"), 0.0, str(error)
    end = next((event.kind for event in state.events if event.ends_range), "depth")
    value = float("nan") if state.figures is None else state.figures.sensitivity_kPa_per_N
    return value, state.range_end, end
