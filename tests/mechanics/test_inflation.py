"""State I against the paper, the published figures of the cap model, and the exact membrane."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from pneutouch.errors import ComputationError
from pneutouch.mechanics.membrane import (
    LIMIT_HEIGHT,
    LIMIT_PRESSURE,
    RISING_BRANCH,
    energy_slope,
    height_errors,
    limit_point_errors,
    pressure,
    relative_height,
    relative_pressure,
    thickness_stretch,
)
from pneutouch.mechanics.membrane import energy as wall_energy
from tests.mechanics.exact_membrane import inflated, limit_point

MODULI = {
    "TangoPlus": 0.17,
    "FLX9940": 0.27,
    "FLX9950": 0.55,
    "FLX9960": 0.91,
    "FLX9970": 1.64,
    "FLX9985": 4.00,
    "FLX9995": 5.33,
}


def test_limit_point_constants():
    assert pytest.approx(1.805244, abs=1e-6) == LIMIT_HEIGHT
    assert pytest.approx(1.519913, abs=1e-6) == LIMIT_PRESSURE
    assert float(thickness_stretch(np.array(LIMIT_HEIGHT))) == pytest.approx(0.469604, abs=1e-6)


def test_limit_point_is_the_maximum_of_the_curve():
    x = np.linspace(1, 5, 200001)
    assert x[np.argmax(relative_pressure(x))] == pytest.approx(LIMIT_HEIGHT, abs=2e-5)


def test_papers_sensor_peaks_where_the_paper_says():
    """17.4 mm (outside: the thinned wall added) and around 42 kPa for Tango+ (paper, Figure 3)."""
    assert pytest.approx(16.70, abs=0.01) == 9.25 * LIMIT_HEIGHT
    assert 9.25 * LIMIT_HEIGHT + 1.5 * float(thickness_stretch(np.array(LIMIT_HEIGHT))) == pytest.approx(
        17.40, abs=0.01
    )
    assert pytest.approx(41.90, abs=0.02) == 1e3 * 0.17 * 1.5 / 9.25 * LIMIT_PRESSURE


@pytest.mark.parametrize(("p_kpa", "height"), [(12, 10.010), (20, 10.662), (22, 10.853)])
def test_heights_of_the_papers_sensor(p_kpa, height):
    x = relative_height(np.array(p_kpa * 1e-3), 9.25, 1.5, 0.17)
    assert 9.25 * float(x) == pytest.approx(height, abs=1e-3)


@pytest.mark.parametrize(
    ("name", "height"), list(zip(MODULI, (10.85, 10.15, 9.66, 9.49, 9.38, 9.30, 9.29), strict=True))
)
def test_heights_at_22_kpa_for_the_seven_resins(name, height):
    x = relative_height(np.array(0.022), 9.25, 1.5, MODULI[name])
    assert 9.25 * float(x) == pytest.approx(height, abs=0.005)


@given(st.floats(2, 50), st.floats(0.02, 0.5), st.floats(0.01, 10), st.floats(0, 0.999))
def test_pressure_and_height_invert_each_other_on_both_branches(radius, share, modulus, fraction):
    wall = share * radius
    top = LIMIT_PRESSURE * modulus * share
    p = np.array([fraction * top])
    rising = relative_height(p, radius, wall, modulus)
    assert 1 <= rising[0] <= LIMIT_HEIGHT
    assert pressure(rising, radius, wall, modulus) == pytest.approx(p, rel=1e-9, abs=1e-12 * top)
    if fraction > 0.01:
        falling = relative_height(p, radius, wall, modulus, falling=True)
        assert falling[0] >= LIMIT_HEIGHT
        assert pressure(falling, radius, wall, modulus) == pytest.approx(p, rel=1e-9)


def test_height_is_linear_in_the_radius_and_blind_to_the_resin():
    radii = np.linspace(2, 50, 25)
    for modulus in MODULI.values():
        x = [
            float(relative_height(np.array(0.8 * LIMIT_PRESSURE * modulus * 0.15), r, 0.15 * r, modulus)) for r in radii
        ]
        assert np.ptp(x) < 1e-9


def test_closed_form_is_stationary_energy():
    """Equation 9 from eq. 8: dE/dh = 0 with the law's own energy, by central differences."""
    radius, wall, modulus = 9.25, 1.5, 0.17
    for x in (1.05, 1.3, 1.7, 2.5):
        h, step = x * radius, 1e-4

        p = float(pressure(np.array(x), radius, wall, modulus))

        def energy(height, p=p):
            volume = np.pi / 6 * height * (3 * radius**2 + height**2)
            stretch = 2 * radius**2 / (radius**2 + height**2)
            return 2 * np.pi * radius**2 * wall * wall_energy(modulus, stretch) - p * volume

        slope = (energy(h + step) - energy(h - step)) / (2 * step)
        assert abs(slope) < 1e-6 * modulus * wall * radius


