"""What the command line computes, as plain documents, and where those of the reference state are stored.

``PYTHONPATH=<reference>/generator python -m tests.figures.store [GROUP ...]`` writes the store anew; do so only where figures change on purpose.
"""

from __future__ import annotations

import csv
import json
import lzma
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Callable, Iterator, Sequence
from math import fsum
from pathlib import Path
from typing import Any

from tests.figures.compare import plain
from tests.running import in_new_process

ROOT = Path(__file__).resolve().parents[2]
STORE = Path(__file__).with_name("before.json.xz")
EXAMPLES = ROOT / "docs" / "examples"
Runner = Callable[[Sequence[str], Path], "subprocess.CompletedProcess[str]"]

# The commands of one group run one after another in one empty folder.
EVERYDAY = {
    "predict paper-dome": ("predict paper-dome",),
    "predict fingertip-dome by atlas": ("predict fingertip-dome --model atlas",),
    "select by flags": ("select --sensitivity 1.9 --at 12 --force-range 15 --max-diameter 25",),
}
DESIGNS = ("agilus-dome", "fingertip-dome", "graded-dome", "long-tube", "paper-dome", "soft-pad", "stiff-dome")
MODELS = ("solid", "atlas", "membrane", "membrane --closure printed", "auto --tolerance 2%")
SLOW = {
    **{f"predict {name}": tuple(f"predict {name} --model {model}" for model in MODELS) for name in DESIGNS},
    "predict with options": (
        "predict paper-dome --aged --monte-carlo 1000",
        "predict soft-pad --clamp flange",
        "predict long-tube --set membrane.wall_thickness_mm=1.2 --set pneumatics.driving_pressures_kPa=[0,7.5]",
    ),
    "select by mix": (
        "select --sensitivity 1.8 --at 12 --inner-radius 9.25 --wall 1.5 --base paper-dome --profile j735 --mix TangoPlus+VeroClear",
    ),
    "select by file": ("select fingertip.toml --tunability 5 --write chosen", "check chosen"),
    "tray": ("tray paper-dome --over membrane.material=TangoPlus,FLX9960 --copies 3", "tray seven-resins.toml"),
    "coupons": ("coupons", "coupons --profile j735 --material Agilus30 --only puck,dumbbell"),
    "scan": ("scan texture-specimen --design paper-dome",),
    "plan": ("plan paper-dome",),
    "campaign": (
        "simulate paper-dome --pressures 0,22 --kinds steps,loop,relaxation,injection --rest 10 --runs 2 --specimens 1",
        "characterize outputs/paper-dome-campaign",
        "calibrate outputs/paper-dome-campaign --hold-out 22",
    ),
    "sweep": (
        "sweep wall-and-resin.toml --workers 1",
        "sweep --design paper-dome --over membrane.wall_thickness_mm=1.2:1.8:3 --workers 1 --out walls.nc",
    ),
    "check": tuple(f"check {name}" for name in DESIGNS),
    "list": ("list",),
    "build paper-dome": ("build paper-dome", "show outputs/paper-dome/paper-dome.3mf"),
    "build texture-specimen": ("build texture-specimen",),
    "cast-dome": (*(f"predict cast-dome --model {model}" for model in MODELS), "check cast-dome", "build cast-dome"),
}
SLOW["predict paper-dome"] = SLOW["predict paper-dome"][1:]
GROUPS = EVERYDAY | {(f"{name}, other models" if name in EVERYDAY else name): runs for name, runs in SLOW.items()}
ROWS = 100  # kept of a long table, evenly; sums stand for the others


def by_itself(words: Sequence[str], folder: Path) -> subprocess.CompletedProcess[str]:
    """Run ``pneutouch WORDS`` as a process, with one thread: the order of the sums of a threaded matrix product is not fixed."""
    environment = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    return in_new_process(words, folder, environment)


