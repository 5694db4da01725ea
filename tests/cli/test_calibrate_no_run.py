"""``pneutouch calibrate`` where no run of the sensor can be used: what it says of each file, also beside another's."""

from __future__ import annotations

import shutil
import tomllib

import pandas
import pytest
from typer.testing import CliRunner

from pneutouch.cli import calibrate, simulate
from pneutouch.cli.app import app
from pneutouch.spec.toml_text import toml_text

assert calibrate and simulate

A, B = (f"runs/TangoPlus-{k}-0kPa-steps-1.csv" for k in (1, 2))


def run(*arguments: str):
    return CliRunner().invoke(app, list(arguments))


@pytest.fixture(scope="module")
def simulated(tmp_path_factory):
    """Two specimens, one run of steps and one loop of each."""
    out = tmp_path_factory.mktemp("simulated")
    words = "--resins TangoPlus --specimens 2 --pressures 0 --runs 1 --kinds steps,loop --rest 10 --model atlas --out"
    result = run("simulate", "paper-dome", *words.split(), str(out))
    assert result.exit_code == 0, result.stderr
    return out / "paper-dome-campaign"


@pytest.fixture
def folder(simulated, tmp_path, monkeypatch):
    """A copy of the campaign, to change."""
    monkeypatch.chdir(tmp_path)
    return shutil.copytree(simulated, tmp_path / "lab")


def absolute(path):
    """The run's pressure as a gauge of absolute pressure reads it, which contradicts its driving pressure."""
    frame = pandas.read_csv(path, comment="#")
    frame["pressure_kPa"] += 101.325
    frame.to_csv(path, index=False)


def refused(folder, sensor):
    result = run("calibrate", str(folder), "--sensor", sensor, "--fit", "modulus", "--out", "out")
    assert result.exit_code == 2 and not (folder.parent / "out").exists()
    return " ".join(result.stderr.split())


def test_why_its_runs_are_not_used_is_said_where_another_sensors_are(folder):
    absolute(folder / A)
    said = refused(folder, "TangoPlus-1")
    assert f"no run of sensor TangoPlus-1 can be used {A}: " in said
    assert "driving_pressure_kPa = 0" in said and B not in said


def test_of_two_sensors_without_a_usable_run_the_named_one_has_its_own_reasons(folder):
    for file in (A, B):
        absolute(folder / file)
    said = refused(folder, "TangoPlus-1")
    assert f"no run of sensor TangoPlus-1 can be used {A}: " in said and B not in said


def test_a_file_that_cannot_be_read_is_a_reason_too(folder):
    (folder / A).write_text("time_s,force_N\n")
    said = refused(folder, "TangoPlus-1")
    assert f"no run of sensor TangoPlus-1 can be used {A}: " in said and B not in said


def rewritten(folder, change):
    """The campaign file with its runs changed."""
    path = folder / "campaign.toml"
    content = tomllib.loads(path.read_text())
    content["runs"] = [changed for run in content["runs"] if (changed := change(run)) is not None]
    path.write_text(toml_text(content))


def test_the_same_reason_of_several_files_is_said_once(folder):
    def second(run):
        return {**run, "sensor": "TangoPlus-1", "run": 2} if run["sensor"] == "TangoPlus-2" else run

    rewritten(folder, second)
    for file in (A, B):
        (folder / file).write_text("time_s,force_N\n")
    said = refused(folder, "TangoPlus-1")
    assert f"no run of sensor TangoPlus-1 can be used {A}, {B}: " in said


def test_a_sensor_with_runs_of_other_kinds_alone_is_told_the_kinds(folder):
    rewritten(folder, lambda run: None if run["file"] == A else run)
    absolute(folder / B)
    assert "no run of kind steps or injection" in refused(folder, "TangoPlus-1")
