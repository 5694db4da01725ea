"""The processes that atheris drives: one for each target, forked from one that has imported and instrumented everything."""

from __future__ import annotations

import hashlib
import json
import mmap
import os
import random
import struct
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import atheris

from tests.fuzzing.place import ROOT
from tests.stability.fuzz.mutate import damaged_csv, damaged_toml

if TYPE_CHECKING:
    from tests.fuzzing.judge import Finding
    from tests.fuzzing.targets import Target

    Judge = Callable[[Target, bytes, Path], Finding | None]

WATCHED = ["pneutouch", "tomllib", "nptdms"]
"""Packages whose branches are counted."""

COMPUTING = ("mechanics", "meridian", "body", "parts", "printability", "selection", "report", "evaluation")
"""Parts of ours that are left out: what computes and draws, and reads nothing."""

DAMAGED = {".toml": damaged_toml, ".json": damaged_toml, ".csv": damaged_csv}
"""Faults on purpose besides changed bytes, by the ending of a target's file."""

LARGEST, SLOWEST = 4096, 600
"""Bytes of an input where no seed is larger, and seconds of the clock after which libFuzzer ends a process."""
MOST_ENDED = 20
"""Processes of a target that ended before their time, after which it is left."""


def left_out() -> list[str]:
    """Names of the modules of `COMPUTING`: atheris takes each by its full name."""
    package = ROOT / "generator" / "pneutouch"
    paths = [path for name in COMPUTING for path in (package / name).rglob("*.py")]
    files = [path.relative_to(package).with_suffix("").parts for path in paths]
    folders = {path.parent.relative_to(package).parts for path in paths}
    return [".".join(("pneutouch", *parts)) for parts in (*files, *folders)]


def main(shares: dict[str, float], jobs: int, folder: Path) -> None:
    """Fuzz each target for its processor time in seconds, in ``folder``/TARGET, so many targets at once."""
    with atheris.instrument_imports(include=WATCHED, exclude=left_out()):
        from tests.fuzzing.judge import judge
        from tests.fuzzing.seeds import seeds
        from tests.fuzzing.targets import TARGETS

        scratch = Path(tempfile.mkdtemp(dir=folder))
        for name in shares:
            corpus = folder / name / "corpus"
            corpus.mkdir(parents=True, exist_ok=True)
            for seed in seeds(name):
                (corpus / hashlib.sha256(seed).hexdigest()[:16]).write_bytes(seed)
                # A reader imports what it needs when it is first called.
                judge(TARGETS[name], seed, scratch)
    queue, running = list(shares.items()), 0
    while queue or running:
        if queue and running < jobs:
            name, seconds = queue.pop(0)
            running += 1
            if os.fork() == 0:
                _until(seconds, lambda left, runs: _fuzz(name, TARGETS[name], judge, left, runs), folder / name)  # noqa: B023
                os._exit(0)
        else:
            os.wait()
            running -= 1


def _until(seconds: float, fuzz: Callable[[float, mmap.mmap], None], folder: Path) -> None:
    """Fuzz in further processes for as long as one ends before its time, as by a fault of a compiled library.

    What was counted before in the folder is added to.
    """
    os.chdir(folder)
    stated, counter, used, ended = Path("count.json"), mmap.mmap(-1, 8), 0.0, 0
    before = json.loads(stated.read_text()) if stated.is_file() else {"runs": 0, "seconds": 0.0, "ended": 0}
    while used < seconds and ended <= MOST_ENDED:
        if (child := os.fork()) == 0:
            log = os.open("log", os.O_WRONLY | os.O_CREAT | os.O_APPEND)
            for stream in (1, 2):
                os.dup2(log, stream)
            fuzz(seconds - used, counter)
        _, status, usage = os.wait4(child, 0)
        used += usage.ru_utime + usage.ru_stime
        ended += status != 0
        now = {"runs": struct.unpack("q", counter[:])[0], "seconds": used, "ended": ended}
        stated.write_text(json.dumps({key: round(before[key] + now[key], 1) for key in now}))


def _fuzz(name: str, target: Target, judge: Judge, seconds: float, counter: mmap.mmap) -> None:
    found, start, place = set[str](), time.process_time(), Path(tempfile.mkdtemp())
    damaged = DAMAGED.get(Path(target.name).suffix)

    def one(content: bytes) -> None:
        counter[:] = struct.pack("q", struct.unpack("q", counter[:])[0] + 1)
        finding = judge(target, content, place)
        if finding is not None and finding.where not in found:
            found.add(finding.where)
            label = f"finding-{hashlib.sha256(content).hexdigest()[:16]}"
            Path(label).write_bytes(content)
            line = {"target": name, "where": finding.where, "words": finding.words, "input": label}
            with Path("findings.jsonl").open("a") as file:
                file.write(json.dumps(line) + "\n")
        if time.process_time() - start > seconds:
            os._exit(0)

    def mutate(content: bytes, most: int, seed: int) -> bytes:
        rng = random.Random(seed)
        if damaged is None or rng.random() < 0.5:
            return bytes(atheris.Mutate(content, most))
        return damaged(content.decode("utf-8", "replace"), rng)[:most] or b"x"

    largest = max(LARGEST, *(path.stat().st_size for path in Path("corpus").iterdir()))
    options = [f"-max_len={largest}", f"-timeout={SLOWEST}", "-rss_limit_mb=3000", "-artifact_prefix=./", "corpus"]
    atheris.Setup([sys.argv[0], *options], one, custom_mutator=mutate)
    atheris.Fuzz()


if __name__ == "__main__":
    main(json.loads(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3]).resolve())
