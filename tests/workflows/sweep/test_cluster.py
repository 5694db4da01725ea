"""A sweep on a real cluster of processes gives the bytes of a local one, also when a worker is lost."""

from __future__ import annotations

import signal
import socket
import sys
from types import SimpleNamespace

import pytest
from distributed import Client

from pneutouch.errors import InputError
from pneutouch.workflows.sweep import sweep
from pneutouch.workflows.sweep import workers as module
from pneutouch.workflows.sweep.execute import ComputeResources
from tests.refusals import refused
from tests.workflows.sweep.conftest import PATIENCE, ended, held, journal_lines, resumed, small


@pytest.mark.slow
def test_a_lost_worker_changes_no_byte(undisturbed, cluster, tmp_path):
    out = tmp_path / "sweep.nc"
    process = held(out, "--scheduler", cluster.address)
    assert journal_lines(out) == 1
    cluster.workers[0].kill()
    assert cluster.workers[0].wait() == -signal.SIGKILL
    code, stdout, stderr = ended(process)
    assert code == 0, stderr
    assert stdout.splitlines()[-1] == str(out)
    (states,) = [line for line in stderr.splitlines() if not line.startswith("written: ") and not line.endswith(" ...")]
    assert states.startswith("320 points, states: ")
    assert out.read_bytes() == undisturbed
    assert not out.with_name("sweep.nc.parts").exists()


class Completed(list):
    """In place of `distributed.as_completed`: chunks are done in the order in which they are added."""

    def __init__(self, **options):
        super().__init__()

    add = list.append

    def is_empty(self):
        return not self

    def __next__(self):
        return self.pop(0)


class LostOnce:
    """A chunk that was done on a worker which ended before it sent the records: Dask computes it again."""

    def __init__(self, number):
        self.number, self.states = number, iter(("lost", "finished"))

    @property
    def status(self):
        return next(self.states, "finished")

    def result(self):
        return [{"point": self.number}]


def test_a_chunk_that_is_lost_with_its_worker_is_waited_for_again(monkeypatch):
    monkeypatch.setattr("distributed.as_completed", Completed)
    numbers = iter(range(9))
    client = SimpleNamespace(loop=None, nthreads=lambda: {"worker": 1}, submit=lambda *_, **__: LostOnce(next(numbers)))
    study = SimpleNamespace(fingerprint="", files={})
    found = [
        record["point"] for records in module._computed(client, study, list("abcde"), "tcp://") for record in records
    ]
    assert sorted(found) == [0, 1, 2, 3, 4]


@pytest.mark.slow
def test_a_lost_cluster_is_said_and_the_sweep_goes_on_without_it(undisturbed, cluster, tmp_path):
    out = tmp_path / "sweep.nc"
    process = held(out, "--scheduler", cluster.address)
    for worker in cluster.workers:
        worker.kill()
    cluster.scheduler.kill()
    code, _, stderr = ended(process)
    assert code == 3, stderr
    assert f"--scheduler {cluster.address}" in stderr, stderr
    assert "Traceback" not in stderr
    assert "goes on from there" in stderr
    assert resumed(out).returncode == 0
    assert out.read_bytes() == undisturbed


def listening():
    """A socket that takes connections and never says a word."""
    silent = socket.socket()
    silent.bind(("127.0.0.1", 0))
    silent.listen()
    return silent


@pytest.mark.slow
def test_no_scheduler_is_an_input_error(command, tmp_path):
    with socket.socket() as unused:
        unused.bind(("127.0.0.1", 0))
        address = f"tcp://127.0.0.1:{unused.getsockname()[1]}"
        words = ["--design", "paper-dome", "--over", "membrane.wall_thickness_mm=1,2", "--scheduler", address]
        result = command("sweep", *words)
    assert (result.returncode, result.stdout) == (2, "")
    (error,) = [line for line in result.stderr.splitlines() if not line.endswith(" ...")]
    assert error.startswith(f"error: --scheduler {address}: no Dask scheduler answers there (")
    assert list(tmp_path.iterdir()) == []
    assert module._PATIENCE < 10


def test_what_is_no_scheduler_is_an_input_error(library, tmp_path, monkeypatch):
    monkeypatch.setattr(module, "_PATIENCE", 1)
    with listening() as silent:
        for address in ("nonsense", "http://localhost:1", f"127.0.0.1:{silent.getsockname()[1]}"):
            with pytest.raises(InputError, match=f'scheduler = "{address}": no Dask scheduler answers there'):
                sweep(small(), tmp_path / "x.nc", ComputeResources(scheduler=address), library=library)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_a_cluster_without_workers_or_with_others_is_an_input_error(cluster, library, tmp_path, monkeypatch):
    monkeypatch.setattr(module, "__version__", "9.9")
    with pytest.raises(InputError, match=r"a worker has pneutouch .*, this is 9\.9"):
        sweep(small(), tmp_path / "x.nc", ComputeResources(scheduler=cluster.address), library=library)
    for worker in cluster.workers:
        worker.kill()
        worker.wait()

    async def no_workers(dask_scheduler):
        """Return when the scheduler has no worker left; local, so that the scheduler gets its code and not its name."""
        import asyncio

        while dask_scheduler.workers:
            await asyncio.sleep(0)

    with Client(cluster.address, timeout=PATIENCE, set_as_default=False) as client:
        client.run_on_scheduler(no_workers)
    monkeypatch.setattr(module, "_PATIENCE", 2)
    with pytest.raises(InputError, match="has no worker; start some with: dask worker"):
        sweep(small(), tmp_path / "x.nc", ComputeResources(scheduler=cluster.address), library=library)


def test_dask_that_is_not_installed_is_named(library, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with refused("scheduler", "tcp://127.0.0.1:1"):
        sweep(small(), tmp_path / "x.nc", ComputeResources(scheduler="tcp://127.0.0.1:1"), library=library)
