"""Speed against accuracy: every method on every scene, beside a reference extrapolated from three refinements."""

from __future__ import annotations

import statistics
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from benchmarks.methods import (
    ATLAS,
    AUTO,
    MODEL_METHODS,
    Answer,
    atlas_answer,
    atlas_limit,
    auto_answer,
    membrane_answer,
    seconds_at_once,
    solid_answer,
    solid_limit,
    why_no_answer,
)
from benchmarks.scenes import SCENES, Scene
from benchmarks.store import timed
from pneutouch.arrays import Array
from pneutouch.mechanics.atlas.coverage import outside_atlas
from pneutouch.mechanics.membrane import limit_point
from pneutouch.units import KPA

REFINEMENTS = ((32, 2), (64, 4), (128, 8))
"""Cells along the arc and across the wall of the three meshes behind the reference: each halves the cells' sides."""

MESHES: dict[str, tuple[int | None, int | None]] = {
    "solid 8 x 1": (8, 1),
    "solid 12 x 1": (12, 1),
    "solid 16 x 1": (16, 1),
    "solid 24 x 1": (24, 1),
    "solid default": (None, None),
    "solid 36 x 2": (36, 2),
    "solid 48 x 3": (48, 3),
}
"""The default is 24 to 48 cells along the arc and one or two across, by the wall ratio."""

METHODS = ("membrane variational", "membrane printed", *MODEL_METHODS, *MESHES)
_RUNS = 3
_SHY = 0.98
"""Finer meshes fold a little earlier: what comes so near an event of a coarser one is not computed."""


def run(method: str, scene: Scene) -> Answer | None:
    """One method on one scene; None where it has no answer."""
    if method == ATLAS:
        return atlas_answer(scene)
    if method == AUTO:
        return auto_answer(scene)[0]
    if method in MESHES:
        return solid_answer(scene, *MESHES[method])
    return membrane_answer(scene, method.split()[1])


def limit(method: str, scene: Scene) -> float:
    """One method's limit pressure, MPa."""
    if method == ATLAS or (method == AUTO and auto_answer(scene)[1] == ATLAS):
        return atlas_limit(scene)
    if method == AUTO:
        return solid_limit(scene, None, None)
    if method in MESHES:
        return solid_limit(scene, *MESHES[method])
    return limit_point(scene.sensor).driving_pressure


def extrapolate(coarse: Array, middle: Array, fine: Array) -> tuple[Array, Array]:
    """Value at vanishing cells and what is thought of its error, from meshes each twice as fine.

    Richardson's with the order observed, where that lies between 0.6 and 4; else first order is assumed, the least
    that the singular edge of the clamp lets one expect. The error stated is what was added.
    """
    last, before = np.asarray(fine - middle, float), np.asarray(middle - coarse, float)
    ratio = np.divide(before, last, out=np.full_like(last, 2.0), where=np.abs(last) > 0)
    ratio = np.where((ratio >= 1.5) & (ratio <= 16.0), ratio, 2.0)
    added = last / (ratio - 1)
    return fine + added, np.abs(added)


@dataclass(frozen=True)
class Reference:
    """Three refined answers of one scene."""

    answers: tuple[Answer, Answer, Answer]
    limits: tuple[float, float, float]

    @property
    def end(self) -> float:
        """Event-free on all three meshes up to this indentation, mm."""
        return min(answer.end for answer in self.answers)

    @property
    def ends(self) -> str:
        """The event that ended the range of the finest mesh that met one, else "depth"."""
        return next((a.ends for a in reversed(self.answers) if a.ends != "depth"), "depth")

    def apex(self) -> tuple[float, float]:
        """Inner apex height at the driving pressure, with its error; mm."""
        value, error = extrapolate(*(np.array(a.apex) for a in self.answers))
        return float(value), float(error)

    def limit(self) -> tuple[float, float]:
        """Limit pressure, with its error; MPa."""
        value, error = extrapolate(*(np.array(x) for x in self.limits))
        return float(value), float(error)

    def force(self, grid: Array) -> tuple[Array, Array]:
        """Forces on a grid of indentations, with their errors; N."""
        return extrapolate(*(a.curve(grid)[0] for a in self.answers))

    def sensitivity(self, grid: Array) -> tuple[float, float]:
        """Sensitivity over a grid of indentations, with its error; kPa/N."""
        value, error = extrapolate(*(np.array(a.sensitivity(grid)) for a in self.answers))
        return float(value), float(error)


