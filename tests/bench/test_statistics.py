"""Statistics of readings, against closed forms and random samples."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.bench.statistics import Mean, dead_volume, mean, neo_hookean, secant_modulus, shear_from_young


def test_mean_and_spread():
    result = mean([1.0, 2.0, 3.0, 4.0])
    assert (result.value, result.count) == (2.5, 4)
    assert result.spread == pytest.approx(np.sqrt(5 / 3))
    assert result.error == pytest.approx(result.spread / 2)
    with pytest.raises(ValueError, match="two"):
        mean([1.0])


def test_the_fit_finds_the_modulus_it_was_given():
    stretch = np.linspace(1.02, 1.2, 10)
    assert neo_hookean(stretch, 0.31 * (stretch - stretch**-2)) == (pytest.approx(0.31), pytest.approx(0, abs=1e-15))


def test_the_standard_error_is_that_of_many_fits():
    rng, stretch = np.random.default_rng(3), np.linspace(1.02, 1.2, 10)
    fits = np.array(
        [neo_hookean(stretch, 0.17 * (stretch - stretch**-2) + rng.normal(0, 0.002, 10)) for _ in range(4000)]
    )
    assert fits[:, 0].mean() == pytest.approx(0.17, abs=3e-4)
    assert np.sqrt((fits[:, 1] ** 2).mean()) == pytest.approx(fits[:, 0].std(), rel=0.05)


def test_the_secant_tends_to_three_mu_and_is_8_percent_lower_at_a_tenth():
    stretch = np.linspace(1.0001, 1.2, 500)
    stress = 0.2 * (stretch - stretch**-2)
    assert shear_from_young(secant_modulus(stretch, stress, 0.001), 0.5) == pytest.approx(0.2, rel=2e-3)
    assert shear_from_young(secant_modulus(stretch, stress, 0.1), 0.49) == pytest.approx(0.92 * 0.2, rel=3e-3)
    assert secant_modulus(stretch, stress, 0.3) is None


def test_boyle_gives_the_dead_volume_back_and_its_uncertainty():
    true, cavity, air, ambient = 0.43, 1.0, 0.25, 101.325
    over_cap, over_plug = air * ambient / true, air * ambient / (true + cavity)
    result = dead_volume(Mean(cavity, 0, 2), Mean(over_cap, 0, 3), Mean(over_plug, 0, 3))
    assert (result.value, result.spread) == (pytest.approx(true), 0.0)
    readings = Mean(cavity, 0.02, 1), Mean(over_cap, 0.3, 1), Mean(over_plug, 0.3, 1)
    stated = dead_volume(*readings)
    rng = np.random.default_rng(5)
    v, a, b = (rng.normal(m.value, m.spread, 40000) for m in readings)
    assert stated.spread == pytest.approx((v * b / (a - b)).std(), rel=0.02)
    with pytest.raises(ValueError, match="lower"):
        dead_volume(Mean(1, 0, 2), Mean(10, 0, 2), Mean(10, 0, 2))
