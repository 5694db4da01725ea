"""The sway with CalculiX (an optional peer, found on PATH): ``python -m benchmarks.sway_calculix [ARC THROUGH AROUND]``.

Half of the paper's dome as a three-dimensional body of C3D20R cells, clamped at its base, with the pressure that the solid
finds at each depth in it, is pressed by a flat plate without friction. A small sideways force on a ring at 45 degrees stands for
an imperfection: force over the displacement of the pole is a stiffness that falls to zero where the dome sways. The same stiffness
follows from the second variation of the solid. Writes docs/background/sway-calculix.json.
"""

from __future__ import annotations

import sys

import numpy as np

from benchmarks.calculix_half import Grid, HalfPress, amplitude, half_model, listed
from benchmarks.calculix_sweep import run_calculix
from benchmarks.scenes import PAPER
from benchmarks.store import store
from pneutouch.mechanics.harmonic.surface import PlacedObject
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


def ring(grid: Grid) -> dict[int, float]:
    """Nodes of the loaded ring, with their shares of an even load on half of it: Simpson's rule in each cell."""
    i, end = 2 * round(0.5 * grid.arc), 2 * grid.around
    shares = {k: (4.0 if k % 2 else 1.0 if k in (0, end) else 2.0) / (6.0 * grid.around) for k in range(end + 1)}
    return {grid.number[i, 2 * grid.through, k]: share for k, share in shares.items()}


def deck(grid: Grid, depths: list[float], pressures: list[float]) -> list[str]:
    """The input of CalculiX; the time of the step is the depth in mm."""
    plate = PlacedObject(Plate(1.0 + WALL / RADIUS, np.inf, 1.0))
    half = HalfPress(plate, (np.array([-15.0, 15.0]), np.array([-2.0, 15.0])), 0.0, np.array(depths))
    # Two nodes of the outer wall at the pole, on both sides of the hole.
    pole = [grid.number[2 * grid.arc, 2 * grid.through, k] for k in (0, 2 * grid.around)]
    return [
        *half_model(half, grid),
        *listed("*NSET,NSET=POLE", pole),
        *amplitude("GAS", list(zip(depths, pressures, strict=True))),
        *amplitude("DOWN", [(0.0, 0.0), (DEPTH + 1, DEPTH + 1)]),
        *amplitude("ON", [(0.0, 0.0), (0.1, 1.0), (DEPTH + 1, 1.0)]),
        *("*BOUNDARY", "HELD,1,3", "FLAT,2,2", "OBJECT,1,2"),
        *("*STEP,NLGEOM,INC=400", "*STATIC", f"0.05,{DEPTH},1e-4,0.2"),
        *("*CONTROLS,PARAMETERS=FIELD", "1e-4,1e-3", "*BOUNDARY,AMPLITUDE=DOWN", "OBJECT,3,3,-1"),
        *("*DLOAD,AMPLITUDE=GAS", "INNER,P3,1", "*CLOAD,AMPLITUDE=ON"),
        *(f"{n},1,{0.5 * SIDEWAYS * share:.10g}" for n, share in sorted(ring(grid).items())),
        *("*NODE PRINT,NSET=POLE", "U", "*NODE PRINT,NSET=OBJECT,TOTALS=ONLY", "RF", "*END STEP"),
    ]


def calculix_press(grid: Grid, depths: list[float], pressures: list[float]) -> list[tuple[float, float, float]]:
    """Depth (mm), sideways displacement of the pole (mm) and force of the plate (N, whole dome) of every increment."""
    rows: dict[float, list[float]] = {}
    moved, time = [], 0.0
    for line in run_calculix(deck(grid, depths, pressures)).prints:
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
