"""Numbers in texts."""

from __future__ import annotations

import math
import sys

import pytest

from pneutouch.spec.values import finite_numbers, is_finite, plain_number, plain_numbers
from tests.refusals import refused


@pytest.mark.parametrize(("text", "value"), [("10", 10), (" -1.5 ", -1.5), ("+.5", 0.5), ("1e-3", 1e-3), ("2.", 2)])
def test_a_number(text, value):
    assert plain_number(text) == value


@pytest.mark.parametrize("text", ["1_0", "nan", "inf", "1e999", "٣", "½", "0x10", "", " ", "1,5", "1 0", "1e", "ten"])
def test_no_number(text):
    with pytest.raises(ValueError, match="is no finite number"):
        plain_number(text)


def test_numbers_with_commas():
    assert plain_numbers("0, 22,1e1") == [0, 22, 10]
    with pytest.raises(ValueError, match="1_0"):
        plain_numbers("0,1_0")


@pytest.mark.parametrize("value", [0, -1.5, sys.float_info.max, -int(sys.float_info.max)])
def test_what_a_float_holds_is_finite(value):
    assert is_finite(value)


@pytest.mark.parametrize("value", [10**400, -(10**400), math.inf, -math.inf, math.nan, True, "1", None, [1]])
def test_what_no_float_holds_is_not(value):
    assert not is_finite(value)
    with refused("k"):
        finite_numbers([1, value], "k")


def test_finite_numbers_are_floats():
    assert [type(each) for each in finite_numbers([0, 1.5], "k")] == [float, float]
