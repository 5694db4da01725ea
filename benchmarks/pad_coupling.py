"""What a model of a pad whose cells answer for themselves leaves out, by CalculiX (an optional peer, found on PATH).

``python -m benchmarks.pad_coupling [SCENE ...]`` presses three domes on one flange in three dimensions without friction,
in the scenes of these names or in all of them. One mesh is held in several ways: at the base plane of the domes, as a
single sensor is taken; on the flange as glue holds it; and so with one dome pressed alone, whose force and rise differ
by what its pressed neighbours do. CalculiX has the gauge pressures of our own answer inside, and its volumes give the
rises that its gas would have. Stores docs/background/pad_coupling.json.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any, Literal

import numpy as np

from benchmarks.calculix_pad import PadPress, PadShape, PadStop, Seat
from benchmarks.pads import PITCH, PRESSURE_KPA, cell_sensor
from benchmarks.store import DOCS, store, stored
from pneutouch.arrays import Array
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.touch.cell import CellTable, cell_table
from pneutouch.mechanics.touch.forward import PadAnswer, PadModel
from pneutouch.units import KPA

NAME = "pad_coupling"
Clamp = Literal["base", "flange"]
COARSE, FINE = (12, 2, 12), (24, 2, 12)
"""Cells along the arc, through the wall and around a dome."""
_LEAST = 0.01
"""Force of a pressed cell at least, N."""
_LEAN = float(np.tan(np.radians(10.0)))
_BALL, _BESIDE = 14.0, 0.8
"""Radius of the ball, and how far its axis lies from the middle of the cells, mm."""
_HALF = np.array([[PITCH / np.sqrt(3.0), 0.0], [-0.5 * PITCH / np.sqrt(3.0), 0.5 * PITCH]])
"""Axes of the first two cells of a triangle about its middle, mm; the third is the mirror image of the second."""


@dataclass(frozen=True)
class PadScene:
    """An object over cells with axes at ``half`` (y >= 0, mm): height of its underside over the tops of the domes at the
    depth 0, our answer at depths (mm), by how much it waits above depth 0, and the meshes by how they are held."""

    half: Array
    height: Callable[[Array, Array], Array]
    answer: Callable[[PadModel, Array], PadAnswer]
    above: float
    depths: tuple[float, ...]
    runs: tuple[tuple[Seat, tuple[int, int, int]], ...]

    @property
    def places(self) -> Array:
        """Axes of all cells, those of `half` first."""
        beside = self.half[self.half[:, 1] > 0.0]
        return np.concatenate([self.half, beside * [1.0, -1.0]])

    def ours(self, table: CellTable, down: float) -> PadAnswer:
        """Our answer at the depths, counted from a plane ``down`` (mm) below the tops of the table's domes."""
        model = PadModel.alike(self.places, table, np.ones(len(self.places)))
        return self.answer(model, np.array(self.depths) + down)


def _under_plate(lean: float) -> Callable[[PadModel, Array], PadAnswer]:
    return lambda model, depth: model.under_plates(np.tile([lean, 0.0], (len(depth), 1)), depth)


def _under_ball(model: PadModel, depth: Array) -> PadAnswer:
    return model.under_balls(np.tile([_BESIDE, 0.0], (len(depth), 1)), np.full(len(depth), _BALL), depth)


def _ball_height(x: Array, y: Array) -> Array:
    return np.asarray(_BALL - np.sqrt(_BALL**2 - (x - _BESIDE) ** 2 - y**2))


