"""The device that the page watches: one process for it, its frames passed on to the page, commands to the process."""

import asyncio
import contextlib
import json
from collections.abc import AsyncIterator, Callable, Container, Mapping
from typing import Any

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import JSONResponse, Response, StreamingResponse
from starlette.routing import Route

from pneutouch.errors import InputError, PneutouchError
from pneutouch.results.record import plain
from pneutouch.spec.values import plain_number
from pneutouch.studio.form import Question, json_body
from pneutouch.studio.guard import fault_response
from pneutouch.studio.solver import process_of
from pneutouch.workflows.live.port import BAUD, ports
from pneutouch.workflows.live.sensor import SIMULATED, faster_of

_KEPT = 512
"""Greatest number of frames that wait for the page; older ones are left out."""

_LAST_SECONDS = 5.0
"""Seconds that a recording has to end."""

_ELSEWHERE = b'{"elsewhere": true}\n'
"""Last frame of a stream in whose place another page watches."""

_KEYS = {"question", "pad", "port", "baud"}

COMMANDS = ("tare", "record", "plan", "stop")


class LiveDesk:
    """One device at a time, for the page that opened or watches it last; ``pads`` lists the pads that are known."""

    def __init__(self, bases: Mapping[str, str], pads: Callable[[], Container[str]]) -> None:
        self._bases, self._pads = bases, pads
        self._process: asyncio.subprocess.Process | None = None
        self._frames: asyncio.Queue[bytes] | None = None
        self._fault = b""
        self._watch: asyncio.Task[None] | None = None
        self._one = asyncio.Lock()

    def routes(self) -> list[Route]:
        """Requests for the device."""
        return [
            Route("/api/live/ports", self.ports),
            Route("/api/live/open", self.open, methods=["POST"]),
            Route("/api/live/do", self.do, methods=["POST"]),
            Route("/api/live/close", self.ended, methods=["POST"]),
            Route("/api/live/frames", self.stream),
        ]

    async def ports(self, request: Request) -> Response:
        """Ports of this machine that a device is at, and the simulated one."""
        try:
            known = await run_in_threadpool(ports)
        except PneutouchError as error:
            return fault_response(error)
        return JSONResponse({"ports": [*known, SIMULATED], "open": self._process is not None})

    async def open(self, request: Request) -> Response:
        """Open a device: ``question`` or ``pad``, ``port`` and ``baud``. Its faults come with its frames."""
        try:
            given = await json_body(request, "request")
            if not isinstance(given, dict) or not given.keys() <= _KEYS:
                raise InputError(f"a request is an object with the keys {', '.join(sorted(_KEYS))}")
            question, port, pad = Question.of(given.get("question")), given.get("port"), given.get("pad")
            if pad is not None and pad not in self._pads():
                raise InputError("no such pad", key="live.sensor", value=pad)
            if not isinstance(port, str) or not 0 < len(port) < 200:
                raise InputError("give the name of a port", key="live.port", value=port)
            faster_of(port)
            baud = _baud(given.get("baud"))
        except PneutouchError as error:
            return fault_response(error)
        async with self._one:
            await self._end()
            asked = {"question": plain(question), "pad": pad, "port": port, "baud": baud}
            await self._start({**asked, "bases": self._bases})
        return JSONResponse({}, 202)

    async def do(self, request: Request) -> Response:
        """Send a command to the device, one of `COMMANDS`."""
        try:
            given = await json_body(request, "command")
            if not isinstance(given, dict) or given.get("do") not in COMMANDS:
                raise InputError(f"a command is one of {', '.join(COMMANDS)}", key="do")
            if self._process is None:
                raise InputError("no device is open", key="live.port")
        except PneutouchError as error:
            return fault_response(error)
        await self._send(given)
        return JSONResponse({}, 202)

    async def ended(self, request: Request) -> Response:
        """Close the device; its recording ends."""
        async with self._one:
            await self._end()
        return JSONResponse({})

    async def stream(self, request: Request) -> Response:
        """Frames of the device as they come, a JSON document a line, from the samples that are kept on."""
        self._put(_ELSEWHERE)
        self._put(b"")
        self._frames = frames = asyncio.Queue[bytes](_KEPT)
        if self._process is None:
            # It failed before this stream was opened.
            self._put(self._fault)
            self._put(b"")
        await self._send({"do": "again"})
        return StreamingResponse(_passed(frames), media_type="application/x-ndjson")

    def _put(self, frame: bytes) -> None:
        """Give a frame to the stream that is open; the oldest that waits is left out where there are too many."""
        if self._frames is not None:
            if self._frames.full():
                self._frames.get_nowait()
            self._frames.put_nowait(frame)

    async def _start(self, request: Mapping[str, Any]) -> None:
        self._fault = b""
        self._process = await process_of("pneutouch.studio.live_process")
        await self._send(request)
        self._watch = asyncio.create_task(self._read(self._process))

    async def _send(self, line: Mapping[str, Any]) -> None:
        if self._process is not None and self._process.stdin is not None:
            with contextlib.suppress(ConnectionError):
                self._process.stdin.write(json.dumps(line).encode() + b"\n")
                await self._process.stdin.drain()

    async def _read(self, process: asyncio.subprocess.Process) -> None:
        """Pass on the frames of a process; an empty one is its end."""
        assert process.stdout is not None
        line = b"-"
        while line:
            line = await process.stdout.readline()
            if line.startswith(b'{"fault"'):
                self._fault = line
            if not line and self._process is process:
                self._process = None
            self._put(line)
        await process.wait()

    async def _end(self) -> None:
        process, self._process = self._process, None
        if process is None:
            return
        if process.stdin is not None:
            process.stdin.close()
        with contextlib.suppress(TimeoutError):
            await asyncio.wait_for(process.wait(), _LAST_SECONDS)
        if process.returncode is None:
            process.kill()
        if self._watch is not None:
            await self._watch

    async def close(self) -> None:
        """End the device with the studio, and the streams with it."""
        await self._end()
        self._put(b"")


async def _passed(frames: asyncio.Queue[bytes]) -> AsyncIterator[bytes]:
    """Frames until the end of the device, or until another page watches."""
    while frame := await frames.get():
        yield frame


def _baud(given: Any) -> int:
    """Bits a second; those of the sketch where nothing is given. Raises InputError."""
    if given in (None, ""):
        return BAUD
    try:
        value = plain_number(str(given))
    except ValueError:
        value = float("nan")
    if not 300 <= value <= 4_000_000:
        raise InputError("must be a number from 300 to 4000000", key="live.baud", value=given)
    return int(value)
