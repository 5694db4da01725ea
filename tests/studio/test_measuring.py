"""What the area Measure answers is what ``characterize`` and ``calibrate`` print, and nothing is written unasked."""

from __future__ import annotations

import json
import shlex
import shutil
from dataclasses import replace

import pytest

from pneutouch.catalogue.library import HOME
from pneutouch.errors import InputError
from pneutouch.results.record import plain
from pneutouch.spec.toml_text import toml_text
from pneutouch.studio import measuring
from tests.bench.recordings import READ, by_hand
from tests.bench.rig import small
from tests.studio.campaigns import BASES, NAME, PLAIN, SENSOR, silent, simulated, uploaded
from tests.tables.instruments import INSTRUMENTS

STEPS = f"runs/{SENSOR}-0kPa-steps-1.csv"
COLUMNS = [("time", "s"), ("position", "mm"), ("force", "N"), ("pressure", "kPa")]


@pytest.fixture(scope="module")
def campaign(tmp_path_factory, library):
    return simulated(tmp_path_factory.mktemp("made"), library)


@pytest.fixture
def mine(tmp_path, monkeypatch):
    """The user's folder."""
    monkeypatch.setenv(HOME, str(tmp_path / "mine"))
    return tmp_path / "mine"


@pytest.fixture
def ask(tmp_path):
    """Does a job in a new folder, which stands below ``ask.folders``."""

    def job(run, files, **more):
        folder = tmp_path / f"job-{len(job.folders)}" / "files"
        folder.mkdir(parents=True)
        job.folders.append(folder)
        content = run({**files, "bases": BASES, "design": PLAIN, **more}, folder, silent)
        return json.loads(json.dumps(plain(content)))

    job.folders = []
    return job


def printed(done):
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.mark.slow
def test_every_run_of_a_plan_is_recognised(campaign, ask):
    found = ask(measuring.recognised, uploaded(campaign))
    assert (found["planned"], found["design"], found["simulated"]) == (True, "paper-dome", True)
    assert [run["kind"] for run in found["runs"]].count("steps") == 2
    assert {run["problem"] for run in found["runs"]} == {None}
    for run in found["runs"]:
        channels = [(column["channel"], column["unit"]) for column in run["columns"]]
        assert channels == (COLUMNS if run["kind"] == "steps" else [("volume", "mL"), ("pressure", "kPa")])
        assert not any(column["found"] for column in run["columns"])


def test_the_columns_of_every_instrument_are_found(tmp_path, ask):
    short = small(rate=25.0, depths=(1.0, 3.0))
    lab = tmp_path / "lab"
    lab.mkdir()
    names = [make(lab, *short[:3], 1e3 * short[3]).name for make in INSTRUMENTS]
    runs = [{"file": name, "sensor": f"S{place}", "resin": "TangoPlus"} for place, name in enumerate(names)]
    (lab / "campaign.toml").write_text(toml_text({"design": "paper-dome", "runs": runs}))
    found = ask(measuring.recognised, uploaded(lab))
    assert [run["file"] for run in found["runs"]] == names
    for run in found["runs"]:
        assert run["problem"] is None, run
        assert [column["channel"] for column in run["columns"]] == ["time", "position", "force", "pressure"]
        assert any(column["found"] for column in run["columns"]) == (run["file"] in found["read_as"])
    assert 'position = { name = "Standardweg", unit = "' in found["read_as"]


def test_a_damaged_file_is_named_and_the_others_are_found(campaign, tmp_path, ask):
    folder = shutil.copytree(campaign, tmp_path / NAME)
    lines = (folder / STEPS).read_text().replace("force_N", "Moment_Nm")
    (folder / STEPS).write_text(lines)
    found = ask(measuring.recognised, uploaded(folder))
    (wrong,) = [run for run in found["runs"] if run["problem"]]
    assert wrong["file"] == STEPS
    assert wrong["problem"].startswith(f"{NAME}/{STEPS}: ")
    assert "no column of force" in wrong["problem"]
    stated = ask(measuring.recognised, uploaded(folder), columns="force=Moment_Nm:N")
    assert {run["problem"] for run in stated["runs"]} == {None}


