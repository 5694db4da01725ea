"""Random damage to every kind of file and every command line: a clear end, never an internal fault.

10,000 cases, each within 1 GB of memory and 60 s of processor time. A case is made again from the seed and its number:
``python -m tests.stability.fuzz.run BASE REPORT SEED NUMBER NUMBER+1``.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys

import pytest

from tests.conftest import ROOT
from tests.stability.fuzz.base import make_base
from tests.stability.fuzz.cases import FILES, LINES
from tests.stability.fuzz.run import LEFT_OUT, SECONDS, cheap, options_of

SEED = 2026
CASES, PARTS = 10_000, 8


@pytest.fixture(scope="module")
def base(shared, built):
    return shared.folder("fuzz", lambda folder: make_base(folder, built("paper-dome")))


def outcomes(base, report, first, last):
    """The outcome of every case; a process that was killed failed at the case it was at, and the next one goes on."""
    environment = {**os.environ, "PYTHONPATH": f"{ROOT / 'generator'}{os.pathsep}{ROOT}", "OMP_NUM_THREADS": "1"}
    killed = []
    while first < last:
        words = [
            sys.executable,
            "-m",
            "tests.stability.fuzz.run",
            str(base),
            str(report),
            str(SEED),
            str(first),
            str(last),
        ]
        done = subprocess.run(words, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
        if done.returncode == 0:
            break
        at = int(report.with_name(f"{report.name}.at").read_text())
        why = signal.Signals(-done.returncode).name if done.returncode < 0 else done.stderr[-2000:]
        why = f"over {SECONDS} s of processor time" if why == "SIGXCPU" else why
        killed.append({"case": at, "fault": why, "seconds": None})
        first = at + 1
    return [*map(json.loads, report.read_text().splitlines()), *killed]


@pytest.mark.slow
@pytest.mark.parametrize("part", range(PARTS))
def test_no_damage_ends_in_an_internal_fault_or_takes_too_much(part, base, tmp_path):
    size = CASES // PARTS
    found = outcomes(base, tmp_path / "report", part * size, (part + 1) * size)
    assert len({case["case"] for case in found}) == size
    faults = [case for case in found if case["fault"]]
    assert not faults, "\n\n".join(f"case {case['case']}: {case['fault']}" for case in faults[:20])


def test_every_command_is_among_the_cases():
    # They run until they are stopped; what is sent to the studio: tests/studio/test_attacks.py, to live: tests/workflows/live.
    assert set(LINES) == set(options_of()) - {"studio", "live"}
    assert all(maker is not None for maker in FILES.values()) and len(FILES) >= 20


def test_what_is_left_out_is_there():
    with cheap(True):
        pass
    assert len(set(LEFT_OUT)) == len(LEFT_OUT)
