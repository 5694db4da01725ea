"""``pneutouch compare`` as a user meets it."""

from __future__ import annotations

import json

import pytest

from pneutouch.cli.table import table_text

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


def test_tables_keep_to_the_width_and_lose_no_word():
    rows = [
        ["sensitivity, kPa/N", "2.342 (1.898 to 2.889)", "2.250 (1.824 to 2.777)", "-3.9 % (-12.4 to +5.5 %): within"]
    ]
    head = ["at 0 kPa", "paper-dome", "thick", "difference"]
    text = table_text(head, rows, 60)
    assert max(map(len, text.splitlines())) <= 60
    assert all(word in text for cell in [*head, *rows[0]] for word in cell.split())


@pytest.mark.parametrize("columns", [30, 41, 60, 80, 100, 160])
def test_figures_and_names_stay_whole_and_columns_that_do_not_fit_follow_below(columns):
    head = ["", "resin", "R0 mm", "t0 mm", "S kPa/N", "U (k=2)", "ends with", "binds"]
    rows = [
        [
            "1",
            "TangoPlus",
            "7.42",
            "0.88",
            "2.996",
            "33 %",
            "inward buckling",
            "rated pressure, by its lower end (+3 %)",
        ],
        ["2 runner-up", "FLX9940", "17.06", "0.96", "2.984", "40 %", "saturation", "footprint (+12 %)"],
    ]
    lines = table_text(head, rows, columns).splitlines()
    assert max(map(len, lines)) <= columns
    blocks = "\n".join(lines).split("\n\n")
    # Each block begins with the column that says which row it is.
    assert all(block.splitlines()[1].startswith("1") for block in blocks)
    for row in rows:
        for cell in row[1:-1]:
            [line] = [line for line in lines if line.startswith(row[0]) and f"  {cell}" in line]
            assert f"  {cell}  " in f"{line}  "


@pytest.mark.parametrize("columns", [10, 16, 20, 24, 28])
def test_where_not_even_two_columns_fit_no_letter_is_lost(columns):
    lines = table_text(
        ["", "resin", "ends with"], [["2 runner-up", "TangoPlus", "inward buckling"]], columns
    ).splitlines()
    assert max(map(len, lines)) <= columns
    letters = "".join("".join(lines).split())
    every = "2runner-upTangoPlusinwardbuckling"
    assert all(letters.count(letter) >= every.count(letter) for letter in every)


def test_a_table_without_a_head_keeps_its_indent_and_its_width():
    rows = [["paper-dome", "the sensor of the paper, with its specimen and a long title"], ["x", "short"]]
    whole = table_text([], rows, indent="  ")
    assert whole == f"  paper-dome  {rows[0][1]}\n  x           short"
    lines = table_text([], rows, 40, indent="  ").splitlines()
    assert len(lines) > 2 and all(line.startswith("  ") and len(line) <= 40 for line in lines)
    assert "".join("".join(lines).split()) == "".join("".join(rows[0] + rows[1]).split())
    assert table_text([], []) == "" and table_text(["a", "b"], []) == "a  b"
