"""A dome under a soft object as a second body in CalculiX (an optional peer, found on PATH), in eight scenes.

The object is a neo-Hookean block of CAX8R cells that is bonded to a plate which comes down. CalculiX has no trapped gas:
the inside pressure follows the solid's own curve, and the rise that is compared is that of the volume that CalculiX finds.

``python -m benchmarks.calculix_soft`` writes docs/background/soft-objects.json; about half an hour.
"""

from __future__ import annotations

from dataclasses import asdict
from typing import Any, NamedTuple

import numpy as np

from benchmarks.calculix_sweep import calculix_model, run_calculix
from benchmarks.store import store
from pneutouch.arrays import Array
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.mechanics import Sensor
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.models.solid import press_settings, solid_probe
from pneutouch.mechanics.soft.body import Nodule, SoftBody
from pneutouch.mechanics.soft.press import SoftPress
from pneutouch.mechanics.solid.inflate import inflate, state_at
from pneutouch.mechanics.solid.mesh import dome, with_middles
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.units import KPA

POISSON, CELLS, FINE, FIRST, TURN = 0.49, (32, 2), 0.4, 900001, 180.0
"""Poisson ratio of the object; cells of the dome; edge of the block's finest cells, mm; number of its first node and
cell; wedges of two degrees, into which CalculiX turns axisymmetric cells, in a turn."""


class Scene(NamedTuple):
    """Driving pressure (kPa), modulus of the object (MPa), thickness of the layer (mm; None: deep), greatest travel
    (mm), first increment, as a share of the press, and a nodule."""

    driving_kPa: float
    modulus: float
    thickness: float | None
    travel: float
    increment: float = 0.1
    nodule: Nodule | None = None


SCENES = (
    Scene(0.0, 0.02, None, 4.0),
    Scene(22.0, 0.02, None, 3.5),
    Scene(0.0, 0.02, 3.0, 3.0),
    Scene(22.0, 0.02, 3.0, 3.0, 0.05),
    Scene(0.0, 0.1, None, 5.0),
    Scene(22.0, 0.1, 3.0, 5.0),
    Scene(22.0, 0.5, None, 5.0),
    Scene(0.0, 5.0, 3.0, 5.0),
)
NODULES = tuple(Scene(0.0, 0.05, None, 2.0, 0.125, nodule) for nodule in (None, Nodule(6.0, 3.0, 2.0)))
"""A block without and with a nodule: 3 mm radius, its middle 6 mm deep, of 2 MPa."""

STEPS = 8


def paper_sensor() -> Sensor:
    """The paper's sensor in Tango+."""
    return evaluate("paper-dome", None, model="membrane").sensor


def main() -> None:
    """Compare and store."""
    sensor = paper_sensor()
    scenes, nodules = ([compared(sensor, scene) for scene in some] for some in (SCENES, NODULES))
    store("soft-objects", {"scenes": scenes, "nodules": nodules, "poisson": POISSON})


def compared(sensor: Sensor, scene: Scene) -> dict[str, Any]:
    """Travel (mm), force (N) and rise (kPa) by both in one scene; nan where CalculiX did not converge."""
    travel = np.linspace(0.0, scene.travel, STEPS + 1)
    driving = scene.driving_kPa * KPA
    solid = solid_probe(sensor).solid
    free = state_at(solid, driving, inflate(solid, to_pressure=driving) if driving else None)
    press = SoftPress(
        solid, free, press_settings(sensor), SoftBody(scene.modulus, POISSON, scene.thickness, nodule=scene.nodule)
    )
    points = [press.point(press.to(float(at))) for at in travel[1:]]
    rise = np.array([0.0, *(one.rise for one in points)])
    force, volume = calculix(sensor, scene, travel, driving + rise, free.outer_apex)
    start = volume[0] if np.isfinite(volume[0]) else free.volume
    there = (driving + sensor.gas.ambient_pressure) * (start / volume - 1.0)
    row = {
        "travel_mm": travel[1:],
        "force_N": np.array([one.force for one in points]),
        "rise_kPa": rise[1:] / KPA,
        "strain": np.array([one.strain for one in points]),
        "calculix_force_N": force[1:],
        "calculix_rise_kPa": there[1:] / KPA,
    }
    rounded = {key: np.round(values, 5).tolist() for key, values in row.items()}
    return scene._asdict() | {"nodule": scene.nodule and asdict(scene.nodule)} | rounded


