"""The paper's sensor refined over its whole depth: ``python -m benchmarks.full_depth`` writes docs/background/full-depth.json."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from benchmarks.scenes import PAPER
from benchmarks.speed_accuracy import REFINEMENTS, extrapolate
from benchmarks.store import store
from pneutouch.mechanics.models.solid import KINDS, curve_between
from pneutouch.mechanics.response import figures
from pneutouch.mechanics.sensor import RigidBase
from pneutouch.mechanics.solid.flange import printed_dome
from pneutouch.mechanics.solid.indent import PressSettings, indent
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.units import KPA

FLANGE = 2.25
"""Width and thickness of the flange of a glued seat around this wall, mm."""
SHALLOW = 5.75
"""Depth in mm beyond which refined meshes without a base fold at the clamp."""
COARSE: tuple[tuple[int | None, int | None], ...] = ((None, None), (36, 2), (48, 3))
MESHES = (*COARSE, *REFINEMENTS)
PRESSURES = (0.0, 22 * KPA)


def pressed(mesh: tuple[int | None, int | None], pressure: float, held: str, base: bool) -> dict[str, Any]:
    """TangoPlus on one mesh at a driving pressure (MPa): cells, processor time, sensitivities to 5.75 mm and to the whole
    depth (None: not reached), and the events on the way; ``held``: "base plane" or "printed"."""
    s, start = PAPER, time.process_time()
    printed = held == "printed"
    body = printed_dome(s.dome.shape, FLANGE, FLANGE, *mesh) if printed else dome(s.dome.shape, *mesh)
    rigid = RigidBase(flange=s.dome.shape.outer_radius + FLANGE if printed else 0.0) if base else None
    solid = SolidModel(body, s.wall.hyperelastic, base=rigid)
    press = PressSettings(
        s.protocol.depth, s.protocol.steps, 2 * s.protocol.plate_radius, s.gas.ambient_pressure, s.gas.dead_volume
    )
    run = indent(solid, state_at(solid, pressure), press)
    seconds = time.process_time() - start
    last = run.path[-1].indentation

    def slope(depth: float) -> float | None:
        if last < depth - 1e-9:
            return None
        grid = np.linspace(0.0, depth, s.protocol.steps + 1)
        force, rise = curve_between(run.path, grid)
        found = figures(grid, force, rise / KPA)
        return None if found is None else found.sensitivity

    kinds = ("base", "overhang", "clamp_fold", "snap", "lost")
    events = [f"{KINDS[e.kind][0]} {e.indentation:.2f}" for e in run.events if e.kind in kinds]
    return {
        "mesh": "default" if mesh[0] is None else f"{mesh[0]} x {mesh[1]}",
        "cells": len(body.cells),
        "processor_s": seconds,
        "sensitivity_kPa_per_N": [slope(SHALLOW), slope(press.depth)],
        "happened": ", ".join(events) or "none",
    }


def measure() -> list[dict[str, Any]]:
    """One group of presses by rim, driving pressure and base, with the extrapolated sensitivities where the meshes allow them."""
    groups = []
    for held in ("base plane", "printed"):
        for pressure in PRESSURES:
            unit = 0.0
            for base in (False, True):
                fine = MESHES if held == "base plane" and base else COARSE
                presses = [pressed(mesh, pressure, held, base) for mesh in fine]
                unit = unit or presses[0]["processor_s"]
                group: dict[str, Any] = {"held": held, "base": base, "driving_pressure_kPa": 1e3 * pressure}
                group["presses"] = [_rounded(one, unit) for one in presses]
                if fine is MESHES:
                    value, error = extrapolate(*(np.array(one["sensitivity_kPa_per_N"]) for one in presses[-3:]))
                    group["extrapolated"] = [[float(v), float(e / v)] for v, e in zip(value, error, strict=True)]
                groups.append(group)
    return groups


def _rounded(press: dict[str, Any], unit: float) -> dict[str, Any]:
    shown = [None if value is None else round(value, 4) for value in press["sensitivity_kPa_per_N"]]
    return {**press, "sensitivity_kPa_per_N": shown, "time_ratio": round(press["processor_s"] / unit, 1)}


if __name__ == "__main__":
    store("full-depth", measure())
