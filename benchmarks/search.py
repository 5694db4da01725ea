"""Selection and sweep against what a laboratory would write itself: ``python -m benchmarks.search`` (ten minutes).

Each way answers the same questions. Its error is that of the sensitivity it states against two refined meshes of the solid,
extrapolated; its time is processor time on one core, whole calls. Writes docs/background/search.json.
"""

from __future__ import annotations

import itertools
import os
import platform
import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import brentq

import pneutouch as pt
from benchmarks.methods import solid_answer
from benchmarks.scenes import Scene
from benchmarks.store import store, timed
from pneutouch.errors import PneutouchError
from pneutouch.evaluation.evaluate import sensor_of
from pneutouch.mechanics import predict
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.atlas.respond import respond
from pneutouch.mechanics.sensor import Sensor
from pneutouch.units import KPA

RESINS = ("TangoPlus", "FLX9940", "FLX9950", "FLX9960", "FLX9970")
WIDEST_MM = 25.0
TARGETS = ((3.0, 10.0), (1.9, 12.0), (1.4, 15.0), (2.2, 5.0))
"""Sensitivity (kPa/N) at a driving pressure (kPa)."""

SWEPT = {"wall_thickness_mm": [1.2, 1.5, 1.8, 2.1], "material": ["TangoPlus", "FLX9940", "FLX9950", "FLX9960"]}
SWEPT_AT_KPA = (0.0, 8.0, 16.0)


def sensor(design: pt.Design) -> Sensor:
    """The sensor of a design."""
    return sensor_of(design.assembly)


def refined(design: pt.Design, pressure_kPa: float) -> float:
    """Sensitivity (kPa/N) from meshes of 32 x 2 and 64 x 4 cells, extrapolated by first order, over their common range."""
    scene = Scene(design.name, sensor(design), pressure_kPa * KPA)
    coarse, fine = (solid_answer(scene, arc, through) for arc, through in ((32, 2), (64, 4)))
    grid = np.linspace(0.0, min(coarse.end, fine.end), scene.sensor.protocol.steps + 1)
    return 2.0 * fine.sensitivity(grid) - coarse.sensitivity(grid)


def by_model(design: pt.Design, pressure_kPa: float, model: str) -> float:
    """Sensitivity (kPa/N) by one model; NaN where it has none."""
    try:
        (state,) = predict("", sensor(design), [pressure_kPa * KPA], model=model).states
    except PneutouchError:
        return np.nan
    return np.nan if state.figures is None else state.figures.sensitivity


def selected(target: float, pressure_kPa: float) -> pt.Design:
    return pt.select(
        sensitivity_kPa_per_N=target, driving_pressure_kPa=pressure_kPa, max_diameter_mm=WIDEST_MM
    ).designs[0]


def on_a_grid(target: float, pressure_kPa: float) -> pt.Design:
    """Nearest of five resins, four radii and five walls, each solved by the solid."""
    designs = [
        pt.Design(inner_radius_mm=radius, wall_thickness_mm=wall, material=resin)
        for resin, radius, wall in itertools.product(RESINS, (6.0, 7.5, 9.0, 10.0), (1.0, 1.3, 1.6, 2.0, 2.4))
    ]
    off = [abs(by_model(design, pressure_kPa, "solid") - target) for design in designs]
    return designs[int(np.nanargmin(off))]


def by_roots(target: float, pressure_kPa: float) -> pt.Design | None:
    """For each resin and four radii the wall that gives the target, by Brent's method on the solid; the first, or None."""
    for resin, radius in itertools.product(RESINS, (9.0, 7.5, 10.0, 6.0)):

        def design(wall: float, resin: str = resin, radius: float = radius) -> pt.Design:
            return pt.Design(inner_radius_mm=radius, wall_thickness_mm=wall, material=resin)

        def off(wall: float, design: Callable[[float], pt.Design] = design) -> float:
            return by_model(design(wall), pressure_kPa, "solid") - target

        ends = off(1.0), off(2.4)
        if np.isfinite(ends).all() and ends[0] * ends[1] < 0:
            return design(round(brentq(off, 1.0, 2.4, xtol=0.01), 2))
    return None


SEARCHES: dict[str, Callable[[float, float], pt.Design | None]] = {
    "pneutouch select": selected,
    "grid of 100 designs, solid": on_a_grid,
    "wall by Brent's method, solid": by_roots,
}


