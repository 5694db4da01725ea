"""Speed against accuracy: everything measured, and reduced to what the pages state.

``python -m benchmarks.accuracy`` measures for half an hour; with ``stored`` it reduces what is stored. It writes
docs/background/accuracy.json, of which accuracy.md and speed-against-accuracy.md are filled.
"""

from __future__ import annotations

import statistics
import sys
from collections import Counter
from typing import Any, NamedTuple

import numpy as np

from benchmarks import full_depth, off_axis_calculix, paper, peers, speed_accuracy, validity
from benchmarks.methods import ATLAS
from benchmarks.scenes import SCENES
from benchmarks.store import store, stored

DEFAULT, OURS = "solid default", "pneutouch"
CUT = 0.8
"""A range shorter than this share of the reference's counts as cut: an event that the reference does not have."""

SECONDS_TARGET, SENSITIVITY_TARGET, OFF_AXIS_TARGET = 0.25, 0.01, 0.1
"""Median processor time of the default, its greatest error, and its time off the axis over CalculiX's at equal error."""

ERRORS = ("apex_error", "limit_error", "force_error", "sensitivity_error")
Rows = list[dict[str, Any]]


def measure() -> None:
    """Measure and store everything that takes minutes."""
    paper.main()
    speeds = speed_accuracy.measure()
    sensor = next(scene for scene in speeds["scenes"] if scene["scene"] == SCENES[1].name)
    programs = peers.measure(1e-3 * sensor["reference"]["limit_pressure_kPa"])
    found = {"speed-accuracy": speeds, "peers": programs, "validity": validity.measure()}
    for name, data in (*found.items(), ("full-depth", full_depth.measure())):
        store(name, data)


def of(rows: Rows, method: str) -> Rows:
    """The rows in which a method has an answer."""
    return [row for row in rows if row["method"] == method and row["processor_s"] is not None]


def sizes(rows: Rows, key: str) -> list[float]:
    """Absolute errors of rows that have one."""
    return [abs(row[key]) for row in rows if row[key] is not None]


def both(values: list[float]) -> list[float]:
    """Median and greatest."""
    return [statistics.median(values), max(values)]


def methods(data: dict[str, Any]) -> Rows:
    """Every method: time over that of the default, median and worst errors, scenes cut short and scenes covered."""
    base = statistics.median(row["processor_s"] for row in of(data["rows"], DEFAULT))
    found = []
    for method in dict.fromkeys(row["method"] for row in data["rows"]):
        rows = of(data["rows"], method)
        found.append(
            {
                "method": method,
                "time_ratio": statistics.median(row["processor_s"] for row in rows) / base,
                **{key: both(sizes(rows, key)) for key in ERRORS},
                "cut": sum(row["range_share"] < CUT for row in rows),
                "covered": len(rows),
            }
        )
    return found


def scenes(data: dict[str, Any]) -> Rows:
    """Every scene by its name, with the error of the default's sensitivity."""
    return [{"scene": row["scene"], "error": row["sensitivity_error"]} for row in of(data["rows"], DEFAULT)]


def costs(data: dict[str, Any]) -> dict[str, float]:
    """Median and greatest time of the default (s), and how many times as fast the atlas is alone and in bulk."""
    default = {row["scene"]: row["processor_s"] for row in of(data["rows"], DEFAULT)}
    base = statistics.median(default.values())
    alone = [default[row["scene"]] / row["processor_s"] for row in of(data["rows"], ATLAS)]
    at_once = base / data["atlas_at_once_s"]
    return {
        "default_s": base,
        "slowest_s": max(default.values()),
        "atlas": statistics.median(alone),
        "at_once": at_once,
    }


def programs(data: dict[str, Any]) -> dict[str, Any]:
    """Every run of every program over the cheapest solve of ours within the error, and shares of their times at it."""
    rows = data["rows"]
    base = peers.cheapest(rows, OURS, "solve_s")
    shares = {}
    for program in ("FElupe", "CalculiX"):
        shares[program] = {}
        for key in ("solve_s", "whole_s"):
            ours, theirs = peers.cheapest(rows, OURS, key), peers.cheapest(rows, program, key)
            shares[program][key] = ours[key] / theirs[key] if ours and theirs else None
    runs = (
        [row | {key: row[f"{key}_s"] / base["solve_s"] for key in ("solve", "whole")} for row in rows] if base else []
    )
    return {"runs": runs, "shares": shares, "missing": data["missing"]}


