"""``pneutouch compare`` as a user meets it."""

from __future__ import annotations

import json

import pytest

FAST = ("--model", "atlas")


def test_compare_prints_what_differs_and_what_exceeds_and_names_the_folder(command, tmp_path):
    (tmp_path / "stiff.toml").write_text('[membrane]\nmaterial = "FLX9960"\n[pneumatics]\ndead_volume_mL = 0\n')
    done = command("compare", "paper-dome", "stiff.toml", "--set", "pneumatics.driving_pressures_kPa=[0,12]", *FAST)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert lines[-1] == "outputs/compare-paper-dome-stiff"
    assert any(line.split() == ["membrane.material", "TangoPlus", "FLX9960"] for line in lines)
    (row, *_) = (line for line in lines if line.startswith("limit pressure, kPa"))
    assert row.endswith(": exceeds")
    assert sum(line.startswith("sensitivity, kPa/N") for line in lines) == 2
    stages = ["evaluating paper-dome", "evaluating stiff.toml", "drawing curves and sections"]
    assert done.stderr.splitlines() == [f"{stage} ..." for stage in stages]
    written = tmp_path / "outputs/compare-paper-dome-stiff"
    assert (written / "comparison.pdf").read_bytes().startswith(b"%PDF")


def test_json_is_the_document_that_is_written(command, tmp_path):
    done = command("compare", "paper-dome", "gallery/none", *FAST)
    assert done.returncode == 2 and "gallery/none" in done.stderr and done.stdout == ""
    words = ("--set", "pneumatics.driving_pressures_kPa=[0]", *FAST, "--json", "--out", "there")
    (tmp_path / "wide.toml").write_text("[membrane]\ninner_radius_mm = 11\n[pneumatics]\ndead_volume_mL = 0\n")
    said = json.loads(command("compare", "paper-dome", "wide.toml", *words).stdout)
    folder = tmp_path / said.pop("folder")
    written = json.loads((folder / "comparison.json").read_text())
    assert written.pop("format") == "pneutouch/comparison/1" and said == written
    assert folder.parent.name == "there"
    assert said["inputs"]["membrane.inner_radius_mm"] == [9.25, 11.0]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("paper-dome", "paper-dome"), "error: paper-dome is given twice; name another design or folder"),
        (("paper-dome",), "error: one thing alone cannot be compared; name another design or folder"),
        (("paper-dome", "empty"), "error: empty: holds no manifest.json: neither a build nor a characterization; "),
        (("paper-dome", "nothing"), 'error: design = "nothing": no such design or file; '),
    ],
)
def test_what_cannot_be_compared_is_one_clear_error(command, tmp_path, words, message):
    (tmp_path / "empty").mkdir()
    done = command("compare", *words, "--model", "membrane")
    assert done.returncode == 2 and done.stdout == ""
    *stages, error = done.stderr.splitlines()
    assert error.startswith(message) and all(line.endswith(" ...") for line in stages)
    assert not (tmp_path / "outputs").exists()
