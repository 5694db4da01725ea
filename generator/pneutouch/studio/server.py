"""The studio served on a port of 127.0.0.1 with a one-time token: requests of the page and their answers."""

import asyncio
import contextlib
import gzip
import resource
import secrets
import socket
from collections.abc import AsyncIterator, Callable
from functools import partial
from importlib.resources import files
from pathlib import Path
from typing import Any, NamedTuple

import uvicorn
from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import JSONResponse, PlainTextResponse, Response
from starlette.routing import Route
from uvicorn.protocols.http.h11_impl import H11Protocol

from pneutouch import __version__
from pneutouch.catalogue import DesignSource, Library
from pneutouch.errors import ComputationError, InputError, PneutouchError
from pneutouch.results.record import plain
from pneutouch.studio.answer import Answers
from pneutouch.studio.form import PageLibrary, Question, design_form, designs_of, json_body, target_form
from pneutouch.studio.guard import (
    Application,
    Guard,
    TooLargeError,
    fault_response,
    internal_fault,
    too_large,
    too_little_memory,
)
from pneutouch.studio.jobs import Desk
from pneutouch.studio.live import LiveDesk
from pneutouch.studio.pads import Pads
from pneutouch.studio.solver import Solver, SupersededError

_KINDS = {
    "html": "text/html; charset=utf-8",
    "css": "text/css; charset=utf-8",
    "js": "text/javascript; charset=utf-8",
    "svg": "image/svg+xml",
}


class PageFile(NamedTuple):
    """A file of the page: its media type, and its bytes as they are and compressed."""

    kind: str
    plain: bytes
    compressed: bytes


def page_files() -> dict[str, PageFile]:
    """The files by the path that they are requested at; ``/`` is the page, which ``/pad`` and ``/live`` open there."""
    root = files("pneutouch.studio") / "static"
    files_by_path = {}
    for folder, prefix in ((root, "/"), (root / "vendor", "/vendor/")):
        for entry in sorted(folder.iterdir(), key=lambda each: each.name):
            kind = _KINDS.get(entry.name.rpartition(".")[2])
            if kind is not None and entry.is_file():
                content = entry.read_bytes()
                files_by_path[f"{prefix}{entry.name}"] = PageFile(kind, content, gzip.compress(content, 9, mtime=0))
    files_by_path["/"] = files_by_path["/pad"] = files_by_path["/live"] = files_by_path.pop("/index.html")
    return files_by_path


def respond(known: dict[str, PageFile], request: Request) -> Response:
    """The file at the path of a request, compressed where the browser takes it; 404 if there is none."""
    file = known.get(request.url.path)
    if file is None:
        return PlainTextResponse("not found", 404)
    packed = "gzip" in request.headers.get("accept-encoding", "")
    headers = {"Vary": "Accept-Encoding"} | ({"Content-Encoding": "gzip"} if packed else {})
    return Response(file.compressed if packed else file.plain, media_type=file.kind, headers=headers)


_WAITING = 8
"""Greatest number of questions that wait for an answer at once; a page sends two."""


class Studio:
    """Answers the page. ``bases`` are the designs that the page may open, by name or path; ``first`` is shown first.

    It keeps between requests the catalogue, one solver process, which starts with its first question, and the desk with
    its jobs and files.
    """

    def __init__(self, bases: dict[str, str], first: str) -> None:
        self._bases, self._first = bases, first
        self._library = PageLibrary(Library.default().folders)
        self.answers, self.pads = Answers(bases, self._library), Pads(self._library)
        self._solver, self.desk = Solver(bases), Desk(bases)
        self.live = LiveDesk(bases, lambda: self._library.paths("pads"))
        self._one, self._waiting = asyncio.Lock(), 0

    async def form(self, request: Request) -> Response:
        """Form of a design and list of designs, from which the page is built."""
        form = await run_in_threadpool(design_form, self._library)
        known = {"designs": designs_of(self._bases), "first": self._first, "version": __version__}
        known["pads"] = list(self._library.paths("pads"))
        return JSONResponse({**plain(form), **known})

    async def target_form(self, request: Request) -> Response:
        """Form of a target."""
        return JSONResponse(plain(await run_in_threadpool(target_form, self._library, self._bases)))

    async def at_once(self, answer: Callable[[Question], object], request: Request) -> Response:
        """Response with what ``answer`` returns, computed in this process, one question at a time."""
        if self._waiting >= _WAITING:
            return fault_response(ComputationError("too many questions at once", remedy="wait for an answer"), 503)
        self._waiting += 1
        try:
            question = await _question(request)
            async with self._one:
                content = await run_in_threadpool(answer, question)
            return JSONResponse(plain(content))
        except PneutouchError as error:
            return fault_response(error)
        except MemoryError:
            return fault_response(too_little_memory())
        finally:
            self._waiting -= 1

    async def solved(self, request: Request) -> Response:
        """Response with the solver process's answer; status 409 if a newer question replaced this one."""
        try:
            question = await _question(request)
            answer = await self._solver.request(plain(question))
        except PneutouchError as error:
            return fault_response(error)
        except SupersededError:
            return JSONResponse({"superseded": True}, 409)
        return JSONResponse(answer["content"], answer["status"])

    @contextlib.asynccontextmanager
    async def running(self, application: Starlette) -> AsyncIterator[None]:
        """Context of the running server; the solver process and the desk end with it."""
        try:
            yield
        finally:
            await self._solver.close()
            await self.desk.close()
            await self.live.close()


