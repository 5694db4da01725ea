"""What the desk hands out: files of jobs, a sheet to be shown in place, archives; and its end."""

from __future__ import annotations

import io
import os
import stat
import sys
import zipfile
from contextlib import asynccontextmanager
from pathlib import Path

import pytest
from starlette.applications import Starlette
from starlette.testclient import TestClient

from pneutouch.studio.design_jobs import build_design
from pneutouch.studio.guard import HEADERS, KEY, SHEET, Guard
from pneutouch.studio.jobs import Desk, Job, Jobs
from pneutouch.workflows.build import CONTENTS, described
from tests.conftest import ROOT
from tests.refusals import refused
from tests.studio.conftest import HOME, PORT, TOKEN, admitted
from tests.studio.test_guard import ASK
from tests.studio.test_jobs import PLAYED, gone


class Opened:
    """A desk whose jobs are played, and a client that opened its address."""

    def __init__(self) -> None:
        self.desk = Desk({"paper-dome": "paper-dome"})
        self.place = Path(self.desk._place.name)
        self.desk.jobs = Jobs(self.place, (sys.executable, "-S", "-c", PLAYED))
        application = Starlette(routes=self.desk.routes(), lifespan=self.running)
        application.router.redirect_slashes = False
        guarded = Guard(application, PORT, TOKEN)
        self.client = TestClient(guarded, base_url=HOME, follow_redirects=False)

    @asynccontextmanager
    async def running(self, application):
        yield
        await self.desk.close()

    def done(self, **files: bytes) -> str:
        """The ticket of a job that has written files."""
        job = Job(1, "build", self.place / "job-1")
        for name, content in files.items():
            path = job.folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
        job.state = "done"
        self.desk.jobs._jobs[1] = job
        return job.ticket

    def post(self, path, content):
        return self.client.post(path, json=content, headers={"Origin": ASK["Origin"]})


@pytest.fixture
def opened():
    here = Opened()
    with here.client:
        admitted(here.client)
        yield here
    assert not here.place.exists()


def test_a_sheet_shown_in_place_has_a_policy_of_its_own_and_nothing_else_has(opened):
    ticket = opened.done(**{"dome/datasheet.html": b"<p>sheet</p>", "dome/dome.3mf": b"PK"})
    shown = opened.client.get(f"/files/{ticket}/dome/datasheet.html?show=1")
    assert shown.headers.get_list("content-security-policy") == [SHEET["Content-Security-Policy"]]
    assert shown.headers["content-disposition"].startswith("inline")
    for name, value in HEADERS.items():
        assert name == "Content-Security-Policy" or shown.headers[name] == value
    for path in ("dome/datasheet.html", "dome/datasheet.html?show=0", "dome/dome.3mf", "none"):
        taken = opened.client.get(f"/files/{ticket}/{path}")
        assert taken.headers.get_list("content-security-policy") == [HEADERS["Content-Security-Policy"]], path
        if path != "none":
            assert taken.headers["content-disposition"].startswith("attachment")


def test_the_policy_of_a_sheet_gives_it_no_origin_and_no_way_out():
    policy = dict(each.strip().partition(" ")[::2] for each in SHEET["Content-Security-Policy"].split(";"))
    assert policy["default-src"] == "'none'"
    assert policy["sandbox"] == "allow-scripts"
    assert policy["frame-ancestors"] == "'self'"
    assert policy["form-action"] == policy["base-uri"] == "'none'"
    assert {name for name, sources in policy.items() if name.endswith("-src") and sources != "'none'"} == {
        "script-src",
        "style-src",
        "img-src",
        "font-src",
    }
    assert not any(word in sources for sources in policy.values() for word in ("http", "blob:", "*", "'self' ", "eval"))


def test_an_archive_has_all_files_and_the_same_bytes_each_time(opened):
    files = {"dome/a.txt": b"a" * 99, "dome/stl/b.stl": b"b"}
    ticket = opened.done(**files)
    answer = opened.client.get(f"/files/{ticket}.zip")
    assert answer.headers["content-disposition"] == 'attachment; filename="dome.zip"'
    with zipfile.ZipFile(io.BytesIO(answer.content)) as archive:
        assert {name: archive.read(name) for name in archive.namelist()} == files
        assert {stat.S_IMODE(entry.external_attr >> 16) for entry in archive.infolist()} == {0o644}
    (opened.place / "job-1/dome.zip").unlink()
    os.utime(opened.place / "job-1/files/dome/a.txt", (1, 1))
    assert opened.client.get(f"/files/{ticket}.zip").content == answer.content


