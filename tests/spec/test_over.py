"""One grammar for the values of an option that varies a field."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.errors import InputError
from pneutouch.spec.toml_text import value_text
from pneutouch.spec.tray import parse_over

KEY = "membrane.wall_thickness_mm"


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("1,2,3", [1, 2, 3]),
        ("1, 2.5,", [1, 2.5]),
        ("1:2:5", [1.0, 1.25, 1.5, 1.75, 2.0]),
        ("1:5:5", [1, 2, 3, 4, 5]),
        ("TangoPlus,FLX9960", ["TangoPlus", "FLX9960"]),
        ("[0, 5],[0, 10]", [[0, 5], [0, 10]]),
        ("'A, B',C", ["A, B", "C"]),
        ("'a:b:c'", ["a:b:c"]),
    ],
)
def test_values(text, values):
    assert parse_over([f"{KEY}={text}"]) == {KEY: values}


@pytest.mark.parametrize("text", ["", KEY, f"{KEY}=", f"{KEY}=1:2", f"{KEY}=1:2:1", f"{KEY}=a:2:3", f"{KEY}=[1,2"])
def test_what_is_not_of_the_grammar_is_an_input_error(text):
    with pytest.raises(InputError):
        parse_over([text])


def test_a_key_given_twice_is_an_input_error():
    with pytest.raises(InputError, match="twice"):
        parse_over([f"{KEY}=1", f"{KEY}=2"])


@given(
    st.lists(
        st.floats(allow_nan=False, allow_infinity=False) | st.text(st.characters(exclude_categories=["Cs"])), min_size=1
    )
)
def test_quoted_values_come_back(values):
    text = ",".join(value_text(value) for value in values)
    assert parse_over([f"{KEY}={text}"]) == {KEY: values}


@given(st.floats(-1e6, 1e6), st.floats(-1e6, 1e6), st.integers(2, 50))
def test_a_range_holds_both_ends_and_equal_steps(start, stop, count):
    values = parse_over([f"{KEY}={start}:{stop}:{count}"])[KEY]
    assert (values[0], values[-1], len(values)) == (start, stop, count)
    steps = [b - a for a, b in pairwise(values)]
    assert max(steps) - min(steps) <= 1e-10 * max(1.0, abs(start), abs(stop))
