"""Contact off the axis with CalculiX in three dimensions (an optional peer, found on PATH).

``python -m benchmarks.off_axis_calculix [SCENE ...]`` presses the paper's sensor in the scenes of these numbers, or in all
of them, with the harmonic solid and with half a dome of C3D20R cells, without the base. Compared are the force, the
sideways force and the pressure rise of both, each with its own gas, and their processor times. Stores
docs/background/off-axis-calculix.json.
"""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from benchmarks.calculix_half import INNER, WALL, HalfPress
from benchmarks.scenes import paper
from benchmarks.store import store, stored
from pneutouch.arrays import Array
from pneutouch.mechanics.harmonic.press import OffAxisPress
from pneutouch.mechanics.harmonic.surface import LyingObject, PlacedObject, Surface
from pneutouch.mechanics.solid.indent import PressSettings
from pneutouch.mechanics.solid.indenter import ball, cylinder, edge
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.object_contact import Plate
from pneutouch.mechanics.solid.stress import StrainProbe
from pneutouch.shape.hemisphere import Hemisphere
from pneutouch.units import KPA

FIGURES = ("force_N", "sideways_N", "rise_kPa")
_STRAIGHT = 1e-4
"""A sideways force below this share of the force is that of a scene with a second plane of symmetry: it is not compared."""

ORDER = 6
_PLATE = 16.0
"""Half the width of the plate of CalculiX, mm."""
_BESIDE = -2.0
"""Where objects begin along y, mm: they reach over the plane of symmetry, y = 0."""


class Place(NamedTuple):
    """Where the object stands, and what is found there: depth and travel along x (mm), force and its part along x (N),
    gauge pressure (MPa)."""

    depth: float
    travel: float
    force: float
    sideways: float
    pressure: float


class OurPress(NamedTuple):
    """The object at first contact, the harmonic solid's places from there on, and its processor time (s), from the mesh
    to the last."""

    surface: Surface
    places: list[Place]
    seconds: float


@dataclass(frozen=True)
class OffAxisScene:
    """An object at any height, R0, the driving pressure (MPa), the edges of the object's cells (mm), and the cells of
    CalculiX's dome, along the arc, through the wall and around half the axis, on a mesh or on coarser and finer ones;
    those in the upper half of the arc are ``closer`` times shorter than below. Compared at half of ``depth`` and at it,
    and where a travel follows at ``stops`` of ten equal parts of it. ``increment``: see `HalfPress`. ``order``: of the
    harmonics. ``steps``: to half of the depth. ``modulus``: shear modulus, MPa. ``symmetric``: about the plane x = 0 too.
    ``others``: orders and cells by which the harmonic solid is timed and compared, too."""

    name: str
    surface: Surface
    driving: float
    edges: tuple[Array, Array]
    meshes: tuple[tuple[int, int, int], ...]
    closer: float = 1.0
    depth: float = 4.0
    increment: float = 0.5
    order: int = ORDER
    friction: float = 0.0
    modulus: float = 0.17
    symmetric: bool = False
    steps: int = 1
    travel: float = 0.0
    stops: tuple[int, ...] = (2, 5, 10)
    others: tuple[tuple[int, tuple[int, int]], ...] = ()

    def pressed(self, order: int | None = None, cells: tuple[int, int] | tuple[()] = ()) -> OurPress:
        """The harmonic solid, with another order or other cells along the arc and through the wall."""
        begun = time.process_time()
        solid = SolidModel(dome(Hemisphere(INNER, WALL), *cells), paper(self.modulus).wall.hyperelastic)
        settings = PressSettings(self.depth, 2 * self.steps, friction=self.friction, gauge_range=np.inf)
        free, probe = state_at(solid, self.driving), StrainProbe(solid)
        press = OffAxisPress(solid, free, settings, self.surface, probe, self.travel, self.symmetric)
        path = press.run(order or self.order)
        states = path.states[:: self.steps]
        places = [Place(s.indentation, 0.0, s.force, s.sideways, s.pressure) for s in states]
        moved = [path.shear.states[stop] for stop in self.stops] if path.shear else []
        places += [Place(self.depth, s.travel, s.force, s.sideways, self.driving + s.rise) for s in moved]
        return OurPress(press.surface, places, time.process_time() - begun)

    def half(self, ours: OurPress, cells: tuple[int, int, int]) -> HalfPress:
        """CalculiX's half dome with the object and to the places of the harmonic solid."""
        sensor = paper(self.modulus)
        return HalfPress(
            ours.surface,
            self.edges,
            self.driving,
            np.array([place.depth for place in ours.places if not place.travel]),
            cells,
            self.closer,
            self.friction,
            self.increment,
            wall=(sensor.wall.shear_modulus, sensor.wall.poisson_ratio),
            travels=tuple(place.travel for place in ours.places if place.travel),
        )