def test_law_slope_is_the_slope_of_its_energy_and_its_modulus_is_mu():
    stretch = np.linspace(0.3, 1.4, 23)
    step = 1e-6
    numeric = (wall_energy(0.55, stretch + step) - wall_energy(0.55, stretch - step)) / (2 * step)
    assert energy_slope(0.55, stretch) == pytest.approx(numeric, abs=1e-8)
    # W'' by the thickness stretch at 1 is 3 mu: equibiaxial strain e has lambda_t = 1 - 2 e and W = 6 mu e^2.
    curvature = (energy_slope(1.0, np.array(1 + step)) - energy_slope(1.0, np.array(1 - step))) / (2 * step)
    assert curvature == pytest.approx(3.0, rel=1e-6)


def test_beyond_the_limit_point_is_an_error_not_a_number():
    with pytest.raises(ComputationError, match="limit point"):
        relative_height(np.array([0.0, 0.0425]), 9.25, 1.5, 0.17)


def test_the_rows_that_the_error_is_stated_against_soften_up_to_the_limit_point():
    """The slope of a neo-Hookean membrane's pressure over its height falls all the way, and is 0 at the end."""
    pressure, height = RISING_BRANCH.T
    slopes = np.diff(pressure) / np.diff(height)
    assert (np.diff(slopes) < 0.0).all() and 0.0 < slopes[-1] < 0.02 * slopes[0]


def test_height_errors_are_those_of_the_exact_membrane_up_to_the_cap_s_limit():
    """Between the rows too, and just below the limit, where the cap's height rises as a root."""
    pressures, heights = np.array([inflated(stretch) for stretch in np.linspace(1.05, 1.66, 25)]).T
    below = (pressures < LIMIT_PRESSURE) & (np.arange(25) <= pressures.argmax())
    true = relative_height(pressures[below], 1.0, 1.0, 1.0) / heights[below] - 1
    np.testing.assert_allclose(height_errors(pressures[below]), true, atol=2e-3)
    last = brentq(lambda stretch: inflated(stretch)[0] - LIMIT_PRESSURE * (1 - 1e-9), 1.3, 1.62)
    expected = LIMIT_HEIGHT / inflated(last)[1] - 1
    assert height_errors(np.array([LIMIT_PRESSURE])) == pytest.approx(expected, abs=2e-3)


@pytest.mark.slow
def test_shooting_meets_every_row_that_the_error_is_stated_against():
    for p, h in RISING_BRANCH[1:-1]:
        stretch = brentq(lambda s, target=h: inflated(s)[1] - target, 1.01, 1.7, xtol=1e-9)
        assert inflated(stretch)[0] == pytest.approx(p, abs=3e-6)
    assert limit_point() == (
        pytest.approx(RISING_BRANCH[-1, 0], abs=2e-5),
        pytest.approx(RISING_BRANCH[-1, 1], abs=1e-3),
    )


def test_limit_point_errors_are_those_of_the_literature_figures():
    assert limit_point_errors() == (pytest.approx(-0.035, abs=1e-3), pytest.approx(0.068, abs=1e-3))


def test_stated_height_error_is_the_distance_from_the_exact_membrane():
    """Between the table's rows too: 22 kPa on the paper's sensor, 10.853 against 10.44996 mm."""
    stated = float(height_errors(np.array([0.022 * 9.25 / (0.17 * 1.5)]))[0])
    assert stated == pytest.approx(10.853 / 10.44996 - 1, abs=1e-3)
    for stretch in (1.03, 1.15, 1.25, 1.35):
        p, h = inflated(stretch)
        cap = float(relative_height(np.array(p), 1.0, 1.0, 1.0))
        assert float(height_errors(np.array([p]))[0]) == pytest.approx(cap / h - 1, abs=0.012)
