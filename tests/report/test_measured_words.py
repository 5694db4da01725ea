"""Numbers of the measured sheet: digits, signs, intervals, and when two of them share a value."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.report.numbers import MINUS, between, number, overlap, signed


@given(st.floats(0.01, 100), st.floats(0, 10), st.floats(0.01, 100), st.floats(0, 10))
def test_intervals_overlap_when_their_centres_are_nearer_than_their_halves(a, half_a, b, half_b):
    near = abs(a - b) - half_a - half_b
    if abs(near) > 1e-9:
        assert overlap((a, a - half_a, a + half_a), (b, b - half_b, b + half_b)) == (near < 0)
    assert overlap((a, a - half_a, a + half_a), (b, None, None)) is None


@given(st.floats(1e-4, 1e5), st.integers(2, 5))
def test_numbers_keep_their_digits(value, digits):
    assert float(number(value, digits)) == pytest.approx(
        value, rel=0.5 * 10 ** (1 - digits) + 1e-9, abs=0.5 if value > 10**digits else 0
    )


def test_numbers_have_a_true_minus_and_no_negative_nothing():
    assert number(-1.234) == f"{MINUS}1.23"
    assert number(-0.0004, 3, like=5.0) == "0.00"
    assert signed(-0.04) == "0.0"
    assert between((2.34, 2.1, 2.58)) == "2.10 to 2.58"
    assert number(float("nan")) == "–"
