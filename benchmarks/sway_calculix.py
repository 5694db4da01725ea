"""The sway with CalculiX (an optional peer, found on PATH): ``python -m benchmarks.sway_calculix [ARC THROUGH AROUND]``.

Half of the paper's dome as a three-dimensional body of C3D20R cells, clamped at its base, with the pressure that the solid
finds at each depth in it, is pressed by a flat plate without friction. A small sideways force on a ring at 45 degrees stands for
an imperfection: force over the displacement of the pole is a stiffness that falls to zero where the dome sways. The same stiffness
follows from the second variation of the solid. Writes docs/background/sway-calculix.json.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from benchmarks.scenes import PAPER
from benchmarks.store import store
from pneutouch.arrays import Array
from pneutouch.mechanics.solid.banded import solve
from pneutouch.mechanics.solid.elements import Regulator
from pneutouch.mechanics.solid.indent import IndentationPath, PressSettings, indent
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import SolidScene, evaluate
from pneutouch.mechanics.solid.object_contact import Plate
from pneutouch.mechanics.solid.second_variation import HarmonicSolid
from pneutouch.shape.hemisphere import Hemisphere

RADIUS, WALL, DEPTH = PAPER.dome.inner_radius, PAPER.dome.wall_thickness, 6.66
SENSOR_DEPTH = 6.94
"""How far the solid goes, mm: past the sway, which CalculiX only comes near."""
SIDEWAYS = 0.02
"""Sideways force, N, on the whole dome."""
HOLE = np.radians(0.6)
"""A hole at the pole spares degenerate cells; its area is a ten-thousandth of the base's."""
SPRING = 300.0
"""Stiffness of the contact, MPa/mm."""


def solid_press(arc: int, through: int) -> tuple[SolidModel, IndentationPath]:
    """The press of the sensor without driving pressure by the solid."""
    solid = SolidModel(dome(Hemisphere(RADIUS, WALL), arc=arc, through=through), PAPER.wall.hyperelastic)
    settings = PressSettings(SENSOR_DEPTH, 35, plate_diameter=None, waves=8)
    return solid, indent(solid, state_at(solid, 0.0), settings)


def solid_stiffness(solid: SolidModel, run: IndentationPath) -> list[float]:
    """Force on a ring of the outer wall at 45 degrees over the displacement of the pole (N/mm), at every state."""
    harmonic, rest = HarmonicSolid(solid), solid.mesh.nodes
    outer = np.unique(solid.mesh.outer[:, :2])
    ring = int(outer[np.abs(np.arctan2(rest[outer, 1], rest[outer, 0]) - 0.25 * np.pi).argmin()])
    out = []
    for state in run.states:
        plate = Plate(1.0 + solid.wall - state.indentation / RADIUS, np.inf, 1.0)
        at = evaluate(SolidScene(solid, Regulator(state.pressure / solid.mu), plate), state.positions / RADIUS)
        assert at is not None
        band = harmonic.bands(at, (1,))[1]
        # The work of a force F along x on the ring is F (a - c)/2, and the form of one wave is over half the circle.
        load = np.zeros((band.shape[1], 1))
        unknowns = harmonic.unknowns[ring]
        load[unknowns[0]], load[unknowns[2]] = 1.0, -1.0
        moved = harmonic.expand(1, solve(band, load).x[:, 0])[solid.mesh.outer_apex, 0]
        out.append(float(solid.mu * RADIUS / moved))
    return out


