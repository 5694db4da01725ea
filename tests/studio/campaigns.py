"""A small simulated campaign, and what the page sends of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pneutouch.catalogue import Library
from pneutouch.spec.options import SimulationOptions
from pneutouch.workflows.simulate import simulate

SMALL = SimulationOptions(
    specimens=1, driving_pressures_kPa=[0.0, 22.0], runs=1, kinds=["steps", "injection"], model="atlas", rest_s=5.0
)
NAME = "paper-dome-campaign"
SENSOR = "TangoPlus-1"
PLAIN = {"base": "paper-dome", "values": {}}
BASES = {"paper-dome": "paper-dome"}


def simulated(folder: Path, library: Library) -> Path:
    """One specimen at two driving pressures, with an injection."""
    return simulate("paper-dome", folder, None, SMALL, library)


def uploaded(folder: Path, *, within: str = NAME, only: tuple[str, ...] = ("*",)) -> dict[str, Any]:
    """Files of a folder, and the paths that the page gives them."""
    found = sorted(path for pattern in only for path in folder.rglob(pattern) if path.is_file())
    prefix = f"{within}/" if within else ""
    paths = [f"{prefix}{path.relative_to(folder).as_posix()}" for path in found]
    files = [{"name": f"run-{place}{path.suffix}", "path": str(path)} for place, path in enumerate(found)]
    return {"files": files, "paths": paths}


def silent(done: int, total: int, what: str | None = None) -> None:
    """Takes the progress of a job."""
