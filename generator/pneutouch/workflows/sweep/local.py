"""Chunks computed on this machine: in this process, or in a pool of others."""

import concurrent.futures as futures
import contextlib
import multiprocessing
import os
import signal
import threading
from collections.abc import Iterator
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from typing import Any

from pneutouch.errors import ComputationError
from pneutouch.workflows.sweep.work import Record, SweepChunk, compute

_QUEUED = 2
"""Chunks waiting a worker: enough that none idles, few enough that a stop is soon done."""


def cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def in_process(chunks: list[SweepChunk], folder: Path) -> Iterator[list[Record]]:
    """Compute one chunk after the other, here."""
    for chunk in chunks:
        yield compute(chunk, folder)


def in_pool(chunks: list[SweepChunk], folder: Path, workers: int) -> Iterator[list[Record]]:
    """Compute chunks in ``workers`` processes; records come in the order in which chunks are done.

    Raises ComputationError if a worker dies. What ends it half way ends the processes as well.
    """
    context = multiprocessing.get_context("spawn")
    waiting, others = iter(chunks), set(multiprocessing.active_children())
    with _single_threaded(), futures.ProcessPoolExecutor(workers, context, _prepare_worker) as pool:
        running: set[futures.Future[list[Record]]] = set()
        # A private name: no public one gives the end that the pool keeps open itself.
        results: Any = pool._result_queue
        try:
            while True:
                while len(running) < _QUEUED * workers and (chunk := next(waiting, None)) is not None:
                    with _deaf():
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
    """Processes started here use one thread each: the pool takes the cores already."""
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
    """Processes started here never receive Ctrl-C, not even while they start: it is the parent's to handle.

    Blocked and not ignored, for the parent receives it afterwards.
    """
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _prepare_worker() -> None:
    """A worker is deaf to Ctrl-C however it was started, and ends with its parent where that was killed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
