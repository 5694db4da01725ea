"""Contact off the axis with CalculiX in three dimensions (an optional peer, found on PATH).

``python -m benchmarks.off_axis_calculix [SCENE ...]`` presses the paper's sensor in the scenes of these numbers, or in all
of them, with the harmonic solid and with half a dome of C3D20R cells, without friction and without the base. Compared are
the force, the sideways force and the pressure rise of both, each with its own gas. Stores docs/off-axis-calculix.json, and
writes its section into docs/validation.md.
"""

from __future__ import annotations

import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.calculix_half import INNER, WALL, HalfPress
from benchmarks.page_section import replace_section
from benchmarks.scenes import PAPER
from pneutouch.arrays import Array
from pneutouch.mechanics.harmonic.press import OffAxisPress, OffAxisState
from pneutouch.mechanics.harmonic.surface import PlacedObject, Surface
from pneutouch.mechanics.solid.contact import Plate
from pneutouch.mechanics.solid.indent import PressSettings
from pneutouch.mechanics.solid.indenter import ball
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.stress import StrainProbe
from pneutouch.units import KPA

ROOT = Path(__file__).resolve().parents[1]
STORED, PAGE = ROOT / "docs" / "off-axis-calculix.json", ROOT / "docs" / "validation.md"
HEADING = "## CalculiX: contact off the axis"
ORDER = 6
FIGURES = ("force_N", "sideways_N", "rise_kPa")


@dataclass(frozen=True)
class OffAxisScene:
    """An object at any height, R0, the driving pressure (MPa), the edges of the object's cells (mm), and the cells of
    CalculiX's dome, along the arc, through the wall and around half the axis, on a mesh or on a coarser and a finer one;
    those in the upper half of the arc are ``closer`` times shorter than below. Compared at half of ``depth`` and at it.
    ``increment``: see `HalfPress`."""

    name: str
    surface: Surface
    driving: float
    edges: tuple[Array, Array]
    meshes: tuple[tuple[int, int, int], ...]
    closer: float = 1.0
    depth: float = 4.0
    increment: float = 0.5


def _plate(tilt: float, driving: float, *meshes: tuple[int, int, int]) -> OffAxisScene:
    leaning = PlacedObject(Plate(0.0, np.inf, 1.0), 0.0, float(np.radians(tilt)))
    edges = (np.array([-16.0, 16.0]), np.array([-2.0, 16.0]))
    name = f"plate tilted by {tilt:g} degrees, {driving / KPA:g} kPa"
    return OffAxisScene(name, leaning, driving, edges, meshes or ((28, 2, 6),))


def _ball(radius: float, offset: float, driving: float, *meshes: tuple[int, int, int]) -> OffAxisScene:
    placed = PlacedObject(ball(radius).scaled(1.0 / INNER), offset / INNER)
    across = 0.9 * radius * np.linspace(-1.0, 1.0, 13)
    edges = (offset + across, np.append(across[5], across[6:]))
    name = f"ball of {radius:g} mm radius, {offset:g} mm off the axis, {driving / KPA:g} kPa"
    return OffAxisScene(name, placed, driving, edges, meshes or ((26, 2, 10),), closer=1.5, increment=0.25)


SCENES = (
    _plate(10.0, 0.0, (28, 2, 6), (40, 2, 6)),
    _plate(10.0, 22.0 * KPA),
    _ball(6.0, 3.0, 0.0, (24, 2, 10), (32, 2, 12)),
    _ball(6.0, 3.0, 22.0 * KPA),
    _plate(20.0, 0.0),
    _ball(12.0, 4.0, 0.0),
)


