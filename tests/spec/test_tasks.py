"""Files of tasks, and what is wrong with them."""

from __future__ import annotations

import pytest

from pneutouch.errors import InputError
from pneutouch.spec.tasks import parse_task, read_tasks


def test_short_and_full_keys_are_one_task():
    short, full = parse_task("sensitivity=1.8"), parse_task(" sensitivity_kPa_per_N = 1.8 ")
    assert short == full
    assert (short.figure, short.value) == ("sensitivity_kPa_per_N", 1.8)
    assert parse_task("force_range=12").figure == "force_range_N"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("stiffness", "write FIGURE=VALUE"),
        ("stif=2", "Did you mean stiffness?"),
        ("stiffness=two", "its unit is N/mm"),
        ("stiffness=-1", "from 1e-06 to 100000 N/mm"),
        ("stiffness=nan", "finite"),
        ("force_range=inf", "finite"),
    ],
)
def test_a_wrong_text_is_one_clear_error(text, message):
    with pytest.raises(InputError, match="for") as error:
        parse_task(text)
    assert message in str(error.value)


def test_a_toml_and_a_csv_file_hold_the_same_tasks(tmp_path):
    (tmp_path / "a.toml").write_text(
        '[[task]]\nname = "grasp"\nstiffness_N_per_mm = 2.4\n[[task]]\nname = "feel"\nsensitivity_kPa_per_N = 2\n'
    )
    (tmp_path / "a.csv").write_text("name,sensitivity_kPa_per_N,stiffness_N_per_mm\ngrasp,,2.4\nfeel,2,\n\n")
    assert read_tasks(tmp_path / "a.toml") == read_tasks(tmp_path / "a.csv")


@pytest.mark.parametrize("delimiter", [";", "\t"])
@pytest.mark.parametrize("mark", [",", "."])
def test_cells_may_be_separated_by_semicolons_or_tabs(tmp_path, delimiter, mark):
    (tmp_path / "a.csv").write_text("name,sensitivity_kPa_per_N,stiffness_N_per_mm\ngrasp,,2.4\n,1.95,\n")
    text = "name;sensitivity_kPa_per_N;stiffness_N_per_mm\ngrasp;;2.4\n;1.95;\n"
    (tmp_path / "b.csv").write_text("\ufeff" + text.replace(".", mark).replace(";", delimiter))
    assert read_tasks(tmp_path / "b.csv") == read_tasks(tmp_path / "a.csv")


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        (
            "a.csv",
            "name,stiffness\ngrasp,2\n",
            'a.csv: header = "stiffness": unknown column. Did you mean stiffness_N_per_mm?',
        ),
        ("a.csv", "name;stiffness\ngrasp;2\n", 'a.csv: header = "stiffness": unknown column. Did you mean stiffness'),
        (
            "a.csv",
            "name;force_range_N\ngrasp;1,234\n",
            'force_range_N = "1,234": must be a number; write it with a decimal',
        ),
        ("a.csv", "name;force_range_N\ngrasp;1,2,3\n", 'force_range_N = "1,2,3": must be a number'),
        ("a.csv", "name,force_range_N\ngrasp,1_0\n", 'force_range_N = "1_0": must be a number'),
        ("a.csv", "name,stiffness_N_per_mm\n", "holds no task"),
        ("a.csv", "name,stiffness_N_per_mm\ngrasp\n", "line 2 has 1 cells, the header 2"),
        ("a.csv", "name,stiffness_N_per_mm\ngrasp,high\n", 'line 2: stiffness_N_per_mm = "high": must be a number'),
        ("a.csv", "name,stiffness_N_per_mm\ngrasp,\n", "no figure is given"),
        ("a.toml", "[[task]]\nstiffness_N_per_mm = 2\nforce_range_N = 3\n", "are given; a task requires exactly one"),
        ("a.toml", "[[task]]\nstiffness = 2\n", "Did you mean stiffness_N_per_mm?"),
        ("a.toml", "task = []\n", "at least one entry"),
        ("a.toml", "[[task]\n", "a.toml"),
    ],
)
def test_a_wrong_file_is_one_clear_error(tmp_path, name, text, message):
    (tmp_path / name).write_text(text)
    with pytest.raises(InputError) as error:
        read_tasks(tmp_path / name)
    assert message in str(error.value) and str(error.value).startswith(str(tmp_path / name))
