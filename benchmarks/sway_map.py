"""Where a pressed dome is no longer a body of revolution: a map over wall ratio, driving pressure, dead volume and resin."""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.outcome_map import draw_outcomes
from pneutouch.errors import PneutouchError
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.solid.indent import PressSettings, indent
from pneutouch.mechanics.solid.inflate import Inflation, inflate, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.rigid_base import RigidBase
from pneutouch.report.style import INK, MUTED, figure, svg

RADIUS, DEPTH, WAVES = 9.25, 0.75, 16
RESINS = {"TangoPlus, 0.17 MPa": 0.17, "FLX9970, 1.64 MPa": 1.64}
WALL_RATIOS = (0.03, 0.04, 0.06, 0.08, 0.12, 0.162, 0.25, 0.35)
FRACTIONS = (0.0, 0.25, 0.5, 0.75)
DEAD = {"sealed, no dead volume": 0.0, "dead volume of one cavity": 1.0, "vented": 1e4}
"""Dead volume over that of the inflated cavity; the largest keeps the pressure."""

JUMPS = ("snap", "clamp_fold", "lost", "unstable", "separation")
LOOKS: dict[str, dict[str, Any]] = {
    "sway first": {"marker": "s", "color": INK, "ms": 5},
    "lobes first": {"marker": "^", "color": INK, "ms": 5.5},
    "jump as a body of revolution first": {"marker": "x", "color": INK, "ms": 5},
    "axisymmetric to 0.75 R0": {"marker": "o", "color": MUTED, "mfc": "white", "ms": 5},
    "no such state": {"marker": "_", "color": MUTED, "ms": 5},
}
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
    solid = SolidModel(dome(RADIUS, ratio * RADIUS), neo_hookean(mu), base=RigidBase())
    return solid, inflate(solid, past_limit=1.0)


def measure() -> list[dict[str, Any]]:
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


def draw(rows: list[dict[str, Any]]) -> str:
    """Resins down, dead volumes across; numbers are depths over R0."""
    with figure(178, 120) as drawn:
        drawn.get_layout_engine().set(rect=(0, 0, 1, 0.915))  # type: ignore[union-attr]
        axes = drawn.subplots(len(RESINS), len(DEAD), sharex=True, sharey=True)
        for i, resin in enumerate(RESINS):
            for k, gas in enumerate(DEAD):
                ax = axes[i, k]
                here = [row for row in rows if (row["resin"], row["gas"]) == (resin, gas)]
                draw_outcomes(ax, here, LOOKS, WALL_RATIOS)
                for row in here:
                    if row["outcome"] in list(LOOKS)[:3]:
                        place = (row["wall_ratio"], row["limit_fraction"])
                        text = f"{row['depth_ratio']:.2f}"
                        ax.annotate(text, place, (0, 5), textcoords="offset points", ha="center", fontsize=5.5)
                ax.set(xlim=(0.026, 0.42), ylim=(-0.06, 0.92))
                if i == 0:
                    ax.set_title(gas, fontsize=7.5)
                if k == 0:
                    ax.set_ylabel(f"{resin}\np / limit  (-)", fontsize=7)
                if i == len(RESINS) - 1:
                    ax.set_xlabel("wall / R0  (-)")
        handles, labels = axes[0, 0].get_legend_handles_labels()
        drawn.legend(handles, labels, loc="upper center", ncols=3)
        return svg(drawn)