def searches() -> Iterator[dict[str, Any]]:
    """One row for each way and target."""
    selected(*TARGETS[0])  # Caches and imports.
    for (target, pressure_kPa), (name, way) in itertools.product(TARGETS, SEARCHES.items()):
        design, seconds = timed(partial(way, target, pressure_kPa))
        truth = None if design is None else refined(design, pressure_kPa)
        yield {
            "way": name,
            "target_kPa_per_N": target,
            "driving_pressure_kPa": pressure_kPa,
            "material": design and design.material,
            "inner_radius_mm": design and design.inner_radius_mm,
            "wall_thickness_mm": design and design.wall_thickness_mm,
            "refined_kPa_per_N": truth,
            "off_relative": truth and truth / target - 1.0,
            "processor_s": seconds,
        }


def _swept(model: str, fields: dict[str, Any] = SWEPT) -> np.ndarray:
    found = pt.sweep(pt.load("paper-dome"), model=model, driving_pressures_kPa=list(SWEPT_AT_KPA), **fields)
    return np.asarray(found["sensitivity_kPa_per_N"].to_numpy().reshape(-1, len(SWEPT_AT_KPA)))


def _looped(model: str, fields: dict[str, Any] = SWEPT) -> np.ndarray:
    rows = []
    for values in itertools.product(*fields.values()):
        design = pt.load("paper-dome").replace(**dict(zip(fields, values, strict=True)))
        rows.append([s.sensitivity_kPa_per_N for s in design.predict(list(SWEPT_AT_KPA), model=model).states])
    return np.array(rows)


def sweeps() -> Iterator[dict[str, Any]]:
    """One row for each way to predict the same 16 designs at three driving pressures."""
    truth = np.array(
        [
            [
                refined(pt.load("paper-dome").replace(wall_thickness_mm=wall, material=resin), kPa)
                for kPa in SWEPT_AT_KPA
            ]
            for wall, resin in itertools.product(*SWEPT.values())
        ]
    )
    ways = {
        "pneutouch sweep, atlas": lambda: _swept("atlas"),
        "pneutouch sweep, auto": lambda: _swept("auto"),
        "pneutouch sweep, solid": lambda: _swept("solid"),
        "loop of predict, atlas": lambda: _looped("atlas"),
        "loop of predict, solid": lambda: _looped("solid"),
    }
    for name, way in ways.items():
        values, seconds = timed(way)
        off = np.abs(values / truth - 1.0)
        yield {
            "way": name,
            "predictions": int(truth.size),
            "processor_s": seconds,
            "median_error": float(np.nanmedian(off)),
            "greatest_error": float(np.nanmax(off)),
        }


def _fields(count: int) -> dict[str, Any]:
    walls = np.linspace(1.0, 1.8, min(count, 1000)).tolist()
    return {"wall_thickness_mm": walls, "inner_radius_mm": np.linspace(9.25, 11.0, -(-count // 1000)).tolist()}


def _arrays(model: str, fields: dict[str, Any]) -> None:
    """The atlas's array operations alone: of each state and the 14 neighbours behind its interval."""
    walls = np.repeat(fields["wall_thickness_mm"], 15 * len(SWEPT_AT_KPA))
    pressures = np.resize(SWEPT_AT_KPA, walls.size) * KPA
    respond(replace(batch_of(sensor(pt.load("paper-dome")), pressures), wall_thickness=walls))


GROWTH: dict[str, tuple[Callable[[str, dict[str, Any]], Any], tuple[int, ...]]] = {
    "pneutouch sweep, atlas": (_swept, (1, 10, 100, 1000, 10_000, 100_000)),
    "loop of predict, atlas": (_looped, (1, 10, 100, 1000)),
    "pneutouch sweep, solid": (_swept, (1, 10, 100)),
    "loop of predict, solid": (_looped, (1, 10, 100)),
    "array operations, atlas": (_arrays, (1, 10, 100, 1000)),
}
"""Ways to predict many designs, and the numbers of designs for which each is timed."""


def growth() -> Iterator[dict[str, Any]]:
    """Processor time of each way over the number of designs; the sweep's with its intervals."""
    for name, (way, counts) in GROWTH.items():
        jobs = [partial(way, name.split(", ")[1], _fields(count)) for count in (1, *counts)]
        yield {"way": name, "designs": counts, "processor_s": [timed(job)[1] for job in jobs][1:]}


def machine() -> str:
    """What the times were taken on."""
    cpu = Path("/proc/cpuinfo").read_text(encoding="utf-8") if Path("/proc/cpuinfo").exists() else ""
    model = re.search(r"model name\s*: (.*)", cpu)
    name = model.group(1) if model else platform.processor() or platform.machine()
    return f"{os.cpu_count()} cores of {name} ({platform.system()}, Python {platform.python_version()})"


def main() -> None:
    data = {"machine": machine(), "searches": list(searches()), "sweeps": list(sweeps()), "growth": list(growth())}
    store("search", data)


if __name__ == "__main__":
    main()
