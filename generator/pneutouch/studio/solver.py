"""One process for what takes a second, and one question waiting for it: the newest."""

import asyncio
import contextlib
import json
import os
import sys
from collections.abc import Mapping
from typing import Any

_LONGEST_LINE = 1 << 26
"""Bytes of an answer; the longest of a design with fifty driving pressures are a tenth of it."""

_PATIENCE = 4.0
"""Seconds after its start at which a computation is ended for a newer question: a process takes one to start."""

Answer = dict[str, Any]


class SupersededError(Exception):
    """A newer question took the place of this one."""


class Solver:
    """Asks the process, one question at a time. A newer question replaces the one that waits.

    One that has been computed for longer than `_PATIENCE` gives way as well: its process is ended, and another starts.
    """

    def __init__(self, bases: Mapping[str, str]) -> None:
        self._bases = dict(bases)
        self._process: asyncio.subprocess.Process | None = None
        self._busy, self._newest = asyncio.Lock(), 0
        self._newer = asyncio.Event()

    async def ask(self, question: Mapping[str, Any]) -> Answer:
        """Status and content of the answer. Raises SupersededError where a newer question came."""
        self._newest += 1
        number = self._newest
        self._newer.set()
        async with self._busy:
            if number != self._newest:
                raise SupersededError
            self._newer.clear()
            return await self._answer({"question": question, "bases": self._bases})

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
        """Return when a newer question waits and this one has had its time."""
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
            self._process = await asyncio.create_subprocess_exec(
                sys.executable,
                "-m",
                "pneutouch.studio.worker",
                stdin=asyncio.subprocess.PIPE,
                stdout=asyncio.subprocess.PIPE,
                stderr=asyncio.subprocess.DEVNULL,
                limit=_LONGEST_LINE,
                # The page is answered while this computes.
                env={**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
                start_new_session=True,
            )
        return self._process
