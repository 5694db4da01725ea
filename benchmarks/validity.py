"""Map of validity: over wall ratio, driving pressure and depth, where each method holds, is off, or stops.

Every sensor is the paper's in TangoPlus with another wall, no dead volume; "within 5 %" is its sensitivity from first
contact to the depth against the solid on a refined mesh.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.answer import Answer, membrane_answer, solid_answer, solid_limit
from benchmarks.models import ATLAS, atlas_answer
from benchmarks.outcome_map import draw_outcomes
from benchmarks.scenes import PAPER, Scene
from pneutouch.errors import PneutouchError
from pneutouch.report.style import ACCENT, INK, MUTED, figure, svg

WALL_RATIOS = (0.02, 0.05, 0.1, 0.162, 0.25, 0.35, 0.5)
FRACTIONS = (0.0, 0.25, 0.5, 0.75, 0.95)
DEPTHS = (0.1, 0.25, 0.5, 0.75)
"""Shares of R0 for walls and depths, and of the solid's limit pressure for driving pressures."""

FINE = (64, 3)
METHODS = ("membrane variational", "membrane printed", ATLAS, "solid 12 x 1", "solid default")
WITHIN = 0.05

LOOKS: dict[str, dict[str, Any]] = {
    "within 5 %": {"marker": "o", "color": ACCENT, "ms": 5.5},
    "off by more": {"marker": "o", "color": INK, "mfc": "white", "ms": 5.5},
    "ends before": {"marker": "x", "color": INK, "ms": 5},
    "fails": {"marker": "s", "color": INK, "ms": 5},
    "outside its box": {"marker": "|", "color": INK, "ms": 6},
    "no such state": {"marker": "_", "color": MUTED, "ms": 6},
}
"""Outcomes: the method's own range ends before the depth; it raised an error; it does not cover such sensors; the refined solid itself buckles,
tears or leaves the gauge's range before the depth, so there is nothing to compare with."""


def _answer(method: str, scene: Scene) -> Answer | None:
    try:
        if method == ATLAS:
            return atlas_answer(scene)
        if method.startswith("membrane"):
            return membrane_answer(scene, method.split()[1])
        return solid_answer(scene, *((12, 1) if method == "solid 12 x 1" else (None, None)))
    except PneutouchError:
        return None


def _outcome(method: str, answer: Answer | None, truth: Answer, depth: float) -> str:
    if truth.end < depth * (1 - 1e-9):
        return "no such state"
    if answer is None:
        return "outside its box" if method == ATLAS else "fails"
    if answer.end < depth * (1 - 1e-9):
        return "ends before"
    grid = np.linspace(0.0, depth, 15)
    error = answer.sensitivity(grid) / truth.sensitivity(grid) - 1
    return "within 5 %" if abs(error) <= WITHIN else "off by more"


def measure() -> list[dict[str, Any]]:
    """One row for every method, wall ratio, driving pressure and depth."""
    rows = []
    for ratio in WALL_RATIOS:
        sensor = PAPER.replace(wall_thickness=ratio * PAPER.dome.inner_radius)
        limit = solid_limit(Scene("", sensor, 0.0), None, None)
        for fraction in FRACTIONS:
            scene = Scene("", sensor, fraction * limit)
            truth = solid_answer(scene, *FINE)
            answers = {method: _answer(method, scene) for method in METHODS}
            rows += [
                {
                    "method": method,
                    "wall_ratio": ratio,
                    "limit_fraction": fraction,
                    "depth_ratio": depth,
                    "outcome": _outcome(method, answer, truth, depth * sensor.dome.inner_radius),
                }
                for method, answer in answers.items()
                for depth in DEPTHS
            ]
    return rows


def draw(rows: list[dict[str, Any]]) -> str:
    """Small multiples: methods down, depths across."""
    with figure(178, 215) as drawn:
        drawn.get_layout_engine().set(rect=(0, 0, 1, 0.965))  # type: ignore[union-attr]
        axes = drawn.subplots(len(METHODS), len(DEPTHS), sharex=True, sharey=True)
        for i, method in enumerate(METHODS):
            for k, depth in enumerate(DEPTHS):
                ax = axes[i, k]
                here = [row for row in rows if (row["method"], row["depth_ratio"]) == (method, depth)]
                draw_outcomes(ax, here, LOOKS, WALL_RATIOS)
                ax.set(xlim=(0.016, 0.62), ylim=(-0.08, 1.03))
                if i == 0:
                    ax.set_title(f"to {depth:g} R0", fontsize=7.5)
                if k == 0:
                    ax.set_ylabel(f"{method}\np / limit  (-)", fontsize=7)
                if i == len(METHODS) - 1:
                    ax.set_xlabel("wall / R0  (-)")
        handles, labels = axes[0, 0].get_legend_handles_labels()
        drawn.legend(handles, labels, loc="upper center", ncols=6)
        return svg(drawn)


def section(rows: list[dict[str, Any]]) -> list[str]:
    """The map on the page, with a count of each outcome."""
    counts = {
        method: [sum(r["method"] == method and r["outcome"] == outcome for r in rows) for outcome in LOOKS]
        for method in METHODS
    }
    lines = [f"| {method} | " + " | ".join(map(str, counts[method])) + " |" for method in METHODS]
    return [
        "## Map of validity",
        "",
        f"The paper's sensor in TangoPlus with walls of {WALL_RATIOS[0]:g} to {WALL_RATIOS[-1]:g} R0, driven to shares of its limit pressure and pressed "
        "to four depths. Compared is the sensitivity from first contact to the depth, against the solid on "
        f"{FINE[0]} x {FINE[1]} cells. Data: `validity.json`.",
        "",
        "![Where each method holds: wall ratio over driving pressure, for four depths and five methods](validity.svg)",
        "",
        "*ends before*: the range of the method ends before the depth. *fails*: it raised an error. *outside its box*: the atlas reports this "
        "and gives no figures. *no such state*: the refined solid has an event before the depth.",
        "",
        "| method | " + " | ".join(LOOKS) + " |",
        "|---|" + "---|" * len(LOOKS),
        *lines,
        "",
    ]
