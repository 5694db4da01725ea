"""Jobs that take longer than an answer, each in a process that can be ended, and the requests for them."""

import asyncio
import contextlib
import json
import os
import secrets
import shutil
import signal
import sys
import tempfile
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import Route

from pneutouch.errors import ComputationError, InputError, PneutouchError
from pneutouch.results.record import plain
from pneutouch.studio.form import NameTakenError, json_body, save_design
from pneutouch.studio.guard import FILES, SHEET, UPLOADS, Uploads, fault_response
from pneutouch.studio.job import BRIEF, KINDS

KEPT = 8
"""Greatest number of jobs of a kind whose files are kept; the oldest is removed first."""

_LONGEST_LINE = 1 << 26
_LAST_SECONDS = 10.0
"""Seconds that a cancelled job has to remove its half-written files."""

_COMMAND = (sys.executable, "-m", "pneutouch.studio.job")
"""Command that starts the process of a job."""

Content = dict[str, Any]


@dataclass(frozen=True, slots=True)
class JobFile:
    """A file of a job: its path below the job's folder, and its size in bytes."""

    name: str
    bytes: int


@dataclass(frozen=True, slots=True)
class JobRecord:
    """State of a job for the page; its ``files``, once it is done, can be read at the address of its ``ticket``."""

    job: int
    ticket: str
    kind: str
    state: str
    progress: Content
    status: int
    content: Content
    files: list[JobFile]


class Job:
    """A job as the page sees it: ``state`` (running, done, failed, cancelled), progress, status and content.

    ``place`` is removed with the job; the job writes its files into ``folder`` below it. Links and frames send no key:
    whoever has the ``ticket``, valid for nothing else, may read these files while they are kept.
    """

    def __init__(self, number: int, kind: str, place: Path) -> None:
        self.number, self.kind, self.place, self.folder = number, kind, place, place / "files"
        self.state, self.status = "running", 200
        self.ticket = secrets.token_urlsafe(32)
        self.progress: Content = {}
        self.content: Content = {}
        self.process: asyncio.subprocess.Process | None = None

    @property
    def runs(self) -> bool:
        """True if the job has not ended; a cancelled one may take a moment to end."""
        return self.state == "running" or (self.process is not None and self.process.returncode is None)

    @property
    def record(self) -> JobRecord:
        """The job for the page: a cancelled one runs until its process has ended, for only then another can begin."""
        files = [JobFile(name, path.stat().st_size) for name, path in self.files().items()]
        state = "running" if self.runs else self.state
        return JobRecord(self.number, self.ticket, self.kind, state, self.progress, self.status, self.content, files)

    def files(self) -> dict[str, Path]:
        """Files of a job that is done, by their path below its folder; none before."""
        if self.state != "done":
            return {}
        paths = sorted(path for path in self.folder.rglob("*") if path.is_file() and not path.is_symlink())
        return {path.relative_to(self.folder).as_posix(): path for path in paths}


class Jobs:
    """Starts, watches and ends jobs, with a folder each below ``folder``.

    One job runs at a time; one of the kinds `BRIEF`, which take a moment, may run beside it.
    """

    def __init__(self, folder: Path, command: Sequence[str] = _COMMAND) -> None:
        self._folder, self._command, self._jobs = folder, command, dict[int, Job]()
        self._watches = set[asyncio.Task[None]]()
        self._number = 0

    def __getitem__(self, number: int) -> Job:
        """Return the job with this number. Raises KeyError if it is unknown or removed."""
        return self._jobs[number]

    def of_ticket(self, ticket: str) -> Job | None:
        """The job of a ticket; None if unknown or removed."""
        known = (job for job in self._jobs.values() if secrets.compare_digest(job.ticket.encode(), ticket.encode()))
        return next(known, None)

    @property
    def records(self) -> list[JobRecord]:
        """The jobs that are known, as the page sees them, oldest first."""
        return [job.record for job in self._jobs.values()]

    async def start(self, kind: str, arguments: Mapping[str, Any]) -> Job:
        """Start a job. Raises ComputationError while another one of its sort, brief (`BRIEF`) or long, runs."""
        brief = kind in BRIEF
        running = [job for job in self._jobs.values() if job.runs and (job.kind in BRIEF) == brief]
        if running:
            raise ComputationError(f"another job is running: {running[0].kind}", remedy="wait for it, or cancel it")
        self._number += 1
        job = Job(self._number, kind, self._folder / f"job-{self._number}")
        job.folder.mkdir(parents=True)
        self._jobs[job.number] = job
        self._drop_oldest(kind)
        request = {"kind": kind, "arguments": dict(arguments), "folder": str(job.folder)}
        watch = asyncio.create_task(self._run(job, json.dumps(request).encode() + b"\n"))
        self._watches.add(watch)
        watch.add_done_callback(self._watches.discard)
        return job

    def _drop_oldest(self, kind: str) -> None:
        for old in [job for job in self._jobs.values() if job.kind == kind][:-KEPT]:
            shutil.rmtree(self._jobs.pop(old.number).place, ignore_errors=True)

    async def cancel(self, job: Job) -> None:
        """End a running job and remove its files; nothing is done for a job that has ended."""
        if job.state != "running":
            return
        job.state = "cancelled"
        await _end(job)
        shutil.rmtree(job.place, ignore_errors=True)

    async def close(self) -> None:
        """End all running jobs."""
        await asyncio.gather(*(self.cancel(job) for job in self._jobs.values()))
        if self._watches:
            # They end with the output of their processes.
            _, hung = await asyncio.wait(self._watches, timeout=_LAST_SECONDS)
            for watch in hung:
                watch.cancel()

    async def _run(self, job: Job, request: bytes) -> None:
        answer: Content | None = None
        try:
            answer = await self._answered(job, request)
        except (OSError, ValueError):
            # No process could be started, or it wrote half a line as it was ended, or one without end.
            await _end(job)
        finally:
            if job.state == "running":
                ended = {"problems": [{"message": "the job was ended from outside", "fields": []}]}
                job.status, job.content = (answer["status"], answer["content"]) if answer else (500, ended)
                job.state = "done" if job.status == 200 else "failed"
                if job.state == "failed":
                    shutil.rmtree(job.place, ignore_errors=True)

    async def _answered(self, job: Job, request: bytes) -> Content | None:
        """The last line of the process; None if it ended without one."""
        job.process = process = await asyncio.create_subprocess_exec(
            *self._command,
            stdin=asyncio.subprocess.PIPE,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.DEVNULL,
            limit=_LONGEST_LINE,
            start_new_session=True,
        )
        if job.state != "running":
            await _end(job)
        assert process.stdin is not None and process.stdout is not None
        with contextlib.suppress(ConnectionError):
            process.stdin.write(request)
            await process.stdin.drain()
        answer = None
        async for line in process.stdout:
            content = json.loads(line)
            if "progress" in content:
                job.progress = content["progress"]
            else:
                answer = content
        # The process ends where its input does: that is how it sees that the studio was ended.
        process.stdin.close()
        await process.wait()
        return answer


