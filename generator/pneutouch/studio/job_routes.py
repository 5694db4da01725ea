"""The requests for jobs and their files, for uploads, and for designs to be saved."""

import asyncio
import tempfile
import zipfile
from pathlib import Path
from typing import Any

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import Route

from pneutouch.errors import InputError, PneutouchError
from pneutouch.results.record import plain
from pneutouch.studio.faults import fault_status, faults_of
from pneutouch.studio.guard import SHEET, UPLOADS, Uploads
from pneutouch.studio.job import KINDS
from pneutouch.studio.jobs import Job, Jobs
from pneutouch.studio.question import json_body
from pneutouch.studio.saving import NameTakenError, save_design

_BUSY = _CLASH = 409


class Desk:
    """Takes uploads and jobs, and hands out files. Its temporary folder is removed with the studio.

    ``bases`` are the designs that the page may open; a design that is saved is added to them.
    """

    def __init__(self, bases: dict[str, str]) -> None:
        self._bases = bases
        self._place = tempfile.TemporaryDirectory(prefix="pneutouch-studio-", ignore_cleanup_errors=True)
        folder = Path(self._place.name)
        self.jobs, self.uploads = Jobs(folder), Uploads(folder)
        self._one = asyncio.Lock()

    def routes(self) -> list[Route]:
        """Its part of the application."""
        return [
            Route(UPLOADS, self.upload, methods=["POST"]),
            Route("/api/designs", self.save, methods=["POST"]),
            Route("/api/jobs", self.known, methods=["GET"]),
            Route("/api/jobs/{kind:str}", self.start, methods=["POST"]),
            Route("/api/jobs/{number}", self.state, methods=["GET"]),
            Route("/api/jobs/{number}/cancel", self.cancel, methods=["POST"]),
            Route("/api/jobs/{number}/files.zip", self.zipped, methods=["GET"]),
            Route("/api/jobs/{number}/files/{name:path}", self.file, methods=["GET"]),
        ]

    async def close(self) -> None:
        """End the running job and remove the kept files."""
        await self.jobs.close()
        self._place.cleanup()

    async def upload(self, request: Request) -> Response:
        """Keep a file; its name is in the query."""
        try:
            number = await self.uploads.add(request.query_params.get("name", ""), request.stream())
        except PneutouchError as error:
            return _fault(error)
        return JSONResponse({"upload": number, "name": self.uploads[number].name})

    async def save(self, request: Request) -> Response:
        """Write a design into the user's folder; 409 where there is such a file and it is not to be replaced."""
        try:
            document = await run_in_threadpool(save_design, await _object(request), self._bases)
        except NameTakenError as error:
            return _fault(error, _CLASH)
        except PneutouchError as error:
            return _fault(error)
        return JSONResponse(document)

    async def known(self, request: Request) -> Response:
        """The jobs that run or whose files are kept: a page that is opened again finds its own there."""
        return JSONResponse(plain({"jobs": self.jobs.records}))

    async def start(self, request: Request) -> Response:
        """Begin a job with the JSON of the page; ``uploads``, numbers of files, are given to it as paths."""
        kind = request.path_params["kind"]
        try:
            if kind not in KINDS:
                raise InputError("unknown kind of job", value=kind)
            arguments = await _object(request)
            files = [self._uploaded(number) for number in arguments.pop("uploads", [])]
            job = await self.jobs.start(kind, arguments | {"files": files, "bases": self._bases})
        except InputError as error:
            return _fault(error)
        except PneutouchError as error:
            return _fault(error, _BUSY)
        return JSONResponse(plain(job.record), 202)

    def _uploaded(self, number: Any) -> dict[str, str]:
        try:
            upload = self.uploads[int(number)]
        except (KeyError, TypeError, ValueError, OverflowError):
            raise InputError("no such file, or no longer", remedy="give the file again") from None
        return {"name": upload.name, "path": str(upload.path)}

    async def state(self, request: Request) -> Response:
        """State of a job."""
        job = self._job(request)
        return _unknown() if job is None else JSONResponse(plain(job.record))

    async def cancel(self, request: Request) -> Response:
        """End a job."""
        job = self._job(request)
        if job is None:
            return _unknown()
        await self.jobs.cancel(job)
        return JSONResponse(plain(job.record))

    async def file(self, request: Request) -> Response:
        """One file of a job, by its name in the job's list."""
        job = self._job(request)
        path = None if job is None else job.files().get(request.path_params["name"])
        if path is None:
            return _unknown()
        shown = request.query_params.get("show") == "1"
        kind = "inline" if shown else "attachment"
        return FileResponse(path, filename=path.name, content_disposition_type=kind, headers=SHEET if shown else None)

    async def zipped(self, request: Request) -> Response:
        """All files of a job in one archive."""
        job = self._job(request)
        if job is None or not job.files():
            return _unknown()
        async with self._one:
            archive = await run_in_threadpool(_archived, job)
        return FileResponse(archive, filename=archive.name, media_type="application/zip")

    def _job(self, request: Request) -> Job | None:
        try:
            return self.jobs[int(request.path_params["number"])]
        except (KeyError, ValueError):
            return None


def _archived(job: Job) -> Path:
    """The archive of a job's files, the same bytes for the same files."""
    files = job.files()
    tops = {name.partition("/")[0] for name in files}
    stem = tops.pop() if len(tops) == 1 and all("/" in name for name in files) else job.kind
    archive = job.place / f"{stem}.zip"
    if not archive.exists():
        part = archive.with_suffix(".part")
        with zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED) as packed:
            for name, path in files.items():
                entry = zipfile.ZipInfo(name)
                # Without a mode of its own it would be extracted for its owner alone.
                entry.external_attr = 0o644 << 16
                packed.writestr(entry, path.read_bytes(), zipfile.ZIP_DEFLATED)
        part.rename(archive)
    return archive


async def _object(request: Request) -> dict[str, Any]:
    content = await json_body(request, "request")
    if not isinstance(content, dict) or not isinstance(content.get("uploads", []), list):
        raise InputError("what is sent is a JSON object, and its uploads are a list of numbers")
    return content


def _fault(error: PneutouchError, status: int | None = None) -> Response:
    return JSONResponse(plain(faults_of(error)), status or fault_status(error))


def _unknown() -> Response:
    return _fault(InputError("no such job or file, or no longer", remedy="start it again"), 404)