class Grid:
    """Half a dome of C3D20R cells: ``arc`` from base to pole, ``through`` the wall, ``around`` half the axis.

    ``angles`` of the nodes above the base (rad), those in the middle of cells included; without them the cells are
    equally long.
    """

    def __init__(self, arc: int, through: int, around: int, angles: Array | None = None) -> None:
        self.arc, self.through, self.around = arc, through, around
        self.number: dict[tuple[int, int, int], int] = {}
        self.points: list[tuple[float, float, float]] = []
        angle = np.linspace(0.0, 0.5 * np.pi - HOLE, 2 * arc + 1) if angles is None else angles
        radius = RADIUS + WALL * np.linspace(0.0, 1.0, 2 * through + 1)
        turn = np.linspace(0.0, np.pi, 2 * around + 1)
        for k, i, j in np.ndindex(turn.size, angle.size, radius.size):
            if i % 2 + j % 2 + k % 2 > 1:
                continue
            r = radius[j] * np.cos(angle[i])
            self.number[i, j, k] = len(self.points) + 1
            self.points.append((r * np.cos(turn[k]), r * np.sin(turn[k]), radius[j] * np.sin(angle[i])))

    def cells(self) -> list[tuple[list[int], bool, bool]]:
        """Nodes of each cell, and whether it has a face inside and one outside."""
        out = []
        for k, i, j in np.ndindex(self.around, self.arc, self.through):
            a, b, c = 2 * i, 2 * j, 2 * k
            # Seen along the turn: inner low, inner high, outer high, outer low.
            corners = [(a, b), (a + 2, b), (a + 2, b + 2), (a, b + 2)]
            sides = [(a + 1, b), (a + 2, b + 1), (a + 1, b + 2), (a, b + 1)]
            order = [(*p, c) for p in corners] + [(*p, c + 2) for p in corners]
            order += [(*p, c) for p in sides] + [(*p, c + 2) for p in sides] + [(*p, c + 1) for p in corners]
            out.append(([self.number[node] for node in order], j == 0, j == self.through - 1))
        return out

    def ring(self) -> dict[int, float]:
        """Nodes of the loaded ring, with their shares of an even load on half of it: Simpson's rule in each cell."""
        i, end = 2 * round(0.5 * self.arc), 2 * self.around
        shares = {k: (4.0 if k % 2 else 1.0 if k in (0, end) else 2.0) / (6.0 * self.around) for k in range(end + 1)}
        return {self.number[i, 2 * self.through, k]: share for k, share in shares.items()}

    def pole(self) -> list[int]:
        """Two nodes of the outer wall at the pole, on both sides of the hole."""
        return [self.number[2 * self.arc, 2 * self.through, k] for k in (0, 2 * self.around)]


def deck(grid: Grid, depths: list[float], pressures: list[float]) -> str:
    """The input of CalculiX; the time of the step is the depth in mm."""
    nu, mu = PAPER.wall.poisson_ratio, PAPER.wall.shear_modulus
    bulk = 2 * mu * (1 + nu) / (3 * (1 - 2 * nu))
    cells, count, top = grid.cells(), len(grid.points), RADIUS + WALL
    corner = [
        (x, y, z) for z in (top, top + 1.0) for x, y in ((-15.0, -2.0), (15.0, -2.0), (15.0, 15.0), (-15.0, 15.0))
    ]
    flat = {number for (_, _, k), number in grid.number.items() if k in (0, 2 * grid.around)}
    held = {number for (i, _, _), number in grid.number.items() if i == 0}
    lines = ["*NODE,NSET=ALL"]
    lines += [f"{n},{x:.10g},{y:.10g},{z:.10g}" for n, (x, y, z) in enumerate([*grid.points, *corner], start=1)]
    lines += ["*ELEMENT,TYPE=C3D20R,ELSET=WALL"]
    for n, (nodes, _, _) in enumerate(cells, start=1):
        lines += [f"{n}," + ",".join(map(str, nodes[:10])) + ",", ",".join(map(str, nodes[10:]))]
    lines += ["*ELEMENT,TYPE=C3D8,ELSET=PLATE", f"{len(cells) + 1}," + ",".join(str(count + k) for k in range(1, 9))]
    lines += ["*NSET,NSET=FLAT", *(f"{n}," for n in sorted(flat)), "*NSET,NSET=HELD", *(f"{n}," for n in sorted(held))]
    lines += ["*NSET,NSET=OBJECT", *(f"{count + k}," for k in range(1, 9))]
    lines += ["*NSET,NSET=POLE", *(f"{n}," for n in grid.pole())]
    lines += ["*ELSET,ELSET=INNER", *(f"{n}," for n, cell in enumerate(cells, start=1) if cell[1])]
    lines += ["*SURFACE,NAME=OUT", *(f"{n},S5" for n, cell in enumerate(cells, start=1) if cell[2])]
    lines += ["*SURFACE,NAME=UNDER", f"{len(cells) + 1},S1"]
    lines += ["*MATERIAL,NAME=RUBBER", "*HYPERELASTIC,NEO HOOKE", f"{0.5 * mu:.12g},{2 / bulk:.12g}"]
    lines += ["*MATERIAL,NAME=STIFF", "*ELASTIC", "1000,0.3"]
    lines += ["*SOLID SECTION,ELSET=WALL,MATERIAL=RUBBER", "*SOLID SECTION,ELSET=PLATE,MATERIAL=STIFF"]
    lines += ["*SURFACE INTERACTION,NAME=SLIPS", "*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR", f"{SPRING}"]
    lines += ["*CONTACT PAIR,INTERACTION=SLIPS,TYPE=SURFACE TO SURFACE", "OUT,UNDER"]
    lines += [
        "*AMPLITUDE,NAME=GAS,TIME=TOTAL TIME",
        *(f"{d:.10g},{p:.10g}" for d, p in zip(depths, pressures, strict=True)),
    ]
    lines += ["*AMPLITUDE,NAME=DOWN,TIME=TOTAL TIME", "0,0", f"{DEPTH + 1},{DEPTH + 1}"]
    lines += ["*AMPLITUDE,NAME=ON,TIME=TOTAL TIME", "0,0", "0.1,1", f"{DEPTH + 1},1"]
    lines += ["*BOUNDARY", "HELD,1,3", "FLAT,2,2", "OBJECT,1,2"]
    lines += ["*STEP,NLGEOM,INC=400", "*STATIC", f"0.05,{DEPTH},1e-4,0.2"]
    lines += ["*CONTROLS,PARAMETERS=FIELD", "1e-4,1e-3", "*BOUNDARY,AMPLITUDE=DOWN", "OBJECT,3,3,-1"]
    lines += ["*DLOAD,AMPLITUDE=GAS", "INNER,P3,1", "*CLOAD,AMPLITUDE=ON"]
    lines += [f"{n},1,{0.5 * SIDEWAYS * share:.10g}" for n, share in sorted(grid.ring().items())]
    lines += ["*NODE PRINT,NSET=POLE", "U", "*NODE PRINT,NSET=OBJECT,TOTALS=ONLY", "RF", "*END STEP", ""]
    return "\n".join(lines)


