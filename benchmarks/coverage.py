"""Do stated intervals hold what they say? Simulated campaigns of the paper, read and made figures, against their truth.

Each campaign: seven resins, three specimens, two driving pressures, three steps runs, one loop and one relaxation run. Writes
docs/background/coverage.json; with ``stored`` the table is reduced anew.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from tests.bench.reads import blocks_of

from benchmarks.store import store, stored
from pneutouch.bench.curve import curve_of
from pneutouch.bench.figures import BY_KEY, FIGURES, RESOLVED, RunGroup, summarize
from pneutouch.bench.record import MeasuredCurve
from pneutouch.bench.simulate.curve import PressCurve, PressCurves, press_curves
from pneutouch.bench.simulate.rig import SimulatedSpecimens
from pneutouch.bench.simulate.runs import SimulationTruth, population, simulate_run
from pneutouch.catalogue import Library
from pneutouch.mechanics import Sensor
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.spec.campaign import CampaignRun, Rig
from pneutouch.units import KPA

RESINS = ("TangoPlus", "FLX9940", "FLX9950", "FLX9960", "FLX9970", "FLX9985", "FLX9995")
PRESSURES = (0.0, 22.0)
CAMPAIGNS, SPECIMENS, RUNS = 200, 3, 3

RATE, LOOP_RATE = 100.0, 2000.0
"""Hz: that of the blocks to which any faster record is averaged before it is looked at; a loop is short, and recorded faster."""

TRUTH = SimulationTruth(rest=10.0)
"""The paper's protocol with rests of 10 s in place of 30: half of them is read at most."""

SAFE, LIGHT = 0.9, 30.0
"""Share of the nominal sensor's range that is pressed where it ends before three quarters of R0, and the greatest force in N: all
specimens reach the one, and none goes beyond the 40 N of the paper's force sensor."""


@dataclass(frozen=True)
class Cell:
    """A resin with its nominal sensor pressed, and the true figures by driving pressure (kPa)."""

    resin: str
    sensor: Sensor
    depth: float
    truth: dict[float, dict[str, float]]


def cell(resin: str) -> Cell:
    """The truth of a resin's population."""
    sensor = material_sensor(Library.default().load("materials", resin))
    pressures = [p * KPA for p in PRESSURES]
    wanted = 0.75 * sensor.dome.inner_radius
    depth = min(_safe(curve, wanted) for curve in press_curves(sensor, pressures, wanted, "atlas").curves)
    nominal = press_curves(sensor, pressures, depth, "atlas")
    return Cell(resin, sensor, depth, {p: _true(nominal, k) for k, p in enumerate(PRESSURES)})


def _safe(curve: PressCurve, wanted: float) -> float:
    """The depth that is pressed of a nominal curve, mm."""
    depth = wanted if curve.reach >= wanted * (1 - 1e-9) else SAFE * curve.reach
    light = float(np.interp(LIGHT, curve.force, curve.indentation))
    return depth if np.interp(depth, curve.indentation, curve.force) < 1.2 * LIGHT else min(depth, light)


def _true(nominal: PressCurves, k: int) -> dict[str, float]:
    found = population(nominal, k, TRUTH, RATE, (1, k)).figures
    known = {key: value for key, value in found.items() if value is not None and key in BY_KEY}
    return {**known, "resolution_N": RESOLVED * known["noise_pressure_kPa"] / known["sensitivity_kPa_per_N"]}


def campaign(of: Cell, number: int) -> list[RunGroup]:
    """One simulated campaign of a resin, read as a lab's would be."""
    rng = np.random.default_rng([RESINS.index(of.resin), number])
    drawn = SimulatedSpecimens.draw(TRUTH.scatter, SPECIMENS, rng)
    curves: list[MeasuredCurve] = []
    for k in range(SPECIMENS):
        pressed = press_curves(drawn.sensor(of.sensor, k), [p * KPA for p in PRESSURES], of.depth, "atlas")
        curves += _runs(of, f"{of.resin}-{k + 1}", pressed, rng)
    return summarize(curves)


def _runs(of: Cell, name: str, pressed: PressCurves, rng: np.random.Generator) -> Iterator[MeasuredCurve]:
    for pressure, curve in zip(PRESSURES, pressed.curves, strict=True):
        for kind, count in (("steps", RUNS), ("loop", 1), ("relaxation", 1)):
            way = TRUTH.protocol(kind, of.sensor.dome.inner_radius, curve.reach)
            for number in range(1, count + 1):
                rate = LOOP_RATE if kind == "loop" else RATE
                record = simulate_run(curve, way, TRUTH.rig, rate, rng, wall=TRUTH.wall, scatter=TRUTH.scatter)
                run = CampaignRun(
                    file=f"{name}-{pressure:g}-{kind}-{number}",
                    kind=kind,
                    sensor=name,
                    resin=of.resin,
                    driving_pressure_kPa=pressure,
                    run=number,
                )
                yield curve_of(run, blocks_of(Path(run.file), *record, rate=rate), Rig(rate_Hz=rate))


def counted(resin: str, campaigns: int = CAMPAIGNS) -> dict[str, dict[str, dict[str, float]]]:
    """By pressure and figure: share of campaigns whose interval held the truth, mean deviation, mean half width, (of truth)."""
    of = cell(resin)
    held: dict[str, dict[str, list[tuple[bool, float, float]]]] = {}
    for number in range(campaigns):
        for group in campaign(of, number):
            true = of.truth[group.key.driving_pressure_kPa]
            into = held.setdefault(f"{group.key.driving_pressure_kPa:g}", {})
            for key, estimate in group.figures.items():
                if key in true and estimate.low is not None and estimate.high is not None:
                    scale = abs(true[key]) or 1.0
                    off, half = (estimate.value - true[key]) / scale, 0.5 * (estimate.high - estimate.low) / scale
                    into.setdefault(key, []).append((estimate.holds(true[key]), off, half))
    return {
        pressure: {
            key: dict(zip(("held", "off", "half"), np.mean(rows, axis=0).round(6).tolist(), strict=True))
            | {"campaigns": len(rows)}
            for key, rows in sorted(figures.items())
        }
        for pressure, figures in held.items()
    }


def table(resins: dict[str, Any]) -> list[dict[str, Any]]:
    """How often the interval of each figure held its true value: over all cells, and in the worst and the best of them."""
    cells: dict[str, list[tuple[float, str]]] = {}
    for resin, pressures in resins.items():
        for pressure, figures in pressures.items():
            for key, entry in figures.items():
                cells.setdefault(key, []).append((entry["held"], f"{resin}, {pressure} kPa"))
    rows = []
    for figure in (figure for figure in FIGURES if figure.key in cells):
        found = cells[figure.key]
        (least, where), mean = min(found), float(np.mean([held for held, _ in found]))
        rows.append({"figure": figure.key, "held": mean, "least": least, "where": where, "most": max(found)[0]})
    return rows


def main(*words: str) -> None:
    if "stored" in words:
        found = stored("coverage")
        campaigns, resins = found["campaigns"], found["resins"]
    else:
        campaigns = int(words[0]) if words else CAMPAIGNS
        with ProcessPoolExecutor(2) as pool:
            resins = dict(zip(RESINS, pool.map(counted, RESINS, [campaigns] * len(RESINS)), strict=True))
    data = {"campaigns": campaigns, "resins": resins, "table": table(resins)}
    store("coverage", data)


if __name__ == "__main__":
    main(*sys.argv[1:])
