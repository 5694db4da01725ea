"""``pneutouch coupons`` as a user meets it."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from pneutouch.cli.app import app


def run(*arguments: str):
    return CliRunner().invoke(app, ["coupons", *arguments])


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_set_is_written_filled_in_and_changes_the_prediction(here):
    result = run("--only", "puck,dumbbell", "--copies", "puck=2,dumbbell=2", "--json")
    assert result.exit_code == 0, result.stderr
    document = json.loads(result.stdout)
    assert {one["piece"]: one["copies"] for one in document["coupons"]} == {
        "puck-TangoPlus": 2,
        "dumbbell-TangoPlus": 2,
    }
    template = (here / document["folder"] / "results.toml").read_text()
    curve = {
        "width_mm": "6.0, 6.0",
        "thickness_mm": "2.0, 2.0",
        "extension_mm": "1, 2, 3, 4",
        "force_N": "0.3, 0.6, 0.8, 1.0",
    }
    for key, readings in curve.items():
        template = template.replace(f"{key} = []", f"{key} = [{readings}]")
    # The pucks stay empty: thickness_mm stands in both tables.
    template = template.replace("thickness_mm = [2.0, 2.0]", "thickness_mm = []", 1)
    (here / "results.toml").write_text('lab = "Lab 1"\ndate = 2026-11-21\n' + template)
    entered = run("--results", "results.toml")
    assert entered.exit_code == 0, entered.stderr
    assert "written: printprofiles/materials/TangoPlus.toml" in entered.stdout
    assert "shear_modulus_MPa" in entered.stdout
    from pneutouch.catalogue import load_scene

    assert load_scene("paper-dome").membrane_material.shear_modulus_MPa.value > 0.17


def test_only_the_folder_is_printed_and_the_next_command_noted():
    result = run("--only", "puck", "--out", "o")
    folder = "o/coupons-objet260-connex"
    assert result.stdout == f"{folder}\n"
    by_hand = f"print and measure as {folder}/measure.md states, fill in {folder}/results.toml"
    assert result.stderr.splitlines()[-1] == f"{by_hand}, then: pneutouch coupons --results {folder}/results.toml"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--copies", "puck"], "--copies puck: write COUPON=N"),
        (["--copies", "puck=many"], "write COUPON=N"),
        (["--only", "puk"], "Did you mean puck"),
        (["--results", "none.toml"], "none.toml: no such file"),
        (["--results", "none.toml", "--material", "TangoPlus"], "--material cannot be given with it"),
        (["--profile", "nothing"], "--profile"),
    ],
)
def test_bad_words_exit_2(words, said):
    result = run(*words)
    assert result.exit_code == 2
    assert said in result.stderr
    assert "Traceback" not in result.output


def test_the_mixing_pages_command_prints_eight_mixes_and_their_results_make_a_curve(here, root):
    page = (root / "docs/background/mixing.md").read_text()
    line = next(line for line in page.splitlines() if line.startswith("pneutouch coupons --mixing"))
    result = run(*line.split()[2:], "--json")
    assert result.exit_code == 0, result.stderr
    document = json.loads(result.stdout)
    assert len(document["coupons"]) == 16
    text = (here / document["folder"] / "results.toml").read_text()
    for reading in ("27, 28", "40, 41", "52, 53"):
        text = text.replace("shore_a = []", f"shore_a = [{reading}]", 1)
    (here / "results.toml").write_text('lab = "Lab 1"\ndate = 2026-11-21\n' + text)
    entered = run("--results", "results.toml")
    assert entered.exit_code == 0, entered.stderr
    assert "written: printprofiles/mixing/TangoPlus+VeroClear.toml" in entered.stdout
    assert "shear_modulus_MPa at 6 %" in entered.stdout
