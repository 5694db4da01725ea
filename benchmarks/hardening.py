"""Bounds of every reader, and what fuzzing, mutation testing and the soak come to: ``python -m benchmarks.hardening``.

Writes docs/background/hardening.json from the constants of the code and from what the tests of the tests have stored
(``tests.mutants``, ``tests.fuzzing``).
"""

from __future__ import annotations

import json
import math
import tomllib
from typing import Any

from tests.mutants.__main__ import FOLDERS
from tests.mutants.sites import PARTS

from benchmarks.store import DOCS, store, stored
from pneutouch.bench.record import MOST_BLOCKS
from pneutouch.export import threemf_read as package
from pneutouch.export.voxels.png import MOST_PIXELS
from pneutouch.spec.files import MOST_BYTES
from pneutouch.spec.tasks import MOST_TASKS
from pneutouch.studio.guard import LARGEST_BODY, LARGEST_FILE
from pneutouch.tables import binary_tables
from pneutouch.tables.read import MOST_NUMBERS
from pneutouch.tables.text import LONGEST_LINE
from pneutouch.workflows.sweep.dataset import MOST_BYTES as MOST_DATASET
from pneutouch.workflows.sweep.journal import MOST_LINE

READ = DOCS.parents[1] / "tests" / "mutants" / "read.toml"


def bounds() -> list[tuple[str, str]]:
    """Every reader, and the greatest size that it takes, from the constants of the code."""
    mib, mb = 2**20, 1e6
    return [
        (
            "TOML: designs, targets, sweeps, trays, tasks, campaigns, profiles",
            f"{MOST_BYTES / mb:g} MB; keys of 32 parts; 20 problems reported",
        ),
        ("tasks as CSV", f"{MOST_BYTES / mb:g} MB, {MOST_TASKS} tasks"),
        (
            "measured run, text",
            f"any size, read in chunks; lines of {LONGEST_LINE} bytes; {MOST_BLOCKS} blocks in memory",
        ),
        (
            "measured run, parquet",
            f"{binary_tables.MOST_ROWS / mb:g} million rows, {binary_tables.MOST_UNPACKED // mib} MiB unpacked in a group of rows; {MOST_BLOCKS} blocks in memory",
        ),
        (
            "measured run, Excel",
            f"{binary_tables.UNPACKED / mb:g} MB unpacked, {binary_tables._PARTS} parts, {binary_tables._ROWS} rows of {binary_tables._COLUMNS} columns",
        ),
        ("measured run, TDMS", f"as many values as its bytes hold, {MOST_BLOCKS} blocks in memory"),
        (
            "a table in memory as a whole: tensile tests, injections, texture signals",
            f"{MOST_NUMBERS / mb:g} million numbers",
        ),
        (
            "3MF",
            f"{package.MOST_BYTES // mib} MiB in the file and inflated, {package.MOST_PARTS} parts, {package.MOST_COMPONENTS} components",
        ),
        ("voxel slice", f"100 MB, {MOST_PIXELS / mb:g} million pixels"),
        ("manifests and figures in output folders (JSON)", "100 MB"),
        ("dataset of a sweep", f"{MOST_DATASET // mib} MiB"),
        ("journal of a sweep", f"any size, in lines of at most {MOST_LINE // mib} MiB"),
        ("exported design, question of the page (JSON)", f"{LARGEST_BODY // 1024} KiB"),
        ("file given to the page", f"{LARGEST_FILE // mib} MiB, 256 MiB in all"),
    ]


def wilson(part: int, whole: int) -> tuple[float, float]:
    """The 95 % interval of a share (E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209, DOI 10.1080/01621459.1927.10502953)."""
    z, share = 1.959964, part / whole
    middle = share + z * z / (2 * whole)
    half = z * math.sqrt(share * (1 - share) / whole + z * z / (4 * whole**2))
    return (middle - half) / (1 + z * z / whole), (middle + half) / (1 + z * z / whole)


def share(part: int, whole: int) -> dict[str, float]:
    """A share with its 95 % interval."""
    low, high = wilson(part, whole)
    return {"share": part / whole, "low": low, "high": high}


def mutation() -> dict[str, Any]:
    """Counts of every draw, of the parts of the last one, and the share that is noticed today."""
    draws = [json.loads(path.read_text(encoding="utf-8")) for path in sorted(DOCS.glob("mutants-*.json"))]
    drawn = [row | {"seed": draw["seed"]} for draw in draws for row in draw["drawn"]]
    read = {(each["seed"], each["number"]): each for each in tomllib.loads(READ.read_text())["survivor"]}
    last = [row for row in drawn if row["seed"] == draws[-1]["seed"]]
    rows = []
    for draw in draws:
        counts = counted([row for row in drawn if row["seed"] == draw["seed"]], read)
        noticed, sound = counts["killed"] + counts["timed out"], counts["faults"] - counts["equivalent"]
        rows.append({"draw": draw["seed"], **counts, "noticed": share(noticed, sound)})
    every = counted(drawn, read)
    now = every["killed"] + every["timed out"] + every["test"]
    return {
        "sites": draws[-1]["sites"],
        "folders": len(FOLDERS.split()),
        "draws": rows,
        "parts": {part: counted([r for r in last if r["module"].startswith(f"{part}/")], read) for part in PARTS},
        "today": share(now, every["faults"] - every["equivalent"]),
    }


def counted(rows: list[Any], read: dict[Any, Any]) -> dict[str, int]:
    """Faults, those of each outcome, and the survivors of each verdict."""
    counts = {"faults": len(rows)}
    counts |= {each: sum(row["outcome"] == each for row in rows) for each in ("killed", "timed out", "survived")}
    verdicts = [read[row["seed"], row["number"]]["verdict"] for row in rows if row["outcome"] == "survived"]
    return counts | {each: verdicts.count(each) for each in ("equivalent", "test", "left")}


def fuzzed() -> dict[str, Any]:
    """Totals of the fuzzing, and the readers in which it found something."""
    rows = stored("fuzzing")
    totals = {key: sum(row[key] for row in rows.values()) for key in ("runs", "seconds", "kept", "kept_bytes")}
    found = {name: row["findings"] for name, row in rows.items() if row["findings"]}
    return {**totals, "readers": len(rows), "findings": found}


def reduced() -> dict[str, Any]:
    """What the page states."""
    return {"bounds": bounds(), "fuzzing": fuzzed(), "mutation": mutation()}


if __name__ == "__main__":
    store("hardening", reduced())
