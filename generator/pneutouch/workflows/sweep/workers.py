"""Computation of chunks in this process, in a pool of processes on this machine, or on an existing Dask cluster."""

from __future__ import annotations

import asyncio
import concurrent.futures as futures
import contextlib
import logging
import multiprocessing
import os
import signal
import threading
from asyncio import CancelledError
from collections.abc import Iterable, Iterator
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pneutouch import __version__
from pneutouch.errors import ComputationError, InputError, PneutouchError
from pneutouch.output.files import digest
from pneutouch.stopping import temporary_folder, uninterrupted
from pneutouch.workflows.sweep.work import Record, SweepChunk, SweepStudy, compute, unpack

if TYPE_CHECKING:
    from distributed import Client


_PATIENCE = 6
"""Seconds to wait for the scheduler, and again for a worker."""

_QUEUED = 3
"""Chunks sent ahead for each core of the cluster: more would only add to the work that a stop throws away."""


def on_cluster(study: SweepStudy, chunks: Iterable[SweepChunk], address: str) -> Iterator[list[Record]]:
    """Compute chunks on the cluster of a scheduler; records come in the order in which chunks are finished.

    If a worker is lost, Dask computes its chunk again elsewhere. Raises InputError if there is no cluster that can do
    this work, ComputationError if the connection is lost."""
    try:
        with _connected(address) as client:
            yield from _computed(client, study, chunks, address)
    except PneutouchError:
        raise
    # Where its scheduler is gone, Dask raises an error of whatever it was doing: a dozen kinds.
    except (Exception, CancelledError) as error:
        raise ComputationError(
            f"the connection was lost ({type(error).__name__})", key="scheduler", value=address
        ) from None


def _computed(client: Client, study: SweepStudy, chunks: Iterable[SweepChunk], address: str) -> Iterator[list[Record]]:
    from distributed import as_completed

    waiting = iter(chunks)
    running = as_completed(loop=client.loop, raise_errors=False)
    free = _QUEUED * max(1, sum(client.nthreads().values()))
    while True:
        while free and (chunk := next(waiting, None)) is not None:
            # Named by all that goes in: Dask gives two tasks of one name one result.
            key = f"pneutouch-{digest(repr((study.fingerprint, chunk)).encode())}"
            running.add(client.submit(compute_there, chunk, study.files, __version__, key=key))
            free -= 1
        if running.is_empty():
            return
        future = next(running)
        if future.status == "lost":
            # Its worker ended after the chunk was done and before it was sent: Dask computes it again.
            running.add(future)
            continue
        free += 1
        yield _result(future, address)


def compute_there(chunk: SweepChunk, files: dict[str, str], version: str) -> list[Record]:
    """Compute a chunk from files sent with it, on a machine without the user's files. Raises InputError for another
    version."""
    if version != __version__:
        raise InputError(f"a worker has pneutouch {__version__}, this is {version}; they must be the same")
    with temporary_folder() as folder:
        unpack(files, folder)
        return compute(chunk, folder)


def _result(future: Any, address: str) -> list[Record]:
    """Records of a chunk. Raises InputError or ComputationError that says what went wrong."""
    if future.status == "finished":
        records: list[Record] = future.result()
        return records
    error = future.exception() if future.status == "error" else None
    if isinstance(error, InputError):
        raise InputError(str(error), key="scheduler", value=address)
    if isinstance(error, ImportError):
        raise InputError(
            f"a worker cannot load pneutouch {__version__} ({error})",
            key="scheduler",
            value=address,
            remedy="install it there",
        )
    why = "the connection was lost" if error is None else f"{type(error).__name__}: {error}"
    raise ComputationError(f"a piece of the sweep was not computed: {why}", key="scheduler", value=address)


@contextlib.contextmanager
def _connected(address: str) -> Iterator[Client]:
    """Client of the scheduler with at least one worker. Raises InputError if there is none."""
    try:
        from distributed import Client
    except ImportError:
        raise InputError(
            "needs Dask, which is not installed: pip install pneutouch[cluster]", key="scheduler", value=address
        ) from None
    # Dask logs its errors to stderr as they happen; here they are reported once and in words.
    for name in ("distributed", "distributed.client", "distributed.core", "distributed.comm", "tornado.application"):
        logging.getLogger(name).setLevel(logging.CRITICAL + 1)
    _require_scheduler(address)
    client = Client(address, timeout=_PATIENCE, set_as_default=False)
    try:
        try:
            client.wait_for_workers(1, timeout=_PATIENCE)
        except TimeoutError:
            raise InputError(
                "has no worker", key="scheduler", value=address, remedy=f"start some with: dask worker {address}"
            ) from None
        yield client
    finally:
        with contextlib.suppress(Exception):
            client.close(timeout=2)