_BOTH: tuple[tuple[Seat, tuple[int, int, int]], ...] = (("base", COARSE), ("groove", COARSE))
SCENES = {
    "one": PadScene(
        np.zeros((1, 2)),
        lambda x, y: np.zeros_like(x),
        _under_plate(0.0),
        0.1,
        (1.0, 1.5),
        (*_BOTH, ("underside", COARSE), ("base", FINE), ("groove", FINE)),
    ),
    "plate": PadScene(
        _HALF,
        lambda x, y: _LEAN * x,
        _under_plate(_LEAN),
        0.6,
        (0.7, 1.1),
        (*_BOTH, ("alone", COARSE), ("groove", FINE)),
    ),
    "ball": PadScene(_HALF, _ball_height, _under_ball, 0.0, (1.6, 2.2), (*_BOTH, ("alone", COARSE))),
}
"""One cell under a level plate; three under a plate that leans by 10 degrees, and under a ball between them."""


def compared(scene: PadScene, runs: tuple[tuple[Seat, tuple[int, int, int]], ...]) -> dict[str, Any]:
    """One scene by our two tables, and by CalculiX held in each way on each mesh."""
    tables = {clamp: table_of(clamp) for clamp in ("base", "flange")}
    high = tables["flange"].apex
    answers = {clamp: scene.ours(table, table.apex - high) for clamp, table in tables.items()}
    ours = {clamp: our_figures(answer) for clamp, answer in answers.items()}
    found = []
    for seat, cells in runs:
        stops, seconds = pressed(scene, answers["base" if seat == "base" else "flange"], seat, cells, high)
        found.append({"held": seat, "cells": list(cells), "processor_s": seconds, "states": stops})
        print(seat, cells, f"{seconds:.0f} s", stops, flush=True)
    return {"depths_mm": list(scene.depths), "ours": ours, "calculix": found}


def pressed(
    scene: PadScene, answer: PadAnswer, seat: Seat, cells: tuple[int, int, int], high: float
) -> tuple[list[dict[str, Any]], float]:
    """CalculiX's figures at the depths from a height of the tops (mm), under the pressures of our answer, and its
    processor time, s."""
    sensor, driving, count = sensor_of("flange"), PRESSURE_KPA * KPA, len(scene.half)
    dome, flange = sensor.dome.shape, sensor.dome.flange
    assert flange is not None
    shape = PadShape(scene.half, PITCH, dome.inner_radius, dome.wall_thickness, flange)
    rise = answer.rise[:, :count] * ([1.0, 0.0][:count] if seat == "alone" else 1.0)
    press = PadPress(
        shape,
        sensor.wall,
        lambda x, y: high + scene.height(x, y),
        scene.above,
        driving,
        np.array(scene.depths),
        driving + rise,
    )
    (free, *stops), seconds = press.run(cells, seat)
    hole = 0.0 if seat == "base" else np.pi * dome.inner_radius**2 * flange[1]
    behind = sensor.gas.dead_volume - hole
    return [calculix_figures(sensor, free, stop, behind, high) for stop in stops], seconds


def calculix_figures(sensor: Sensor, free: PadStop, stop: PadStop, behind: float, high: float) -> dict[str, Any]:
    """Figures of a state: the rises are those of gas that was shut in at the driving pressure, with a volume ``behind``
    the cavity (mm3)."""
    whole = sensor.gas.ambient_pressure + PRESSURE_KPA * KPA
    rises = whole * ((behind + free.volumes) / (behind + stop.volumes) - 1.0)
    # Where the line of the force crosses the plane of the tops.
    centre = (high * stop.force[0] - stop.moment[1]) / stop.force[2]
    return figures(stop.force[2], centre, stop.forces[:, 2], rises)


def our_figures(answer: PadAnswer) -> list[dict[str, Any]]:
    """The same of our answer, for the cells with y >= 0."""
    count = min(2, answer.rise.shape[1])
    rows = zip(answer.force, answer.centre[:, 0], answer.forces[:, :count], answer.rise[:, :count], strict=True)
    return [figures(*row) for row in rows]


def figures(force: float, centre: float, forces: Array, rises: Array) -> dict[str, Any]:
    """Whole force (N), place of its line along x (mm), forces (N) and pressure rises (MPa) of the cells with y >= 0."""
    return {
        "force_N": float(force),
        "centre_mm": float(centre),
        "forces_N": forces.tolist(),
        "rises_kPa": (rises / KPA).tolist(),
    }