def calculix_press(grid: Grid, depths: list[float], pressures: list[float]) -> list[tuple[float, float, float]]:
    """Depth (mm), sideways displacement of the pole (mm) and force of the plate (N, whole dome) of every increment."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "sway.inp").write_text(deck(grid, depths, pressures), encoding="ascii")
        with (folder / "out").open("w") as out:
            subprocess.run(["ccx", "sway"], cwd=folder, stdout=out, check=False)
        text = (folder / "sway.dat").read_text(encoding="ascii")
    rows: dict[float, list[float]] = {}
    moved, time = [], 0.0
    for line in text.splitlines():
        words = line.split()
        if "time" in words:
            time, moved = float(words[-1]), []
        elif len(words) == 4:
            moved.append(float(words[1]))
            if len(moved) == 2:
                rows[time] = [0.5 * sum(moved)]
        elif len(words) == 3 and time in rows:
            rows[time].append(-2.0 * float(words[2]))
    return [(time, *values) for time, values in rows.items() if len(values) == 2]


def main(arc: int = 24, through: int = 2, around: int = 10) -> None:
    """Both programs on cells of one size, and one table."""
    solid, run = solid_press(arc, through)
    ours = solid_stiffness(solid, run)
    depths = [state.indentation for state in run.states]
    theirs = calculix_press(Grid(arc, through, around), depths, [state.pressure for state in run.states])
    rows = [
        {
            "depth_mm": depth,
            "calculix_force_N": force,
            "solid_force_N": float(np.interp(depth, depths, [state.force for state in run.states])),
            "calculix_sideways_N_per_mm": SIDEWAYS / moved,
            "solid_sideways_N_per_mm": float(np.interp(depth, depths, ours)),
        }
        for depth, moved, force in theirs
        if depth > 0.3
    ]
    events = {event.kind: event.indentation for event in run.events if event.kind in ("sway", "lobes")}
    data = {"cells": [arc, through, around], "solid_events_mm": events, "rows": rows}
    store("sway-calculix", data)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