def _kpa(driving: float) -> str:
    return f"{driving / KPA:g} kPa"


def _plate(tilt: float, driving: float, *meshes: tuple[int, int, int]) -> OffAxisScene:
    leaning = PlacedObject(Plate(0.0, np.inf, 1.0), 0.0, float(np.radians(tilt)))
    edges = (np.array([-_PLATE, _PLATE]), np.array([_BESIDE, _PLATE]))
    return OffAxisScene(f"plate tilted by {tilt:g} degrees, {_kpa(driving)}", leaning, driving, edges, meshes)


def _ball(radius: float, offset: float, driving: float, *meshes: tuple[int, int, int]) -> OffAxisScene:
    placed = PlacedObject(ball(radius).scaled(1.0 / INNER), offset / INNER)
    across = 0.9 * radius * np.linspace(-1.0, 1.0, 13)
    edges = (offset + across, np.append(across[5], across[6:]))
    name = f"ball of {radius:g} mm radius, {offset:g} mm off the axis, {_kpa(driving)}"
    return OffAxisScene(name, placed, driving, edges, meshes, closer=1.5, increment=0.25)


def _lying(word: str, radius: float, offset: float, driving: float, *meshes: tuple[int, int, int]) -> OffAxisScene:
    body = (edge if word == "edge" else cylinder)(radius).scaled(1.0 / INNER)
    across = offset + 0.9 * radius * np.linspace(-1.0, 1.0, 13)
    where = f"{offset:g} mm off the axis" if offset else "across the middle"
    name = f"{word} of {radius:g} mm radius, {where}, {_kpa(driving)}"
    edges = (across, np.array([_BESIDE, _PLATE]))
    return OffAxisScene(name, LyingObject(body, offset / INNER), driving, edges, meshes, closer=1.5)


def _sheared(friction: float, modulus: float, *meshes: tuple[int, int, int]) -> OffAxisScene:
    """A level plate: under one that leans, or a ball beside the axis, CalculiX counts as slip how far the object came
    sideways along its own surface before a point touched."""
    name = f"level plate, friction {friction:g}, wall of {modulus:g} MPa, 0 kPa, then sideways"
    scene = replace(_plate(0.0, 0.0, *meshes), name=name, friction=friction, modulus=modulus)
    return replace(scene, depth=1.2, steps=4, travel=0.2, stops=(5, 10))


OTHERS = ((4, (12, 1)), (4, (24, 2)), (ORDER, (24, 2)))
"""Orders, and cells along the arc and through the wall, by which the harmonic solid is timed."""
EVEN_OTHERS = ((8, (48, 2)), (12, (24, 2)), (16, (24, 2)))
"""The same in a scene that is symmetric about two planes."""

SCENES = (
    _plate(10.0, 0.0, (28, 2, 6), (40, 2, 6)),
    replace(_plate(10.0, 22.0 * KPA, (28, 2, 6)), others=OTHERS),
    _ball(6.0, 3.0, 0.0, (24, 2, 10), (32, 2, 12)),
    _ball(6.0, 3.0, 22.0 * KPA, (26, 2, 10)),
    _plate(20.0, 0.0, (28, 2, 6)),
    _ball(12.0, 4.0, 0.0, (26, 2, 10)),
    replace(_lying("edge", 5.0, 0.0, 0.0, (36, 2, 8)), order=8, symmetric=True, increment=0.25, others=EVEN_OTHERS),
    replace(_lying("edge", 5.0, 2.5, 0.0, (24, 2, 10)), order=12, increment=0.25),
    _sheared(0.3, 0.91, (28, 2, 6)),
)


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
    known = {scene["scene"]: scene for scene in stored("off-axis-calculix")}
    for number in numbers or range(1, len(SCENES) + 1):
        scene = SCENES[number - 1]
        known[scene.name] = compared(scene)
        data = [known[scene.name] for scene in SCENES if scene.name in known]
        store("off-axis-calculix", data)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
