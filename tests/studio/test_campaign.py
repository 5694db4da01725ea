"""A campaign's folder is made of what was given, and of nothing else."""

from __future__ import annotations

import pytest

from pneutouch.errors import InputError
from pneutouch.spec.campaign import campaign_of
from pneutouch.studio.measured import placed, write_runs
from tests.refusals import refused

LONG = ["x" * 300, "a/" * 20 + "b.csv"]
PLAN = '[[runs]]\nfile = "runs/a.csv"\nsensor = "A"\nresin = "TangoPlus"\n'


def given(folder, **contents):
    """Files by path: the names that the studio keeps them by are not those."""
    files = []
    for place, content in enumerate(contents.values()):
        path = folder / f"upload-{place}"
        path.write_text(content)
        files.append({"name": path.name, "path": str(path)})
    return files, list(contents)


@pytest.fixture
def place(tmp_path):
    (tmp_path / "place").mkdir()
    return tmp_path / "place"


def inside(place):
    return sorted(path.relative_to(place).as_posix() for path in place.rglob("*") if path.is_file())


def test_a_folder_keeps_its_name_and_its_files(tmp_path, place):
    files, paths = given(tmp_path, **{"mine/campaign.toml": PLAN, "mine/runs/a.csv": "1", "mine/notes.txt": "2"})
    folder, found = placed(files, paths, place)
    assert (str(folder), found) == ("mine", ["campaign.toml", "runs/a.csv", "notes.txt"])
    assert inside(place) == ["mine/campaign.toml", "mine/notes.txt", "mine/runs/a.csv"]
    assert (place / "mine/runs/a.csv").read_text() == "1"


def test_files_chosen_one_by_one_go_where_the_campaign_names_them(tmp_path, place):
    files, paths = given(tmp_path, **{"a.csv": "1", "campaign.toml": PLAN, "b.csv": "2"})
    folder, found = placed(files, paths, place)
    assert (str(folder), sorted(found)) == ("campaign", ["b.csv", "campaign.toml", "runs/a.csv"])
    assert inside(place) == ["campaign/b.csv", "campaign/campaign.toml", "campaign/runs/a.csv"]
    assert (tmp_path / "upload-0").read_text() == "1"


def test_files_beside_the_campaign_s_folder_are_left_out(tmp_path, place):
    files, paths = given(tmp_path, **{"x/campaign.toml": PLAN, "y/a.csv": "1"})
    folder, found = placed(files, paths, place)
    assert (str(folder), found) == ("x", ["campaign.toml"])
    assert inside(place) == ["x/campaign.toml"]


def test_runs_without_a_campaign_are_stated_in_one(tmp_path, place):
    files, paths = given(tmp_path, **{"lab/monday/a.csv": "1", "lab/monday/b.csv": "2"})
    folder, found = placed(files, paths, place)
    assert (str(folder), found) == ("lab/monday", ["a.csv", "b.csv"])
    write_runs(place / folder, [{"file": "a.csv", "sensor": "A", "resin": "TangoPlus", "driving_pressure_kPa": 7.5}])
    campaign, _ = campaign_of(place / folder)
    assert [(run.file, run.driving_pressure_kPa) for run in campaign.runs] == [("a.csv", 7.5)]


@pytest.mark.parametrize(
    "path",
    [
        "",
        "/etc/passwd",
        "../a.csv",
        "a/../../b.csv",
        "a//b.csv",
        "./a.csv",
        "a/",
        "a\\..\\b.csv",
        "a\0.csv",
        "a\nb.csv",
        *LONG,
    ],
)
def test_a_path_that_leads_elsewhere_is_refused(path, tmp_path, place):
    files, paths = given(tmp_path, **{"good.csv": "0", path: "1"})
    with refused("paths"):
        placed(files, paths, place)
    assert inside(place) == []


@pytest.mark.parametrize("named", ["../../upload-0", "/etc/passwd", "..", "a\\b.csv", "passwd/passwd"])
def test_a_campaign_brings_no_file_to_another_place(named, tmp_path, place):
    plan = PLAN.replace('"runs/a.csv"', f"'{named}'")
    files, paths = given(tmp_path, **{"passwd": "1", "campaign.toml": plan})
    placed(files, paths, place)
    assert inside(place) == ["campaign/campaign.toml", "campaign/passwd"]


@pytest.mark.parametrize(
    ("paths", "words"),
    [
        (["a.csv", "a.csv"], "two files of this name"),
        (["a/campaign.toml", "b/campaign.toml"], "2 campaign files"),
        (["a.csv"], "each file has one path"),
    ],
)
def test_what_cannot_be_one_campaign_is_refused(paths, words, tmp_path, place):
    files, _ = given(tmp_path, one=PLAN, two=PLAN)
    with pytest.raises(InputError, match=words):
        placed(files, paths, place)
    assert inside(place) == []


def test_a_run_in_the_place_of_a_folder_is_refused(tmp_path, place):
    files, paths = given(tmp_path, **{"a": "1", "a/b.csv": "2"})
    with refused("file", "a"):
        placed(files, paths, place)
