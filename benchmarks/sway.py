"""Where a pressed dome leaves its axis: a map of domes, the paper's sensor refined, and thin shells (a few minutes).

``python -m benchmarks.sway`` writes docs/background/sway.json; with ``stored`` it reduces the stored rows anew, and those
of ``benchmarks.sway_calculix``.
"""

from __future__ import annotations

import statistics
import sys
from collections import Counter
from typing import Any

import numpy as np

from benchmarks.store import store, stored
from pneutouch.errors import PneutouchError
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.sensor import RigidBase
from pneutouch.mechanics.solid.elements import Regulator
from pneutouch.mechanics.solid.indent import PressSettings, indent
from pneutouch.mechanics.solid.inflate import Inflation, inflate, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import NewtonFailure, SolidScene, minimise
from pneutouch.mechanics.solid.second_variation import HarmonicSolid, unstable_waves
from pneutouch.shape.hemisphere import Hemisphere

PUBLISHED = 0.8
"""Share of the classical pressure at which a clamped hemisphere buckles (arXiv 2412.15066)."""

SHELLS = (0.01, 0.02, 0.03, 0.05)
SHOWN_MM = (0.5, 2.0, 4.0, 5.0, 5.5, 6.0, 6.3, 6.5, 6.9)
"""Depths at which both programs are shown."""

RADIUS, DEPTH, WAVES = 9.25, 0.75, 16
RESINS = {"TangoPlus, 0.17 MPa": 0.17, "FLX9970, 1.64 MPa": 1.64}
WALL_RATIOS = (0.03, 0.04, 0.06, 0.08, 0.12, 0.162, 0.25, 0.35)
FRACTIONS = (0.0, 0.25, 0.5, 0.75)
DEAD = {"sealed, no dead volume": 0.0, "dead volume of one cavity": 1.0, "vented": 1e4}
"""Dead volume over that of the inflated cavity; the largest keeps the pressure."""

JUMPS = ("snap", "clamp_fold", "lost", "unstable", "separation")
OUTCOMES = (
    "sway first",
    "lobes first",
    "jump as a body of revolution first",
    "axisymmetric to 0.75 R0",
    "no such state",
)
_KINDS = {"sway": "sway first", "lobes": "lobes first"}


def pressed(solid: SolidModel, run: Inflation, fraction: float, dead: float) -> tuple[str, float, str]:
    """What comes first, at which depth over R0, and the events by kind with theirs."""
    limit = run.limit.pressure if run.limit is not None else run.states[-1].pressure
    try:
        free = state_at(solid, fraction * limit, run)
        settings = PressSettings(
            DEPTH * RADIUS, plate_diameter=None, dead_volume=dead * free.volume, gauge_range=np.inf, waves=WAVES
        )
        path = indent(solid, free, settings)
    except PneutouchError:
        return "no such state", float("nan"), ""
    changes = sorted((e.indentation / RADIUS, e.kind) for e in path.events if e.kind in (*_KINDS, *JUMPS))
    if not changes:
        return "axisymmetric to 0.75 R0", DEPTH, ""
    first = _KINDS.get(changes[0][1], "jump as a body of revolution first")
    return first, round(changes[0][0], 4), ", ".join(f"{kind} {depth:.3f}" for depth, kind in changes)


def inflated(ratio: float, mu: float) -> tuple[SolidModel, Inflation]:
    """A dome of a wall ratio and a modulus (MPa), with a base under its wall, inflated to its limit point."""
    solid = SolidModel(dome(Hemisphere(RADIUS, ratio * RADIUS)), neo_hookean(mu), base=RigidBase())
    return solid, inflate(solid, past_limit=1.0)


def mapped() -> list[dict[str, Any]]:
    """One row for every resin, wall ratio, driving pressure and dead volume; both faces of the wall meet the base."""
    rows = []
    for resin, mu in RESINS.items():
        for ratio in WALL_RATIOS:
            solid, run = inflated(ratio, mu)
            for fraction in FRACTIONS:
                for gas, dead in DEAD.items():
                    outcome, depth, events = pressed(solid, run, fraction, dead)
                    row = {"resin": resin, "wall_ratio": ratio, "limit_fraction": fraction, "gas": gas}
                    rows.append({**row, "outcome": outcome, "depth_ratio": depth, "events": events})
    return rows


