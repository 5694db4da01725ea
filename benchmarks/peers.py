"""The same inflation sweep by other programs where they are installed: error in limit pressure beside processor time.

Each run is a process of its own, measured whole (start, imports, everything) and for its solve alone:
``python -m benchmarks.peers NAME CELLS_ALONG CELLS_ACROSS COUNT`` is such a process.
"""

from __future__ import annotations

import json
import os
import resource
import shutil
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.scenes import PAPER

OURS = "pneutouch"
MESHES: dict[str, tuple[tuple[int, int], ...]] = {
    OURS: ((4, 1), (8, 1), (12, 1), (24, 2), (48, 4)),
    "FElupe Q2/P1": ((3, 1), (4, 1), (8, 1), (24, 2), (48, 4)),
    "FElupe Q1 mean dilatation": ((12, 2), (24, 2), (48, 4)),
    "CalculiX CAX8R": ((6, 1), (12, 1), (24, 2), (48, 4)),
}
WITHIN = 0.005
"""The error in limit pressure at which costs are compared."""

_RUNS = 3


def missing() -> dict[str, str]:
    """Peers that cannot be run here, and why."""
    absent = {} if find_spec("felupe") else {name: "FElupe is not installed" for name in MESHES if "FElupe" in name}
    return absent | ({} if shutil.which("ccx") else {"CalculiX CAX8R": "CalculiX (ccx) is not on the PATH"})


def solve(name: str, arc: int, through: int, count: int = 0) -> tuple[float, int]:
    """Limit pressure (MPa) of the paper's sensor in TangoPlus, and the states or steps on the way."""
    if name != OURS:
        from benchmarks.felupe_sweep import felupe_limit

        return felupe_limit(PAPER, arc, through, name == "FElupe Q2/P1", count or None)
    from pneutouch.mechanics.solid.inflate import inflate
    from pneutouch.mechanics.solid.mesh import dome
    from pneutouch.mechanics.solid.model import SolidModel

    mesh = dome(PAPER.dome.shape, arc=arc, through=through)
    run = inflate(SolidModel(mesh, PAPER.wall.hyperelastic), past_limit=1.0)
    return (np.nan if run.limit is None else run.limit.pressure), len(run.states)


def _preload(name: str) -> None:
    """Import what the solve needs, so that it can be timed alone."""
    ours = ("pneutouch.mechanics.solid.inflate", "pneutouch.mechanics.solid.mesh", "numpy.polynomial")
    for module in ours if name == OURS else ("felupe", "benchmarks.felupe_sweep"):
        import_module(module)


def child(name: str, arc: int, through: int, count: int) -> None:
    """What a measured process does."""
    _preload(name)
    start = time.process_time()
    found, steps = solve(name, arc, through, count)
    print(json.dumps({"limit": found, "steps": steps, "solve": time.process_time() - start}))


def _process(name: str, arc: int, through: int, count: int) -> dict[str, Any]:
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(
        [sys.executable, "-m", "benchmarks.peers", name, str(arc), str(through), str(count)],
        env=os.environ | {"OMP_NUM_THREADS": "1"},
        cwd=Path(__file__).parents[1],
        capture_output=True,
        text=True,
        check=True,
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    whole = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return {**json.loads(done.stdout), "whole": whole}


def _run(name: str, arc: int, through: int, count: int) -> dict[str, Any]:
    if "CalculiX" not in name:
        return _process(name, arc, through, count)
    from benchmarks.calculix_sweep import calculix_limit

    found, steps, whole, alone = calculix_limit(PAPER, arc, through)
    return {"limit": found, "steps": steps, "solve": alone, "whole": whole}


def measure(truth: float) -> dict[str, Any]:
    """Every installed program on its meshes against a reference limit pressure (MPa); medians of runs in turn."""
    absent = missing()
    cases = [(name, arc, through) for name, meshes in MESHES.items() if name not in absent for arc, through in meshes]
    # The number of steps that FElupe's Newton follows is found beforehand: trying is not charged to it.
    counts = {case: solve(*case)[1] if "FElupe" in case[0] else 0 for case in cases}
    runs: dict[tuple[str, int, int], list[dict[str, Any]]] = {case: [] for case in cases}
    for _ in range(_RUNS):
        for case in cases:
            runs[case].append(_run(*case, counts[case]))
    rows = [
        {
            "program": case[0],
            "cells_along": case[1],
            "cells_across": case[2],
            "steps": found[0]["steps"],
            "limit_pressure_kPa": 1e3 * found[0]["limit"],
            "limit_error": found[0]["limit"] / truth - 1,
            "solve_s": statistics.median(r["solve"] for r in found),
            "whole_s": statistics.median(r["whole"] for r in found),
        }
        for case, found in runs.items()
    ]
    return {"reference_limit_kPa": 1e3 * truth, "missing": absent, "rows": rows}


def cheapest(rows: list[dict[str, Any]], program: str, key: str, within: float = WITHIN) -> dict[str, Any] | None:
    """The cheapest run of a program that is within an error."""
    good = [r for r in rows if r["program"].startswith(program) and abs(r["limit_error"]) <= within]
    key_of: Callable[[dict[str, Any]], float] = lambda r: r[key]  # noqa: E731
    return min(good, key=key_of, default=None)


if __name__ == "__main__":
    child(sys.argv[1], *(int(word) for word in sys.argv[2:5]))  # type: ignore[call-arg]