class SpeedPoint(NamedTuple):
    """One program with one resolution on a scene: processor time (s) and the greatest relative error of its figures."""

    program: str
    label: str
    seconds: float
    error: float


def _error(scene: dict[str, Any], found: list[dict[str, float]]) -> float:
    """Greatest relative error of figures at every place against the mean of both programs' finest answers."""
    worst = 0.0
    for row, finest, values in zip(scene["rows"], scene["settling"][-1]["rows"], found, strict=True):
        for figure in off_axis_calculix.FIGURES:
            if off_axis_calculix.compares(row, figure):
                middle = 0.5 * (finest[figure] + row["calculix"][-1][figure])
                worst = max(worst, abs(values[figure] / middle - 1.0))
    return worst


def points(scene: dict[str, Any]) -> list[SpeedPoint]:
    """Every resolution of both programs on a scene off the axis, by rising time for each program."""

    def times(cells: list[int]) -> str:
        return " x ".join(map(str, cells))

    found = [
        SpeedPoint(OURS, f"M {run['harmonics']}, {times(run['cells'])}", run["processor_s"], _error(scene, run["rows"]))
        for run in scene["settling"]
    ]
    for k, (cells, cost) in enumerate(zip(scene["cells"], scene["calculix_cost"], strict=True)):
        error = _error(scene, [row["calculix"][k] for row in scene["rows"]])
        found.append(SpeedPoint("CalculiX", times(cells), cost["processor_s"], error))
    return sorted(found, key=lambda point: (point.program != OURS, point.seconds))


def off_axis(data: Rows) -> Rows:
    """Scenes off the axis that were timed: every resolution, what can be resolved, and our share of each mesh's time."""
    found = []
    for scene in (scene for scene in data if "settling" in scene):
        every = points(scene)
        # Errors below half of the difference of the finest answers are not known.
        resolved = _error(scene, [row["calculix"][-1] for row in scene["rows"]])
        base = min(point.seconds for point in every if point.program != OURS)
        shares = []
        for theirs in (point for point in every if point.program != OURS):
            good = [p for p in every if p.program == OURS and p.error <= max(theirs.error, resolved)]
            ours = min(good, key=lambda point: point.seconds)
            shares.append({"theirs": theirs.label, "ours": ours.label, "share": ours.seconds / theirs.seconds})
        rows = [point._asdict() | {"time_ratio": point.seconds / base} for point in every]
        found.append({"scene": scene["scene"], "resolved": resolved, "points": rows, "shares": shares})
    return found


class Point(NamedTuple):
    """A way to answer: its name, its time over that of pneutouch's default way, and its relative error."""

    way: str
    time_ratio: float
    error: float


def panels(timed: Rows) -> dict[str, tuple[str, list[Point]]]:
    """By kind of work, what the error is of, and every way that was measured."""
    speeds, mesh, voxel, searched = (stored(name) for name in ("speed-accuracy", "meshing", "voxels", "search"))
    names = {
        "membrane variational": "membrane theory",
        ATLAS: f"{OURS}, atlas",
        "solid 12 x 1": f"{OURS}, 12 x 1 cells",
        DEFAULT: f"{OURS}, default",
        "solid 48 x 3": f"{OURS}, 48 x 3 cells",
    }
    table = {row["method"]: row for row in methods(speeds)}
    predicted = [Point(new, table[old]["time_ratio"], table[old]["sensitivity_error"][0]) for old, new in names.items()]
    # Six harmonics with four as their check, on the usual mesh: what `harmonic` takes for this scene.
    base = next(p["seconds"] for p in timed[0]["points"] if p["label"] == "M 6, 24 x 2")
    contact = [Point(p["program"], p["seconds"] / base, p["error"]) for p in timed[0]["points"]]
    return {
        "Prediction, 14 scenes": ("sensitivity", predicted),
        "Inflation to the limit point": ("limit pressure", _inflation(stored("peers")["rows"])),
        "Contact under a leaning plate": ("forces and pressure", contact),
        "Print mesh of the membrane": ("surface, over R0", _meshes(mesh["bodies"]["membrane"])),
        "Voxels of the membrane": ("volume", _voxels(voxel["rasters"])),
        "Selection for a target": ("distance from the target", _selection(searched["searches"])),
        "Sweep of 16 designs": ("sensitivity", _sweep(searched["sweeps"])),
    }