def application(bases: dict[str, str], first: str, port: int, token: str) -> Application:
    """The whole studio as an ASGI application for the address with ``port``, which ``token`` opens once."""
    studio, known = Studio(bases, first), page_files()

    async def page(request: Request) -> Response:
        return respond(known, request)

    async def echo(request: Request) -> Response:
        """Echo of the request as it is: it measures the time that the page and the network take."""
        return Response(await request.body(), media_type="application/json")

    routes = [
        Route("/api/form", studio.form),
        Route("/api/form/target", studio.target_form),
        Route("/api/quick", partial(studio.at_once, studio.answers.quick), methods=["POST"]),
        Route("/api/intervals", partial(studio.at_once, studio.answers.intervals), methods=["POST"]),
        Route("/api/view", partial(studio.at_once, studio.answers.view), methods=["POST"]),
        Route("/api/pad", partial(studio.at_once, studio.pads.open), methods=["POST"]),
        Route("/api/pad/touch", partial(studio.at_once, studio.pads.touch), methods=["POST"]),
        Route("/api/solved", studio.solved, methods=["POST"]),
        Route("/api/echo", echo, methods=["POST"]),
        *studio.desk.routes(),
        *studio.live.routes(),
        Route("/{path:path}", page),
    ]
    handlers = {TooLargeError: _refused, Exception: _failed}
    return Guard(Starlette(routes=routes, lifespan=studio.running, exception_handlers=handlers), port, token, known)


async def _question(request: Request) -> Question:
    """The question in a body. Raises InputError if there is none."""
    return Question.of(await json_body(request, "question"))


async def _refused(request: Request, error: Exception) -> Response:
    return too_large(request.url.path)


async def _failed(request: Request, error: Exception) -> Response:
    """Response to an internal fault, without a traceback."""
    return fault_response(internal_fault(error))


HOST = "127.0.0.1"

_LAST_ANSWERS = 2
"""Seconds that unfinished answers have when the studio is stopped."""


_HEAD_SECONDS, _REST_SECONDS = 10, 120
"""Seconds that a connection has to send a request's head, and to send its body or read on in an answer."""

_MOST_CONNECTIONS, _AT_ONCE = 128, 4
"""Greatest number of connections open or waiting; and of those accepted at a time before surplus ones are closed."""