def collect(group: str, run_in: Runner = by_itself) -> dict[str, Any]:
    """One document a command of the group: exit code, its JSON and the numbers of every file that it wrote."""
    documents: dict[str, Any] = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for example in EXAMPLES.glob("*.toml"):
            shutil.copy(example, folder)
        for run in GROUPS[group]:
            before = set(folder.rglob("*"))
            done = run_in([*run.split(), "--json"], folder)
            written = {path.relative_to(folder).as_posix(): read(path) for path in written_since(before, folder)}
            documents[run] = {"exit": done.returncode, "json": parsed(done), "files": written}
    return documents


def written_since(before: set[Path], folder: Path) -> Iterator[Path]:
    return (path for path in sorted(folder.rglob("*")) if path not in before and path.is_file())


def parsed(done: subprocess.CompletedProcess[str]) -> Any:
    return json.loads(done.stdout) if done.stdout else {"stderr": done.stderr}


def read(path: Path) -> Any:
    """The numbers of a file; nothing of drawings, sheets and containers, whose figures stand in the other files."""
    readers = {".json": read_json, ".toml": read_toml, ".csv": read_csv, ".stl": read_stl, ".nc": read_dataset}
    return readers[path.suffix](path) if path.suffix in readers else None


def read_json(path: Path) -> Any:
    return json.loads(path.read_text())


def read_toml(path: Path) -> Any:
    return json.loads(json.dumps(tomllib.loads(path.read_text()), default=str))


def read_csv(path: Path) -> dict[str, Any]:
    """Columns by name, every n-th row of long ones, and the sum of every column of numbers."""
    rows = list(csv.reader(line for line in path.read_text().splitlines() if not line.startswith("#")))
    columns = {name: [number(cell) for cell in cells] for name, *cells in zip(*rows, strict=True)}
    step = -(-len(rows) // ROWS)
    sums = {name: fsum(cells) for name, cells in columns.items() if all(isinstance(cell, float) for cell in cells)}
    return {"rows": len(rows), "sums": sums, "columns": {name: cells[::step] for name, cells in columns.items()}}


def number(cell: str) -> float | str:
    try:
        return float(cell)
    except ValueError:
        return cell


def read_stl(path: Path) -> dict[str, Any]:
    """Triangles, bounds (mm), volume (mm3) and area (mm2) of a binary STL file."""
    import numpy as np

    kind = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    corners = np.frombuffer(path.read_bytes()[84:], kind)["corners"].astype(float)
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return {
        "triangles": len(corners),
        "bounds_mm": [corners.min((0, 1)).tolist(), corners.max((0, 1)).tolist()],
        "volume_mm3": fsum((corners[:, 0] * across).sum(1)) / 6,
        "area_mm2": fsum(np.linalg.norm(across, axis=1)) / 2,
    }


def read_dataset(path: Path) -> dict[str, Any]:
    import xarray

    with xarray.open_dataset(path) as dataset:
        variables = {str(name): values.values.tolist() for name, values in dataset.variables.items()}
        return {
            "sizes": {str(k): n for k, n in dataset.sizes.items()},
            "attributes": dict(dataset.attrs),
            "variables": variables,
        }


def stored() -> dict[str, Any]:
    """Documents of the reference state, by group and command."""
    documents: dict[str, Any] = json.loads(lzma.decompress(STORE.read_bytes()))
    return documents


def main(groups: list[str]) -> None:
    """Store the groups named anew, or all."""
    documents = stored() if groups else {}
    for group in groups or GROUPS:
        documents[group] = plain(collect(group))
        sys.stdout.write(f"{group}: {[document['exit'] for document in documents[group].values()]}\n")
    text = json.dumps(documents, sort_keys=True, separators=(",", ":"))
    STORE.write_bytes(lzma.compress(text.encode(), preset=9 | lzma.PRESET_EXTREME))


if __name__ == "__main__":
    main(sys.argv[1:])
