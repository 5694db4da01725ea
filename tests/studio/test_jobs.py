"""Jobs: processes of their own that report, fail, are cancelled or killed, and leave nothing then."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import subprocess
import sys
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from pneutouch.errors import ComputationError
from pneutouch.results.record import plain
from pneutouch.studio import jobs as kept
from pneutouch.studio.jobs import Job, Jobs
from pneutouch.studio.server import bases_of

PLAYED = """
import json, pathlib, signal, subprocess, sys, time
request = json.loads(sys.stdin.readline())
folder, act = pathlib.Path(request["folder"]), request["arguments"]
def say(**line):
    print(json.dumps(line), flush=True)
if act.get("stubborn"):
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
if act.get("child"):
    script = "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); print(1, flush=True); time.sleep(600)"
    child = subprocess.Popen([sys.executable, "-S", "-c", script], stdout=subprocess.PIPE)
    child.stdout.readline()
    say(progress={"child": child.pid})
(folder / "dome").mkdir()
(folder / "dome/a.txt").write_text("whole")
say(progress={"done": 1, "total": 2, "what": "second half", **({"child": child.pid} if act.get("child") else {})})
if act.get("waits"):
    time.sleep(600)
if act.get("cut"):
    print('{"status": 2', end="", flush=True)
    sys.exit(0)
say(status=act.get("status", 200), content={"problems": [{"message": "no", "fields": []}]} if "status" in act else {"of": "dome"})
"""
"""Plays a job: what it does stands in its arguments."""


@asynccontextmanager
async def played(folder: Path):
    jobs = Jobs(folder, (sys.executable, "-S", "-c", PLAYED))
    try:
        yield jobs
    finally:
        await jobs.close()


async def ended(job: Job) -> None:
    while job.runs:
        await asyncio.sleep(0.005)


async def begun(job: Job) -> None:
    """Wait until the job has written its file and said so."""
    while job.progress.get("done") != 1:
        assert job.state == "running"
        await asyncio.sleep(0.005)


def gone(pid: int) -> bool:
    """Whether a process has ended; one that nobody has asked for its code still has an entry."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except OSError:
        return True


def left(folder: Path) -> list[Path]:
    return sorted(path for path in folder.rglob("*") if path.is_file())


def test_progress_then_content_and_files(tmp_path):
    async def run():
        async with played(tmp_path) as jobs:
            job = await jobs.start("build", {})
            assert plain(job.record)["files"] == []
            await ended(job)
            assert jobs.records == [job.record]
            return job.ticket, plain(job.record)

    ticket, record = asyncio.run(run())
    assert record == {
        "job": 1,
        "ticket": ticket,
        "kind": "build",
        "state": "done",
        "progress": {"done": 1, "total": 2, "what": "second half"},
        "status": 200,
        "content": {"of": "dome"},
        "files": [{"name": "dome/a.txt", "bytes": 5}],
    }


@pytest.mark.parametrize("status", [422, 500])
def test_an_error_is_its_answer_and_nothing_is_kept(status, tmp_path):
    async def run():
        async with played(tmp_path) as jobs:
            job = await jobs.start("build", {"status": status})
            await ended(job)
            return plain(job.record)

    document = asyncio.run(run())
    assert (document["state"], document["status"], document["files"]) == ("failed", status, [])
    assert document["content"]["problems"][0]["message"] == "no"
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("manner", [{}, {"stubborn": True}, {"child": True}], ids=["usual", "stubborn", "with a child"])
def test_cancelled_it_ends_with_all_it_started_and_leaves_nothing(manner, tmp_path, monkeypatch):
    if "stubborn" in manner:
        monkeypatch.setattr(kept, "_LAST_SECONDS", 0.2)

    async def run():
        async with played(tmp_path) as jobs:
            job = await jobs.start("build", {"waits": True, **manner})
            await begun(job)
            assert left(tmp_path)
            ending = asyncio.create_task(jobs.cancel(job))
            await asyncio.sleep(0)
            # Not before its process has ended is there room for another.
            assert (job.state, plain(job.record)["state"]) == ("cancelled", "running")
            with pytest.raises(ComputationError, match="another job is running"):
                await jobs.start("build", {})
            await ending
            assert plain(job.record)["state"] == "cancelled"
            child = job.progress.get("child")
            while child and not gone(child):
                await asyncio.sleep(0.005)
            again = await jobs.start("build", {})
            await ended(again)
            return job, again.state

    job, again = asyncio.run(run())
    assert (job.state, again) == ("cancelled", "done")
    assert job.process.returncode == -(signal.SIGKILL if "stubborn" in manner else signal.SIGTERM)
    assert not job.place.exists()
    assert job.files() == {}


