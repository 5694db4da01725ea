"""The paper's sensor refined over its whole depth: ``python -m benchmarks.full_depth`` writes docs/background/full-depth.json."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmarks.scenes import PAPER
from benchmarks.speed_accuracy import REFINEMENTS, extrapolate
from benchmarks.store import store
from pneutouch.mechanics.response import figures
from pneutouch.mechanics.solid.indent import PressSettings, indent
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.printed import printed_dome
from pneutouch.mechanics.solid.rigid_base import RigidBase
from pneutouch.mechanics.solid_states import KINDS, curve_between
from pneutouch.units import KPA

FLANGE = 2.25
"""Width and thickness of the flange of a glued seat around this wall, mm."""
SHALLOW = 5.75
"""Depth in mm beyond which refined meshes without a base fold at the clamp."""
COARSE: tuple[tuple[int | None, int | None], ...] = ((None, None), (36, 2), (48, 3))
MESHES = (*COARSE, *REFINEMENTS)
PRESSURES = (0.0, 22 * KPA)


@dataclass(frozen=True)
class FullDepthPress:
    """One press: cells, processor time, sensitivities in kPa/N to 5.75 mm and to the whole depth (nan: not reached),
    and what happened: the end of the path, and where the wall lies down on its base."""

    mesh: tuple[int | None, int | None]
    cells: int
    seconds: float
    shallow: float
    deep: float
    happened: str


def pressed(mesh: tuple[int | None, int | None], pressure: float, held: str, base: bool) -> FullDepthPress:
    """TangoPlus on one mesh at a driving pressure (MPa); ``held``: "base plane" or "printed"."""
    s, start = PAPER, time.process_time()
    size = (s.dome.inner_radius, s.dome.wall_thickness)
    printed = held == "printed"
    body = printed_dome(*size, FLANGE, FLANGE, *mesh) if printed else dome(*size, *mesh)
    rigid = RigidBase(flange=sum(size) + FLANGE if printed else 0.0) if base else None
    solid = SolidModel(body, s.wall.hyperelastic, base=rigid)
    press = PressSettings(
        s.protocol.depth, s.protocol.steps, 2 * s.protocol.plate_radius, s.gas.ambient_pressure, s.gas.dead_volume
    )
    run = indent(solid, state_at(solid, pressure), press)
    seconds = time.process_time() - start
    last = run.path[-1].indentation

    def slope(depth: float) -> float:
        if last < depth - 1e-9:
            return np.nan
        grid = np.linspace(0.0, depth, s.protocol.steps + 1)
        force, rise = curve_between(run.path, grid)
        found = figures(grid, force, rise / KPA)
        return np.nan if found is None else found.sensitivity_kPa_per_N

    kinds = ("base", "overhang", "clamp_fold", "snap", "lost")
    events = [f"{KINDS[e.kind][0]} {e.indentation:.2f}" for e in run.events if e.kind in kinds]
    return FullDepthPress(
        mesh, len(body.cells), seconds, slope(SHALLOW), slope(press.depth), ", ".join(events) or "none"
    )


def measure() -> list[dict[str, Any]]:
    """One group of presses by rim, driving pressure and base, with the extrapolated sensitivities where the meshes allow them."""
    groups = []
    for held in ("base plane", "printed"):
        for pressure in PRESSURES:
            unit = 0.0
            for base in (False, True):
                fine = MESHES if held == "base plane" and base else COARSE
                presses = [pressed(mesh, pressure, held, base) for mesh in fine]
                unit = unit or presses[0].seconds
                group: dict[str, Any] = {"held": held, "base": base, "driving_pressure_kPa": 1e3 * pressure}
                group["presses"] = [_stored(press, unit) for press in presses]
                if fine is MESHES:
                    value, error = extrapolate(*(np.array([p.shallow, p.deep]) for p in presses[-3:]))
                    group["extrapolated"] = [[float(v), float(e / v)] for v, e in zip(value, error, strict=True)]
                groups.append(group)
    return groups


def _stored(press: FullDepthPress, unit: float) -> dict[str, Any]:
    shallow, deep = (None if np.isnan(x) else round(x, 4) for x in (press.shallow, press.deep))
    return {
        "mesh": "default" if press.mesh[0] is None else f"{press.mesh[0]} x {press.mesh[1]}",
        "cells": press.cells,
        "time_ratio": round(press.seconds / unit, 1),
        "sensitivity_kPa_per_N": [shallow, deep],
        "happened": press.happened,
    }


if __name__ == "__main__":
    store("full-depth", measure())
