"""The specimen as an elastic layer: its filters and compliances against limits and an independent solution."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.mechanics.soft.layer import bonded_layer, half_space, reaching
from pneutouch.texture.substrate import FIRST_ZERO, BarRow, MatrixLayer, Substrate, amplitude, contrast, patch_filter

MU = 0.206
MATRIX = MatrixLayer(8.0, MU, 0.49)


def row(pitch=6.0, width=3.0, depth=2.0, length=60.0, first=1.5) -> BarRow:
    near = np.arange(first, length - width + 1e-9, pitch)
    return BarRow("row", pitch, width, 1.5, depth, np.stack([near, near + width], axis=1))


def airy(q: float, poisson: float) -> tuple[float, float]:
    """Sinking times 2 mu k on top and pressure on the floor of a bonded layer, solved by its four coefficients."""

    def basis(y):
        c, s = np.cosh(y), np.sinh(y)
        return np.array(
            [
                [c, s, y * c, y * s],
                [s, c, c + y * s, s + y * c],
                [c, s, 2 * s + y * c, 2 * c + y * s],
                [s, c, 3 * c + y * s, 3 * s + y * c],
            ]
        )

    top, floor = basis(0.0), basis(q)
    sliding = (1 - poisson) * floor[2] + poisson * floor[0]
    sinking = (1 - poisson) * floor[3] - (2 - poisson) * floor[1]
    weights = np.linalg.solve(np.stack([top[0], top[1], sliding, sinking]), [1.0, 0.0, 0.0, 0.0])
    return float(((1 - poisson) * top[3] - (2 - poisson) * top[1]) @ weights), float(floor[0] @ weights)


def test_patch_filter_has_the_values_of_the_physics_notes():
    k = 2 * np.pi / np.array([[3.0], [6.0]])
    found = patch_filter(k, np.array([1.0, 1.5, 2.0, 2.63, 3.5]))
    # physics.md 4.2 prints two decimals.
    assert found == pytest.approx(
        np.array([[0.54, 0.18, -0.06, -0.12, 0.02], [0.87, 0.72, 0.54, 0.31, 0.04]]), abs=0.006
    )
    assert abs(patch_filter(np.array(FIRST_ZERO), 1.0)) < 1e-5
    assert patch_filter(np.array([0.0, 1e-6]), 3.0) == pytest.approx([1.0, 1.0])


def test_bonded_layer_is_the_incompressible_formula_of_the_physics_notes():
    q = np.array([0.01, 0.1, 0.5, 1.0, 3.0, 9.0])
    printed = (np.sinh(2 * q) - 2 * q) / (np.cosh(2 * q) + 2 * q**2 + 1) / (2 * MU * q)
    assert bonded_layer(q, 1.0, MU, 0.5) == pytest.approx(printed, rel=1e-9)
    # Thin: k^2 h^3/(3 mu), no bed of springs.
    assert bonded_layer(np.array([1e-3]), 2.0, MU, 0.5)[0] == pytest.approx(1e-6 * 8 / (3 * MU), rel=1e-5)


@given(q=st.floats(0.05, 12.0), poisson=st.floats(0.0, 0.5))
def test_layer_formulas_are_those_of_a_layer_solved_anew(q, poisson):
    sinking, floor = airy(q, poisson)
    assert bonded_layer(np.array([q]), 1.0, 0.5, poisson)[0] * q == pytest.approx(sinking, rel=1e-5)
    assert reaching(np.array([q]), 1.0, poisson)[0] == pytest.approx(floor, rel=1e-5, abs=1e-8)


@given(poisson=st.floats(0.0, 0.49))
def test_limits_of_the_layer(poisson):
    thin = bonded_layer(np.array([1e-6]), 3.0, MU, poisson)[0]
    assert thin == pytest.approx(3.0 * (1 - 2 * poisson) / (2 * MU * (1 - poisson)), rel=1e-4)
    thick = bonded_layer(np.array([5.0]), 1e3, MU, poisson)
    assert thick == pytest.approx(half_space(np.array([5.0]), MU, poisson), rel=1e-12)
    assert reaching(np.array([0.0, 2.0]), 0.0, poisson) == pytest.approx([1.0, 1.0])
    assert reaching(np.array([1.0]), 60.0, poisson)[0] < 1e-20


def test_deep_down_a_plate_gets_twice_what_a_half_space_carries():
    k, depth = 2 * np.pi / 6, np.array([8.0, 12.0])
    carried = (1 + k * depth) * np.exp(-k * depth)
    found = np.array([reaching(np.array(k), d, 0.5) for d in depth])
    assert found == pytest.approx(2 * carried, rel=1e-4)
    # physics.md 4.2 prints the half-space's own at 1, 2, 3 mm for pitch 6 mm.
    near = (1 + k * np.array([1, 2, 3])) * np.exp(-k * np.array([1, 2, 3]))
    assert near == pytest.approx([0.718, 0.381, 0.179], abs=6e-4)


def test_disc_on_a_half_space_sinks_as_love_says():
    # Mean sinking of a uniform disc: 16 (1 - nu) F/(3 pi^2 mu rho) / 2; Johnson, Contact Mechanics, eq. 3.30.
    deep = MatrixLayer(1e5, MU, 0.49)
    radii = np.array([0.5, 2.0, 5.0])
    assert deep.compliance(radii) == pytest.approx(8 * 0.51 / (3 * np.pi**2 * MU * radii), rel=1e-3)


@given(radius=st.floats(0.5, 6.0), depth=st.floats(0.0, 8.0))
def test_cover_is_stiffer_than_the_layer(radius, depth):
    taken = float(contrast(MATRIX, depth, np.array(radius)))
    bare = float(MATRIX.compliance(np.array(radius)))
    assert -1e-12 <= taken <= bare
    assert float(contrast(MATRIX, 8.0, np.array(radius))) == pytest.approx(0.0, abs=1e-12)


@given(pitch=st.floats(2.0, 20.0), depth=st.floats(0.0, 6.0), radius=st.floats(0.5, 4.0))
def test_deeper_bars_show_less_and_amplitudes_follow_the_filter(pitch, depth, radius):
    bars, lower = row(pitch, pitch / 2, depth), row(pitch, pitch / 2, depth + 1.0)
    found, less = (abs(float(amplitude(MATRIX, b, np.array(radius)))) for b in (bars, lower))
    assert less <= found + 1e-12
    k = 2 * np.pi / pitch
    sign = np.sign(float(patch_filter(np.array(k), radius)))
    assert np.sign(float(amplitude(MATRIX, bars, np.array(radius)))) in (sign, 0.0)


def test_series_is_the_true_profile_with_its_harmonics():
    bars = row(width=2.0, first=2.0)
    x = np.linspace(0.0, 60.0, 6000, endpoint=False)
    orders = 2000
    wave = np.exp(2j * np.pi * np.outer(x[::7], np.arange(orders + 1)) / 60.0) * bars.series(60.0, orders)
    values = 2 * wave.real.sum(axis=1) - wave.real[:, 0]
    away = np.abs(x[::7, None] - bars.edges.ravel()).min(axis=1) > 0.3
    assert values[away] == pytest.approx(bars.covers(x[::7])[away], abs=0.05)
    for order in (1, 2, 3):
        assert 2 * abs(bars.series(60.0, 30)[10 * order]) == pytest.approx(bars.harmonic(order), abs=1e-9)
    assert row(width=3.0).harmonic(2) == pytest.approx(0.0, abs=1e-12)


def test_compliance_along_the_path_has_the_stated_mean_and_amplitude():
    bars = row()
    ground = Substrate(MATRIX, (bars,), 60.0, 2.3)
    found = np.fft.rfft(ground.compliance(2048)) / 2048
    assert 2 * abs(found[10]) == pytest.approx(abs(ground.amplitude(bars)), rel=1e-6)
    assert found[0].real == pytest.approx(ground.bare * ground.shares[0], rel=1e-9)
    # Softest over a gap, stiffest over a bar.
    line = ground.compliance(2000)
    assert line[0] > line[100]


def test_no_bars_no_contrast():
    assert np.ptp(Substrate(MATRIX, (), 60.0, 2.0).compliance(64)) == pytest.approx(0.0, abs=1e-15)
    assert float(amplitude(MATRIX, row(depth=8.0), np.array(2.0))) == pytest.approx(0.0, abs=1e-12)


def test_rows_above_shield_those_below_and_halves_do_not():
    lower = row()
    upper = BarRow("upper", 3.0, 1.5, 1.0, 0.0, row(3.0, 1.5, 0.0, 60.0, 0.75).edges)
    alone, under = Substrate(MATRIX, (lower,), 60.0, 2.3), Substrate(MATRIX, (upper, lower), 60.0, 2.3)
    assert under.amplitude(lower) == pytest.approx(alone.amplitude(lower) * under.shares[0])
    first, second = lower.edges[:5], lower.edges[5:]
    halves = [BarRow(f"half {k}", 6.0, 3.0, 1.5, 2.0, edges) for k, edges in enumerate((first, second))]
    both = Substrate(MATRIX, tuple(halves), 60.0, 2.3)
    assert both.amplitude(halves[0]) == pytest.approx(alone.amplitude(lower))
    assert both.compliance(512) == pytest.approx(alone.compliance(512), rel=1e-9)


def test_vero_bars_spread_their_load_beyond_the_patch():
    assert row().bending_length(2500.0, MU) == pytest.approx((4 * 2500 * 3 * 1.5**3 / 12 / (4 * np.pi * MU)) ** 0.25)
    assert row().bending_length(2500.0, MU) > 3.6
