"""Contact off the axis with CalculiX in three dimensions (an optional peer, found on PATH).

``python -m benchmarks.off_axis_calculix [SCENE ...]`` presses the paper's sensor in the scenes of these numbers, or in all
of them, with the harmonic solid and with half a dome of C3D20R cells, without the base. Compared are the force, the
sideways force and the pressure rise of both, each with its own gas, and their processor times. Stores
docs/background/off-axis-calculix.json, and writes its section into docs/background/validation.md
(``python -m benchmarks.pages.validation_text`` renews the whole page from what is stored).
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.off_axis_scenes import SCENES, OffAxisScene
from benchmarks.page_section import replace_section
from pneutouch.units import KPA

ROOT = Path(__file__).resolve().parents[1]
STORED, PAGE = ROOT / "docs" / "background" / "off-axis-calculix.json", ROOT / "docs" / "background" / "validation.md"
HEADING = "## CalculiX: contact off the axis"
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


def section(data: list[dict[str, Any]]) -> list[str]:
    """The lines of the comparison for a page."""
    worst = {figure: max(map(abs, differences(data, figure))) for figure in FIGURES}
    orders = " or ".join(map(str, sorted({scene["harmonics"] for scene in data})))
    refined = " and ".join(f"{_times(s['cells'][-2])} to {_times(s['cells'][-1])}" for s in data if len(s["cells"]) > 1)
    return [
        HEADING,
        "",
        f"The paper's sensor without its base: the harmonic solid (M = {orders}, 24 x 2 cells), and half a dome of C3D20R cells. "
        "CalculiX has no gas; its pressure is that which Boyle's law gives in the volume that it finds. Columns "
        '"CalculiX": difference of CalculiX on its finest mesh from the figure left of it. Last column: greatest change of the three '
        f"figures by refinement in CalculiX, where it was run on two meshes ({refined}). [off-axis.md](off-axis.md#calculix) explains "
        "the differences. `python -m benchmarks.off_axis_calculix` computes the section.",
        "",
        "| scene | mm | force N | CalculiX | sideways N | CalculiX | pressure rise kPa | CalculiX | refinement |",
        "|---|---|---|---|---|---|---|---|---|",
        *(_line(scene, row) for scene in data for row in scene["rows"]),
        "",
        f"Greatest differences: force {worst['force_N']:.1%}, sideways force {worst['sideways_N']:.1%}, pressure rise "
        f"{worst['rise_kPa']:.1%}.",
        "",
        *_cost_lines(data),
    ]


def _cost_lines(data: list[dict[str, Any]]) -> list[str]:
    """M, the finest mesh of CalculiX and the processor times, of scenes that have them."""
    timed = [scene for scene in data if "calculix_cost" in scene]
    if not timed:
        return []
    lines = [
        f"| {scene['scene']} | {scene['harmonics']} | {_times(scene['cells'][-1])} | "
        f"{scene['calculix_cost'][-1]['processor_s'] / scene['harmonic_processor_s']:.0f} | "
        f"{scene['calculix_cost'][-1]['raised_share']:.0%} |"
        for scene in timed
    ]
    return [
        "Processor times: one thread, one machine, one program after the other; CalculiX's is that of its whole process. The last column "
        "is the share of its Newton iterations that went to the second pressure, from which Boyle's law follows. Times at equal error: "
        "[accuracy.md](accuracy.md#contact-off-the-axis-time-at-equal-error).",
        "",
        "| scene | M | CalculiX's cells | CalculiX's time over that of the harmonic solid | second pressure |",
        "|---|---|---|---|---|",
        *lines,
        "",
    ]


def _times(cells: list[int]) -> str:
    return " x ".join(map(str, cells))


def _line(scene: dict[str, Any], row: dict[str, Any]) -> str:
    ours, fine = row["harmonic"], row["calculix"][-1]
    known = [figure for figure in FIGURES if compares(row, figure)]
    pairs = [
        f"{ours[figure]:.4g} | {fine[figure] / ours[figure] - 1.0:+.1%}" if figure in known else "0 |"
        for figure in FIGURES
    ]
    changes = [abs(fine[figure] / coarse[figure] - 1.0) for coarse in row["calculix"][-2:-1] for figure in known]
    settled = f"{max(changes):.1%}" if changes else ""
    where = f"{row['depth_mm']:g}" + (f", {row['travel_mm']:g} sideways" if "travel_mm" in row else "")
    return f"| {scene['scene']} | {where} | {' | '.join(pairs)} | {settled} |"


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
    replace_section(PAGE, section(json.loads(STORED.read_text("utf-8"))))


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