def reference(scene: Scene) -> Reference:
    """Solve a scene on the three refinements; each only nearly as deep as the one before found no event."""
    answers: list[Answer] = []
    for arc, through in REFINEMENTS:
        cut = bool(answers) and answers[-1].ends != "depth"
        answers.append(solid_answer(scene, arc, through, _SHY * answers[-1].end if cut else None))
    limits = tuple(solid_limit(scene, arc, through) for arc, through in REFINEMENTS)
    return Reference((answers[0], answers[1], answers[2]), limits)  # type: ignore[arg-type]


def compare(method: str, scene: Scene, answer: Answer, truth: Reference) -> dict[str, Any]:
    """Errors of one answer over the range that is free of events for it and for the reference alike."""
    common = min(answer.end, truth.end)
    grid = np.linspace(0.0, common, scene.sensor.protocol.steps + 1)
    force, _ = truth.force(grid)
    row: dict[str, Any] = {
        "method": method,
        "scene": scene.name,
        "range_end_mm": answer.end,
        "ends": answer.ends,
        "compared_to_mm": common,
        "range_share": common / truth.end,
        "sensitivity_kPa_per_N": answer.sensitivity(grid),
        "own_sensitivity_kPa_per_N": answer.sensitivity(np.linspace(0.0, answer.end, scene.sensor.protocol.steps + 1)),
        "sensitivity_error": answer.sensitivity(grid) / truth.sensitivity(grid)[0] - 1,
        "force_error": float(np.max(np.abs(answer.curve(grid)[0] - force)) / np.max(force)),
        "apex_error": answer.apex / truth.apex()[0] - 1 if scene.pressure else None,
        "limit_error": limit(method, scene) / truth.limit()[0] - 1,
    }
    return {key: None if isinstance(value, float) and np.isnan(value) else value for key, value in row.items()}


def model_note(method: str, scene: Scene) -> dict[str, str]:
    """What the table states of a model on a scene: why it has no answer, or which one was chosen."""
    if method == ATLAS and atlas_answer(scene) is None:
        return {"no_answer": why_no_answer(scene)}
    return {"model": auto_answer(scene)[1]} if method == AUTO else {}


def describe(scene: Scene, truth: Reference) -> dict[str, Any]:
    """A scene, its reference and the reference's own errors."""
    s = scene.sensor
    grid = np.linspace(0.0, truth.end, s.protocol.steps + 1)
    (apex, apex_off), (top, top_off), (slope, slope_off) = truth.apex(), truth.limit(), truth.sensitivity(grid)
    force, force_off = truth.force(grid)
    known = not np.isnan(top)
    return {
        "scene": scene.name,
        "inner_radius_mm": s.dome.inner_radius,
        "wall_thickness_mm": s.dome.wall_thickness,
        "law": [s.wall.law[0], list(s.wall.law[1])] if s.wall.law else ["neo-hookean", [s.wall.shear_modulus]],
        "poisson_ratio": s.wall.poisson_ratio,
        "driving_pressure_kPa": scene.pressure / KPA,
        "dead_volume_mL": s.gas.dead_volume * 1e-3,
        "depth_mm": s.protocol.depth,
        "reference": {
            "range_end_mm": truth.end,
            "ends": truth.ends,
            "range_ends_mm": [a.end for a in truth.answers],
            "apex_height_inner_mm": apex,
            "apex_error": apex_off / apex,
            "limit_pressure_kPa": top / KPA if known else None,
            "limit_error": top_off / top if known else None,
            "sensitivity_kPa_per_N": slope,
            "sensitivity_error": slope_off / slope,
            "force_N": float(force[-1]),
            "force_error": float(np.max(force_off) / np.max(force)),
        },
    }


def measure(scenes: tuple[Scene, ...] = SCENES) -> dict[str, Any]:
    """All methods on all scenes: errors, and the processor time (s, median of runs taken in turn) of the same work."""
    truths = {scene.name: reference(scene) for scene in scenes}
    rows = []
    for scene in scenes:
        answers: dict[str, Answer | None] = {}
        seconds: dict[str, list[float]] = {method: [] for method in METHODS}
        for _ in range(_RUNS):
            for method in METHODS:
                answers[method], taken_s = timed(partial(run, method, scene))
                seconds[method].append(taken_s)
        for method, answer in answers.items():
            blank = {"method": method, "scene": scene.name, "processor_s": None}
            taken = {"processor_s": statistics.median(seconds[method])}
            row = blank if answer is None else {**compare(method, scene, answer, truths[scene.name]), **taken}
            rows.append({**row, **model_note(method, scene)})
    return {
        "refinements": [list(r) for r in REFINEMENTS],
        "base": all(scene.sensor.dome.base is not None for scene in scenes),
        "scenes": [describe(scene, truths[scene.name]) for scene in scenes],
        "rows": rows,
        "atlas_at_once_s": statistics.median(seconds_at_once(s) for s in scenes if outside_atlas(s.sensor) is None),
    }