def calculix(sensor: Sensor, scene: Scene, travel: Array, pressures: Array, top: float) -> tuple[Array, Array]:
    """Force (N) and volume (mm3) at travels (mm) with gauge pressures (MPa) there; ``top``: height of the object at
    first contact, mm."""
    begin = 1.0 if pressures[0] else 0.0
    times = (begin + travel / travel[-1]).tolist()
    start = ["0.,0."] if begin else []
    arc, through = CELLS
    deck = [
        *calculix_model(sensor, arc, through),
        *_block(scene, top),
        "*ELSET,ELSET=OUTER",
        *(f"{k}," for k in range(through, arc * through + 1, through)),
        "*SURFACE,NAME=SKIN",
        "OUTER,S2",
        "*SURFACE,NAME=UNDERSIDE",
        "FACE,S1",
        "*SURFACE INTERACTION,NAME=DRY",
        "*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR",
        "20.,1e-5,1e-4",
        "*CONTACT PAIR,INTERACTION=DRY,TYPE=SURFACE TO SURFACE",
        "SKIN,UNDERSIDE",
        "*AMPLITUDE,NAME=DOWN",
        *start,
        f"{begin:.12g},0.,{begin + 1:.12g},{-travel[-1]:.12g}",
        "*AMPLITUDE,NAME=GAS",
        *start,
        *(f"{t:.12g},{p:.12g}" for t, p in zip(times, pressures, strict=True)),
        "*TIME POINTS,NAME=SHOWN",
        *(f"{t:.12g}" for t in times[0 if begin else 1 :]),
        "*STEP,NLGEOM,INC=2000",
        "*STATIC",
        f"{scene.increment},{begin + 1:.12g},1e-5,{scene.increment}",
        "*BOUNDARY,AMPLITUDE=DOWN",
        "UPPER,2,2,1.",
        "*BOUNDARY",
        "UPPER,1,1,0.",
        "MIDDLE,1,1,0.",
        "*DLOAD,AMPLITUDE=GAS",
        "INNER,P4,1.",
        "*CONTACT PRINT,MASTER=UNDERSIDE,SLAVE=SKIN,TIME POINTS=SHOWN",
        "CF",
        "*NODE PRINT,NSET=ALL,TIME POINTS=SHOWN",
        "U",
        "*END STEP",
    ]
    return _read(sensor, run_calculix(deck).prints, travel, begin)


def _spaced(fine: float, flat: float, end: float) -> Array:
    """Points from 0 to ``end``, evenly to ``flat``, beyond it each a quarter farther apart than the last."""
    steps = [fine] * round(flat / fine)
    while sum(steps) < end:
        steps.append(1.25 * steps[-1])
    points = np.concatenate([[0.0], np.cumsum(steps)])
    return np.where(points > flat, flat + (points - flat) * (end - flat) / max(points[-1] - flat, 1e-9), points)


def _block(scene: Scene, top: float) -> list[str]:
    """The object, from its surface at the height ``top`` upwards: nodes, cells, material, and its sets."""
    deep, layer = scene.thickness is None, scene.thickness or 0.0
    radii = with_middles(_spaced(FINE, 12.0, 250.0 if deep else 60.0))
    flat = 4.0 if scene.nodule is None else 10.0
    heights = with_middles(_spaced(FINE, flat, 250.0) if deep else np.linspace(0.0, layer, 1 + round(layer / FINE)))
    places = [(i, j) for i in range(len(radii)) for j in range(len(heights)) if not (i % 2 and j % 2)]
    number = {place: FIRST + k for k, place in enumerate(places)}
    around = ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1))
    corners = [(i, j) for i in range(0, len(radii) - 2, 2) for j in range(0, len(heights) - 2, 2)]
    nodule = scene.nodule or Nodule(0.0, 0.0, scene.modulus)
    inside = [bool(np.hypot(radii[i + 1], heights[j + 1] - nodule.depth) < nodule.radius) for i, j in corners]
    cells = [",".join(str(number[i + a, j + b]) for a, b in around) for i, j in corners]
    deck = ["*NODE,NSET=BLOCK", *(f"{number[i, j]},{radii[i]:.12g},{top + heights[j]:.12g},0." for i, j in places)]
    for name, modulus, held in (("SOFT", scene.modulus, False), ("HARD", nodule.modulus, True)):
        if held not in inside:
            continue
        shear, bulk = 0.5 * modulus / (1.0 + POISSON), modulus / (3.0 - 6.0 * POISSON)
        deck += [
            f"*ELEMENT,TYPE=CAX8R,ELSET={name}",
            *(f"{FIRST + k},{cell}" for k, cell in enumerate(cells) if inside[k] == held),
            f"*MATERIAL,NAME={name}",
            "*HYPERELASTIC,NEO HOOKE",
            f"{0.5 * shear:.12g},{2.0 / bulk:.12g}",
            f"*SOLID SECTION,ELSET={name},MATERIAL={name}",
        ]
    return [
        *deck,
        "*ELSET,ELSET=FACE",
        *(f"{FIRST + k}," for k, (_, j) in enumerate(corners) if j == 0),
        "*NSET,NSET=UPPER",
        *(f"{number[place]}," for place in places if place[1] == len(heights) - 1),
        "*NSET,NSET=MIDDLE",
        *(f"{number[place]}," for place in places if place[0] == 0),
    ]


def _read(sensor: Sensor, lines: list[str], travel: Array, begin: float) -> tuple[Array, Array]:
    """Force of the whole turn, from the contact forces printed for the wedge, and volume under the displaced wall."""
    mesh = dome(sensor.dome.shape, *CELLS, order=8)
    solid, places, at = SolidModel(mesh, neo_hookean(1.0)), mesh.nodes.copy(), None
    force, volume = np.full((2, len(travel)), np.nan)
    for k, line in enumerate(lines):
        words = line.split()
        if line.startswith(" statistics for slave set") or "displacements" in line:
            near = np.abs(begin + travel / travel[-1] - float(words[-1])) < 1e-4
            at = near if "displacements" in line else at
            if "displacements" not in line:
                force[near] = -TURN * float(lines[k + 4].split()[1])
        elif at is not None and len(words) == 4 and words[0].isdigit() and int(words[0]) <= len(places):
            node = int(words[0]) - 1
            places[node] = mesh.nodes[node] + np.array(words[1:3], dtype=np.float64)
            if node == len(places) - 1:
                volume[at] = solid.cavity.volume(places / mesh.length) * mesh.length**3
    return force, volume


if __name__ == "__main__":
    main()
