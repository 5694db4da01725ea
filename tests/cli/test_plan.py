"""``pneutouch plan`` and ``pneutouch simulate`` as a user meets them."""

from __future__ import annotations

import json
import re

import pytest
from typer.testing import CliRunner

from pneutouch.cli import plan, simulate
from pneutouch.cli.app import app
from pneutouch.formats import format_of

assert plan and simulate


def run(*arguments: str):
    return CliRunner().invoke(app, list(arguments))


@pytest.mark.slow
def test_plan_prints_its_document_and_warns_on_stderr(tmp_path):
    rig = tmp_path / "rig.toml"
    rig.write_text('[rig]\nname = "small"\nforce_range_N = 10.0\n')
    words = ("plan", "paper-dome", "--specimens", "1", "--rig", str(rig), "--out", str(tmp_path), "--json")
    result = run(*words)
    assert result.exit_code == 0, result.stderr
    said = json.loads(result.stdout)
    written = json.loads((tmp_path / "paper-dome-plan" / "plan.json").read_text())
    assert {key: value for key, value in said.items() if key != "folder"} | {"format": format_of("plan")} == written
    assert said["rig"]["force_range_N"] == 10.0 and said["rig"]["file"] == "rig.toml"
    force = [w for w in said["warnings"] if w["rule"] == "force range"]
    assert [w["driving_pressure_kPa"] for w in force] == [0, 5, 12, 22]
    for warning in said["warnings"]:
        message = (
            warning["message"].replace("`rig`", "--rig").replace("`pneumatics.", "--set pneumatics.").replace("`", "")
        )
        assert f"warning: {warning['rule']}: {message}" in result.stderr

    text = run(*words[:-1]).stdout.split("\n\n" + str(tmp_path))[0].splitlines()
    rows = [re.split(" {2,}", row) for row in text[3 : text.index("", 3)]]
    assert rows.pop() == ["all", "26"]
    assert [row[0] for row in rows] == ["leak", "injection", "steps", "loop", "saturation", "relaxation"]
    for _, pressures_kPa, at_each, specimens, runs, *_ in rows:
        assert len(pressures_kPa.split(",")) * int(at_each) * int(specimens) == int(runs)
    assert sum(int(row[4]) for row in rows) == 26
    assert text[0] == f"paper-dome: 26 runs on 1 specimen, {written['total_s'] / 3600:.1f} h on small"
    state = written["resins"][0]["states"][-1]["points"][-1]
    assert text[-1].split()[1:5] == [
        "22",
        *(f"{state[key]:.2f}" for key in ("depth_mm", "force_N", "pressure_rise_kPa")),
    ]


def test_simulate_writes_a_campaign_and_says_so(tmp_path):
    words = ("simulate", "paper-dome", "--specimens", "1", "--pressures", "0", "--kinds", "loop", "--model", "atlas")
    result = run(*words, "--out", str(tmp_path), "--json")
    assert result.exit_code == 0, result.stderr
    said = json.loads(result.stdout)
    assert said["simulated"] is True and said["runs"] == 1 and said["specimens"] == 1
    assert (tmp_path / "paper-dome-campaign" / "runs" / "TangoPlus-1-0kPa-loop-1.csv").is_file()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("simulate", "paper-dome", "--pressures", "a,b"), "--pressures a,b: must be numbers"),
        (("simulate", "paper-dome", "--resins", "Tango"), "no such elastomer. Did you mean TangoPlus?"),
        (("plan", "paper-dome", "--specimens", "0"), "--specimens 0: must be from 1 to 1000"),
        (("plan", "paper-dome", "--rig", "nowhere.toml"), "nowhere.toml: no such file"),
    ],
)
def test_wrong_words_end_with_two_and_a_reason(words, message, tmp_path):
    result = run(*words, "--out", str(tmp_path))
    assert result.exit_code == 2 and message in result.stderr, result.stderr
