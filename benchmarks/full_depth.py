"""The paper's sensor refined over its whole depth: ``python -m benchmarks.full_depth`` writes this part of docs/background/accuracy.md."""

from __future__ import annotations

import json
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.page_section import replace_section
from benchmarks.scenes import PAPER
from benchmarks.speed_accuracy import REFINEMENTS, extrapolate
from pneutouch.mechanics.response import figures
from pneutouch.mechanics.solid.indent import PressSettings, indent
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.printed import printed_dome
from pneutouch.mechanics.solid.rigid_base import RigidBase
from pneutouch.mechanics.solid_states import KINDS, curve_between
from pneutouch.units import KPA

DOCS = Path(__file__).resolve().parents[1] / "docs" / "background"
PAGE, STORED = DOCS / "accuracy.md", DOCS / "full-depth.json"
HEADING = "## The paper's sensor over its whole depth"
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


def section(groups: list[dict[str, Any]]) -> list[str]:
    """The part of the page."""
    lines, verdicts = [], []
    for group in groups:
        pressure = f"{group['driving_pressure_kPa']:.0f}"
        label = f"| {group['held']} | {'yes' if group['base'] else 'no'} | {pressure} |"
        lines += [f"{label} {_row(press)}" for press in group["presses"]]
        if "extrapolated" in group:
            shallow, deep = group["extrapolated"]
            lines.append(f"{label} extrapolated | | | {_pair(*shallow)} | {_pair(*deep)} | |")
            default = group["presses"][0]["sensitivity_kPa_per_N"][1]
            verdicts.append(f"{default / deep[0] - 1:+.2%} at {pressure} kPa")
    return [
        HEADING,
        "",
        "With a base, the default, the wall lies down next to its clamp: on the rigid base plane, or on the free top of its own flange where "
        "the rim is held as printed. The default mesh then differs from the extrapolated sensitivity over the whole depth by "
        f"{' and '.join(verdicts)}. Without a base (`contact.base = false`) the wall passes through its base plane, refined meshes fold at the clamp, and "
        "figures over the whole depth do not converge.",
        "",
        "The table has the sensitivity S in kPa/N of TangoPlus without dead volume, from first contact to 5.75 mm and to the whole depth of 6.94 mm. "
        "Extrapolated from 32 x 2, 64 x 4 and 128 x 8 cells. Times are over that of the default mesh without base.",
        "",
        "| held at | base | driving kPa | mesh | cells | time | S to 5.75 mm | S to 6.94 mm | events, mm |",
        "|---|---|---|---|---|---|---|---|---|",
        *lines,
        "",
    ]


def _row(press: dict[str, Any]) -> str:
    shallow, deep = ("not reached" if x is None else f"{x:.4f}" for x in press["sensitivity_kPa_per_N"])
    return (
        f"{press['mesh']} | {press['cells']} | {press['time_ratio']:.1f} | {shallow} | {deep} | {press['happened']} |"
    )


def _pair(value: float, error: float) -> str:
    return f"{value:.4f} ± {error:.2%}"


def main() -> None:
    groups = measure()
    STORED.write_text(json.dumps(groups, indent=1) + "\n", encoding="utf-8")
    replace_section(PAGE, section(groups))
    print(f"wrote {HEADING.removeprefix('## ')} of docs/background/{PAGE.name}")


if __name__ == "__main__":
    main()
