"""Contact off the axis with CalculiX (an optional peer, found on PATH): ``python -m benchmarks.off_axis_calculix``.

Half of the paper's dome as a three-dimensional body of C3D20R cells, clamped at its base, is pressed by a ball off the axis or a
leaning plate, without friction, with the pressure that the solid with harmonics finds at each depth in it. Compared are the force,
the sideways force, and the pressure that the gas has in the volume that CalculiX finds. Optional arguments: cells along the arc,
through the wall and around half the axis, then harmonics. Writes docs/off-axis-calculix.json.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

from benchmarks.scenes import PAPER
from benchmarks.sway_calculix import RADIUS as INNER
from benchmarks.sway_calculix import SPRING, WALL, Grid
from pneutouch.arrays import Array
from pneutouch.mechanics.harmonic.press import OffAxisPath, OffAxisPress
from pneutouch.mechanics.harmonic.surface import PlacedObject
from pneutouch.mechanics.solid.contact import Plate
from pneutouch.mechanics.solid.indent import PressSettings
from pneutouch.mechanics.solid.indenter import ball
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.stress import StrainProbe

ROOT = Path(__file__).resolve().parents[1]
DEPTH, STEPS = 4.0, 8
AMBIENT = 0.101325
BALL, OFFSET, TILT = 6.0, 3.0, 10.0

Scene = tuple[str, PlacedObject, list[float], list[float]]
"""Name, object in R0, and the edges in x and y of the cells of its rigid body, mm."""


def scenes() -> list[Scene]:
    """The ball and the plate."""
    plate = Plate(0.0, np.inf, 1.0)
    wide = list(np.linspace(-5.4, 5.4, 45))
    return [
        (f"plate tilted by {TILT:g} degrees", PlacedObject(plate, 0.0, np.radians(TILT)), [-16.0, 16.0], [-2.0, 16.0]),
        (
            f"ball of {BALL:g} mm offset by {OFFSET:g} mm",
            PlacedObject(ball(BALL).scaled(1.0 / INNER), OFFSET / INNER),
            [OFFSET + x for x in wide],
            [y for y in wide if y > -0.5],
        ),
    ]


def harmonic_press(placed: PlacedObject, order: int) -> tuple[OffAxisPath, float]:
    """The press of the sensor without driving pressure, and the height of the object at first contact (mm)."""
    solid = SolidModel(dome(INNER, WALL), PAPER.wall.hyperelastic)
    press = OffAxisPress(
        solid, state_at(solid, 0.0), PressSettings(DEPTH, STEPS, ambient=AMBIENT), placed, StrainProbe(solid)
    )
    return press.run(order), press.surface.height * INNER


def deck(grid: Grid, scene: Scene, height: float, depths: Array, pressures: Array) -> str:
    """The input of CalculiX; the time of the step is the depth in mm."""
    nu, mu = PAPER.wall.poisson_ratio, PAPER.wall.shear_modulus
    bulk = 2 * mu * (1 + nu) / (3 * (1 - 2 * nu))
    _, placed, xs, ys = scene
    cells, count = grid.cells(), len(grid.points)
    flat_x, flat_y = (a.ravel() for a in np.meshgrid(xs, ys, indexing="ij"))
    under = height + INNER * placed.at(0.0).over(flat_x / INNER, flat_y / INNER).height
    body = [(x, y, z + up) for up in (0.0, 1.0) for x, y, z in zip(flat_x, flat_y, under, strict=True)]
    layer, row = len(flat_x), len(ys)
    corners = [
        (i * row + k, (i + 1) * row + k, (i + 1) * row + k + 1, i * row + k + 1)
        for i in range(len(xs) - 1)
        for k in range(row - 1)
    ]
    bricks = [[count + 1 + n for n in low] + [count + 1 + layer + n for n in low] for low in corners]
    flat = {number for (_, _, k), number in grid.number.items() if k in (0, 2 * grid.around)}
    held = {number for (i, _, _), number in grid.number.items() if i == 0}
    inner = sorted(number for (_, j, _), number in grid.number.items() if j == 0)
    lines = ["*NODE,NSET=ALL"]
    lines += [f"{n},{x:.10g},{y:.10g},{z:.10g}" for n, (x, y, z) in enumerate([*grid.points, *body], start=1)]
    lines += ["*ELEMENT,TYPE=C3D20R,ELSET=WALL"]
    for n, (nodes, _, _) in enumerate(cells, start=1):
        lines += [f"{n}," + ",".join(map(str, nodes[:10])) + ",", ",".join(map(str, nodes[10:]))]
    lines += ["*ELEMENT,TYPE=C3D8,ELSET=BODY"]
    lines += [f"{len(cells) + 1 + n}," + ",".join(map(str, brick)) for n, brick in enumerate(bricks)]
    lines += ["*NSET,NSET=FLAT", *(f"{n}," for n in sorted(flat)), "*NSET,NSET=HELD", *(f"{n}," for n in sorted(held))]
    lines += ["*NSET,NSET=OBJECT", *(f"{count + 1 + k}," for k in range(len(body)))]
    lines += ["*NSET,NSET=INSIDE", *(f"{n}," for n in inner)]
    lines += ["*ELSET,ELSET=INNER", *(f"{n}," for n, cell in enumerate(cells, start=1) if cell[1])]
    lines += ["*SURFACE,NAME=OUT", *(f"{n},S5" for n, cell in enumerate(cells, start=1) if cell[2])]
    lines += ["*SURFACE,NAME=UNDER", *(f"{len(cells) + 1 + n},S1" for n in range(len(bricks)))]
    lines += ["*MATERIAL,NAME=RUBBER", "*HYPERELASTIC,NEO HOOKE", f"{0.5 * mu:.12g},{2 / bulk:.12g}"]
    lines += ["*MATERIAL,NAME=STIFF", "*ELASTIC", "1000,0.3"]
    lines += ["*SOLID SECTION,ELSET=WALL,MATERIAL=RUBBER", "*SOLID SECTION,ELSET=BODY,MATERIAL=STIFF"]
    lines += ["*SURFACE INTERACTION,NAME=SLIPS", "*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR", f"{SPRING}"]
    lines += ["*CONTACT PAIR,INTERACTION=SLIPS,TYPE=SURFACE TO SURFACE", "OUT,UNDER"]
    pairs = zip(depths, pressures, strict=True)
    lines += ["*AMPLITUDE,NAME=GAS,TIME=TOTAL TIME", *(f"{d:.10g},{p:.10g}" for d, p in pairs)]
    lines += ["*AMPLITUDE,NAME=DOWN,TIME=TOTAL TIME", "0,0", f"{DEPTH + 1},{DEPTH + 1}"]
    lines += ["*TIME POINTS,NAME=STEPS,GENERATE", f"{DEPTH / STEPS},{DEPTH},{DEPTH / STEPS}"]
    lines += ["*BOUNDARY", "HELD,1,3", "FLAT,2,2", "OBJECT,1,2"]
    lines += ["*STEP,NLGEOM,INC=400", "*STATIC", f"0.1,{DEPTH},1e-4,0.5"]
    lines += ["*CONTROLS,PARAMETERS=FIELD", "1e-3,1e-2", "*BOUNDARY,AMPLITUDE=DOWN", "OBJECT,3,3,-1"]
    lines += ["*DLOAD,AMPLITUDE=GAS", "INNER,P3,1"]
    lines += [
        "*NODE PRINT,NSET=INSIDE,TIME POINTS=STEPS",
        "U",
        "*NODE PRINT,NSET=OBJECT,TOTALS=ONLY,TIME POINTS=STEPS",
        "RF",
    ]
    return "\n".join([*lines, "*END STEP", ""])


def calculix_press(grid: Grid, text: str) -> list[tuple[float, float, float, float]]:
    """Depth (mm), force and sideways force on the object (N, whole dome) and volume (mm^3) at every step."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "press.inp").write_text(text, encoding="ascii")
        with (folder / "out").open("w") as out:
            subprocess.run(["ccx", "press"], cwd=folder, stdout=out, check=False)
        found = (folder / "press.dat").read_text(encoding="ascii")
    rows, moved, time = [], dict[int, Array](), 0.0
    for line in found.splitlines():
        words = line.split()
        if "time" in words:
            time = float(words[-1])
        elif len(words) == 4 and words[0].isdigit():
            moved[int(words[0])] = np.array([float(w) for w in words[1:]])
        elif len(words) == 3:
            x, _, z = (float(w) for w in words)
            rows.append((time, -2.0 * z, -2.0 * x, _volume(grid, lambda n: moved[n])))
    return rows


