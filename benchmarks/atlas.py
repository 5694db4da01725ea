"""Random presses inside the atlas's box, pressed by the solid and by the atlas alike; everything in units of R0 and mu.

``python -m benchmarks.atlas`` (minutes, every core) writes docs/background/atlas.json; with ``stored`` it reduces the
stored errors anew.
"""

from __future__ import annotations

import os
import sys
from collections import Counter
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from typing import Any, NamedTuple

import numpy as np

from benchmarks.store import store, stored
from pneutouch.arrays import Array
from pneutouch.mechanics.atlas.press import AtlasPress, SensorBatch
from pneutouch.mechanics.atlas.recipe import RECIPE, axes
from pneutouch.mechanics.atlas.respond import ENDS, respond
from pneutouch.mechanics.atlas.table import SHIPPED, shipped
from pneutouch.mechanics.events import range_end
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.models.solid import curve_between, reported_events
from pneutouch.mechanics.response import figures
from pneutouch.mechanics.sensor import RigidBase
from pneutouch.mechanics.solid.indent import PressSettings, indent
from pneutouch.mechanics.solid.inflate import inflate, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.shape.hemisphere import Hemisphere
from pneutouch.units import KPA

COUNT, SEED = 500, 2000
KEYS = ("wall", "share", "ambient", "dead", "depth")
ERRORS = {
    "force": "force at the worst state of a press, over its greatest force",
    "pressure": "pressure at the worst state of a press, over its greatest rise",
    "gauge": "the same, over its greatest gauge pressure",
    "common": "sensitivity over the common range",
    "own": "sensitivity, each over its range",
    "limit": "limit pressure",
}
LEVELS = (0.001, 0.002, 0.005)
_DIGITS = 4

STEPS = 14
POISSON = 0.49
_SHORTEST = 0.05
"""A range of less of R0 is a few of the solid's contact elements: a slope over it is no figure."""


@dataclass(frozen=True)
class Case:
    """One dome and one press: t0/R0, share of the limit pressure, ambient/mu, dead volume/R0^3, depth/R0, and what may
    end the range early: gauge limit/mu and stretch at break, both infinite for none."""

    wall: float
    share: float
    ambient: float
    dead: float
    depth: float
    gauge: float = np.inf
    tear: float = np.inf

    def batch(self, limit: float) -> SensorBatch:
        """The same for the atlas, driven to a share of a limit pressure."""
        values = (
            1.0,
            self.wall,
            1.0,
            self.ambient,
            self.dead,
            self.share * limit,
            self.depth,
            np.inf,
            self.gauge,
            self.tear,
        )
        return SensorBatch(*(np.array([value]) for value in values))


@dataclass(frozen=True)
class Gap:
    """How far the atlas is from the solid over one press.

    force, pressure: greatest difference over the common range, over the solid's greatest force and greatest pressure
    rise there; gauge: the same difference of pressures over the greatest gauge pressure. every_force, every_pressure: at
    each state. common, own: relative difference of the sensitivities over the common range and over each one's own.
    near: the atlas says that the wall would soon buckle. ends: (solid's, atlas's) reason; positions: (solid's, atlas's) end of the range in R0.
    """

    case: Case
    force: float
    pressure: float
    gauge: float
    every_force: Array
    every_pressure: Array
    common: float
    own: float
    ends: tuple[str, str]
    positions: tuple[float, float]
    limit: float
    near: bool

    @property
    def inside(self) -> bool:
        """Whether the press keeps away from the edge where walls buckle, at which the box ends."""
        return not self.near and "inward buckling" not in self.ends and "no equilibrium found" not in self.ends


def random_cases(count: int, seed: int) -> list[Case]:
    """Walls and gas stiffness even in their logarithm, a quarter of the domes without pressure or dead volume, a quarter
    each with a gauge limit or a break strain within reach."""
    rng = np.random.default_rng(seed)
    found = []
    for _ in range(count):
        wall = float(np.exp(rng.uniform(np.log(0.06), np.log(0.35))))
        share = 0.0 if rng.random() < 0.25 else rng.uniform(0.0, 0.97)
        ambient = float(np.exp(rng.uniform(np.log(0.01), np.log(RECIPE.stiffest))))
        dead = 0.0 if rng.random() < 0.25 else float(rng.exponential(2.0))
        event = rng.random()
        gauge = wall * (1.5 * share + rng.uniform(0.2, 3.0)) if event < 0.25 else np.inf
        # A free dome stretches by about 0.7 share^2; a tear before contact would leave nothing to compare.
        # No printed rubber of the catalogue tears below 1.35.
        tear = 1.3 + 0.75 * share**2 + rng.uniform(0.0, 0.6) if event > 0.75 else np.inf
        found.append(Case(wall, share, ambient, dead, rng.uniform(0.2, 0.75), gauge, tear))
    return found


