"""Fuzz readers by the branches that their inputs reach, then put the inputs that reach new code into the corpus."""

from __future__ import annotations

import argparse
import importlib.util
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from tests.fuzzing.corpus import CORPUS
from tests.fuzzing.keep import keep
from tests.fuzzing.place import ROOT
from tests.fuzzing.targets import TARGETS

RESULTS = ROOT / "docs" / "background" / "fuzzing.json"
NESTED = (
    *("run-csv", "run-xlsx", "run-parquet", "run-tdms", "threemf", "recipe", "dataset", "journal", "slice", "stack"),
    *("prediction", "figures"),
)
"""Binary and nested formats: each has three times the processor time of another."""

STATE = r"(\w+) +cov: (\d+) ft: (\d+) "
"""A line of libFuzzer: what happened, edges and features."""

MISSING = """atheris is not installed. It has wheels for Linux, and none for every Python that pneutouch runs on:
install it into an environment of its own that has the development dependencies, pip install atheris==3.0.0"""


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.fuzzing", description=__doc__)
    known = ", ".join(TARGETS)
    parser.add_argument("targets", nargs="*", metavar="TARGET", help=f"one of {known}; all where none is given")
    parser.add_argument("--seconds", type=float, default=3600.0, help="processor time of all targets together")
    parser.add_argument("--jobs", type=int, default=1, help="targets at once")
    parser.add_argument("--folder", type=Path, help="where the inputs are; one that is there is gone on with")
    words = "put the inputs of --folder into the corpus, and the counts into docs/background/fuzzing.json"
    parser.add_argument("--keep", action="store_true", help=words)
    given = parser.parse_args()
    names = given.targets or list(TARGETS)
    if unknown := [name for name in names if name not in TARGETS]:
        parser.error(f"unknown target {unknown[0]}; known: {known}")
    if given.keep and given.folder is None:
        parser.error("--keep needs the --folder that the fuzzing printed")
    folder = given.folder or Path(tempfile.mkdtemp(prefix="pneutouch-fuzzing-"))
    if given.keep:
        return _keep(names, folder)
    if importlib.util.find_spec("atheris") is None:
        parser.error(MISSING)
    for name in names:
        (folder / name / "corpus").mkdir(parents=True, exist_ok=True)
        for kept in (CORPUS / name).glob("*"):
            (folder / name / "corpus" / kept.name).write_bytes(kept.read_bytes())
    command = [sys.executable, "-m", "tests.fuzzing.child", json.dumps(shares(names, given.seconds))]
    subprocess.run([*command, str(given.jobs), str(folder)], check=True)
    rows = {name: counts(folder / name) for name in names}
    for name, row in rows.items():
        print(name, json.dumps(row))  # noqa: T201
    print(f"inputs and findings: {folder}\nnext: python -m tests.fuzzing --keep --folder {folder}")  # noqa: T201
    return 1 if any(row["findings"] for row in rows.values()) else 0


def shares(names: list[str], seconds: float) -> dict[str, float]:
    """Processor time of each target, the longest first, so that two at once end together."""
    weights = {name: 3.0 if name in NESTED else 1.0 for name in names}
    parts = {name: seconds * weight / sum(weights.values()) for name, weight in weights.items()}
    return dict(sorted(parts.items(), key=lambda item: -item[1]))


def counts(folder: Path) -> dict[str, object]:
    """Runs, seconds, edges and features (first and last) and findings of the target that was fuzzed in ``folder``."""
    log = (folder / "log").read_text(errors="replace") if (folder / "log").is_file() else ""
    states = [(kind, (int(edges), int(features))) for kind, edges, features in re.findall(STATE, log)]
    # While it reads the first inputs, libFuzzer reports those that reach more than the ones before.
    first = next((state for kind, state in states if kind == "INITED"), (0, 0))
    last = max((state for _, state in states), default=(0, 0))
    stated = folder / "count.json"
    run = json.loads(stated.read_text()) if stated.is_file() else {"runs": 0, "seconds": 0.0, "ended": 0}
    lines = folder / "findings.jsonl"
    found = [json.loads(line) for line in lines.read_text().splitlines()] if lines.is_file() else []
    ended = [path.name for kind in ("crash", "timeout", "oom") for path in sorted(folder.glob(f"{kind}-*"))]
    findings = [f"{each['where']}: {each['words']}" for each in found] + ended
    return run | {"edges": [first[0], last[0]], "features": [first[1], last[1]], "findings": findings}


def _keep(names: list[str], folder: Path) -> int:
    stored = json.loads(RESULTS.read_text()) if RESULTS.is_file() else {}
    for name in names:
        row = counts(folder / name)
        if not row["runs"]:
            continue
        files = list((folder / name / "corpus").glob("*"))
        kept = keep(name, [path.read_bytes() for path in files])
        row["findings"] = len(row["findings"])  # type: ignore[arg-type]
        stored[name] = row | {"corpus": len(files), "kept": len(kept), "kept_bytes": sum(map(len, kept))}
        print(f"{name}: {len(kept)} of {len(files)} inputs kept")  # noqa: T201
        text = json.dumps({each: stored[each] for each in TARGETS if each in stored}, indent=1)
        RESULTS.write_text(text + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
