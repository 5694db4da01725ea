"""Curves to figures: exact on straight lines, definitions on made-up curves."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.mechanics.response import figures, saturation_force, tangent_stiffness
from pneutouch.mechanics.viscous.runs import hysteresis


@given(st.floats(0.1, 50), st.floats(-3, 3), st.floats(0.2, 20))
def test_a_straight_line_gives_itself_back(slope, intercept, stiffness):
    depth = np.linspace(0, 5, 12)
    force = stiffness * depth
    found = figures(depth, force, intercept + slope * force)
    assert found is not None
    assert found.sensitivity == pytest.approx(slope, rel=1e-9)
    assert found.intercept_kPa == pytest.approx(intercept, abs=1e-8)
    assert found.stiffness == pytest.approx(stiffness, rel=1e-12)
    assert found.r_squared == pytest.approx(1.0, abs=1e-9)
    assert found.nonlinearity == pytest.approx(0.0, abs=1e-9)
    assert found.force_range == pytest.approx((0, 5 * stiffness))
    assert np.isinf(found.saturation_force)


def test_least_squares_against_the_normal_equations():
    force = np.array([0.0, 1.0, 2.0, 4.0])
    rise = np.array([0.0, 3.0, 5.0, 8.0])
    found = figures(np.array([0.0, 1, 2, 3]), force, rise)
    assert found is not None
    assert found.sensitivity == pytest.approx(17 / 8.75, rel=1e-12)
    assert found.sensitivity_through_origin == pytest.approx(45 / 21, rel=1e-12)
    assert found.r_squared == pytest.approx((17 / 8.75) ** 2 * 8.75 / 34, rel=1e-12)


@given(st.floats(0.2, 5), st.floats(0.2, 5))
def test_figures_of_a_curve_with_factors_are_those_of_the_scaled_curve(force_factor, rise_factor):
    depth, force = np.linspace(0, 3, 13), np.linspace(0, 3, 13) ** 1.5
    rise = 2.0 + 3.0 * np.tanh(force)
    plain = figures(depth, force, rise)
    found, expected = (
        each._asdict()
        for each in (plain.scaled(force_factor, rise_factor), figures(depth, force_factor * force, rise_factor * rise))
    )
    assert np.isfinite(found["saturation_force"])
    for key, value in expected.items():
        assert found[key] == pytest.approx(value, rel=1e-6), key


def test_curves_that_determine_no_line_have_no_figures():
    assert figures(np.array([0.0, 1]), np.array([0.0, 1]), np.array([0.0, 1])) is None
    assert figures(np.arange(4.0), np.zeros(4), np.arange(4.0)) is None


def test_saturation_is_where_the_local_slope_has_halved():
    force = np.linspace(0, 10, 1001)
    rise = 2 * np.minimum(force, 6.0)
    assert saturation_force(force, rise, 2.0) == pytest.approx(6.0, abs=0.02)


def test_tangent_stiffness_of_a_parabola():
    depth = np.linspace(0, 3, 31)
    assert tangent_stiffness(depth, depth**2) == pytest.approx(2 * depth, abs=1e-9)


def test_hysteresis_of_a_parallelogram_in_both_definitions():
    force = np.linspace(0, 10, 101)
    width, area = hysteresis(force, 2 * force, force[::-1], 2 * force[::-1] + 1)
    assert width == pytest.approx(1 / 20)
    assert area == pytest.approx(10 / 100)
