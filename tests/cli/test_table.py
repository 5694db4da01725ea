"""Tables in a terminal: every word and figure is there, whatever the width."""

from __future__ import annotations

import pytest

from pneutouch.cli.terminal import table_text


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
