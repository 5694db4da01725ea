"""Guard of the studio, the files that the page was given, and errors as the page takes them.

Only a browser that was given the address is answered, and no page of another site. Files are kept in numbered folders,
limited in size and number.
"""

import re
import secrets
from collections.abc import AsyncIterator, Awaitable, Callable, Container, MutableMapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from starlette.responses import JSONResponse, PlainTextResponse, Response

from pneutouch.errors import ComputationError, InputError, PneutouchError
from pneutouch.results.record import plain
from pneutouch.spec.design import DesignFile
from pneutouch.spec.fields import table_of

LARGEST_FILE = 64 << 20
"""Greatest size of one file, in bytes."""

_LARGEST_SUM = 256 << 20
"""Greatest size of all files in bytes, arriving ones included; the oldest complete file is removed first."""

_MOST_FILES = 500
_LONGEST_NAME = 120
_NAME = re.compile(r"[\w][\w .,()+@=-]*", re.ASCII)


class Upload(NamedTuple):
    """A file that was given: its name in the user's folder, its path here, and its size in bytes."""

    name: str
    path: Path
    bytes: int


class Uploads:
    """Keeps files in ``folder`` by number. A file lies in a folder of its own, under its checked name: readers go by
    the name's ending, and messages state the name."""

    def __init__(self, folder: Path) -> None:
        self._folder, self._files, self._number = folder, dict[int, Upload](), 0
        self._coming = dict[int, int]()

    def __getitem__(self, number: int) -> Upload:
        """Return the file with this number. Raises KeyError if it is unknown or removed."""
        return self._files[number]

    async def add(self, name: str, stream: AsyncIterator[bytes]) -> int:
        """Keep a file; returns its number. Raises InputError for a bad name, and for too large a file or too many."""
        if not _NAME.fullmatch(name) or len(name) > _LONGEST_NAME:
            remedy = "use letters, digits and . _ - + = @ ( ) , alone, and begin with a letter or a digit"
            raise InputError("not a name for a file", key="name", value=name[:_LONGEST_NAME], remedy=remedy)
        self._number += 1
        number = self._number
        path = self._folder / f"upload-{number}" / name
        path.parent.mkdir(parents=True)
        self._coming[number] = 0
        try:
            self._make_room(name, 0)
            with path.open("xb") as file:
                async for part in stream:
                    self._coming[number] += len(part)
                    self._make_room(name, self._coming[number])
                    file.write(part)
            self._files[number] = Upload(name, path, self._coming[number])
        except BaseException:
            path.unlink(missing_ok=True)
            path.parent.rmdir()
            raise
        finally:
            del self._coming[number]
        return number

    def _make_room(self, name: str, size: int) -> None:
        """Remove the oldest files to fit one that has come to ``size`` bytes. Raises InputError if that fails."""
        if size > LARGEST_FILE:
            remedy = f"give files of at most {LARGEST_FILE >> 20} MiB, or use the commands"
            raise InputError("the file is too large", key=name, remedy=remedy)
        while self._bytes() > _LARGEST_SUM or len(self._files) + len(self._coming) > _MOST_FILES:
            if not self._files:
                raise InputError("too many files come at once", key=name, remedy="give one after the other")
            old = self._files.pop(next(iter(self._files)))
            old.path.unlink(missing_ok=True)
            old.path.parent.rmdir()

    def _bytes(self) -> int:
        return sum(each.bytes for each in self._files.values()) + sum(self._coming.values())


LARGEST_BODY = 64 * 1024
"""Greatest size of a question, in bytes."""

UPLOADS = "/api/uploads"
"""Path that takes files, as bytes; every other path takes JSON."""

FILES = "/files/"
"""Start of the addresses of files that a job wrote; the job's ticket follows, in place of the key."""

KEY = "pneutouch-key"
"""Header of the page's requests for the key; in the request to `OPENING` it holds the one-time token."""

OPENING = "/api/open"
"""Path that returns the key in exchange for the token."""

HEADERS = {
    "Content-Security-Policy": "default-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}

SHEET = {
    "Content-Security-Policy": "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "img-src data:; font-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'self'; sandbox allow-scripts"
}
"""Replaces the policy of `HEADERS` for a page that a job wrote: it is complete in itself and shown in a frame, where it
has no origin, reaches neither the studio nor anything else, and opens nothing."""

_NAMES = ("127.0.0.1", "localhost")

Scope = MutableMapping[str, Any]
Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]
Application = Callable[[Scope, Receive, Send], Awaitable[None]]


class TooLargeError(Exception):
    """Error for a request's body that is longer than its path takes."""