def _inflation(rows: Rows) -> list[Point]:
    base = min((row for row in rows if row["program"] == OURS), key=lambda row: abs(row["cells_along"] - 24))["solve_s"]
    return [Point(row["program"], row["solve_s"] / base, abs(row["limit_error"])) for row in rows]


def _meshes(rows: Rows) -> list[Point]:
    base = next(row for row in rows if row["method"] == OURS and row["tolerance"] == 0.016)["milliseconds"]
    wanted = (OURS, "manifold3d alone", "CadQuery, angle 0.1", "plain grid, numpy")
    kept = [row for row in rows if row["method"] in wanted]
    return [Point(row["method"], row["milliseconds"] / base, row["deviation"] / 9.25) for row in kept]


def _voxels(rows: Rows) -> list[Point]:
    kept = [row for row in rows if row["layer_um"] == 27.0 or row["method"] == "trimesh"]
    base = next(row for row in kept if row["method"] == "exact sections" and row["coarser"] == 1.0)["seconds"]
    names = {"exact sections": OURS, "manifold3d slices, Pillow": "mesh slices, Pillow"}
    names["manifold3d slices, matplotlib"] = "mesh slices, Matplotlib"
    return [Point(names.get(r["method"], r["method"]), r["seconds"] / base, abs(r["volume"])) for r in kept]


def _selection(rows: Rows) -> list[Point]:
    base = statistics.median(row["processor_s"] for row in rows if row["way"] == "pneutouch select")
    found = []
    for way in dict.fromkeys(row["way"] for row in rows):
        own = [row for row in rows if row["way"] == way]
        off = sizes(own, "off_relative")
        name = way if len(off) == len(own) else f"{way}, {len(off)} of {len(own)} targets"
        cost = statistics.median(row["processor_s"] for row in own)
        found.append(Point(name, cost / base, statistics.median(off)))
    return found


def _sweep(rows: Rows) -> list[Point]:
    base = next(row for row in rows if row["way"] == "pneutouch sweep, solid")["processor_s"]
    return [Point(row["way"], row["processor_s"] / base, row["median_error"]) for row in rows]


def work(title: str, error: str, found: list[Point]) -> dict[str, Any]:
    """One kind of work: the error of our default, and every other way at no greater error, else at its least."""
    default = min((p for p in found if p.way.startswith(OURS)), key=lambda p: abs(p.time_ratio - 1.0))
    others = []
    for way in dict.fromkeys(p.way for p in found if not p.way.startswith(OURS)):
        mine = [p for p in found if p.way == way]
        good = [p for p in mine if p.error <= default.error]
        best = min(good, key=lambda p: p.time_ratio) if good else min(mine, key=lambda p: p.error)
        others.append({"way": way, "time_ratio": best.time_ratio, "error": None if good else best.error})
    ways = [point._asdict() for point in found]
    return {"title": title, "figure": error, "error": default.error, "others": others, "points": ways}


def reduced() -> dict[str, Any]:
    """What the pages state, from everything that is stored."""
    speeds, known = stored("speed-accuracy"), stored("validity")
    timed = off_axis(stored("off-axis-calculix"))
    truths = [scene["reference"] for scene in speeds["scenes"]]
    counts = {method: Counter() for method in dict.fromkeys(row["method"] for row in known)}
    for row in known:
        counts[row["method"]][row["outcome"]] += 1
    return {
        "reference": {key: both(sizes(truths, key)) for key in ("sensitivity_error", "force_error", "limit_error")},
        "methods": methods(speeds),
        "scenes": scenes(speeds),
        "costs": costs(speeds),
        "programs": programs(stored("peers")),
        "off_axis": timed,
        "validity": {method: {outcome: counts[method][outcome] for outcome in validity.OUTCOMES} for method in counts},
        "states": len(known) // len(counts),
        "work": [work(title, *panel) for title, panel in panels(timed).items()],
        "machine": stored("search")["machine"],
    }


def main(*words: str) -> None:
    if "stored" not in words:
        measure()
    store("accuracy", reduced())


if __name__ == "__main__":
    np.seterr(all="raise", under="ignore")
    main(*sys.argv[1:])
