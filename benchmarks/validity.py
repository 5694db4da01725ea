"""Map of validity: over wall ratio, driving pressure and depth, where each method holds, is off, or stops.

Every sensor is the paper's in TangoPlus with another wall, no dead volume; "within 5 %" is its sensitivity from first
contact to the depth against the solid on a refined mesh.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.methods import ATLAS, Answer, atlas_answer, membrane_answer, solid_answer, solid_limit
from benchmarks.scenes import PAPER, Scene
from pneutouch.errors import PneutouchError

WALL_RATIOS = (0.02, 0.05, 0.1, 0.162, 0.25, 0.35, 0.5)
FRACTIONS = (0.0, 0.25, 0.5, 0.75, 0.95)
DEPTHS = (0.1, 0.25, 0.5, 0.75)
"""Shares of R0 for walls and depths, and of the solid's limit pressure for driving pressures."""

FINE = (64, 3)
METHODS = ("membrane variational", "membrane printed", ATLAS, "solid 12 x 1", "solid default")
WITHIN = 0.05

OUTCOMES = ("within 5 %", "off by more", "ends before", "fails", "outside its box", "no such state")
"""The method's own range ends before the depth; it raised an error; it does not cover such sensors; the refined solid itself buckles,
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
