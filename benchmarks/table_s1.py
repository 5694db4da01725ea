"""The cells of the paper's Table S1 as friction, base, dead volume and fitted range change, one at a time.

``python -m benchmarks.table_s1`` (two minutes of processor time) writes docs/background/table-s1.json; with ``stored`` it
reduces the stored cells anew. `benchmarks.protocol` varies them together, with more that the paper leaves open.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from benchmarks.paper import OTHER_SOURCE, resins
from benchmarks.store import LIBRARY, store, stored
from benchmarks.validation import PRINTED_FLANGE
from pneutouch.arrays import Array
from pneutouch.catalogue import Library
from pneutouch.errors import ComputationError
from pneutouch.evaluation.table_s1 import PRESSURES, measured
from pneutouch.mechanics import Sensor, predict
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.sensor import RigidBase
from pneutouch.spec.material import Material
from pneutouch.units import KPA, ML


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


FACTORS = {
    "friction 0.3": Assumptions(friction=0.3),
    "friction 0.6": Assumptions(friction=0.6),
    "friction 1": Assumptions(friction=1.0),
    "grip": Assumptions(friction=np.inf),
    "rim as printed": Assumptions(rim="as printed"),
    "no base": Assumptions(rim="no base"),
    "dead volume 0.2 mL": Assumptions(dead_volume_mL=0.2),
    "range to depth": Assumptions(range="depth"),
}
"""One assumption changed at a time."""

ALL = (Assumptions(), *FACTORS.values())


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
    value = float("nan") if state.figures is None else state.figures.sensitivity
    return value, state.range_end, end


def errors(rows: list[CellRow], assumed: Assumptions) -> Array:
    """Relative errors of the cells under assumptions, (n_rows,); NaN where there is no figure."""
    return np.array([row.sensitivity[assumed] / row.measured - 1 for row in rows])


def raw(rows: list[CellRow]) -> list[dict[str, Any]]:
    """The rows as JSON: sensitivities in kPa/N and ends in mm, in the order of `ALL`."""
    return [
        {
            "material": row.material,
            "driving_pressure_kPa": row.pressure_kPa,
            "measured_kPa_per_N": row.measured,
            "repeatability_kPa_per_N": row.repeatability,
            "cells": {
                assumed.change(): [
                    round(row.sensitivity[assumed], 5),
                    round(row.ends[assumed][0], 3),
                    row.ends[assumed][1],
                ]
                for assumed in ALL
            },
        }
        for row in rows
    ]


def read(cells: list[dict[str, Any]]) -> list[CellRow]:
    """The rows that `raw` wrote."""
    names = {assumed.change(): assumed for assumed in ALL}
    return [
        CellRow(
            one["material"],
            one["driving_pressure_kPa"],
            one["measured_kPa_per_N"],
            one["repeatability_kPa_per_N"],
            {names[key]: value[0] for key, value in one["cells"].items()},
            {names[key]: (value[1], value[2]) for key, value in one["cells"].items()},
        )
        for one in cells
    ]


def reduced(rows: list[CellRow]) -> dict[str, Any]:
    """What the page states of the cells: errors by friction, and effects of each assumption."""
    twelve, default = [row for row in rows if row.material != OTHER_SOURCE], Assumptions()
    frictions = [assumed for assumed in ALL if assumed == Assumptions(assumed.friction)]
    return {
        "rms": float(np.sqrt(np.mean(errors(twelve, default) ** 2))),
        "rows": [
            {
                "material": row.material,
                "driving_pressure_kPa": row.pressure_kPa,
                "measured_kPa_per_N": row.measured,
                "default_kPa_per_N": row.sensitivity[default],
                "effects": [row.sensitivity[a] / row.sensitivity[default] - 1 for a in FACTORS.values()],
                "errors": [row.sensitivity[a] / row.measured - 1 for a in frictions],
                "ends": [row.ends[default], row.ends[FACTORS["grip"]]],
            }
            for row in rows
        ],
    }


def main(*words: str) -> None:
    found = stored("table-s1")["cells"] if "stored" in words else raw(cells(LIBRARY))
    data = {"summary": reduced(read(found)), "cells": found}
    store("table-s1", data)


if __name__ == "__main__":
    main(*sys.argv[1:])
