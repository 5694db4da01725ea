"""What the largest input of each reader takes: ``python -m tests.fuzzing.largest [READER ...]``.

Peak memory is that of a new process, above what it has after a small input. Processor time is stated over that of ``json.loads`` for as
many bytes as the input has unpacked, in the same run: a list of numbers, 20 MB. Stores both in docs/background/largest-inputs.json.
"""

from __future__ import annotations

import json
import sys
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any, NamedTuple

from tests.fuzzing import largest_files as files
from tests.fuzzing.judge import forget_peak, peak
from tests.fuzzing.seeds import seeds
from tests.fuzzing.targets import TARGETS

STORED = Path(__file__).resolve().parents[2] / "docs" / "background" / "largest-inputs.json"


class Case(NamedTuple):
    """An input of a target of the fuzzing: how its file is written, and what it is."""

    target: str
    write: Callable[[Path], None]
    words: str
    unpacked: float | None = None
    """Bytes, where the file is compressed."""


CASES: dict[str, list[Case]] = {
    "TOML": [
        Case("design", files.toml_numbers, "numbers in one list"),
        Case("design", files.toml_keys, "unknown keys"),
        Case("campaign", files.toml_runs, "runs"),
    ],
    "tasks as CSV": [Case("tasks-csv", files.task_rows, "tasks")],
    "measured run, text": [Case("run-csv", files.run_rows, "a run; any size is read in chunks")],
    "measured run, parquet": [Case("run-parquet", files.parquet, "a run in one group of rows", files.PARQUET)],
    "measured run, Excel": [Case("run-xlsx", files.workbook, "a run in one sheet", files.WORKBOOK)],
    "measured run, TDMS": [Case("run-tdms", files.tdms, "a run; any size is read in chunks")],
    "3MF": [Case("threemf", files.model, "triangles", files.MODEL)],
    "voxel slice": [Case("slice", files.pixels, "pixels of one colour", files.MOST_PIXELS)],
    "manifests and figures (JSON)": [Case("leak", files.empty_lists, "empty lists")],
    "dataset of a sweep": [Case("dataset", files.dataset, "a twentieth of the largest")],
    "journal of a sweep": [Case("journal", files.journal, "64 MB; any size is read in lines")],
    "exported design (JSON)": [Case("exported", files.exported, "values")],
    "question of the page (JSON)": [Case("question", files.question, "values")],
}


def measured(case: Case, folder: Path) -> dict[str, Any]:
    """Bytes of the file, peak memory in MiB, processor time in s and refusal, of a process that has read a small one before."""
    target = TARGETS[case.target]
    path = folder / target.name
    case.write(path)
    small = folder / "small" / target.name
    small.parent.mkdir()
    small.write_bytes(target.written(seeds(case.target)[0]))
    # A new process: memory that another one has freed, or left in pieces, would change the peak.
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        pool.submit(_read, case.target, small).result()
        found = pool.submit(_read, case.target, path).result()
    return found | {"bytes": path.stat().st_size}


def _read(name: str, path: Path) -> dict[str, Any]:
    target = TARGETS[name]
    forget_peak()
    before, start, refusal = peak(), time.process_time(), ""
    try:
        target.read(path)
    except target.allowed as error:
        refusal = str(error)
    return {"mebibytes": peak() - before, "seconds": time.process_time() - start, "refusal": refusal}


def json_seconds() -> float:
    """Processor time of ``json.loads`` for a byte of a list of numbers, the least of three."""
    text = json.dumps([k / 7 for k in range(1_000_000)])
    times = []
    for _ in range(3):
        start = time.process_time()
        json.loads(text)
        times.append(time.process_time() - start)
    return min(times) / len(text)


def main(names: list[str]) -> None:
    plain = json_seconds()
    known = json.loads(STORED.read_text()) if STORED.is_file() else []
    rows = {(row["reader"], row["input"]): row for row in known}
    for name in names or CASES:
        for case in CASES[name]:
            with tempfile.TemporaryDirectory() as folder:
                found = measured(case, Path(folder))
            print(name, case.words, found, flush=True)
            unpacked = case.unpacked or found["bytes"]
            rows[name, case.words] = {
                "reader": name,
                "input": case.words,
                "outcome": "refused" if found["refusal"] else "read",
                "bytes": found["bytes"],
                "unpacked_bytes": int(unpacked),
                "mebibytes": round(found["mebibytes"], 1),
                "time_over_json": float(f"{found['seconds'] / (plain * unpacked):.2g}"),
            }
    order = [(name, case.words) for name in CASES for case in CASES[name]]
    kept = [rows[key] for key in order if key in rows]
    STORED.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
