"""Chunks computed on a Dask cluster that is there already."""

from __future__ import annotations

import asyncio
import contextlib
import logging
from asyncio import CancelledError
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from pneutouch import __version__
from pneutouch.errors import ComputationError, InputError, PneutouchError
from pneutouch.holding import temporary_folder
from pneutouch.output.files import digest
from pneutouch.workflows.sweep.study import SweepStudy
from pneutouch.workflows.sweep.work import Record, SweepChunk, compute, unpack

if TYPE_CHECKING:
    from distributed import Client

_PATIENCE = 6
"""Seconds to wait for the scheduler, and again for a worker."""

_QUEUED = 3
"""Chunks sent ahead a core of the cluster: more only lengthen the work that a stop throws away."""


def on_cluster(study: SweepStudy, chunks: list[SweepChunk], address: str) -> Iterator[list[Record]]:
    """Compute chunks on the cluster of a scheduler; records come in the order in which chunks are done.

    A chunk whose worker is lost is computed again elsewhere by Dask. Raises InputError if there is no cluster
    that can do this work, ComputationError where the connection is lost.
    """
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


def _computed(client: Client, study: SweepStudy, chunks: list[SweepChunk], address: str) -> Iterator[list[Record]]:
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
    """Compute a chunk on a machine that may have nothing of the user's: the files come with it."""
    if version != __version__:
        raise InputError(f"a worker has pneutouch {__version__}, this is {version}; they must be the same")
    with temporary_folder() as folder:
        unpack(files, folder)
        return compute(chunk, folder)


def _result(future: Any, address: str) -> list[Record]:
    """A chunk's records; raises an error that says what went wrong."""
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
    """A client of the scheduler with at least one worker behind it."""
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
    """Raise InputError where no scheduler answers. Checked before a client is made: one that fails to connect takes
    a quarter of a minute to go away, and prints a traceback."""
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
