"""The true figures of a simulated specimen, against records without noise, derivatives and declared values."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from pneutouch.bench.indents import protocol
from pneutouch.bench.simulate.curve import ModelDeviation, PressCurves, press_curves
from pneutouch.bench.simulate.rig import (
    RigModel,
    ScatterModel,
    SimulatedSpecimens,
    WallMemory,
    ageing_factor,
    stiffened,
)
from pneutouch.bench.simulate.runs import SimulationTruth, population, simulate_run, specimen_figures
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.atlas.respond import respond
from pneutouch.units import KPA
from tests.bench.truths import NO_WALL, R0, ends, rng


@pytest.fixture(scope="module")
def atlas(sensor) -> PressCurves:
    return press_curves(sensor, [0.0, 22 * KPA], 0.75 * R0, "atlas", steps=28)


@pytest.mark.parametrize("smooth", [0.02, 0.05])
def test_a_smooth_deviation_has_the_standard_deviation_that_is_stated(atlas, smooth):
    """Of force and rise of 400 specimens at five travels, on two driving pressures."""
    draw = np.random.default_rng(4)
    made = [ModelDeviation(smooth=smooth).deviated(atlas, draw).curves for _ in range(400)]
    for k, plain in enumerate(atlas.curves):
        at = np.linspace(5, plain.force.size - 1, 5).astype(int)
        for name in ("force", "rise"):
            shares = [np.log(getattr(each[k], name)[at] / getattr(plain, name)[at]) for each in made]
            # Root mean square over the travel: it differs from place to place by the waves' shape.
            assert np.sqrt(np.mean(np.square(shares))) == pytest.approx(smooth, rel=0.25)


def test_relaxation_truth_is_that_of_the_quiet_record(pressed):
    truth, curve = SimulationTruth(rest=2.0, rig=RigModel.perfect()), pressed.curves[1]
    stated = specimen_figures(curve, truth, R0, 100.0)
    test = truth.protocol("relaxation", R0, curve.reach)
    record = simulate_run(curve, test, RigModel.perfect(), 100.0, rng(), wall=truth.wall, scatter=ScatterModel.none())
    since = record.time - test.knots()[0][2]
    # The stop and the release fall between samples.
    time = np.geomspace(1.0, 599.9, 400)
    for name, values in (("force", record.force), ("pressure", record.pressure - curve.driving)):
        level = np.interp(time, since, values)
        assert stated[f"relaxation_{name}_percent"] == pytest.approx(100 * (level[0] - level[-1]) / level[0], rel=2e-3)
        slope = np.polyfit(np.log10(time), level, 1)[0]
        assert stated[f"relaxation_{name}_percent_per_decade"] == pytest.approx(-100 * slope / level[0], rel=2e-3)
        assert stated[f"relaxation_{name}_percent"] > 0


def test_loading_truth_is_that_of_the_quiet_record(pressed):
    truth, curve = SimulationTruth(rest=2.0), pressed.curves[0]
    stated = specimen_figures(curve, truth, R0, 100.0)
    test = truth.protocol("steps", R0, curve.reach)
    record = simulate_run(curve, test, RigModel.perfect(), 200.0, rng(), wall=truth.wall, scatter=ScatterModel.none())
    at = ends(test, 200.0)
    force, rise = (
        np.append(0.0, record.force[at]),
        np.append(
            0.0, record.pressure[at] - record.pressure[np.floor(test.knots()[0][1::4] * 200.0 + 1e-6).astype(int)]
        )
        / KPA,
    )
    assert stated["sensitivity_kPa_per_N"] == pytest.approx(np.polyfit(force, rise, 1)[0], rel=2e-4)
    assert stated["force_range_N"] == pytest.approx(force[-1], rel=2e-4)
    assert stated["sensitivity_through_origin_kPa_per_N"] == pytest.approx(force @ rise / (force @ force), rel=2e-4)
    assert stated["stiffness_N_per_mm"] == pytest.approx(force[-1] / test.depths[-1], rel=2e-4)


def test_hysteresis_comes_from_memory_alone_and_grows_with_it(pressed):
    result = [
        specimen_figures(pressed.curves[0], SimulationTruth(wall=WallMemory((g,), (0.0,), (1.0,)), rest=2.0), R0, 100.0)
        for g in (0.0, 0.01, 0.02)
    ]
    width = [one["hysteresis_width_percent"] for one in result]
    assert width[0] < 0.02 and width[2] == pytest.approx(2 * width[1], rel=0.1) and width[1] > 0.3


def test_population_spreads_as_the_derivative_predicts(sensor, atlas):
    """To first order the spread of a figure is its logarithmic derivative by the modulus times the modulus' spread."""
    truth = SimulationTruth(scatter=replace(ScatterModel.none(), modulus=0.04, gain=0.002), wall=NO_WALL, rest=2.0)
    result = population(atlas, 1, truth, 100.0, (7,))
    depths = np.append(0.0, protocol("steps", R0).depths)

    def slope(factor: float) -> float:
        one = respond(batch_of(stiffened(sensor, factor).replace(gauge_limit=np.inf), [22 * KPA]), 56)
        force, rise = (np.interp(depths, one.indentation[0], x[0]) for x in (one.force, one.rise))
        return float(np.polyfit(force, rise / KPA, 1)[0])

    by_modulus = (slope(1.02) - slope(0.98)) / (np.log(1.02) - np.log(0.98))
    assert result.count == 4000
    assert result.figures["part_to_part_kPa_per_N"] == pytest.approx(abs(by_modulus) * 0.04, rel=0.06)
    assert result.figures["sensitivity_kPa_per_N"] == pytest.approx(slope(1.0), rel=2e-3)
    assert result.figures["repeatability_kPa_per_N"] == pytest.approx(0.002 * slope(1.0), rel=2e-3)


def test_population_without_scatter_is_the_nominal_sensor(pressed):
    truth = SimulationTruth(scatter=ScatterModel.none(), rest=2.0, specimens=20)
    result = population(pressed, 0, truth, 100.0, (0,))
    nominal = specimen_figures(pressed.curves[0], truth, R0, 100.0)
    for key, value in nominal.items():
        if value is None:
            assert result.figures[key] is None, key
        else:
            assert result.figures[key] == pytest.approx(value, rel=1e-9), key
    assert max(result.spread.values()) < 1e-9


def test_specimens_are_drawn_as_declared():
    scatter = ScatterModel(modulus=0.04, wall=0.1, dead_volume=20.0)
    some = SimulatedSpecimens.draw(scatter, 20_000, rng(2))
    assert np.log(some.modulus).std() == pytest.approx(0.04, rel=0.03)
    assert np.abs(some.wall).max() <= 0.1 and some.wall.std() == pytest.approx(0.1 / np.sqrt(3), rel=0.03)
    assert some.dead_volume.min() >= 0 and some.dead_volume.mean() == pytest.approx(10.0, rel=0.03)


def test_a_year_changes_every_modulus_and_no_exponent(sensor):
    scatter = replace(ScatterModel(), ageing=0.1)
    assert [ageing_factor(scatter, days) for days in (0.0, 365.0, 3650.0)] == pytest.approx(
        [1.0, np.exp(0.1), np.exp(0.1)]
    )
    ogden = sensor.replace(law=("ogden", (0.1, 2.5, 0.02, -3.0)))
    assert stiffened(ogden, 2.0).wall.law == ("ogden", (0.2, 2.5, 0.04, -3.0))
    assert stiffened(ogden, 2.0).wall.hyperelastic.mu == pytest.approx(2 * ogden.wall.hyperelastic.mu)
