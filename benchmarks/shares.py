"""Where the time goes: the default solid on every scene under the profiler, by what is being done."""

from __future__ import annotations

import cProfile
import pstats
from pathlib import Path

from benchmarks.scenes import SCENES, Scene
from benchmarks.speed_accuracy import run

PARTS: dict[str, tuple[tuple[str, str], ...]] = {
    "assembly: strains, law, forces, stiffness": (
        ("model.py", "local"),
        ("model.py", "forces"),
        ("model.py", "stiffness"),
        ("model.py", "expand"),
        ("banded.py", "matrix"),
        ("banded.py", "vector"),
        ("cavity.py", "gradient"),
        ("cavity.py", "hessian"),
    ),
    "factorisation and back substitution": (("banded.py", "solve"),),
    "counting negative pivots": (("banded.py", "negative_pivots"),),
    "contact: gaps and tractions": (
        ("contact.py", "touch"),
        ("contact.py", "linear"),
        ("contact.py", "hessian"),
        ("contact.py", "force"),
        ("contact.py", "footprint"),
    ),
    "stress maxima and events at each state": (("stress.py", "peak"), ("indent.py", "events")),
    "mesh and set-up": (("mesh.py", "dome"), ("model.py", "__init__"), ("stress.py", "__init__")),
}
"""Functions by file; none of one row calls one of another, so that times within them add up."""

CLOSING_IN = ("events.py", "_close_in")
"""Bisection of a jump; its time lies within the rows above."""


def shares(scenes: tuple[Scene, ...] = SCENES) -> dict[str, float]:
    """Share of the profiled time in each part; "locating a jump" counts over all parts."""
    profile = cProfile.Profile()
    for scene in scenes:
        profile.runcall(run, "solid default", scene)
    inside: dict[tuple[str, str], float] = {}
    stats = pstats.Stats(profile).stats  # type: ignore[attr-defined]
    for (file, _, name), (_, _, _, cumulative, _) in stats.items():
        if Path(file).parent.name == "solid":
            key = (Path(file).name, name)
            inside[key] = inside.get(key, 0.0) + cumulative
    total = pstats.Stats(profile).total_tt  # type: ignore[attr-defined]
    found = {part: sum(inside.get(key, 0.0) for key in keys) / total for part, keys in PARTS.items()}
    found["Newton control, line search, the rest"] = 1.0 - sum(found.values())
    return {**found, "locating a jump": inside.get(CLOSING_IN, 0.0) / total}
