"""Requests written byte by byte, as no browser and no library of HTTP would send them."""

from __future__ import annotations

import contextlib
import re
import socket

from pneutouch.studio.guard import KEY
from tests.studio.served import Studio

_PATIENCE = 60
"""Seconds in which an answer comes from a studio that lives."""


def request(studio: Studio, line: bytes = b"GET /", body: bytes = b"", **changed: str | None) -> bytes:
    """A request of the studio's own page; ``changed`` heads replace its own, None leaves one out."""
    heads: dict[str, str | None] = {"Host": studio.netloc, KEY: studio.key, "Connection": "close"}
    if line.startswith(b"POST"):
        heads |= {"Origin": studio.home[:-1], "Content-Type": "application/json", "Content-Length": str(len(body))}
    heads |= {name.replace("_", "-"): value for name, value in changed.items()}
    lines = [f"{name}: {value}".encode() for name, value in heads.items() if value is not None]
    return b"\r\n".join([line + b" HTTP/1.1", *lines, b"", body])


def answer(studio: Studio, sent: bytes, ends: bool = False) -> bytes:
    """All that comes back until the studio closes; with ``ends`` the connection is closed from here after what is sent."""
    parts = []
    with socket.create_connection(("127.0.0.1", studio.port), timeout=_PATIENCE) as connection:
        # A studio that has answered need not take the rest.
        with contextlib.suppress(ConnectionError):
            connection.sendall(sent)
            if ends:
                connection.shutdown(socket.SHUT_WR)
        with contextlib.suppress(ConnectionError):
            while part := connection.recv(1 << 16):
                parts.append(part)
    return b"".join(parts)


def status(answered: bytes) -> int | None:
    """The status of the first answer; None where there is none."""
    found = re.match(rb"HTTP/1\.1 (\d{3}) ", answered)
    return int(found[1]) if found else None