async def _end(job: Job) -> None:
    """Stop the process and all that it started: by SIGTERM first, then by SIGKILL."""
    process = job.process
    if process is None or process.returncode is not None:
        return
    for number in (signal.SIGTERM, signal.SIGKILL):
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, number)
        with contextlib.suppress(TimeoutError):
            await asyncio.wait_for(process.wait(), _LAST_SECONDS)
            break
    with contextlib.suppress(ProcessLookupError):
        # What the process itself started and left behind.
        os.killpg(process.pid, signal.SIGKILL)


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
        self._one, self._saving = asyncio.Lock(), asyncio.Lock()

    def routes(self) -> list[Route]:
        """Routes of the desk in the application."""
        return [
            Route(UPLOADS, self.upload, methods=["POST"]),
            Route("/api/designs", self.save, methods=["POST"]),
            Route("/api/jobs", self.known, methods=["GET"]),
            Route("/api/jobs/{kind:str}", self.start, methods=["POST"]),
            Route("/api/jobs/{number}", self.state, methods=["GET"]),
            Route("/api/jobs/{number}/cancel", self.cancel, methods=["POST"]),
            Route(f"{FILES}{{ticket}}.zip", self.zipped, methods=["GET"]),
            Route(f"{FILES}{{ticket}}/{{name:path}}", self.file, methods=["GET"]),
        ]

    async def close(self) -> None:
        """End the running jobs and remove the kept files."""
        await self.jobs.close()
        self._place.cleanup()

    async def upload(self, request: Request) -> Response:
        """Keep a file; its name is in the query."""
        try:
            number = await self.uploads.add(request.query_params.get("name", ""), request.stream())
        except PneutouchError as error:
            return fault_response(error)
        return JSONResponse({"upload": number, "name": self.uploads[number].name})

    async def save(self, request: Request) -> Response:
        """Write a design into the user's folder; status 409 if the file exists and is not to be replaced."""
        try:
            content = await _object(request)
            async with self._saving:
                document = await run_in_threadpool(save_design, content, self._bases)
        except NameTakenError as error:
            return fault_response(error, _CLASH)
        except PneutouchError as error:
            return fault_response(error)
        return JSONResponse(document)

    async def known(self, request: Request) -> Response:
        """Jobs that run or whose files are kept, so that a page that is opened again finds its own."""
        return JSONResponse(plain({"jobs": self.jobs.records}))

    async def start(self, request: Request) -> Response:
        """Start a job with the page's JSON; the files numbered in ``uploads`` are passed to it as paths."""
        kind = request.path_params["kind"]
        try:
            if kind not in KINDS:
                raise InputError("unknown kind of job", value=kind)
            arguments = await _object(request)
            files = [self._uploaded(number) for number in arguments.pop("uploads", [])]
            job = await self.jobs.start(kind, arguments | {"files": files, "bases": self._bases})
        except InputError as error:
            return fault_response(error)
        except PneutouchError as error:
            return fault_response(error, _BUSY)
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
        job = self.jobs.of_ticket(request.path_params["ticket"])
        path = None if job is None else job.files().get(request.path_params["name"])
        if path is None:
            return _unknown()
        shown = request.query_params.get("show") == "1"
        kind = "inline" if shown else "attachment"
        return FileResponse(path, filename=path.name, content_disposition_type=kind, headers=SHEET if shown else None)

    async def zipped(self, request: Request) -> Response:
        """All files of a job in one archive."""
        job = self.jobs.of_ticket(request.path_params["ticket"])
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


def _unknown() -> Response:
    return fault_response(InputError("no such job or file, or no longer", remedy="start it again"), 404)
