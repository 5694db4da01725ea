"""Write docs/background/sway.md with its map: ``make sway-page`` (a few minutes)."""

from __future__ import annotations

import json
import statistics
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import sway_map
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.solid.harmonics import HarmonicSolid
from pneutouch.mechanics.solid.indent import PressSettings, indent
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import NewtonFailure, SolidScene, minimise
from pneutouch.mechanics.solid.rigid_base import RigidBase
from pneutouch.mechanics.solid.supply import Regulator
from pneutouch.mechanics.solid.sway import unstable_waves

DOCS = Path(__file__).resolve().parents[1] / "docs" / "background"
PUBLISHED = 0.8
SHELLS = (0.01, 0.02, 0.03, 0.05)


def refinement() -> list[dict[str, Any]]:
    """The paper's sensor at 0 and 22 kPa, frictionless, without and with a base under its wall, on refined meshes."""
    rows = []
    for pressure in (0.0, 0.022):
        for base in (None, RigidBase()):
            for cells in ((24, 2), (36, 2), (48, 3)):
                solid = SolidModel(dome(9.25, 1.5, *cells), neo_hookean(0.17), base=base)
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
    solid = SolidModel(dome(10.0, 10.0 * ratio, arc=64, through=1), neo_hookean(1.0, nu))
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


def measure() -> dict[str, Any]:
    """All numbers of the page but those of CalculiX."""
    return {"map": sway_map.measure(), "refinement": refinement(), "hemisphere": [buckling(ratio) for ratio in SHELLS]}


def _place(value: float | None) -> str:
    return "-" if value is None else f"{value:.2f}"


def _critical(rows: list[dict[str, Any]], sway: float | None) -> str:
    """Where both programs find the sway; nothing where CalculiX did not come near it."""
    stiffness = [row["calculix_sideways_N_per_mm"] for row in rows]
    if sway is None or stiffness[-1] > 0.2 * stiffness[0]:
        return "The run was ended there, before the sway; the solid locates it at " + (
            f"{sway:.2f} mm." if sway else "no depth."
        )
    critical = zero(rows)
    return (
        f"The line through CalculiX's last two stiffnesses is zero at {critical:.2f} mm; the solid locates the sway at {sway:.2f} mm "
        f"({sway / critical - 1:+.1%}). CalculiX did not converge beyond {rows[-1]['depth_mm']:.2f} mm, so its value is an extrapolation from two "
        f"points {rows[-1]['depth_mm'] - rows[-2]['depth_mm']:.3f} mm apart. Near the sway both stiffnesses fall in steps as points come into contact, and "
        f"differ by up to {_worst(rows):.0%} at single depths. The comparison confirms the depth of the sway, not its second digit."
    )


def _worst(rows: list[dict[str, Any]]) -> float:
    """Greatest relative difference of the two stiffnesses at one depth."""
    return max(abs(row["calculix_sideways_N_per_mm"] / row["solid_sideways_N_per_mm"] - 1) for row in rows)


def zero(rows: list[dict[str, Any]]) -> float:
    """Depth (mm) at which the line through the last two stiffnesses of CalculiX is zero."""
    before, last = rows[-2:]
    fall = before["calculix_sideways_N_per_mm"] - last["calculix_sideways_N_per_mm"]
    return float(last["depth_mm"] + (last["depth_mm"] - before["depth_mm"]) * last["calculix_sideways_N_per_mm"] / fall)


def calculix_section(data: dict[str, Any]) -> list[str]:
    """The sideways stiffness by both programs, and where it would be zero."""
    rows = data["rows"]
    shown = [
        min(rows, key=lambda row: abs(row["depth_mm"] - depth))
        for depth in (0.5, 2.0, 4.0, 5.0, 5.5, 6.0, 6.3, 6.5, 6.9)
    ]
    off = [row["calculix_sideways_N_per_mm"] / row["solid_sideways_N_per_mm"] - 1 for row in rows]
    arc, through, around = data["cells"]
    return [
        "## CalculiX in three dimensions",
        "",
        f"Half of the paper's dome in CalculiX 2.20 ({arc} x {through} x {around} C3D20R cells), without driving pressure, base and friction, at the cavity "
        "pressure of the solid at each depth. The imperfection is a sideways force of 0.02 N on a ring at 45 degrees. Force over displacement of "
        "the pole is a stiffness that falls to zero where the dome sways; the solid gives it by its second variation on "
        f"{arc} x {through} cells. `python -m benchmarks.sway_calculix {arc} {through} {around}` writes `sway-calculix.json`.",
        "",
        "| depth mm | CalculiX N/mm | solid N/mm | difference |",
        "|---|---|---|---|",
        *(
            f"| {row['depth_mm']:.2f} | {row['calculix_sideways_N_per_mm']:.3f} | {row['solid_sideways_N_per_mm']:.3f} | "
            f"{row['calculix_sideways_N_per_mm'] / row['solid_sideways_N_per_mm'] - 1:+.1%} |"
            for row in {row["depth_mm"]: row for row in shown}.values()
        ),
        "",
        f"Median difference over all {len(rows)} increments, to {rows[-1]['depth_mm']:.2f} mm: {statistics.median(map(abs, off)):.1%}. "
        + _critical(rows, data["solid_events_mm"].get("sway")),
        "",
    ]


def _lobes(rows: list[dict[str, Any]]) -> str:
    first = sum(row["outcome"] == "lobes first" for row in rows)
    after = sum("lobes" in row["events"] for row in rows) - first
    return f"Lobes come first in {first or 'none'} of the {len(rows)} presses, and in {after} between a sway and the jump that follows it."