class Guard:
    """Checks requests before an application: Host, Origin, key, and kind and size of what is sent.

    ``token`` is exchanged once for the key, which the page keeps and sends in a header: unlike a cookie, no browser
    sends it by itself, or gives it to a page or a server of another port. The files of the page, at ``public`` paths,
    hold nothing of the user's and need no key.
    """

    def __init__(self, application: Application, port: int, token: str, public: Container[str] = ()) -> None:
        self._application, self._token, self._public = application, token, public
        self._key = secrets.token_urlsafe(32)
        self._hosts = {f"{name}:{port}" for name in _NAMES}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or hand it on; every answer has `HEADERS`, but a sheet shown in a frame keeps `SHEET`."""
        if scope["type"] != "http":
            # Start and stop of the server; there are no web sockets.
            if scope["type"] == "lifespan":
                await self._application(scope, receive, send)
            return
        headers = {name.decode("latin-1").lower(): value.decode("latin-1") for name, value in scope["headers"]}
        refused = self._refused(scope, headers)

        async def guarded(message: Message) -> None:
            if message["type"] == "http.response.start":
                given = list(message.get("headers", []))
                stated = {name for name, _ in given}
                added = [(name.lower().encode(), value.encode()) for name, value in HEADERS.items()]
                message["headers"] = [*given, *(each for each in added if each[0] not in stated)]
            await send(message)

        if refused is not None:
            await refused(scope, receive, guarded)
            return
        await self._application(scope, _limited(receive, _largest(scope["path"])), guarded)

    def _refused(self, scope: Scope, headers: dict[str, str]) -> Response | None:
        """Response to a request that is refused, or the key for the token; None for a request to pass on."""
        if headers.get("host") not in self._hosts:
            return PlainTextResponse("unknown host", 403)
        path, home = scope["path"], f"http://{headers['host']}"
        if headers.get("origin", None if scope["method"] == "POST" else home) != home:
            return PlainTextResponse("unknown origin", 403)
        if path not in self._public and headers.get("sec-fetch-site", "none") not in ("none", "same-origin"):
            return PlainTextResponse("unknown origin", 403)
        if path == OPENING and self._opens(headers.get(KEY, "")):
            return JSONResponse({"key": self._key})
        if path not in self._public and not path.startswith(FILES) and not _is(headers.get(KEY, ""), self._key):
            return PlainTextResponse("Open the address that pneutouch studio printed; it opens the page once.", 403)
        if scope["method"] == "POST":
            return _refused_question(path, headers)
        return None if scope["method"] in ("GET", "HEAD") else PlainTextResponse("not allowed", 405)

    def _opens(self, given: str) -> bool:
        """True if ``given`` is the token, which is then used up."""
        if not self._token or not _is(given, self._token):
            return False
        self._token = ""
        return True


def _is(given: str, secret: str) -> bool:
    return secrets.compare_digest(given.encode(), secret.encode())


def _refused_question(path: str, headers: dict[str, str]) -> Response | None:
    kind = "application/octet-stream" if path == UPLOADS else "application/json"
    if headers.get("content-type", "").partition(";")[0].strip().lower() != kind:
        return PlainTextResponse(f"what is sent here is {kind}", 415)
    length = headers.get("content-length", "0")
    is_number = length.isdecimal() and len(length) < 20
    return None if is_number and int(length) <= _largest(path) else too_large(path)


def too_large(path: str) -> Response:
    """The answer to a body that is longer than ``path`` allows."""
    what = (
        f"a file has at most {LARGEST_FILE >> 20} MiB"
        if path == UPLOADS
        else f"a question has at most {LARGEST_BODY} bytes"
    )
    return JSONResponse({"problems": [{"message": what, "fields": []}]}, 413)


def _largest(path: str) -> int:
    return LARGEST_FILE if path == UPLOADS else LARGEST_BODY


def _limited(receive: Receive, largest: int) -> Receive:
    """Wrap ``receive``: TooLargeError beyond ``largest`` bytes, whatever length the request's head states."""
    taken = 0

    async def counted() -> Message:
        nonlocal taken
        message = await receive()
        taken += len(message.get("body", b""))
        if taken > largest:
            raise TooLargeError
        return message

    return counted


CHANGED = 412
BAD_INPUT = 422
FAILED = 500


class ChangedFileError(InputError):
    """Error for a design's file that was changed since the page read it: the page shows other values."""


@dataclass(frozen=True, slots=True)
class PageProblem:
    """A problem: its message, in the words of the CLI, and the form's fields (``table.key``) where it is shown."""

    message: str
    fields: list[str]


@dataclass(frozen=True, slots=True)
class PageFault:
    """The problems of an error."""

    problems: list[PageProblem]


@dataclass(frozen=True, slots=True)
class PageResponse:
    """HTTP status and content of the answer of a computation."""

    status: int
    content: object


def faults_of(error: PneutouchError) -> PageFault:
    """The problems of an error and of its ``others``, for the page."""
    return PageFault([_problem(each) for each in (error, *error.others)])


def fault_status(error: PneutouchError) -> int:
    """HTTP status of an error: the file was changed, the input is wrong, or the computation failed."""
    if isinstance(error, ChangedFileError):
        return CHANGED
    return BAD_INPUT if isinstance(error, InputError) else FAILED


def fault_response(error: PneutouchError, status: int | None = None) -> Response:
    """Response with the problems of an error; ``status`` None: that of `fault_status`."""
    return JSONResponse(plain(faults_of(error)), status or fault_status(error))


def reported(compute: Callable[[], object]) -> PageResponse:
    """The response of a computation; an error is an answer too, without a traceback."""
    try:
        return PageResponse(200, compute())
    except PneutouchError as error:
        fault = error
    except MemoryError:
        fault = too_little_memory()
    except Exception as error:
        fault = internal_fault(error)
    return PageResponse(fault_status(fault), faults_of(fault))


def internal_fault(error: Exception) -> PneutouchError:
    """Error for a fault of the program, without a traceback."""
    return ComputationError(f"internal fault ({type(error).__name__}: {error})", remedy="please report it")


def too_little_memory() -> PneutouchError:
    """Error for a lack of memory."""
    return ComputationError("not enough memory", remedy="close other programs")


def _problem(error: PneutouchError) -> PageProblem:
    words = error.problem if not error.remedy else f"{error.problem}; {error.remedy}"
    return PageProblem(PneutouchError(words).message(), _fields(error))


def _fields(error: PneutouchError) -> list[str]:
    """Fields of the form that an error is about: its key if that is a field, else the fields of its table or file."""
    key = (error.key or "").partition("[")[0]
    alone = "." in key or (key in DesignFile.model_fields and table_of(DesignFile, key) is None)
    return [key] if alone else list(error.fields)