def refinement() -> list[dict[str, Any]]:
    """The paper's sensor at 0 and 22 kPa, frictionless, without and with a base under its wall, on refined meshes."""
    rows = []
    for pressure in (0.0, 0.022):
        for base in (None, RigidBase()):
            for cells in ((24, 2), (36, 2), (48, 3)):
                solid = SolidModel(dome(Hemisphere(9.25, 1.5), *cells), neo_hookean(0.17), base=base)
                run = indent(solid, state_at(solid, pressure), PressSettings(6.94, waves=8))
                events = {event.kind: round(event.indentation, 3) for event in run.events}
                row = {
                    "driving_pressure_kPa": 1e3 * pressure,
                    "base": base is not None,
                    "cells": f"{cells[0]} x {cells[1]}",
                }
                rows.append({**row, "sway_mm": events.get("sway"), "clamp_fold_mm": events.get("clamp_fold")})
    return rows


def buckling(ratio: float) -> dict[str, Any]:
    """A clamped hemisphere under outside pressure: share of the classical pressure at which it buckles, and waves."""
    nu = 0.3
    solid = SolidModel(dome(Hemisphere(10.0, 10.0 * ratio), arc=64, through=1), neo_hookean(1.0, nu))
    harmonic, waves = HarmonicSolid(solid), tuple(range(1, 25))
    classical = 4.0 * (1.0 + nu) * (ratio / (1.0 + 0.5 * ratio)) ** 2 / np.sqrt(3.0 * (1.0 - nu**2))
    x = solid.rest
    for share in np.arange(0.7, 1.0, 0.0025):
        solved = minimise(SolidScene(solid, Regulator(-share * classical), None), x)
        if isinstance(solved, NewtonFailure):
            return {"wall_ratio": ratio, "share": round(float(share), 4), "waves": [0]}
        x = solved.state.x
        lost = unstable_waves(harmonic, solved.state, waves)
        if lost:
            return {"wall_ratio": ratio, "share": round(float(share), 4), "waves": list(lost)}
    return {"wall_ratio": ratio, "share": None, "waves": []}


def zero(rows: list[dict[str, Any]]) -> float:
    """Depth (mm) at which the line through the last two stiffnesses of CalculiX is zero."""
    before, last = rows[-2:]
    fall = before["calculix_sideways_N_per_mm"] - last["calculix_sideways_N_per_mm"]
    return float(last["depth_mm"] + (last["depth_mm"] - before["depth_mm"]) * last["calculix_sideways_N_per_mm"] / fall)


def reduced(data: dict[str, Any], calculix: dict[str, Any]) -> dict[str, Any]:
    """What the page states: counts of the map, the lobes in it, and how near CalculiX is."""
    rows, counts = data["map"], Counter((row["gas"], row["outcome"]) for row in data["map"])
    lobes_first = sum(row["outcome"] == "lobes first" for row in rows)
    pairs = calculix["rows"]
    off = [abs(row["calculix_sideways_N_per_mm"] / row["solid_sideways_N_per_mm"] - 1) for row in pairs]
    shown = [min(pairs, key=lambda row: abs(row["depth_mm"] - depth)) for depth in SHOWN_MM]
    return {
        "counts": {gas: [counts[gas, outcome] for outcome in OUTCOMES] for gas in DEAD},
        "presses": len(rows),
        "sway_first": sum(row["outcome"] == OUTCOMES[0] for row in rows),
        "axisymmetric": sum(row["outcome"] == OUTCOMES[3] for row in rows),
        "lobes_first": lobes_first,
        "lobes_after": sum("lobes" in row["events"] for row in rows) - lobes_first,
        "calculix": {
            "cells": calculix["cells"],
            "shown": list({row["depth_mm"]: row for row in shown}.values()),
            "increments": len(pairs),
            "last_mm": pairs[-1]["depth_mm"],
            "apart_mm": pairs[-1]["depth_mm"] - pairs[-2]["depth_mm"],
            "median_difference": statistics.median(off),
            "greatest_difference": max(off),
            "sway_mm": zero(pairs),
            "solid_sway_mm": calculix["solid_events_mm"]["sway"],
        },
    }


def main(*words: str) -> None:
    if "stored" in words:
        data = stored("sway")
    else:
        data = {"map": mapped(), "refinement": refinement(), "hemisphere": [buckling(ratio) for ratio in SHELLS]}
    data["summary"] = reduced(data, stored("sway-calculix"))
    store("sway", data)


if __name__ == "__main__":
    main(*sys.argv[1:])