def page(data: dict[str, Any], calculix: dict[str, Any]) -> str:
    """docs/background/sway.md."""
    counts = Counter((row["gas"], row["outcome"]) for row in data["map"])
    lines = [
        f"| {gas} | " + " | ".join(str(counts[gas, outcome]) for outcome in sway_map.LOOKS) + " |"
        for gas in sway_map.DEAD
    ]
    refined = [
        f"| {row['driving_pressure_kPa']:g} | {'yes' if row['base'] else 'no'} | {row['cells']} | {_place(row['sway_mm'])} | "
        f"{_place(row['clamp_fold_mm'])} |"
        for row in data["refinement"]
    ]
    shells = [
        f"| {row['wall_ratio']:g} | {row['share']:.3f} | {row['share'] / PUBLISHED - 1:+.1%} | {', '.join(map(str, row['waves']))} |"
        for row in data["hemisphere"]
    ]
    return "\n".join(
        [
            *_answer(data, calculix),
            *_method(),
            "## The paper's sensor",
            "",
            "No friction, pressed to 6.94 mm, three meshes. Without a base the wall can hang below its base plane and fold at the clamp; it then "
            "sways. A base under the wall (the default) removes the fold and the sway.",
            "",
            "| driving kPa | base | cells | sway at mm | fold at the clamp at mm |",
            "|---|---|---|---|---|",
            *refined,
            "",
            "## Other domes",
            "",
            f"Counts of the map above: {len(data['map'])} presses to 0.75 R0, checked for up to {sway_map.WAVES} waves. Where a jump comes first, the path "
            "of the solid ends there with its own event.",
            "",
            "| gas | " + " | ".join(sway_map.LOOKS) + " |",
            "|---|" + "---|" * len(sway_map.LOOKS),
            *lines,
            "",
            *_shells(shells),
            *calculix_section(calculix),
            *_limits(data["map"]),
        ]
    )


def _answer(data: dict[str, Any], calculix: dict[str, Any]) -> list[str]:
    """The question, the answer and the map."""
    first = sum(row["outcome"] == "sway first" for row in data["map"])
    kept = sum(row["outcome"] == "axisymmetric to 0.75 R0" for row in data["map"])
    sway = calculix["solid_events_mm"]["sway"]
    return [
        "# Where the dome leaves its axis",
        "",
        "Does a pressed dome stay a body of revolution? It can sway sideways (one wave around the axis) or form lobes (more waves). Of "
        f"{len(data['map'])} domes with a base, pressed to 0.75 R0 without friction, {kept} stay axisymmetric and {first} sway before any other "
        "event. The paper's sensor does not sway. Without a base it does, at 0 kPa and a depth of "
        f"{sway:.2f} mm; CalculiX in three dimensions gives {zero(calculix['rows']):.2f} mm.",
        "",
        "![Map of pressed domes over wall ratio and driving pressure: sway, lobes, jump or axisymmetric to 0.75 R0](sway.svg)",
        "",
        f"What happens first in domes of {sway_map.RADIUS:g} mm with a base, pressed by an endless plate without friction. The number at a mark is "
        "the depth over R0. Data: `sway.json`.",
        "",
    ]


def _method() -> list[str]:
    return [
        "## Method",
        "",
        "The model `solid` follows the axisymmetric path. It checks, at states on the path and at its end, whether the second variation of the "
        "total energy of wall, gas and contact is positive for displacements of 1 to `indentation.checked_waves` waves (default 8; 0: no check). "
        "Where it is not, the depth is located and reported as the event `sway` or `lobes`, a warning. All figures stay those of the axisymmetric path, "
        "which the sensor leaves there. The check takes a quarter of the solid's time (at most 30 %, `make ratios`).",
        "",
        "Points that stick to the plate hold the wall in both directions; points that slide are taken as free. A coefficient of friction of 0.05 keeps "
        "the paper's sensor on its axis, also without a base.",
        "",
    ]


def _shells(shells: list[str]) -> list[str]:
    return [
        "## A clamped hemisphere under outside pressure",
        "",
        "Share of the classical buckling pressure 2 E (t/R)²/√(3(1 - ν²)) at which a clamped hemisphere buckles, in steps of 0.0025, with ν = 0.3 "
        "and 64 cells; R and t of the middle surface. The published value is 0.8, at the clamped boundary (arXiv 2412.15066).",
        "",
        "| wall / R0 | share | against 0.8 | waves |",
        "|---|---|---|---|",
        *shells,
        "",
    ]


def _limits(rows: list[dict[str, Any]]) -> list[str]:
    return [
        "## Limits",
        "",
        "- The path after a sway is not followed: no figure states what the sensor reads there.",
        f"- {_lobes(rows)}",
        "- Vented thin walls without driving pressure dimple at 2.4 to 2.6 wall thicknesses (Pauchard and Rica 1998: near two, then polygons). "
        "The solid follows few of them further.",
        "- `atlas` and `membrane` do not make the check; both list this among their assumptions.",
        "- CalculiX was compared on one mesh of one dome.",
        "",
        "The tests compare the second variation with differences of the energy of bodies bent in three dimensions, for each law "
        "(`tests/mechanics/solid/test_harmonics.py`). A complete thin sphere under outside pressure buckles at one pressure for 0, 2, 4, 6, 8 "
        "and 10 waves, as theory requires (`tests/mechanics/solid/test_sway.py`).",
        "",
        "`make sway-page` writes this page.",
        "",
    ]


def main() -> None:
    data = measure()
    calculix = json.loads((DOCS / "sway-calculix.json").read_text(encoding="utf-8"))
    (DOCS / "sway.json").write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")
    (DOCS / "sway.svg").write_text(sway_map.draw(data["map"]), encoding="utf-8")
    (DOCS / "sway.md").write_text(page(data, calculix), encoding="utf-8")
    print("wrote docs/background/sway.md, sway.json and sway.svg")


if __name__ == "__main__":
    main()