def most_connections(files: int) -> int:
    """Greatest number of open connections if a process may have ``files`` open files, -1 for no limit."""
    return min(_MOST_CONNECTIONS, files // 4) if files > 0 else _MOST_CONNECTIONS


class Connection(H11Protocol):
    """A connection that is closed if the other side lets the studio wait for too long.

    One more than `most` closes the one that has waited longest, or is itself closed if none waits: idle connections
    keep nobody out, and take no file descriptor that a job needs.
    """

    most = most_connections(resource.getrlimit(resource.RLIMIT_NOFILE)[0])
    _owed: tuple[int, object] | None = None
    _timer: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Accept the connection; beyond `most`, abort the longest waiting one, or else this one."""
        super().connection_made(transport)
        if len(self.connections) > self.most:
            waiting = [each for each in self.connections if isinstance(each, Connection) and each._timer]
            oldest = min(waiting, key=lambda each: each._since, default=self)
            oldest._wait(None)
            oldest.transport.abort()
        self._watch()

    def data_received(self, data: bytes) -> None:
        """Take received data, and limit the time of the next step."""
        super().data_received(data)
        self._watch()

    def on_response_complete(self) -> None:
        """Go on with the next request."""
        super().on_response_complete()
        self._watch()

    def pause_writing(self) -> None:
        """Stop sending until the other side reads on."""
        super().pause_writing()
        self._watch()

    def resume_writing(self) -> None:
        """Go on sending."""
        super().resume_writing()
        self._watch()

    def connection_lost(self, exc: Exception | None) -> None:
        """End the timer of a closed connection."""
        super().connection_lost(exc)
        self._wait(None)

    def _watch(self) -> None:
        """Limit the time of the other side's next step; an answer may be computed for as long as it takes."""
        if self.transport.is_closing() or self.flow.write_paused:
            self._wait((_REST_SECONDS, self.cycle))
        elif not self.headers or self.cycle.response_complete:
            self._wait((_HEAD_SECONDS, self.cycle))
        else:
            self._wait((_REST_SECONDS, self.scope) if self.cycle.more_body else None)

    def _wait(self, owed: tuple[int, object] | None) -> None:
        """Start a timer for ``owed``, (seconds, request), unless it runs for the same; None stops it."""
        if owed == self._owed:
            return
        if self._timer:
            self._timer.cancel()
        self._owed, self._since = owed, self.loop.time()
        self._timer = self.loop.call_later(owed[0], self.transport.abort) if owed else None


def without_traceback(loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
    """Keep errors of connections, such as a lack of file descriptors, off the terminal. The event loop tries again by
    itself, even, in vain, on a listener that was closed meanwhile."""
    if not isinstance(context.get("exception"), OSError) and "_start_serving" not in context["message"]:
        loop.default_exception_handler(context)


class _Server(uvicorn.Server):
    """A server that calls ``opened`` when it takes requests. A stop signal ends it, and is raised again afterwards."""

    def __init__(self, config: uvicorn.Config, opened: Callable[[], None]) -> None:
        super().__init__(config)
        self._opened = opened

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Start to listen."""
        asyncio.get_running_loop().set_exception_handler(without_traceback)
        await super().startup(sockets)
        for each in sockets or []:
            # As many may queue; asyncio takes as many at once as it was told that may.
            each.listen(_MOST_CONNECTIONS)
        if self.started:
            self._opened()


def bases_of(design: str | None) -> tuple[dict[str, str], str]:
    """Designs that the page may open, by the name shown, and the name of the one shown first.

    ``design`` is a name or a path; a path's design is named by its file. Raises InputError if it is not found.
    """
    library = Library.default()
    bases = {name: name for name in library.paths("designs")}
    if design is None:
        return bases, "paper-dome" if "paper-dome" in bases else next(iter(bases))
    if design in bases:
        return bases, design
    source = DesignSource.of(design, library)
    source.changed({})
    path = Path(design)
    return {source.name: str(path.resolve()) if path.is_file() else design, **bases}, source.name


def serve(design: str | None, port: int, opened: Callable[[str], None]) -> None:
    """Serve until a stop signal raises KeyboardInterrupt; ``opened`` receives the address. ``port`` 0: a free one.

    Raises InputError if the design is not found or the port is taken.
    """
    bases, first = bases_of(design)
    token = secrets.token_urlsafe(32)
    # By name TCP: asyncio sends the parts of an answer at once only where it is stated, else 40 ms apart.
    listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listener.bind((HOST, port))
        except (OSError, OverflowError) as error:
            remedy = "give another port, or none for a free one"
            raise InputError(f"cannot be used: {error}", key="port", value=port, remedy=remedy) from None
        bound = listener.getsockname()[1]
        config = uvicorn.Config(
            application(bases, first, bound, token),
            log_config=None,
            log_level="critical",
            access_log=False,
            server_header=False,
            date_header=False,
            http=Connection,
            ws="none",
            backlog=_AT_ONCE,
            timeout_graceful_shutdown=_LAST_ANSWERS,
        )
        server = _Server(config, lambda: opened(f"http://{HOST}:{bound}/?token={token}"))
        asyncio.run(server.serve(sockets=[listener]))
    finally:
        listener.close()