def test_cancelled_before_its_process_is_there_it_never_does_anything(tmp_path):
    async def run():
        async with played(tmp_path) as jobs:
            job = await jobs.start("build", {"waits": True})
            await jobs.cancel(job)
            while job.process is None or job.runs:
                await asyncio.sleep(0.005)
            return job

    assert asyncio.run(run()).state == "cancelled"
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("manner", ["killed", "half a line"])
def test_ended_from_outside_it_has_failed_and_another_can_run(manner, tmp_path):
    async def run():
        async with played(tmp_path) as jobs:
            job = await jobs.start("build", {"waits": True} if manner == "killed" else {"cut": True})
            if manner == "killed":
                await begun(job)
                os.kill(job.process.pid, signal.SIGKILL)
            await ended(job)
            document, kept_files = plain(job.record), left(tmp_path)
            again = await jobs.start("build", {})
            await ended(again)
            return document, kept_files, again.state

    document, kept_files, again = asyncio.run(run())
    assert (document["state"], document["status"], again) == ("failed", 500, "done")
    assert "ended from outside" in document["content"]["problems"][0]["message"]
    assert kept_files == []


def test_one_runs_at_a_time_and_a_brief_one_beside_it(tmp_path):
    async def run():
        async with played(tmp_path) as jobs:
            await jobs.start("build", {"waits": True})
            with pytest.raises(ComputationError, match="another job is running: build; wait for it, or cancel it"):
                await jobs.start("build", {})
            await jobs.start("open", {"waits": True})
            with pytest.raises(ComputationError, match="another job is running: open"):
                await jobs.start("open", {})

    asyncio.run(run())


def test_closing_ends_what_runs(tmp_path):
    async def run():
        async with played(tmp_path) as jobs:
            both = [await jobs.start(kind, {"waits": True}) for kind in ("build", "open")]
            for job in both:
                await begun(job)
        return both

    for job in asyncio.run(run()):
        assert job.state == "cancelled"
        assert gone(job.process.pid)
    assert list(tmp_path.iterdir()) == []


def test_the_oldest_of_a_kind_goes_and_others_stay(tmp_path, monkeypatch):
    monkeypatch.setattr(kept, "KEPT", 2)

    async def run():
        async with played(tmp_path) as jobs:
            for kind in ("build", "open", "open", "open"):
                await ended(await jobs.start(kind, {}))
            return [(each.job, each.kind) for each in jobs.records]

    assert asyncio.run(run()) == [(1, "build"), (3, "open"), (4, "open")]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["job-1", "job-3", "job-4"]


@pytest.fixture
def building(tmp_path):
    """The process of a job as the studio starts it, at the second stage of a build into ``tmp_path``."""
    bases, first = bases_of(None)
    arguments = {"question": {"base": first, "values": {}}, "bases": bases, "files": []}
    request = {"kind": "build", "arguments": arguments, "folder": str(tmp_path)}
    command, pipe = [sys.executable, "-m", "pneutouch.studio.job"], subprocess.PIPE
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=pipe, start_new_session=True) as process:
        process.stdin.write(json.dumps(request).encode() + b"\n")
        process.stdin.flush()
        while json.loads(process.stdout.readline())["progress"]["what"] != "STEP":
            assert process.poll() is None
        yield process
        process.kill()


@pytest.mark.slow
@pytest.mark.parametrize("manner", ["SIGTERM", "its studio was killed"])
def test_a_build_that_is_ended_unwinds_and_leaves_nothing(manner, building, tmp_path):
    if manner == "SIGTERM":
        building.terminate()
    else:
        # What the system does to the pipes of a process that is killed.
        building.stdin.close()
    assert building.wait(60) == 143
    assert building.stderr.read() == b""
    assert list(tmp_path.iterdir()) == []