def sensor_of(clamp: Clamp) -> Sensor:
    """The cell, held at its base plane or on its flange."""
    return cell_sensor() if clamp == "flange" else cell_sensor().replace(flange=None)


@cache
def table_of(clamp: Clamp) -> CellTable:
    """Our table of the cell."""
    return cell_table(sensor_of(clamp), PRESSURE_KPA * KPA)


def state(data: dict[str, Any], seat: Seat, cells: tuple[int, int, int] = COARSE) -> list[dict[str, Any]]:
    """CalculiX's figures of a scene, held in a way, on a mesh; none if it is not among the runs."""
    found = (run["states"] for run in data["calculix"] if run["held"] == seat and tuple(run["cells"]) == cells)
    return next(found, [])


def change(after: list[dict[str, Any]], before: list[dict[str, Any]]) -> dict[str, float]:
    """What differs most from ``before`` to ``after`` over the depths: whole force, and pressure rise of a cell over the
    greatest of any, relative; centre, mm."""
    pairs = list(zip(after, before, strict=True))
    rises = [(np.array(a["rises_kPa"]) - b["rises_kPa"]) / max(b["rises_kPa"]) for a, b in pairs]
    return {
        "force": max((a["force_N"] / b["force_N"] - 1.0 for a, b in pairs), key=abs),
        "centre_mm": max((a["centre_mm"] - b["centre_mm"] for a, b in pairs), key=abs),
        "rise": max(np.concatenate(rises).tolist(), key=abs),
    }


def neighbours(pressed: list[dict[str, Any]], alone: list[dict[str, Any]]) -> dict[str, float]:
    """What the other cells do to the first one when they are pressed, too, most over the depths: its force over the
    greatest of a cell, and its pressure rise over the greatest; and the rise of a cell beside the first one alone, over
    that of the first."""
    pairs = list(zip(pressed, alone, strict=True))
    columns = {"force": "forces_N", "rise": "rises_kPa"}
    found = {
        name: max(((a[key][0] - b[key][0]) / max(a[key]) for a, b in pairs), key=abs) for name, key in columns.items()
    }
    beside = [b["rises_kPa"][1] / b["rises_kPa"][0] for _, b in pairs if b["forces_N"][0] > _LEAST]
    return {**found, "beside": max(beside, key=abs)}


def reduced(data: dict[str, Any]) -> dict[str, Any]:
    """What the page states of each scene, as differences of `change`: our answer from CalculiX's on one flange
    (``flange``), and held at the base plane (``base``); CalculiX's own by what is held and by the mesh."""
    out: dict[str, Any] = {}
    for name, scene in data.items():
        ours, clamped, glued = scene["ours"], state(scene, "base"), state(scene, "groove")
        out[name] = {
            "base": change(ours["base"], clamped),
            "flange": change(ours["flange"], glued),
            "without_flange": change(ours["base"], glued),
            "foot": change(glued, clamped),
        }
        if alone := state(scene, "alone"):
            out[name]["neighbours"] = neighbours(glued, alone)
        if loose := state(scene, "underside"):
            out[name]["unglued_holes"] = change(loose, glued)
        if fine := state(scene, "groove", FINE):
            out[name] |= {"mesh": change(glued, fine), "fine": change(ours["flange"], fine)}
    return out


def main(*names: str) -> None:
    """The scenes of the names, or all; the others as they are stored."""
    for name in names or SCENES:
        found = compared(SCENES[name], SCENES[name].runs)
        known = stored(NAME)["scenes"] if (DOCS / f"{NAME}.json").exists() else {}
        every = {**known, name: found}
        scenes = {key: every[key] for key in SCENES if key in every}
        store(NAME, {"scenes": scenes, "reduced": reduced(scenes)})


if __name__ == "__main__":
    main(*sys.argv[1:])
