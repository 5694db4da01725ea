"""What the flags of ``pneutouch tray`` mean, and one clear line for what they cannot."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.errors import InputError
from pneutouch.spec.toml_text import value_text
from pneutouch.workflows.tray.order import order_of_file, order_of_flags

KEY = "membrane.wall_thickness_mm"


def over(text):
    return order_of_flags(["paper-dome"], [f"{KEY}={text}"]).tray.entry[0].over[KEY]


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("[1,2]", [[1, 2]]),
        ("[0, 10], [0,20,]", [[0, 10], [0, 20]]),
        ("1,2.5", [1, 2.5]),
        ("TangoPlus,FLX9940", ["TangoPlus", "FLX9940"]),
        ("TangoPlus, 'a,b',[1, 2] ,3", ["TangoPlus", "a,b", [1, 2], 3]),
        ('"a, b"', ["a, b"]),
        ("M3,1,[2]", ["M3", 1, [2]]),
        ("robot-50-4-M6", ["robot-50-4-M6"]),
        ("1,2,", [1, 2]),
    ],
)
def test_values_are_parted_as_toml_parts_them(text, values):
    assert over(text) == values


SCALARS = st.one_of(
    st.integers(-99, 99), st.floats(-9, 9), st.text(st.characters(min_codepoint=32, max_codepoint=126), min_size=1)
)


@given(st.lists(SCALARS | st.lists(st.integers(0, 9), max_size=3), min_size=1, max_size=5, unique_by=repr))
def test_any_toml_values_come_back(values):
    if any(value in values[:k] for k, value in enumerate(values)):
        return
    assert over(",".join(map(value_text, values))) == values


@pytest.mark.parametrize("text", ["[1,2", "1,[2", "'a,b", "[[1],2"])
def test_what_is_not_closed_is_said(text):
    with pytest.raises(InputError, match=r"over = .*not closed") as error:
        over(text)
    assert text in str(error.value)


@pytest.mark.parametrize("text", ["nan", "inf", "1,-inf", "[1,nan]", "true", "[[1],2]", "{a=1}", "2026-11-21"])
def test_a_value_of_no_use_is_one_clear_line(text):
    with pytest.raises(InputError) as error:
        over(text)
    (line,) = str(error.value).splitlines()
    assert KEY in line
    assert "must be a finite number, text or a list of finite numbers" in line


@pytest.mark.parametrize("table", ["over = { KEY = [1, nan] }", "set = { KEY = nan }"])
def test_so_it_is_in_a_tray_file(table, tmp_path):
    path = tmp_path / "t.toml"
    path.write_text(f'[[entry]]\ndesign = "paper-dome"\n{table.replace("KEY", KEY)}\n')
    with pytest.raises(InputError) as error:
        order_of_file(path)
    (line,) = str(error.value).splitlines()
    assert line.startswith(f"{path}: ")
    assert f"{KEY}: nan: must be a finite number" in line


@pytest.mark.parametrize("copies", [0, -1, 201])
def test_copies_are_told_by_their_flag(copies):
    with pytest.raises(InputError) as error:
        order_of_flags(["paper-dome", "agilus-dome"], [], copies)
    assert str(error.value) == f"copies = {copies}: must be from 1 to 200"
