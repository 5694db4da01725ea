"""The studio served: a free port of 127.0.0.1, an address with a one-time token, a clean end."""

import asyncio
import secrets
import socket
from collections.abc import Callable
from pathlib import Path

import uvicorn

from pneutouch.catalogue import DesignSource, Library
from pneutouch.errors import InputError
from pneutouch.studio.application import application

HOST = "127.0.0.1"

_LAST_ANSWERS = 2
"""Seconds that unfinished answers have when the studio is stopped."""


class _Server(uvicorn.Server):
    """A server that reports when it takes requests. A stop signal ends it, and is raised again when it has ended."""

    def __init__(self, config: uvicorn.Config, opened: Callable[[], None]) -> None:
        super().__init__(config)
        self._opened = opened

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Start to listen."""
        await super().startup(sockets)
        if self.started:
            self._opened()


def bases_of(design: str | None) -> tuple[dict[str, str], str]:
    """Designs that the page may open, by the name shown, and the name that it begins with.

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
    """Serve until a stop signal raises KeyboardInterrupt; ``opened`` is given the address. ``port`` 0 is a free one.

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
        guarded = application(bases, first, bound, token)
        config = uvicorn.Config(
            guarded,
            log_config=None,
            log_level="critical",
            access_log=False,
            server_header=False,
            date_header=False,
            ws="none",
            timeout_graceful_shutdown=_LAST_ANSWERS,
        )
        server = _Server(config, lambda: opened(f"http://{HOST}:{bound}/?token={token}"))
        asyncio.run(server.serve(sockets=[listener]))
    finally:
        listener.close()
