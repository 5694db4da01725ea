"""A small plan, its undisturbed dataset, and a real cluster of three processes."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from dataclasses import dataclass

import pytest
import xarray

from pneutouch.errors import ComputationError
from pneutouch.spec.read import parse_changes
from pneutouch.workflows.sweep import plan_of_flags, sweep, work
from pneutouch.workflows.sweep.run import ComputeResources

OVER = [
    "membrane.material=TangoPlus,FLX9950",
    "membrane.wall_thickness_mm=0.50:0.88:160",
    "pneumatics.driving_pressures_kPa=5,22",
]
WORDS = ["--design", "paper-dome", *(word for over in OVER for word in ("--over", over)), "--model", "membrane"]
POINTS, CHUNKS = 320, 10
"""About two seconds of one core; the thinnest walls in TangoPlus are refused at 22 kPa."""


ALONE = ComputeResources(workers=1)


def load(path) -> xarray.Dataset:
    return xarray.load_dataset(path, engine="scipy")


def small(over=(), *, design="paper-dome", settings=(), **options):
    return plan_of_flags(
        design,
        list(over) or ["membrane.wall_thickness_mm=0.5,0.9,1.5"],
        parse_changes(settings),
        **{"model": "membrane", **options},
    )


def journal_lines(out) -> int:
    path = out.with_name(f"{out.name}.parts") / "journal"
    return path.read_bytes().count(b"\n") if path.exists() else 0


def _listening():
    """A shell's background jobs ignore Ctrl-C, and so would all that they start."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def started(out, *words, group=False):
    """The command line as a process, returned as soon as it has kept its first chunk."""
    process = subprocess.Popen(
        [sys.executable, "-m", "pneutouch", "sweep", *WORDS, "--out", str(out), *words],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=group,
        preexec_fn=_listening,
    )  # fmt: skip
    before, deadline = journal_lines(out), time.monotonic() + 60
    while journal_lines(out) <= before and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.01)
    return process


def ended(process):
    """Exit code, stdout and stderr."""
    stdout, stderr = process.communicate(timeout=60)
    return process.returncode, stdout, stderr


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def stopped(out, library, after, **options):
    """A sweep of six points in chunks of one, stopped by the user after some."""

    def stop(done, total):
        if done == after:
            raise KeyboardInterrupt

    with pytest.raises(ComputationError, match=f"{after} of 6 points are done"):
        sweep(six(**options), out, ALONE, library=library, progress=stop)


def six(**options):
    return small(["membrane.wall_thickness_mm=1.0:1.5:6"], settings=["pneumatics.driving_pressures_kPa=[5]"], **options)


@pytest.fixture
def single(monkeypatch):
    monkeypatch.setattr(work, "CHUNK_POINTS", {"membrane": 1})


@pytest.fixture(scope="session")
def undisturbed(library, tmp_path_factory) -> bytes:
    """The file of the sweep of ``WORDS``, computed in this process in one go."""
    out = tmp_path_factory.mktemp("undisturbed") / "sweep.nc"
    plan = plan_of_flags("paper-dome", OVER, model="membrane")
    sweep(plan, out, ComputeResources(workers=1), library=library)
    return out.read_bytes()


@dataclass
class Cluster:
    address: str
    scheduler: subprocess.Popen[bytes]
    workers: list[subprocess.Popen[bytes]]


@pytest.fixture
def cluster(tmp_path):
    """A scheduler and two workers, each a process of its own, in a folder that holds no designs."""
    folder, quiet = (
        tmp_path / "cluster",
        {**os.environ, "OMP_NUM_THREADS": "1", "DASK_DISTRIBUTED__LOGGING__DISTRIBUTED": "error"},
    )
    folder.mkdir()
    options = {"cwd": folder, "env": quiet, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}

    def dask(*words):
        return subprocess.Popen([sys.executable, "-m", "dask", *words], **options)

    scheduler = dask(
        "scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--scheduler-file", "scheduler.json"
    )
    workers = [
        dask("worker", "--scheduler-file", "scheduler.json", "--nthreads", "1", "--no-nanny", "--no-dashboard")
        for _ in range(2)
    ]
    try:
        deadline = time.monotonic() + 30
        while time.monotonic() < deadline:
            try:
                address = json.loads((folder / "scheduler.json").read_text())["address"]
                break
            except (OSError, ValueError):
                time.sleep(0.05)
        yield Cluster(address, scheduler, workers)
    finally:
        for process in (*workers, scheduler):
            process.kill()
            process.wait()
