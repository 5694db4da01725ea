"""Figures of runs whose loops, lines and relaxation are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.bench.figures import BY_KEY, FIGURES, FIRST, _relaxation, run_figures
from pneutouch.bench.record import MeasuredCurve
from pneutouch.spec.campaign import CampaignRun
from pneutouch.units import KPA

DEPTHS = np.linspace(0.0, 7.0, 15)


def curve(kind="steps", **more):
    run = CampaignRun(file="a.csv", kind=kind, sensor="a", resin="TangoPlus")
    force = 1.5 * DEPTHS**1.5
    plain = MeasuredCurve(
        run, DEPTHS, force, 2.0 * KPA * force, 0.0, noise=(0.02, 0.01 * KPA), drift=(0.1 * KPA / 60, 0.0)
    )
    return replace(plain, **more)


def test_every_figure_has_a_key_of_its_own_with_its_unit():
    assert len(BY_KEY) == len(FIGURES)
    for figure in FIGURES:
        assert figure.of == "" or figure.of in BY_KEY
        assert figure.key.endswith(
            ("kPa_per_N", "percent", "decade", "N_per_mm", "_N", "kPa", "kPa_per_min", "squared")
        )


@given(slope=st.floats(0.1, 10.0), power=st.floats(1.0, 2.0))
def test_a_straight_response_has_its_slope(slope, power):
    force = 0.8 * DEPTHS**power
    result = run_figures(curve(force=force, rise=slope * KPA * force))
    assert result["sensitivity_kPa_per_N"] == pytest.approx(slope, rel=1e-9)
    assert result["sensitivity_through_origin_kPa_per_N"] == pytest.approx(slope, rel=1e-9)
    assert result["r_squared"] == pytest.approx(1.0) and result["nonlinearity_percent"] == pytest.approx(0.0, abs=1e-6)
    assert result["stiffness_N_per_mm"] == pytest.approx(force[-1] / 7.0) and result["force_range_N"] == force[-1]
    assert result["resolution_N"] == pytest.approx(3 * 0.01 / slope)
    assert result["drift_pressure_kPa_per_min"] == pytest.approx(0.1)


def test_a_saturating_run_gives_its_range_and_no_sensitivity():
    force = np.linspace(0.0, 30.0, 31)
    rise = KPA * np.where(force < 18, 2.0 * force, 36.0 + 0.2 * (force - 18))
    result = run_figures(curve("saturation", indentation=np.linspace(0, 8, 31), force=force, rise=rise))
    assert result["saturation_force_N"] == pytest.approx(18.0, abs=1.0) == result["sensing_range_N"]
    assert "sensitivity_kPa_per_N" not in result
    straight = run_figures(curve("saturation", force=force[:15], rise=2 * KPA * force[:15]))
    assert "saturation_force_N" not in straight and straight["sensing_range_N"] == 14.0


def branches(width, noise=0.0, count=400, seed=0):
    """A loop whose gap is a parabola in the root of the force: in below, out above, closed at the greatest force."""
    draw = np.random.default_rng(seed)
    force = np.linspace(0.0, 1.0, count) ** 2 * 25.0
    root = np.sqrt(force / 25.0)
    gap = 4 * width * root * (1 - root)
    middle = 2.0 * force - 0.01 * force**2
    sides = []
    for direction in (-0.5, 0.5):
        sides += [
            force + noise * draw.standard_normal(count),
            (middle + direction * gap + noise * draw.standard_normal(count)) * KPA,
        ]
    return tuple(sides)


def test_a_known_loop_has_its_width_and_area_in_noise_too():
    clean = run_figures(curve("loop", loop=(branches(0.3),) * 3))
    full = 50.0 - 6.25
    assert clean["hysteresis_width_percent"] == pytest.approx(100 * 0.3 / full, rel=1e-3)
    force, low, _, high = branches(0.3)
    area = 100 * np.trapezoid(high - low, force) / np.trapezoid(low, force)
    assert clean["hysteresis_area_percent"] == pytest.approx(area, rel=0.01)
    noisy = [
        run_figures(curve("loop", loop=tuple(branches(0.3, 0.02, seed=3 * k + j) for j in range(3)))) for k in range(8)
    ]
    for key in ("hysteresis_width_percent", "hysteresis_area_percent"):
        assert np.mean([result[key] for result in noisy]) == pytest.approx(clean[key], rel=0.04)


def test_a_loop_of_an_elastic_sensor_has_next_to_none():
    result = run_figures(curve("loop", loop=tuple(branches(0.0, 0.02, seed=j) for j in range(3))))
    assert result["hysteresis_width_percent"] < 0.05 and "noise_force_N" not in result


@pytest.mark.parametrize("terms", [((0.05, 10.0),), ((0.02, 1.0), (0.02, 10.0), (0.02, 100.0))])
def test_relaxation_is_what_a_prony_series_loses(terms):
    time = np.arange(0.0, 600.0, 0.01)
    force = 20.0 * (1.0 - sum(share * (1 - np.exp(-time / tau)) for share, tau in terms))
    draw = np.random.default_rng(0)
    noisy = force + 0.02 * draw.standard_normal(time.size)
    result = run_figures(curve("relaxation", relaxation=(time, noisy, 2 * KPA * force)))
    start = np.interp(1.0, time, force)
    assert result["relaxation_force_percent"] == pytest.approx(100 * (start - force[-1]) / start, abs=0.06)
    assert result["relaxation_pressure_percent"] == pytest.approx(100 * (start - force[-1]) / start, abs=0.05)
    even = np.interp(np.geomspace(1.0, 599.99, 200), time, force)
    slope = np.polyfit(np.log10(np.geomspace(1.0, 599.99, 200)), even, 1)[0]
    assert result["relaxation_force_percent_per_decade"] == pytest.approx(-100 * slope / start, abs=0.03)


def test_what_a_run_does_not_determine_is_left_out():
    assert "sensitivity_kPa_per_N" not in run_figures(curve(indentation=DEPTHS[:2], force=DEPTHS[:2], rise=DEPTHS[:2]))
    assert "relaxation_force_percent" not in run_figures(
        curve("relaxation", relaxation=(np.arange(3.0), np.ones(3), np.ones(3)))
    )
    # A loop without its cycles has the line of its loading, but neither hysteresis nor rests that are long enough.
    assert not {"hysteresis_width_percent", "noise_force_N"} & run_figures(curve("loop")).keys()


def test_a_loss_that_is_even_in_the_logarithm_of_time_is_its_slope_over_the_first_value():
    time = np.geomspace(0.2 * FIRST, 100.0 * FIRST, 20000)
    force, rise = 10.0 - np.log10(time / FIRST), 4.0 - 0.2 * np.log10(time / FIRST)
    found = _relaxation(time, force, rise)
    assert found == pytest.approx(
        {
            "relaxation_force_percent": 20.0,
            "relaxation_force_percent_per_decade": 10.0,
            "relaxation_pressure_percent": 10.0,
            "relaxation_pressure_percent_per_decade": 5.0,
        },
        rel=1e-3,
    )
    assert _relaxation(time[time < FIRST], force[time < FIRST], rise[time < FIRST]) == {}
