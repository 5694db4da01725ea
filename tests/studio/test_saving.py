"""Designs saved from the page: the files of the command, under checked names, never over a file unasked."""

from __future__ import annotations

import pytest

from pneutouch.catalogue import DesignSource, Library
from pneutouch.studio.design_jobs import build_design, nearest_state
from pneutouch.studio.form import PageLibrary
from pneutouch.studio.guard import CHANGED, ChangedFileError
from pneutouch.studio.solver import answered
from tests.conftest import ROOT
from tests.refusals import refused
from tests.studio.test_guard import ASK

WALL = {"membrane.wall_thickness_mm": "1.4", "pneumatics.driving_pressures_kPa": "[0, 12]"}
WORDS = ["--set", "membrane.wall_thickness_mm=1.4", "--set", "pneumatics.driving_pressures_kPa=0,12"]


@pytest.fixture
def home(tmp_path, monkeypatch):
    """The folder in which the studio was started; the command of the other tests writes elsewhere."""
    folder = tmp_path / "home"
    folder.mkdir()
    monkeypatch.setenv("PNEUTOUCH_HOME", str(folder))
    return folder


def saved(client, name, values=WALL, base="paper-dome", **more):
    request = {"question": {"base": base, "values": values}, "name": name, **more}
    return client.post("/api/designs", json=request, headers={"Origin": ASK["Origin"]})


def asked(client, base, values):
    question = {"base": base, "values": values}
    return client.post("/api/quick", json=question, headers={"Origin": ASK["Origin"]}).json()


def files(folder):
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize(("values", "words"), [(WALL, WORDS), ({}, [])], ids=["changed", "as it is"])
def test_it_is_the_file_of_the_command_and_then_among_the_designs(values, words, home, client, command, monkeypatch):
    answer = saved(client, "my-dome", values)
    assert answer.status_code == 200, answer.text
    assert answer.json() == {"name": "my-dome", "file": str(home / "designs/my-dome.toml")}
    assert files(home) == {"designs/my-dome.toml"}
    content = (home / "designs/my-dome.toml").read_bytes()
    assert "my-dome" in [one["name"] for one in client.get("/api/form").json()["designs"]]
    was, now = asked(client, "paper-dome", values), asked(client, "my-dome", {})
    assert now["name"] == "my-dome"
    assert {**now["values"], "document": 0} == {**was["values"], "document": 0}
    (home / "designs/my-dome.toml").unlink()
    done = command("new", "my-dome", "--from", "paper-dome", *words)
    assert done.returncode == 0, done.stderr
    assert (home / "designs/my-dome.toml").read_bytes() == content


def test_a_key_that_is_left_out_stays_so(home, client):
    assert saved(client, "mine", {"pneumatics.dead_volume_mL": None}).status_code == 200
    assert asked(client, "mine", {})["values"]["pneumatics"]["dead_volume_mL"] is None


def test_a_file_that_is_there_is_replaced_only_where_that_is_asked(home, client):
    assert saved(client, "mine", {}).status_code == 200
    before = (home / "designs/mine.toml").read_bytes()
    answer = saved(client, "mine")
    assert answer.status_code == 409
    assert answer.json()["problems"][0]["message"] == "there is such a file already; give another name, or replace it"
    assert (home / "designs/mine.toml").read_bytes() == before
    assert saved(client, "mine", replace=True).status_code == 200
    assert asked(client, "mine", {})["values"]["membrane"]["wall_thickness_mm"] == 1.4
    # Of the page's own design, changed once more.
    assert saved(client, "mine", {"membrane.wall_thickness_mm": "1.2"}, "mine", replace=True).status_code == 200
    assert asked(client, "mine", {})["values"]["membrane"]["wall_thickness_mm"] == 1.2
    assert files(home) == {"designs/mine.toml"}


def asked_at(client, version, path="quick", **values):
    question = {"base": "mine", "values": values, "version": version}
    return client.post(f"/api/{path}", json=question, headers={"Origin": ASK["Origin"]})


@pytest.fixture
def outdated(home, client):
    """The version of a design that one page read, and that another has saved in a new one since."""
    assert saved(client, "mine", {}).status_code == 200
    version = asked_at(client, None).json()["version"]
    assert saved(client, "mine", WALL, "mine", replace=True).status_code == 200
    return version


def test_a_page_does_not_compute_with_the_values_that_another_one_saved(outdated, client):
    for path in ("quick", "intervals", "view"):
        answer = asked_at(client, outdated, path)
        assert answer.status_code == CHANGED, path
        assert "mine" in answer.json()["problems"][0]["message"]
    # The page that takes the file as it is gets its version, and goes on with that.
    now = asked_at(client, None).json()
    assert now["values"]["membrane"]["wall_thickness_mm"] == 1.4
    for path in ("quick", "intervals", "view"):
        assert asked_at(client, now["version"], path).status_code == 200
    assert asked_at(client, 7).status_code == 422


def test_an_answer_that_is_kept_is_that_of_the_file_as_it_is(home, client):
    assert saved(client, "mine", {}).status_code == 200
    before = asked_at(client, None, "intervals").json()
    assert saved(client, "mine", WALL, "mine", replace=True).status_code == 200
    assert asked_at(client, None, "intervals").json() != before


