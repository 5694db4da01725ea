"""Measures the atlas, the solid and a plain table on one thread; prints one JSON object of seconds and errors."""

from __future__ import annotations

import json
import statistics
import time
from collections.abc import Callable

import numpy as np
from benchmarks.atlas_presses import POISSON, random_cases
from scipy.interpolate import RegularGridInterpolator

from pneutouch.mechanics.atlas.respond import respond
from pneutouch.mechanics.atlas.table import shipped
from tests.mechanics.atlas.sampled import batch, random_batch

RESPONSES, SOLIDS, GRID = 4000, 12, (11, 9, 7, 7, 7)


def seconds(work: Callable[[], object], runs: int = 5) -> float:
    """Processor time of a piece of work, median of runs; warm."""
    work()
    taken = []
    for _ in range(runs):
        start = time.process_time()
        work()
        taken.append(time.process_time() - start)
    return statistics.median(taken)


def one_solid(case) -> None:
    """A full response by the solid: the mesh, the driving pressure, the press."""
    from pneutouch.mechanics.laws import neo_hookean
    from pneutouch.mechanics.solid.indent import PressSettings, indent
    from pneutouch.mechanics.solid.inflate import inflate, state_at
    from pneutouch.mechanics.solid.mesh import dome
    from pneutouch.mechanics.solid.model import SolidModel

    solid = SolidModel(dome(1.0, case.wall), neo_hookean(1.0, POISSON))
    run = inflate(solid, past_limit=1.0)
    assert run.limit is not None
    indent(
        solid,
        state_at(solid, case.share * run.limit.pressure, run),
        PressSettings(case.depth, 14, None, case.ambient, case.dead),
    )


def sensitivities(points: np.ndarray) -> np.ndarray:
    """The atlas at rows of (log wall, share of the limit, log ambient, dead/(1 + dead), depth)."""
    wall, gas = np.exp(points[:, 0]), np.exp(points[:, 2])
    limit = shipped().slices(np.unique(wall)).limit_pressure[np.unique(wall, return_inverse=True)[1]]
    sensors = batch(
        wall_thickness=wall, ambient_pressure=gas, driving_pressure=points[:, 1] * limit, depth=points[:, 4],
        dead_volume=points[:, 3] / (1 - points[:, 3]),
    )  # fmt: skip
    return respond(sensors).lines.sensitivity_kPa_per_N


def plain_table() -> dict[str, float]:
    """A linear table of one figure over the same box, and its error between its nodes."""
    low, high = (
        np.array([np.log(0.06), 0.0, np.log(0.01), 0.0, 0.2]),
        np.array([np.log(0.35), 0.95, np.log(3.0), 0.8, 0.6]),
    )
    nodes = [np.linspace(a, b, n) for a, b, n in zip(low, high, GRID, strict=True)]
    values = sensitivities(np.stack(np.meshgrid(*nodes, indexing="ij"), axis=-1).reshape(-1, 5)).reshape(GRID)
    table = RegularGridInterpolator(nodes, np.log(values))
    points = np.random.default_rng(1).uniform(low, high, (RESPONSES, 5))
    error = np.abs(np.exp(table(points)) / sensitivities(points) - 1.0)
    error = error[np.isfinite(error)]
    return {
        "nodes": float(values.size), "table_median": float(np.median(error)), "table_worst": float(error.max()),
        "table_s": seconds(lambda: table(points)) / RESPONSES,
    }  # fmt: skip


def main() -> None:
    sensors = random_batch(RESPONSES, 1)
    single = sensors.take(slice(0, 1))
    cases = random_cases(SOLIDS, 7)
    print(json.dumps({  # noqa: T201
        "atlas_s": seconds(lambda: respond(sensors)) / RESPONSES,
        "single_s": seconds(lambda: [respond(single) for _ in range(50)]) / 50,
        "solid_s": seconds(lambda: [one_solid(case) for case in cases], runs=1) / SOLIDS,
        **plain_table(),
    }))  # fmt: skip


if __name__ == "__main__":
    main()