def test_runs_without_a_plan_are_proposed_at_the_pressure_that_they_show(campaign, ask):
    found = ask(measuring.recognised, uploaded(campaign, within="", only=("*steps*.csv", "truth.json")))
    assert not found["planned"]
    assert [run["driving_pressure_kPa"] for run in found["runs"]] == [0.0, 22.0]
    assert {(run["sensor"], run["resin"], run["kind"]) for run in found["runs"]} == {("sensor-1", "TangoPlus", "steps")}
    assert found["unused"] == ["truth.json"]
    with pytest.raises(InputError, match="names the design"):
        ask(measuring.recognised, uploaded(campaign, only=("*steps*.csv",)), design=None)


def test_runs_without_a_plan_are_proposed_as_what_they_show(tmp_path, ask):
    """Presses without a stay, a press by hand and a leak: read as steps they would give no curve, or a wrong one."""
    (tmp_path / "lab").mkdir()
    hand = replace(READ["triangular"], write=by_hand)
    for name, recording in (("a.csv", READ["triangular"]), ("b.csv", hand), ("c.csv", READ["stairs without return"])):
        (tmp_path / "lab" / name).write_text(recording.text())
    rows = "\n".join(f"{0.01 * k:.2f},{5 - 1e-5 * k:.5f}" for k in range(3000))
    (tmp_path / "lab/d.csv").write_text(f"time_s,pressure_kPa\n{rows}\n")
    found = ask(measuring.recognised, uploaded(tmp_path / "lab", within=""))
    assert [run["problem"] for run in found["runs"]] == [None] * 4
    assert [run["kind"] for run in found["runs"]] == ["loop", "hand", "steps", "leak"]


def test_text_that_is_no_run_is_refused_in_the_words_of_the_command(tmp_path, ask):
    (tmp_path / "lab").mkdir()
    (tmp_path / "lab/note.csv").write_text("what we did\n")
    found = ask(measuring.recognised, uploaded(tmp_path / "lab", within=""))
    assert found["runs"][0]["problem"].startswith("campaign/note.csv: ")
    runs = [{key: found["runs"][0][key] for key in ("file", "kind", "sensor", "resin")}]
    with pytest.raises(InputError, match="none of its files can be read"):
        ask(measuring.characterize, uploaded(tmp_path / "lab", within=""), runs=runs)
    with pytest.raises(InputError, match=r"runs\[0\]\.file.*leads out of the folder"):
        ask(measuring.characterize, uploaded(tmp_path / "lab", within=""), runs=[{**runs[0], "file": "../../a.csv"}])


@pytest.mark.parametrize("value", [10**400, float("nan"), True, "12"])
def test_a_pressure_that_is_no_number_is_refused_by_its_key(campaign, ask, value):
    with pytest.raises(InputError, match=r"hold_out_kPa\[1\]( = .*)?: must be "):
        ask(measuring.calibrate, uploaded(campaign), hold_out_kPa=[12, value])


@pytest.mark.parametrize("rows", ["9" * 5000, "1e300", "-1", "2.5", "two"])
def test_rows_that_are_no_count_are_refused_by_their_key(campaign, ask, rows):
    with pytest.raises(InputError, match="skip_rows"):
        ask(measuring.recognised, uploaded(campaign), format={"skip_rows": rows})


@pytest.mark.slow
def test_a_calibration_is_that_of_the_command_and_is_kept_only_where_it_is_saved(
    campaign, mine, tmp_path, ask, command
):
    asked = {"sensor": SENSOR, "hold_out_kPa": [22]}
    content = ask(measuring.calibrate, uploaded(campaign), **asked)
    assert not mine.exists()
    assert content["saved"] is None
    shutil.copytree(campaign, tmp_path / NAME)
    words = shlex.split(content["command"])[1:]
    document = printed(command(*words, "--json"))
    written = document.pop("written")
    assert {key: value for key, value in content["document"].items() if key != "written"} == document
    name = document["calibration"]
    by_command = (mine / "calibrations" / f"{name}.toml").read_bytes()
    assert (ask.folders[0] / f"calibrations/{name}.toml").read_bytes() == by_command
    chart = ask.folders[0] / content["chart"]
    assert chart.read_bytes() == (tmp_path / written[0] / "residuals.svg").read_bytes()

    saved = ask(measuring.calibrate, uploaded(campaign), **asked, save=name)
    assert saved["saved"] == str(mine / "calibrations" / f"{name}.toml")
    assert saved["opens"] == {"base": "paper-dome", "values": {"calibration": name}}
    assert saved["command"].endswith(f"--save {name}")
    assert (mine / "calibrations" / f"{name}.toml").read_bytes() == by_command

    other = {**asked, "fit": ["modulus", "offset"], "save": name}
    with pytest.raises(InputError, match="of other content"):
        ask(measuring.calibrate, uploaded(campaign), **other)
    assert (mine / "calibrations" / f"{name}.toml").read_bytes() == by_command
    replaced = ask(measuring.calibrate, uploaded(campaign), **other, replace=True)
    assert [one["parameter"] for one in replaced["document"]["estimates"]] == ["modulus", "offset"]
    assert (mine / "calibrations" / f"{name}.toml").read_bytes() != by_command


