"""Gent's relation: a tabulated value, its inverse, its slope."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.mechanics.paper_sensor import logarithmic_change, logarithmic_slope, shore_a, young_modulus


def test_value_of_the_relation_as_it_is_usually_printed():
    printed = 0.0981 * (56 + 7.62336 * 50) / (0.137505 * (254 - 2.54 * 50))
    assert young_modulus(50.0) == pytest.approx(printed, rel=1e-12)
    assert young_modulus(50.0) == pytest.approx(2.456, abs=1e-3)


@given(st.floats(10, 95))
def test_hardness_and_modulus_undo_one_another(shore):
    assert shore_a(young_modulus(shore)) == pytest.approx(shore, rel=1e-9)


@given(st.floats(10, 95))
def test_slope_is_the_derivative_and_changes_add_up_to_it(shore):
    step = 1e-3
    assert logarithmic_change(shore - step, shore + step) / (2 * step) == pytest.approx(
        logarithmic_slope(shore), rel=1e-5
    )
    assert logarithmic_slope(shore) > 0