def compare(case: Case) -> Gap | None:
    """Press once by both; None where the range ends nearly at once, in which there is nothing to compare."""
    solid = SolidModel(dome(Hemisphere(1.0, case.wall)), neo_hookean(1.0, POISSON), base=RigidBase())
    run = inflate(solid, past_limit=1.0)
    assert run.limit is not None
    free = state_at(solid, case.share * run.limit.pressure, run)
    press = PressSettings(case.depth, STEPS, None, case.ambient, case.dead, case.gauge, case.tear - 1.0)
    found = indent(solid, free, press)
    happened = reported_events(found.events)
    end = min(range_end(happened, case.depth), found.path[-1].indentation)
    ends = next((event.kind for event in happened if event.ends_range), ENDS[0])
    batch = case.batch(run.limit.pressure)
    said = respond(batch, STEPS)
    mine = float(said.range_end[0])
    names, limit = (ends, ENDS[int(said.ends[0])]), float(said.limit_pressure[0]) / run.limit.pressure - 1.0
    common = min(end, mine)
    if not common > _SHORTEST:
        return None
    lookup = AtlasPress(batch, shipped().slices(batch.wall_ratio), np.zeros(1, dtype=np.intp))
    grid, whole = (np.linspace(0.0, reach, STEPS + 1) for reach in (common, end))
    theirs, full = figures(grid, *curve_between(found.path, grid)), figures(whole, *curve_between(found.path, whole))
    ours = figures(grid, *_looked_up(lookup, grid))
    assert ours is not None and theirs is not None and full is not None
    travel = np.maximum([s.indentation for s in found.path if s.indentation <= common * (1 + 1e-9)], 0.0)
    if travel.size < 3:  # the range ends within the solid's first step: between its states then, on its own slopes
        travel = grid
    force, rise = _differences(lookup, travel, curve_between(found.path, travel))
    return Gap(
        case,
        force.error,
        rise.error,
        rise.error * rise.scale / (free.pressure + rise.scale),
        force.every,
        rise.every,
        ours.sensitivity / theirs.sensitivity - 1.0,
        KPA * float(said.lines.sensitivity[0]) / full.sensitivity - 1.0,
        names,
        (end, mine),
        limit,
        bool(said.near_buckling[0]),
    )


class _Difference(NamedTuple):
    """Differences over the greatest value, at every state and the greatest of them."""

    every: Array
    scale: float

    @property
    def error(self) -> float:
        return float(self.every.max())


def _differences(lookup: AtlasPress, travel: Array, theirs: tuple[Array, Array]) -> tuple[_Difference, _Difference]:
    """Of force and pressure rise at plate travels."""
    one, other = (
        _Difference(np.abs(a - b) / b.max(), float(b.max()))
        for a, b in zip(_looked_up(lookup, travel), theirs, strict=True)
    )
    return one, other


def _looked_up(lookup: AtlasPress, travel: Array) -> tuple[Array, Array]:
    """Force and pressure rise of the atlas at plate travels."""
    track = lookup.march(travel[None, :])
    return track.point.force[0], track.point.pressure[0] - lookup.pressure[0]


def compare_all(cases: Iterable[Case], workers: int) -> list[Gap | None]:
    """All cases, in their order, by processes of their own."""
    if workers == 1:
        return [compare(case) for case in cases]
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        return list(pool.map(compare, cases, chunksize=20))


def measure() -> dict[str, Any]:
    """Errors of random presses, as columns; the presses of `make check-slow`."""
    os.environ["OMP_NUM_THREADS"] = "1"
    gaps = [gap for gap in compare_all(random_cases(COUNT, SEED), os.cpu_count() or 1) if gap is not None]

    def column(values: list[float]) -> list[float]:
        return [float(f"{value:.{_DIGITS}g}") for value in values]

    return {
        "requested": COUNT,
        **{key: column([getattr(gap.case, key) for gap in gaps]) for key in KEYS},
        **{name: column([getattr(gap, name) for gap in gaps]) for name in ERRORS},
        "end_off": column([gap.positions[1] - gap.positions[0] for gap in gaps]),
        "states": {name: _states(gaps, f"every_{name}") for name in ("force", "pressure")},
        "ends": dict(Counter(" / ".join(gap.ends) for gap in gaps).most_common()),
    }


def _states(gaps: list[Gap], name: str) -> list[float]:
    """Count, median, 99th percentile and greatest over all states of all presses."""
    errors = np.concatenate([getattr(gap, name) for gap in gaps])
    return [float(errors.size), *(float(f"{x:.{_DIGITS}g}") for x in np.quantile(errors, [0.5, 0.99, 1.0]))]


def reduced(data: dict[str, Any]) -> dict[str, Any]:
    """What the page states: quantiles of every error, the six worst presses, and the box of the recipe."""
    rows = []
    for name, words in ERRORS.items():
        errors = np.abs(np.array(data[name]))
        quantiles = [float(x) for x in np.quantile(errors, [0.5, 0.99, 1.0])]
        rows.append({"error": words, "quantiles": quantiles, "above": int((errors > LEVELS[-1]).sum())})
    worst = np.argsort(-np.abs(np.array(data["force"])))[:6]
    columns = (*KEYS, "force", "pressure", "common")
    grid, same = axes(RECIPE), [count for kinds, count in data["ends"].items() if len(set(kinds.split(" / "))) == 1]
    return {
        "count": len(data["wall"]),
        "errors": rows,
        "median_sensitivity": float(np.median(np.abs(data["common"]))),
        "greatest_sensitivity": float(np.abs(data["common"]).max()),
        "greatest_force": float(np.abs(data["force"]).max()),
        "same_end": sum(same),
        "greatest_end_off": float(np.abs(data["end_off"]).max()),
        "worst": [{key: data[key][i] for key in columns} for i in worst],
        "recipe": {
            "walls": [RECIPE.thinnest, RECIPE.thickest],
            "volumes": [RECIPE.lowest_volume, RECIPE.highest_volume],
            "deepest": RECIPE.deepest,
            "stiffest": RECIPE.stiffest,
            "surveyed": RECIPE.walls,
            "degree": RECIPE.degree,
            "poisson_ratio": RECIPE.poisson_ratio,
            "coefficients": [grid.wall.size, grid.volume.size, grid.depth.size],
        },
        "megabytes": SHIPPED.stat().st_size / 1e6,
    }


def main(*words: str) -> None:
    data = stored("atlas") if "stored" in words else measure()
    data["summary"] = reduced(data)
    store("atlas", data, None)


if __name__ == "__main__":
    main(*sys.argv[1:])
