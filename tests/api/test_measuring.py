"""Scans and campaigns: the documents that the commands print."""

from __future__ import annotations

import json
import signal

import pytest

import pneutouch as pt
from pneutouch.api import measuring
from pneutouch.workflows.calibrate import calibrate as calibrating
from pneutouch.workflows.calibrate.calibration_files import write_calibration


def without_folder(document):
    return {key: value for key, value in document.items() if key != "folder"}


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    out = tmp_path_factory.mktemp("simulated")
    return pt.simulate(
        "paper-dome", out, specimens=1, runs=1, kinds=["steps"], driving_pressures_kPa=[0, 12], model="atlas"
    )


@pytest.mark.slow
def test_a_simulated_campaign_has_the_bytes_of_the_command_lines(campaign, printed, tmp_path):
    options = (
        "--specimens",
        1,
        "--runs",
        1,
        "--kinds",
        "steps",
        "--pressures",
        "0,12",
        "--model",
        "atlas",
        "--out",
        tmp_path,
    )
    printed("simulate", "paper-dome", *options)
    theirs = tmp_path / campaign.name
    for path in campaign.rglob("*"):
        assert path.is_dir() or path.read_bytes() == (theirs / path.relative_to(campaign)).read_bytes(), path


@pytest.mark.slow
def test_figures_of_measured_runs_are_the_command_lines(campaign, printed, tmp_path):
    found = pt.characterize(campaign, model="atlas")
    said = printed("characterize", campaign, "--model", "atlas", "--out", tmp_path / "theirs")
    assert json.loads(json.dumps(found.to_dict())) == without_folder(said)
    assert (found.save(tmp_path / "ours") / "figures.json").is_file()
    own = pt.characterize(campaign, pt.load("paper-dome").replace(wall_thickness_mm=2.0), model="atlas")
    assert own.to_dict() != found.to_dict()


def test_columns_are_given_as_a_table_or_in_the_words_of_the_command():
    table = {"force": {"name": "load", "unit": "N", "sign": -1}}
    for given in (table, "force=-load:N", ["force=-load:N"]):
        assert measuring._reading(given, None) == {"columns": table, "format": {}}
    with pytest.raises(pt.InputError) as caught:
        measuring._reading("load", None)
    assert (caught.value.key, caught.value.value) == ("columns", "load")


@pytest.mark.slow
def test_a_stop_leaves_no_report_without_its_calibration(campaign, tmp_path, monkeypatch):
    monkeypatch.setenv("PNEUTOUCH_HOME", str(tmp_path))

    def stopped(*given):
        folder = write_calibration(*given)
        signal.raise_signal(signal.SIGINT)
        return folder

    monkeypatch.setattr(calibrating, "write_calibration", stopped)
    with pytest.raises(KeyboardInterrupt):
        pt.calibrate(campaign, fit=["modulus"], out=tmp_path / "out", save="mine")
    assert list((tmp_path / "out").rglob("calibration.json")) and (tmp_path / "calibrations" / "mine.toml").is_file()


@pytest.mark.slow
def test_a_calibration_is_the_command_lines_and_can_be_used_at_once(campaign, printed, tmp_path, monkeypatch):
    monkeypatch.setenv("PNEUTOUCH_HOME", str(tmp_path))
    found = pt.calibrate(campaign, fit=["modulus"], out=tmp_path / "ours")
    said = printed("calibrate", campaign, "--fit", "modulus", "--out", tmp_path / "theirs")
    drop = {"written"}
    assert {k: v for k, v in found.to_dict().items() if k not in drop} == {
        k: v for k, v in said.items() if k not in drop
    }
    design = pt.load("paper-dome").replace(calibration=found.name)
    modulus = found["estimates"][0]["value"]
    assert design.predict([0, 12], model="atlas").evaluation.sensor.wall.shear_modulus == pytest.approx(modulus)
    assert design.replace(calibration=None).predict([0], model="atlas").evaluation.scene.calibration is None
    assert found.save("other") == tmp_path / "calibrations" / "other.toml"
    assert dict(pt.calibrations()) == dict.fromkeys((found.name, "other"), "sensor TangoPlus-1, " + found["campaign"])
    pt.calibrate(campaign, fit=["modulus", "wall"], out=tmp_path / "ours", save="third")
    with pytest.raises(pt.InputError, match="there is a calibration of this name"):
        found.save("third")
    assert found.save("third", replace=True).read_bytes() == found.save().read_bytes().replace(
        f"@{found.name}".encode(), b"@third"
    )
    with pytest.raises(pt.InputError, match="no such parameter") as caught:
        pt.calibrate(campaign, fit=["moduls"])
    assert (caught.value.key, caught.value.value) == ("fit", "moduls")


@pytest.mark.slow
def test_a_plan_is_the_command_lines(printed, tmp_path):
    found = pt.plan(pt.load("paper-dome"), specimens=1)
    assert json.loads(json.dumps(found.to_dict())) == without_folder(
        printed("plan", "paper-dome", "--specimens", 1, "--out", tmp_path)
    )
    assert (found.save(tmp_path / "ours") / "campaign.toml").is_file()
    with pytest.raises(pt.InputError) as caught:
        pt.plan("paper-dome", specimens=0)
    assert caught.value.key == "specimens"


@pytest.mark.slow
def test_a_scan_is_the_command_lines(printed, tmp_path):
    found = pt.scan("texture-specimen", pt.load("paper-dome"), driving_pressures_kPa=[22], noise_kPa=0.02)
    said = printed(
        "scan", "texture-specimen", "--design", "paper-dome", "--pressures", "22", "--noise", 0.02, "--out", tmp_path
    )
    assert json.loads(json.dumps(found.to_dict())) == without_folder(said)
    with pytest.raises(pt.InputError, match="must be from 0 to") as caught:
        pt.scan("texture-specimen", "paper-dome", noise_kPa=-1.0)
    assert caught.value.key == "noise_kPa"
