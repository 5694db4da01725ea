"""The splines under the atlas against scipy's own, against polynomials and against difference quotients."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from pneutouch.mechanics.atlas.recipe import SplineAxis, pieces
from pneutouch.mechanics.atlas.surveyed import roughness

axes = st.builds(
    lambda low, length, cells, degree, stretch: SplineAxis(low, low + length, cells, degree, stretch),
    st.floats(-2.0, 2.0),
    st.floats(0.3, 3.0),
    st.integers(1, 12),
    st.integers(2, 5),
    st.none() | st.floats(0.05, 1.0),
)


def inside(axis: SplineAxis, count: int = 41) -> np.ndarray:
    """Points that are neither ends nor knots."""
    return axis.low + (axis.high - axis.low) * (np.arange(count) + 0.37) / count


def straight(axis: SplineAxis, x: np.ndarray) -> np.ndarray:
    """The coordinate in which the cells of an axis are equal, from its definition."""
    return x - axis.low if axis.stretch is None else np.sqrt(x - axis.low + axis.stretch**2) - axis.stretch


@pytest.mark.parametrize("degree", [1, 2, 3, 4, 5])
def test_pieces_are_the_b_splines_of_scipy(degree):
    u = np.linspace(0.0, 1.0, 11)[:-1]
    ours = u[:, None] ** np.arange(degree + 1) @ pieces(degree)
    knots = np.arange(-degree, degree + 2.0)
    assert ours == pytest.approx(BSpline.design_matrix(u, knots, degree).toarray(), abs=1e-13)


@given(axes)
def test_values_sum_to_one_and_slopes_to_nothing(axis):
    x = inside(axis)
    assert axis.rows(x).sum(axis=1) == pytest.approx(1.0, abs=1e-12)
    assert axis.rows(x).min() >= -1e-13
    for order in (1, 2):
        rows = axis.rows(x, order)
        assert np.abs(rows.sum(axis=1)).max() <= 1e-11 * np.abs(rows).max()


@given(axes)
def test_polynomials_of_the_degree_come_back_exactly_with_both_derivatives(axis):
    x = inside(axis, 12 * (axis.cells + axis.degree))
    z = straight(axis, x) / straight(axis, np.array([axis.high]))[0]
    polynomial = np.polynomial.Polynomial(np.cos(np.arange(axis.degree + 1.0)))
    coefficients = np.linalg.lstsq(axis.rows(x), polynomial(z), rcond=None)[0]
    assert axis.rows(x) @ coefficients == pytest.approx(polynomial(z), abs=1e-9)
    # dz/dx of z = (sqrt(x - low + s^2) - s)/scale, and its own derivative.
    scale = straight(axis, np.array([axis.high]))[0]
    root = 1.0 if axis.stretch is None else 2.0 * np.sqrt(x - axis.low + axis.stretch**2)
    rate = 1.0 / (scale * root)
    turn = 0.0 if axis.stretch is None else -2.0 * rate / root**2
    first, second = polynomial.deriv(), polynomial.deriv(2)
    slope, bend = first(z) * rate, second(z) * rate**2 + first(z) * turn
    assert axis.rows(x, 1) @ coefficients == pytest.approx(slope, abs=1e-7 * np.abs(slope).max())
    assert axis.rows(x, 2) @ coefficients == pytest.approx(bend, abs=1e-5 * np.abs(bend).max())


@given(axes, st.integers(0, 2**31))
def test_derivatives_are_difference_quotients(axis, seed):
    coefficients = np.random.default_rng(seed).normal(size=axis.size)
    x, step = inside(axis), 1e-5 * (axis.high - axis.low) / axis.cells
    # A quotient across a knot is only as good as the spline is smooth there.
    cell = axis.basis(np.stack([x - step, x + step]).ravel())[0].reshape(2, -1)
    x = x[cell[0] == cell[1]]
    for order in (0, 1):
        quotient = (axis.rows(x + step, order) - axis.rows(x - step, order)) @ coefficients / (2 * step)
        exact = axis.rows(x, order + 1) @ coefficients
        assert quotient == pytest.approx(exact, abs=2e-4 * np.abs(exact).max())


@given(axes, st.integers(0, 2**31))
def test_neighbouring_cells_meet_smoothly_in_value_and_slope(axis, seed):
    coefficients = np.random.default_rng(seed).normal(size=axis.size)
    knots = axis.even(axis.cells + 1)[1:-1]
    step = 1e-9 * (axis.high - axis.low)
    for order in (0, 1):
        jump = (axis.rows(knots + step, order) - axis.rows(knots - step, order)) @ coefficients
        size = np.abs(axis.rows(inside(axis), order + 1)).max() * np.abs(coefficients).max()
        assert np.abs(jump).max(initial=0.0) <= 10 * step * size * axis.size + 1e-12


@given(axes)
def test_even_points_are_even_where_the_cells_are_and_end_at_the_ends(axis):
    x = axis.even(9)
    assert x[[0, -1]] == pytest.approx([axis.low, axis.high], abs=1e-12)
    assert np.ptp(np.diff(straight(axis, np.maximum(x, axis.low)))) < 1e-7


def test_beyond_the_high_end_the_last_polynomial_goes_on():
    axis = SplineAxis(0.0, 1.0, 4, 3)
    x = np.linspace(0.76, 0.99, 30)
    coefficients = np.linalg.lstsq(axis.rows(np.linspace(0, 1, 99)), np.linspace(0, 1, 99) ** 3, rcond=None)[0]
    assert axis.rows(x + 0.2) @ coefficients == pytest.approx((x + 0.2) ** 3, abs=1e-10)


def test_roughness_is_blind_to_lower_powers_and_sees_its_own():
    index = np.arange(9.0)
    assert roughness(9, 2) @ (3 * index + 1) == pytest.approx(0.0, abs=1e-12)
    assert roughness(9, 2) @ index**2 == pytest.approx(2.0)