def test_a_ticket_reads_the_files_of_its_job_and_is_no_key(opened):
    ticket = opened.done(**{"dome/a.txt": b"a"})
    key = opened.client.headers.pop(KEY)
    assert opened.client.get(f"/files/{ticket}/dome/a.txt").content == b"a"
    assert opened.client.get(f"/files/{ticket}.zip").status_code == 200
    for other in ("x", ticket[1:], f"{ticket}x", key, "1", "é"):
        assert opened.client.get(f"/files/{other}/dome/a.txt").status_code == 404
        assert opened.client.get(f"/files/{other}.zip").status_code == 404
    assert opened.client.get("/api/jobs/1", headers={KEY: ticket}).status_code == 403
    assert opened.client.get(f"/files/{ticket}.zip", headers={"Sec-Fetch-Site": "same-site"}).status_code == 403
    assert opened.client.get(f"/files/{ticket}.zip", headers={"Host": "127.0.0.1:8124"}).status_code == 403


def test_no_path_leads_out_of_a_job(opened):
    ticket = opened.done(**{"dome/a.txt": b"a"})
    (opened.place / "job-1/secret").write_text("secret")
    (opened.place / "job-1/files/dome/link").symlink_to(opened.place / "job-1/secret")
    for path in (
        "../secret",
        "..%2fsecret",
        "dome/../../secret",
        "dome/link",
        "/etc/passwd",
        "%2fetc%2fpasswd",
        "dome",
        "",
    ):
        assert opened.client.get(f"/files/{ticket}/{path}").status_code == 404, path


def test_a_second_page_is_refused_and_finds_the_job_of_the_first(opened):
    begun = opened.post("/api/jobs/build", {"waits": True})
    assert begun.status_code == 202
    refused = opened.post("/api/jobs/build", {})
    assert refused.status_code == 409
    assert refused.json()["problems"][0]["message"] == "another job is running: build; wait for it, or cancel it"
    (known,) = opened.client.get("/api/jobs").json()["jobs"]
    assert (known["job"], known["kind"], known["state"]) == (begun.json()["job"], "build", "running")
    assert opened.post(f"/api/jobs/{known['job']}/cancel", {}).json()["state"] == "cancelled"
    assert opened.client.get(f"/files/{known['ticket']}.zip").status_code == 404


def test_the_end_of_the_studio_ends_a_job_and_removes_what_was_kept():
    here = Opened()
    with here.client:
        admitted(here.client)
        here.post("/api/jobs/build", {"waits": True})
        while here.client.get("/api/jobs/1").json()["progress"].get("done") != 1:
            pass
        sent = {"Origin": HOME, "Content-Type": "application/octet-stream"}
        assert here.client.post("/api/uploads?name=a.csv", content=b"1", headers=sent).status_code == 200
        process = here.desk.jobs[1].process
    assert gone(process.pid)
    assert not here.place.exists()


def test_the_words_on_files_are_those_of_the_reference():
    text = (ROOT / "docs" / "reference" / "files.md").read_text()
    lines = text[text.index("| in `outputs/paper-dome/` |") :].split("\n\n")[0].splitlines()[2:]
    rows = [line.split("|")[1:3] for line in lines]
    table = {names.strip(): words.strip() for names, words in rows}
    for patterns, words in CONTENTS:
        if patterns == ("mould/*",):
            # Only a cast design has one: it stands below the table.
            assert words.partition("its mould, ")[2] in " ".join(text.split())
            continue
        if patterns == ("NAME-gasket.dxf",):
            assert "`paper-dome-gasket.dxf`, the outline for a laser cutter in mm" in text
            continue
        files = {
            ("stl/*.stl",): ["stl/membrane.stl", "stl/connector.stl"],
            ("jobs/*.3mf",): ["jobs/NAME-membrane.3mf", "jobs/NAME-connector.3mf"],
            ("jobs/*.ini",): ["jobs/NAME-connector.ini"],
        }.get(patterns, patterns)
        assert table.pop(", ".join(f"`{each}`" for each in files).replace("NAME", "paper-dome")) == words
    assert table == {}


def test_every_file_of_a_build_is_described_once(built):
    folder = built("paper-dome")
    names = sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file())
    groups = described(names, "paper-dome")
    assert sorted(name for there, _ in groups for name in there) == names
    assert all(words for _, words in groups)
    assert groups[0][0] == ["datasheet.html", "datasheet.pdf"]
    assert described(["a.txt", "paper-dome.3mf"], "paper-dome")[-1] == (["a.txt"], "")


@pytest.mark.parametrize("name", ["../x", "a/b", ".", "a\nb", 7, "x" * 200])
def test_a_build_of_no_name_is_refused_before_anything_is_computed(name, tmp_path):
    arguments = {"question": {"base": "paper-dome", "values": {}}, "bases": {"paper-dome": "paper-dome"}, "name": name}
    with refused("name"):
        build_design(arguments, tmp_path, lambda *_: pytest.fail("computed"))
    assert list(tmp_path.iterdir()) == []
