"""Contact off the axis with CalculiX in three dimensions (an optional peer, found on PATH).

``python -m benchmarks.off_axis_calculix [SCENE ...]`` presses the paper's sensor in the scenes of these numbers, or in all
of them, with the harmonic solid and with half a dome of C3D20R cells, without the base. Compared are the force, the
sideways force and the pressure rise of both, each with its own gas, and their processor times. Stores
docs/background/off-axis-calculix.json.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.off_axis_scenes import SCENES, OffAxisScene
from pneutouch.units import KPA

ROOT = Path(__file__).resolve().parents[1]
STORED = ROOT / "docs" / "background" / "off-axis-calculix.json"
FIGURES = ("force_N", "sideways_N", "rise_kPa")
_STRAIGHT = 1e-4
"""A sideways force below this share of the force is that of a scene with a second plane of symmetry: it is not compared."""


def compared(scene: OffAxisScene) -> dict[str, Any]:
    """One scene by both programs, CalculiX on every mesh."""
    ours = scene.pressed()
    others = [settled(scene, order, cells) for order, cells in scene.others]
    pressures = np.array([place.pressure for place in ours.places])
    rows: list[dict[str, Any]] = [
        {
            "depth_mm": place.depth,
            **({"travel_mm": place.travel} if place.travel else {}),
            "harmonic": figures(place.force, place.sideways, place.pressure - scene.driving),
            "calculix": [],
        }
        for place in ours.places[1:]
    ]
    costs = []
    for cells in scene.meshes:
        stops, cost = scene.half(ours, cells).run(pressures)
        costs.append({"processor_s": cost.seconds, "raised_share": cost.raised})
        for row, stop in zip(rows, stops, strict=False):
            row["calculix"].append(figures(stop.force, stop.sideways, stop.pressure - scene.driving))
            print(scene.name, cells, cost.seconds, row, flush=True)
    return {
        "scene": scene.name,
        "cells": [list(mesh) for mesh in scene.meshes],
        "harmonics": scene.order,
        "harmonic_processor_s": ours.seconds,
        "calculix_cost": costs,
        "rows": rows,
        **({"settling": others} if others else {}),
    }


def settled(scene: OffAxisScene, order: int, cells: tuple[int, int]) -> dict[str, Any]:
    """One scene by the harmonic solid with other harmonics and cells: figures at every place, and the processor time."""
    ours = scene.pressed(order, cells)
    found = [figures(place.force, place.sideways, place.pressure - scene.driving) for place in ours.places[1:]]
    print(scene.name, order, cells, ours.seconds, found, flush=True)
    return {"harmonics": order, "cells": list(cells), "processor_s": ours.seconds, "rows": found}


def figures(force: float, sideways: float, rise: float) -> dict[str, float]:
    """The figures compared, from N, N and MPa."""
    return dict(zip(FIGURES, (float(force), float(sideways), float(rise) / KPA), strict=True))


def compares(row: dict[str, Any], figure: str) -> bool:
    """Whether a figure of a row is compared: a sideways force that symmetry forbids is not."""
    ours = row["harmonic"]
    return figure != "sideways_N" or abs(ours[figure]) > _STRAIGHT * abs(ours["force_N"])


def differences(data: list[dict[str, Any]], figure: str) -> list[float]:
    """CalculiX's finest mesh over the harmonic solid, less 1, in every row."""
    rows = [row for scene in data for row in scene["rows"] if compares(row, figure)]
    return [row["calculix"][-1][figure] / row["harmonic"][figure] - 1.0 for row in rows]


def main(*numbers: int) -> None:
    """The scenes of the numbers, from 1, or all; the others as they are stored."""
    stored = {scene["scene"]: scene for scene in (json.loads(STORED.read_text("utf-8")) if STORED.exists() else [])}
    for number in numbers or range(1, len(SCENES) + 1):
        scene = SCENES[number - 1]
        stored[scene.name] = compared(scene)
        data = [stored[scene.name] for scene in SCENES if scene.name in stored]
        STORED.write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