def _volume(grid: Grid, moved: Callable[[int], Array]) -> float:
    """Volume inside the inner wall of the whole dome above z = 0: quadratic surfaces by 3 x 3 Gauss points a face."""
    from pneutouch.mechanics.solid.elements import cell_shapes, gauss_square

    points, weights = gauss_square(3)
    value, slope = cell_shapes(points, 8)
    total = 0.0
    for k, i in np.ndindex(grid.around, grid.arc):
        a, c = 2 * i, 2 * k
        spots = [(a, c), (a + 2, c), (a + 2, c + 2), (a, c + 2), (a + 1, c), (a + 2, c + 1), (a + 1, c + 2), (a, c + 1)]
        numbers = [grid.number[p, 0, q] for p, q in spots]
        place = np.array([np.array(grid.points[n - 1]) + moved(n) for n in numbers])
        at, along, turned = value @ place, slope[..., 0] @ place, slope[..., 1] @ place
        # The horizontal position through the surface: half its flux is the volume.
        normal = np.cross(turned, along)
        total += float(weights @ (at[:, :2] * normal[:, :2]).sum(axis=1))
    return abs(total)


def compared(scene: Scene, sizes: tuple[int, int, int], order: int) -> dict[str, object]:
    """One scene by both programs."""
    path, height = harmonic_press(scene[1], order)
    grid = Grid(*sizes)
    text = deck(grid, scene, height, path.column("indentation"), path.column("pressure"))
    rows: list[dict[str, float]] = []
    rest = _volume(grid, lambda n: np.zeros(3))
    for depth, force, sideways, volume in calculix_press(grid, text):
        ours = min(path.states, key=lambda s: abs(s.indentation - depth))
        if abs(ours.indentation - depth) > 1e-6 or any(row["depth_mm"] == ours.indentation for row in rows):
            continue
        theirs_kPa = 1e3 * (AMBIENT * rest / volume - AMBIENT)
        rows.append(
            {
                "depth_mm": ours.indentation,
                "harmonic_force_N": ours.force,
                "calculix_force_N": force,
                "harmonic_sideways_N": ours.sideways,
                "calculix_sideways_N": sideways,
                "harmonic_pressure_kPa": 1e3 * ours.pressure,
                "calculix_pressure_kPa": theirs_kPa,
            }
        )
        print(" ".join(f"{name}={value:.5g}" for name, value in rows[-1].items()), flush=True)
    return {"scene": scene[0], "cells": list(sizes), "harmonics": order, "rows": rows}


def main(arc: int = 24, through: int = 2, around: int = 12, order: int = 8) -> None:
    """Both scenes, and one table."""
    data = [compared(scene, (arc, through, around), order) for scene in scenes()]
    (ROOT / "docs" / "off-axis-calculix.json").write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