@pytest.mark.parametrize("name", ["../x", "a/b", "", "none", "x.toml", ".x"])
def test_a_calibration_has_a_name_that_is_no_path(name, campaign, mine, ask):
    with pytest.raises(InputError, match="save"):
        ask(measuring.calibrate, uploaded(campaign), sensor=SENSOR, save=name)
    assert not mine.exists()


@pytest.mark.slow
def test_a_characterization_is_that_of_the_command(campaign, tmp_path, ask, command):
    folder = shutil.copytree(campaign, tmp_path / NAME)
    (folder / STEPS).write_text((folder / STEPS).read_text()[:40_000] + "1,2,x,3\n")
    content = ask(
        measuring.characterize,
        uploaded(folder),
        design={"base": "paper-dome", "values": {"membrane.wall_thickness_mm": "1.6"}},
    )
    said = command(*shlex.split(content["command"])[1:], "--json")
    assert said.returncode == 3
    document = json.loads(said.stdout)
    measured = tmp_path / document.pop("folder")
    assert content["document"] == document
    (failed,) = [run for run in content["runs"] if run["problem"]]
    assert (failed["file"], failed["problem"]) == (STEPS, document["failures"][0]["message"])
    assert failed["problem"].partition(f"{STEPS}: ")[2] in said.stderr and STEPS in said.stderr
    for path in measured.rglob("*"):
        if path.is_file():
            assert (ask.folders[0] / measured.name / path.relative_to(measured)).read_bytes() == path.read_bytes()
    (group,) = content["groups"]
    for row in group["figures"]:
        figure = document["groups"][0]["figures"][row["key"]]
        assert (row["value"], row["low"], row["high"]) == (figure["value"], figure["low"], figure["high"])
        if row.get("agrees") is not None:
            low, high = row["low"] or row["value"], row["high"] or row["value"]
            assert row["agrees"] == (low <= row["predicted"]["high"] and row["predicted"]["low"] <= high)


@pytest.mark.slow
def test_the_paper_s_sensitivity_stands_beside_that_of_its_sensor_alone(campaign, ask):
    def published(values):
        design = {"base": "paper-dome", "values": values}
        groups = ask(measuring.characterize, uploaded(campaign), design=design)["groups"]
        return [
            row.get("published")
            for group in groups
            for row in group["figures"]
            if row["key"].startswith("sensitivity_kPa")
        ]

    assert published({}) == [2.547, 1.923]
    assert published({"membrane.wall_thickness_mm": "1.6"}) == [None, None]


@pytest.mark.slow
def test_the_campaign_file_of_runs_without_one_leads_the_command_to_the_same_figures(campaign, tmp_path, ask, command):
    files = uploaded(campaign / "runs", within="lab", only=("*steps*.csv",))
    runs = ask(measuring.recognised, files)["runs"]
    stated = [{key: run[key] for key in ("file", "kind", "sensor", "resin", "driving_pressure_kPa")} for run in runs]
    content = ask(measuring.characterize, files, runs=stated)
    assert "campaign.toml" in content["before"]
    shutil.copytree(campaign / "runs", tmp_path / "lab")
    shutil.copyfile(ask.folders[1] / "campaign.toml", tmp_path / "lab/campaign.toml")
    document = printed(command(*shlex.split(content["command"])[1:], "--json"))
    document.pop("folder")
    assert content["document"] == document
