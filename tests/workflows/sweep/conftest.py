"""A small plan, its undisturbed dataset, and a real cluster of three processes."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import threading
from dataclasses import dataclass

import pytest
import xarray
from distributed import Client

from pneutouch.spec.read import parse_changes
from pneutouch.workflows.sweep import plan_of_flags, sweep, work
from pneutouch.workflows.sweep.execute import ComputeResources
from tests.running import in_process

OVER = [
    "membrane.material=TangoPlus,FLX9950",
    "membrane.wall_thickness_mm=0.50:0.88:160",
    "pneumatics.driving_pressures_kPa=5,22",
]
WORDS = ["--design", "paper-dome", *(word for over in OVER for word in ("--over", over)), "--model", "membrane"]
POINTS = 320
"""About two seconds of one core in ten chunks; the thinnest walls in TangoPlus are refused at 22 kPa."""


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


PATIENCE = 600
"""Seconds to wait for what is there and comes: a loaded machine may be slow, a test must not fail by it."""

HELD = """
import os, sys
from pneutouch.cli import run
from pneutouch.workflows.sweep import workers
from pneutouch.workflows.sweep.journal import Journal
workers._PATIENCE = {patience}
keep, left = Journal.append, iter([*[False] * ({after} - 1), True])
def append(self, records):
    place = keep(self, records)
    if next(left, False):
        os.write({pipe}, b"held")
        sys.stdin.read()
    return place
Journal.append = append
sys.argv = {words!r}
run()
"""


def held(out, *words, after=1, group=False):
    """The command line as a process that stands still when it has kept ``after`` chunks, until its stdin is closed."""
    reading, pipe = os.pipe()
    command = ["pneutouch", "sweep", *WORDS, "--out", str(out), *words]
    code = HELD.format(after=after, pipe=pipe, patience=PATIENCE, words=command)
    process = subprocess.Popen(
        [sys.executable, "-c", code],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        pass_fds=[pipe],
        start_new_session=group,
        preexec_fn=_listening,
    )
    os.close(pipe)
    with os.fdopen(reading, "rb") as stream:
        assert stream.read(4) == b"held", ended(process)
    return process


def ended(process):
    """Exit code, stdout and stderr."""
    stdout, stderr = process.communicate()
    return process.returncode, stdout, stderr


def resumed(out):
    """What the command line says when it is called again for ``out``."""
    return in_process(["sweep", *WORDS, "--out", str(out), "--workers", "1", "--json"], out.parent)


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def stopped(out, library, after, **options):
    """A sweep of six points in chunks of one, stopped by the user after some."""

    def stop(done, total):
        if done == after:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as caught:
        sweep(six(**options), out, ALONE, library=library, progress=stop)
    assert caught.value.__notes__[0].startswith(f"{after} of 6 points are done and kept in ")


def six(**options):
    return small(["membrane.wall_thickness_mm=1.0:1.5:6"], settings=["pneumatics.driving_pressures_kPa=[5]"], **options)


@pytest.fixture
def single(monkeypatch):
    monkeypatch.setattr(work, "CHUNK_POINTS", {"membrane": 1})


@pytest.fixture(scope="session")
def undisturbed(library, shared) -> bytes:
    """The file of the sweep of ``WORDS``, computed in one go."""

    def fill(folder):
        sweep(plan_of_flags("paper-dome", OVER, model="membrane"), folder / "sweep.nc", ALONE, library=library)

    return (shared.folder("undisturbed-sweep", fill) / "sweep.nc").read_bytes()


@dataclass
class Cluster:
    address: str
    scheduler: subprocess.Popen[bytes]
    workers: list[subprocess.Popen[bytes]]


@pytest.fixture
def cluster(tmp_path, monkeypatch):
    """A scheduler and two workers, each a process of its own, in a folder that holds no designs."""
    folder, quiet = (
        tmp_path / "cluster",
        {**os.environ, "OMP_NUM_THREADS": "1", "DASK_DISTRIBUTED__LOGGING__DISTRIBUTED": "info"},
    )
    folder.mkdir()
    options = {"cwd": folder, "env": quiet, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}

    def dask(*words, **more):
        return subprocess.Popen([sys.executable, "-m", "dask", *words], **{**options, **more})

    scheduler = dask(
        "scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard", stderr=subprocess.PIPE, text=True
    )
    workers = []
    try:
        # Closed after the line that names the address, the pipe would break the scheduler.
        address = next(found[0] for line in scheduler.stderr if (found := re.findall(r"Scheduler at: +(tcp\S+)", line)))
        drain = threading.Thread(target=scheduler.stderr.read)
        drain.start()
        words = ("worker", address, "--nthreads", "1", "--no-nanny", "--no-dashboard")
        workers += [dask(*words), dask(*words)]
        with Client(address, timeout=PATIENCE, set_as_default=False) as client:
            client.wait_for_workers(len(workers))
        monkeypatch.setattr("pneutouch.workflows.sweep.workers._PATIENCE", PATIENCE)
        yield Cluster(address, scheduler, workers)
    finally:
        for process in (*workers, scheduler):
            process.kill()
            process.wait()
        drain.join()
        scheduler.stderr.close()