def _require_scheduler(address: str) -> None:
    """Raise InputError if no scheduler answers. This is checked before a client is made, because one that fails to
    connect takes a quarter of a minute to give up, and prints a traceback."""
    try:
        kind = asyncio.run(asyncio.wait_for(_identity(address), _PATIENCE))
    except (OSError, ValueError) as error:
        kind = (str(error) or f"no answer within {_PATIENCE} s").splitlines()[0]
    # What listens there may be no Dask at all, and its bytes be taken for anything, even a length beyond all memory.
    except Exception:
        kind = "what listens there has another protocol"
    if kind != "Scheduler":
        raise InputError(
            f"no Dask scheduler answers there ({kind})",
            key="scheduler",
            value=address,
            remedy="give the address that it printed when it started, such as tcp://host:8786",
        )


async def _identity(address: str) -> str:
    from distributed import rpc
    from distributed.security import Security

    async with rpc(address, connection_args=Security().get_connection_args("client"), timeout=_PATIENCE) as remote:
        return str((await remote.identity())["type"])


_QUEUED_EACH = 2
"""Chunks queued for each worker: enough that none idles, few enough that a stop is soon done."""


def cores() -> int:
    """Number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def in_process(chunks: Iterable[SweepChunk], folder: Path) -> Iterator[list[Record]]:
    """Compute one chunk after the other in this process."""
    for chunk in chunks:
        yield compute(chunk, folder)


def in_pool(chunks: Iterable[SweepChunk], folder: Path, workers: int) -> Iterator[list[Record]]:
    """Compute chunks in ``workers`` processes; records come in the order in which chunks are finished.

    Raises ComputationError if a worker dies. If the iteration is closed early, the processes end as well.
    """
    context = multiprocessing.get_context("spawn")
    waiting, others = iter(chunks), set(multiprocessing.active_children())
    with _single_threaded(), futures.ProcessPoolExecutor(workers, context, _prepare_worker) as pool:
        running: set[futures.Future[list[Record]]] = set()
        # A private name: no public one gives the end that the pool keeps open itself.
        results: Any = pool._result_queue
        try:
            while True:
                while len(running) < _QUEUED_EACH * workers and (chunk := next(waiting, None)) is not None:
                    # A stop that met a worker half started would leave it without its orders, and a traceback.
                    with uninterrupted(), _deaf():
                        running.add(pool.submit(compute, chunk, folder))
                if not running:
                    others.update(multiprocessing.active_children())
                    return
                done, running = futures.wait(running, return_when=futures.FIRST_COMPLETED)
                for future in done:
                    yield future.result()
        except BrokenProcessPool:
            raise ComputationError(
                "a worker process died, perhaps for missing memory", remedy="try fewer with `workers`"
            ) from None
        finally:
            pool.shutdown(wait=False, cancel_futures=True)
            # They would end what they compute first.
            stopped = set(multiprocessing.active_children()) - others
            for process in stopped:
                process.terminate()
            for process in stopped:
                process.join()
            if stopped:
                # The pool's thread waits for the rest of a message that a process was sending; only this ends that.
                results._writer.close()


@contextlib.contextmanager
def _single_threaded() -> Iterator[None]:
    """Context in which processes are started with one thread each, because the pool already uses all cores."""
    before = os.environ.get("OMP_NUM_THREADS")
    os.environ["OMP_NUM_THREADS"] = "1"
    try:
        yield
    finally:
        if before is None:
            del os.environ["OMP_NUM_THREADS"]
        else:
            os.environ["OMP_NUM_THREADS"] = before


@contextlib.contextmanager
def _deaf() -> Iterator[None]:
    """Context in which processes are started that never receive Ctrl-C, even while they start: the parent handles it.

    It is blocked and not ignored, so that the parent receives it afterwards.
    """
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _prepare_worker() -> None:
    """Make a worker ignore Ctrl-C, however it was started, and end when its parent is killed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