def harmonic_states(scene: OffAxisScene) -> tuple[Surface, list[OffAxisState]]:
    """The object at first contact, and the states of the harmonic solid there, at half of the depth and at it."""
    solid = SolidModel(dome(INNER, WALL), PAPER.wall.hyperelastic)
    settings = PressSettings(scene.depth, steps=2)
    press = OffAxisPress(solid, state_at(solid, scene.driving), settings, scene.surface, StrainProbe(solid))
    states = press.run(ORDER).states
    return press.surface, states[:: (len(states) - 1) // 2]


def compared(scene: OffAxisScene) -> dict[str, Any]:
    """One scene by both programs, CalculiX on every mesh."""
    surface, states = harmonic_states(scene)
    depths, pressures = (np.array([getattr(s, name) for s in states]) for name in ("indentation", "pressure"))
    rows: list[dict[str, Any]] = [
        {"depth_mm": s.indentation, "harmonic": figures(s.force, s.sideways, s.rise), "calculix": []}
        for s in states[1:]
    ]
    for cells in scene.meshes:
        half = HalfPress(surface, scene.edges, scene.driving, depths, cells, scene.closer, increment=scene.increment)
        for row, stop in zip(rows, half.run(pressures), strict=False):
            row["calculix"].append(figures(stop.force, stop.sideways, stop.pressure - scene.driving))
            print(scene.name, cells, row["depth_mm"], row["harmonic"], row["calculix"][-1], flush=True)
    return {"scene": scene.name, "cells": [list(m) for m in scene.meshes], "harmonics": ORDER, "rows": rows}


def figures(force: float, sideways: float, rise: float) -> dict[str, float]:
    """The figures compared, from N, N and MPa."""
    return dict(zip(FIGURES, (float(force), float(sideways), float(rise) / KPA), strict=True))


def section(data: list[dict[str, Any]]) -> list[str]:
    """The lines of the comparison for a page."""
    worst = {figure: max(map(abs, differences(data, figure))) for figure in FIGURES}
    refined = " and ".join(f"{_times(a)} to {_times(b)}" for a, b in (s["cells"] for s in data if len(s["cells"]) > 1))
    return [
        HEADING,
        "",
        f"The paper's sensor without its base, without friction, by the harmonic solid (M = {ORDER}, 24 x 2 cells) and by "
        "half a dome of C3D20R cells in three dimensions, each with its own gas shut in: CalculiX's pressure is that which "
        "Boyle's law gives in the volume that CalculiX finds. Next to each figure of the harmonic solid is the difference "
        "of CalculiX from it; where CalculiX was run on a coarser mesh too, the last column is the greatest change of its three "
        f"figures by the refinement: {refined}. "
        "`python -m benchmarks.off_axis_calculix` computes it. See [off-axis.md](off-axis.md).",
        "",
        "| scene | mm | force N | CalculiX | sideways N | CalculiX | pressure rise kPa | CalculiX | refinement |",
        "|---|---|---|---|---|---|---|---|---|",
        *(_line(scene["scene"], row) for scene in data for row in scene["rows"]),
        "",
        f"Greatest differences: force {worst['force_N']:.1%}, sideways force {worst['sideways_N']:.1%}, pressure rise "
        f"{worst['rise_kPa']:.1%}.",
        "",
    ]


def _times(cells: list[int]) -> str:
    return " x ".join(map(str, cells))


def _line(scene: str, row: dict[str, Any]) -> str:
    ours, fine = row["harmonic"], row["calculix"][-1]
    pairs = [f"{ours[figure]:.4g} | {fine[figure] / ours[figure] - 1.0:+.1%}" for figure in FIGURES]
    changes = [abs(fine[figure] / coarse[figure] - 1.0) for coarse in row["calculix"][:-1] for figure in FIGURES]
    settled = f"{max(changes):.1%}" if changes else ""
    return f"| {scene} | {row['depth_mm']:g} | {' | '.join(pairs)} | {settled} |"


def differences(data: list[dict[str, Any]], figure: str) -> list[float]:
    """CalculiX's finer mesh over the harmonic solid, less 1, in every row."""
    return [row["calculix"][-1][figure] / row["harmonic"][figure] - 1.0 for scene in data for row in scene["rows"]]


def main(*numbers: int) -> None:
    """The scenes of the numbers, from 1, or all; the others as they are stored."""
    stored = {scene["scene"]: scene for scene in (json.loads(STORED.read_text("utf-8")) if STORED.exists() else [])}
    for number in numbers or range(1, len(SCENES) + 1):
        scene = SCENES[number - 1]
        stored[scene.name] = compared(scene)
    data = [stored[scene.name] for scene in SCENES if scene.name in stored]
    STORED.write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")
    replace_section(PAGE, section(data))


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