def test_the_process_and_the_jobs_refuse_an_old_version(outdated, home):
    bases = {"mine": str(home / "designs/mine.toml")}
    question = {"base": "mine", "values": {}, "version": outdated}
    library = PageLibrary(Library.default().folders)
    assert answered({"question": question, "bases": bases}, library).status == CHANGED
    with pytest.raises(ChangedFileError):
        build_design({"question": question, "bases": bases}, home, lambda *words: None)
    assert files(home) == {"designs/mine.toml"}


def test_changes_to_an_old_version_are_not_saved(outdated, home, client):
    before = (home / "designs/mine.toml").read_bytes()
    question = {"base": "mine", "values": {"contact.friction": "0.3"}, "version": outdated}
    for name in ("mine", "other"):
        request = {"question": question, "name": name, "replace": True}
        assert client.post("/api/designs", json=request, headers={"Origin": ASK["Origin"]}).status_code == CHANGED
    assert (home / "designs/mine.toml").read_bytes() == before
    assert files(home) == {"designs/mine.toml"}


def test_comments_and_the_order_of_keys_are_no_other_version(home, client):
    assert saved(client, "mine").status_code == 200
    version = asked_at(client, None).json()["version"]
    file = home / "designs/mine.toml"
    file.write_text(f"# a comment\n{file.read_text()}")
    assert asked_at(client, version).status_code == 200


def test_the_state_of_a_design_that_was_found_is_of_a_version(home, client):
    assert saved(client, "mine").status_code == 200
    bases, library = {"mine": str(home / "designs/mine.toml")}, Library.default()
    source = DesignSource.of(bases["mine"], library)
    assert nearest_state(source, bases, library).version == asked_at(client, None).json()["version"]


NAMES = [
    *("", " ", ".", "..", "../x", "/etc/x", "a/b", "a\\b", "..\\x", ".hidden", "a\0b", "a\nb", "-rf", "~", "a:b"),
    "x" * 200,
]
"""Paths, hidden names and what no file can be called."""


def test_names_that_are_paths_or_none_are_refused(home, client):
    for name in NAMES:
        for replace in (False, True):
            answer = saved(client, name, replace=replace)
            assert answer.status_code == 422, name
            assert "cannot be a name; use letters" in answer.json()["problems"][0]["message"]
    assert files(home.parent) == set()


@pytest.mark.parametrize(
    ("request_", "says"),
    [
        ({"name": 7}, "name is a text"),
        ({"name": "x", "replace": 1}, "replace is true or false"),
        ({"name": "x", "folder": "/etc"}, "has the keys"),
        ({"name": "paper-dome"}, "which the new file would hide"),
        ({"name": "paper-dome", "replace": True}, "which the new file would hide"),
        ({"name": "x", "question": {"base": "../../etc/passwd", "values": {}}}, "unknown design"),
        (
            {"name": "x", "question": {"base": "paper-dome", "values": {"membrane.wall_thickness_mm": "99"}}},
            "from 0.05",
        ),
    ],
)
def test_what_cannot_be_saved_is_one_clear_error(request_, says, home, client):
    request = {"question": {"base": "paper-dome", "values": {}}, **request_}
    answer = client.post("/api/designs", json=request, headers={"Origin": ASK["Origin"]})
    assert answer.status_code == 422
    assert says in answer.json()["problems"][0]["message"]
    assert files(home) == set()


def test_links_and_folders_are_not_followed(home, client):
    (home / "designs/folder.toml").mkdir(parents=True)
    (home / "theirs.toml").write_text("theirs")
    (home / "designs/link.toml").symlink_to(home / "theirs.toml")
    (home / "designs/dangling.toml").symlink_to(home / "nothing.toml")
    for name in ("folder", "link", "dangling"):
        assert saved(client, name).status_code == 409
    assert "this is a folder" in saved(client, "folder", replace=True).text
    assert saved(client, "link", replace=True).status_code == 200
    assert (home / "theirs.toml").read_text() == "theirs"
    assert not (home / "nothing.toml").exists()


def test_a_design_that_is_open_from_elsewhere_keeps_its_name(home):
    from pneutouch.studio.form import save_design

    (home / "mine.toml").write_text("[membrane]\nwall_thickness_mm = 1\n")
    bases = {"mine": str(home / "mine.toml")}
    request = {"question": {"base": "mine", "values": WALL}, "name": "mine"}
    with refused("name", "mine"):
        save_design(request, bases)
    assert save_design({**request, "name": "other"}, bases)["name"] == "other"
    assert files(home) == {"mine.toml", "designs/other.toml"}


def test_new_changes_a_design_as_it_copies_it(command, tmp_path):
    assert command("new", "mine", "--from", "paper-dome", "--set", "membrane.wall_thickness_mm=2").returncode == 0
    assert "wall_thickness_mm = 2" in (tmp_path / "designs/mine.toml").read_text()
    for words, says in (
        (["other", "--set", "membrane.wall_thickness_mm=99"], "must be from 0.05 to 50"),
        (["--from", "paper-dome", "--set", "membrane.wall_thickness_mm=2"], "paper-dome is the name of the original"),
        (["other", "--from", "paper-dome", "--set", "membrane.wall_thickness_mm=99"], "must be from 0.05 to 50"),
        (["other", "--from", "fingertip", "--set", "membrane.wall_thickness_mm=2"], "no such design"),
        (["mine", "--from", "paper-dome", "--set", "membrane.wall_thickness_mm=2"], "there is such a file already"),
    ):
        done = command("new", *words)
        assert done.returncode == 2
        assert says in done.stderr
    assert files(tmp_path) == {"designs/mine.toml"}
    assert (ROOT / "designs/paper-dome.toml").is_file()
