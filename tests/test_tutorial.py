"""The tutorial of docs/howto/measuring.md, run as it stands; its campaign file is read."""

from __future__ import annotations

import json
import re
import shlex
import tomllib

import pytest

from pneutouch.spec.campaign import Campaign
from pneutouch.spec.read import validate
from tests.conftest import ROOT
from tests.running import in_process

TEXT = (ROOT / "docs" / "howto" / "measuring.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def walked(tmp_path_factory):
    """The folder after all of the tutorial's commands, and what each of them said."""
    folder = tmp_path_factory.mktemp("tutorial")
    block = re.search(r"```sh\n(.*?)```", TEXT, re.DOTALL)
    assert block is not None
    said = {}
    for line in block.group(1).splitlines():
        words = shlex.split(line, comments=True)
        assert words[0] == "pneutouch"
        result = in_process(words[1:], folder)
        assert result.returncode == 0, f"{line}\n{result.stderr}"
        said[words[1]] = result.stdout
    return folder, said


@pytest.mark.slow
def test_the_steps_leave_what_the_page_says(walked):
    folder, said = walked
    assert set(said) == {"plan", "simulate", "characterize", "calibrate", "predict"}
    for name in ("plan.md", "plan.json", "campaign.toml"):
        assert (folder / "outputs" / "paper-dome-plan" / name).is_file()
    sheet = folder / "outputs" / "paper-dome-campaign-measured"
    for name in ("measured-datasheet.html", "measured-datasheet.pdf", "figures.json", "points.csv", "segments.csv"):
        assert (sheet / name).is_file()
    assert list((sheet / "evidence").glob("*.svg"))
    assert (folder / "calibrations" / "my-sensor.toml").is_file()


@pytest.mark.slow
def test_the_truth_lies_in_the_intervals_of_what_was_measured(walked):
    folder, _ = walked
    truth = json.loads((folder / "outputs/paper-dome-campaign/truth.json").read_text())
    found = json.loads((folder / "outputs/paper-dome-campaign-measured/figures.json").read_text())
    assert found["simulated"] is True
    for group in found["groups"]:
        (true,) = (p for p in truth["populations"] if p["driving_pressure_kPa"] == group["driving_pressure_kPa"])
        for key in ("sensitivity_kPa_per_N", "force_range_N", "noise_force_N", "repeatability_kPa_per_N"):
            figure = group["figures"][key]
            assert figure["low"] <= true["figures"][key] <= figure["high"], key
        assert abs(group["figures"]["sensitivity_kPa_per_N"]["predicted"]["measured_off_percent"]) < 10


@pytest.mark.slow
def test_what_is_predicted_again_is_the_sensor_in_hand(walked):
    """The calibrated sensor's prediction is nearer to its own measured sensitivity than the design's is."""
    folder, said = walked
    found = json.loads((folder / "outputs/paper-dome-campaign-measured/figures.json").read_text())
    rows = {
        float(row.split()[0]): float(row.split()[3])
        for row in said["predict"].splitlines()
        if re.match(r"\d+ +\d", row) and len(row.split()) > 8
    }
    for pressure in (0.0, 22.0):
        own = [
            run["figures"]["sensitivity_kPa_per_N"]
            for run in found["runs"]
            if (run["sensor"], run["driving_pressure_kPa"], run["kind"]) == ("TangoPlus-1", pressure, "steps")
        ]
        assert rows[pressure] == pytest.approx(sum(own) / len(own), rel=0.03)


def test_the_campaign_file_of_the_page_is_one():
    (block,) = re.findall(r"```toml\n(.*?)```", TEXT, re.DOTALL)
    campaign = validate(Campaign, tomllib.loads(block), "docs/howto/measuring.md")
    assert campaign.columns.position.unit == "um" and len(campaign.runs) == 2


def test_every_kind_of_run_is_explained():
    for kind in Campaign.model_fields["runs"].annotation.__args__[0].model_fields["kind"].annotation.__args__:
        assert f"| `{kind}` |" in TEXT
