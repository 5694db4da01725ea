"""The files of the page, held in memory and compressed once: no path of a request reaches the disk."""

import gzip
from importlib.resources import files
from typing import NamedTuple

from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response

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
    """The files by the path that they are requested at; ``/`` is the page."""
    root = files("pneutouch.studio") / "static"
    files_by_path = {}
    for folder, prefix in ((root, "/"), (root / "vendor", "/vendor/")):
        for entry in sorted(folder.iterdir(), key=lambda each: each.name):
            kind = _KINDS.get(entry.name.rpartition(".")[2])
            if kind is not None and entry.is_file():
                content = entry.read_bytes()
                files_by_path[f"{prefix}{entry.name}"] = PageFile(kind, content, gzip.compress(content, 9, mtime=0))
    files_by_path["/"] = files_by_path.pop("/index.html")
    return files_by_path


def respond(known: dict[str, PageFile], request: Request) -> Response:
    """The file at the path of a request, compressed where the browser takes it; 404 if there is none."""
    file = known.get(request.url.path)
    if file is None:
        return PlainTextResponse("not found", 404)
    packed = "gzip" in request.headers.get("accept-encoding", "")
    headers = {"Vary": "Accept-Encoding"} | ({"Content-Encoding": "gzip"} if packed else {})
    return Response(file.compressed if packed else file.plain, media_type=file.kind, headers=headers)
