"""One process for computations that take a second, and one question waiting for it: the newest."""

import asyncio
import contextlib
import json
import os
import signal
import sys
from collections.abc import Iterable, Mapping
from typing import Any, BinaryIO

from pneutouch.catalogue import Library
from pneutouch.results.record import plain
from pneutouch.studio.answer import full_answer
from pneutouch.studio.form import PageLibrary, Question
from pneutouch.studio.guard import PageResponse, reported

_LONGEST_LINE = 1 << 26
"""Greatest size of an answer in bytes; the longest, of a design with fifty driving pressures, has a tenth of it."""

_PATIENCE = 4.0
"""Seconds after which a computation is ended if a newer question waits; a process takes one second to start."""

Answer = dict[str, Any]


class SupersededError(Exception):
    """A newer question took the place of this one."""


class Solver:
    """Sends questions to one process, one at a time. A newer question replaces the one that waits.

    It also replaces one computed for longer than `_PATIENCE`: that process is ended, and another started.
    """

    def __init__(self, bases: Mapping[str, str]) -> None:
        self._bases = bases
        self._process: asyncio.subprocess.Process | None = None
        self._waiting: asyncio.Future[None] | None = None
        self._is_busy, self._newer = False, asyncio.Event()

    async def request(self, question: Mapping[str, Any]) -> Answer:
        """Status and content of the answer. Raises SupersededError if a newer question came."""
        self._newer.set()
        if self._waiting is not None:
            self._waiting.set_exception(SupersededError())
            self._waiting = None
        if self._is_busy:
            await self._turn()
        self._is_busy = True
        if self._waiting is None:
            self._newer.clear()
        try:
            return await self._answer({"question": question, "bases": self._bases})
        finally:
            self._pass_on()

    async def _turn(self) -> None:
        """Wait until the process is free. Raises SupersededError if a newer question takes this one's place."""
        self._waiting = turn = asyncio.get_running_loop().create_future()
        try:
            await turn
        except asyncio.CancelledError:
            if self._waiting is turn:
                self._waiting = None
            elif not turn.cancelled():
                self._pass_on()
            raise

    def _pass_on(self) -> None:
        """Give the process to the waiting question; mark it free if none waits."""
        turn, self._waiting = self._waiting, None
        self._is_busy = turn is not None
        if turn is not None:
            turn.set_result(None)

    async def close(self) -> None:
        """End the process."""
        process, self._process = self._process, None
        if process is not None and process.returncode is None:
            with contextlib.suppress(ProcessLookupError):
                process.kill()
            await process.wait()

    async def _answer(self, request: Answer) -> Answer:
        answer = asyncio.create_task(self._exchange(request))
        newer = asyncio.create_task(self._waited_for())
        try:
            await asyncio.wait((answer, newer), return_when=asyncio.FIRST_COMPLETED)
            if not answer.done():
                await self.close()
                raise SupersededError
            return answer.result()
        finally:
            for task in (answer, newer):
                task.cancel()
                with contextlib.suppress(asyncio.CancelledError, Exception):
                    await task

    async def _waited_for(self) -> None:
        """Return when a newer question waits and this one has been computed for `_PATIENCE`."""
        await asyncio.sleep(_PATIENCE)
        await self._newer.wait()

    async def _exchange(self, request: Answer) -> Answer:
        process = await self._running()
        assert process.stdin is not None and process.stdout is not None
        line = b""
        with contextlib.suppress(ConnectionError):
            process.stdin.write(json.dumps(request).encode() + b"\n")
            await process.stdin.drain()
            line = await process.stdout.readline()
        if not line:
            await self.close()
            problem = {"message": "the computation was ended from outside; change a value to start it again"}
            return {"status": 500, "content": {"problems": [{**problem, "fields": []}]}}
        answer: Answer = json.loads(line)
        return answer

    async def _running(self) -> asyncio.subprocess.Process:
        if self._process is None or self._process.returncode is not None:
            self._process = await process_of("pneutouch.studio.solver")
        return self._process


async def process_of(module: str) -> asyncio.subprocess.Process:
    """A process of a module that answers by lines, on one thread: the page is answered while it computes."""
    return await asyncio.create_subprocess_exec(
        sys.executable,
        "-m",
        module,
        stdin=asyncio.subprocess.PIPE,
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.DEVNULL,
        limit=_LONGEST_LINE,
        env={**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
        start_new_session=True,
    )


def answered(request: Mapping[str, Any], library: Library) -> PageResponse:
    """Status and content of the answer to a request with ``question`` and ``bases``; an error is an answer too."""
    return reported(lambda: full_answer(Question.of(request["question"]), request["bases"], library))


def work(requests: Iterable[bytes], answers: BinaryIO) -> None:
    """Answer every request in turn."""
    library = PageLibrary(Library.default().folders)
    for line in requests:
        answers.write(json.dumps(plain(answered(json.loads(line), library))).encode() + b"\n")
        answers.flush()


if __name__ == "__main__":
    # The studio ends this process: Ctrl-C in its terminal is no affair of this one.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    work(sys.stdin.buffer, sys.stdout.buffer)
