"""Known parameters are recovered, with intervals of the stated coverage."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.bench.calibrate.fit import fit
from pneutouch.bench.calibrate.fitted_atlas import FLOOR
from pneutouch.bench.calibrate.goodness import misses, residuals
from pneutouch.bench.calibrate.notes import gain_shifts
from pneutouch.bench.calibrate.observations import Observations
from pneutouch.bench.calibrate.parameters import DEAD, MODULUS, NAMES, OFFSET, USUAL, WALL
from tests.bench.calibrate.sensors import DESIGNED, chosen, curves, exact, injections, other

TRUTH = {"shear_modulus": 0.21, "wall_thickness": 1.56, "dead_volume": 1400.0}


def coordinates(truth, offset=0.0):
    modulus, wall, friction = truth.wall.shear_modulus, truth.dome.wall_thickness, truth.protocol.friction
    return np.array([np.log(modulus), np.log(wall), truth.gas.dead_volume, offset, friction])


def test_clean_curves_give_all_four_parameters_back(library):
    truth = other(**TRUTH)
    result = fit(Observations(exact(truth, (0.0, 12.0, 22.0))), DESIGNED, chosen(library, *USUAL, priors=False))
    assert result.full == pytest.approx(coordinates(truth), rel=1e-4, abs=1e-3)
    assert result.chi_squared / result.freedom < 1e-4


def test_clean_injections_and_curves_agree(library):
    truth = other(**TRUTH)
    pushed = injections(truth, np.linspace(100, 1500, 12), 3, np.random.default_rng(0), 0.0, 0.0)
    result = fit(Observations(exact(truth, (0.0, 22.0)), pushed), DESIGNED, chosen(library, *USUAL, priors=False))
    assert result.full == pytest.approx(coordinates(truth), rel=1e-4, abs=1e-3)


def test_a_missed_first_touch_is_found(library):
    truth = other(shear_modulus=0.2, depth=6.0)
    seen = curves(truth, (0.0, 12.0, 22.0), 2, np.random.default_rng(2), 0.002, offset=0.15)
    result = fit(Observations(seen), DESIGNED, chosen(library, "modulus", "offset", priors=False))
    assert result.full[OFFSET] == pytest.approx(0.15, abs=result.half_width[1])
    assert result.full[MODULUS] == pytest.approx(np.log(0.2), abs=result.half_width[0])
    assert result.half_width[1] < 0.03


def test_derivatives_are_those_of_the_model(library):
    """Each parameter moves the curves as its derivative predicts: a step of ten times the difference's."""
    result = fit(Observations(exact(DESIGNED, (0.0, 22.0))), DESIGNED, chosen(library, *USUAL, priors=False))
    step = 10 * result.parameters.step
    for k in (MODULUS, WALL, DEAD, OFFSET):
        moved = result.full + step * np.eye(len(NAMES))[k]
        change = (result.problem.model.values(moved[None])[0][0] - result.solution.model) / result.problem.errors
        expected = result.solution.jacobian[:, k] * step[k]
        assert np.linalg.norm(change - expected) < 0.05 * np.linalg.norm(change), NAMES[k]


def cover(library, trials, runs, pressures, priors, floor=FLOOR):
    """Share of the trials whose intervals of modulus and dead volume hold the truth, the truth drawn again each time."""
    rng = np.random.default_rng(11)
    parameters = chosen(library, "modulus", "dead-volume", priors=priors)
    hits = np.zeros(2)
    for _ in range(trials):
        dead = DESIGNED.gas.dead_volume + parameters.prior_spread[DEAD] * rng.normal()
        # Wall and contact have priors, and so they are drawn.
        wall = np.sqrt(3.0) * parameters.prior_spread[WALL] * rng.uniform(-1, 1) if priors else 0.0
        offset = abs(parameters.prior_spread[OFFSET] * rng.normal()) if priors else 0.0
        modulus = 0.2 * np.exp(0.2 * rng.normal())
        truth = other(
            shear_modulus=modulus, dead_volume=dead, wall_thickness=DESIGNED.dome.wall_thickness * np.exp(wall)
        )
        seen = Observations(curves(truth, pressures, runs, rng, offset=offset))
        result = fit(seen, DESIGNED, parameters, floor)
        at = coordinates(truth)[[MODULUS, DEAD]]
        hits += np.abs(result.solution.at - at) <= result.half_width
    return hits / trials


@pytest.mark.slow
def test_intervals_hold_the_truth(library):
    """Of 30 trials at 95 %, fewer than 25 are hit with a chance of 0.3 %, as fewer than 52 of 60 are."""
    share = cover(library, 30, 2, (0.0, 12.0, 22.0), True)
    assert np.all(share >= 25 / 30)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("runs", "pressures", "priors"),
    [
        (2, (0.0, 12.0, 22.0), True),
        (2, (0.0, 12.0, 22.0), False),
        (3, (0.0, 12.0, 22.0), False),
        (2, (0.0, 22.0), False),
    ],
)
def test_intervals_hold_the_truth_in_200_trials(library, runs, pressures, priors):
    """Sensors of the atlas itself: nothing is left out, and the discrepancy is at its floor."""
    share = cover(library, 200, runs, pressures, priors, np.zeros(3))
    assert np.all(share >= 0.90)
    assert np.all(share <= 0.995)


def test_intervals_include_the_scatter_between_runs(library):
    """Gains that differ between runs widen the interval; points alone, however many, would not show it."""
    truth, rng = other(shear_modulus=0.2), np.random.default_rng(5)
    pressures, parameters = (0.0, 12.0, 22.0), chosen(library, "modulus", "dead-volume", priors=False)
    none = np.zeros(3)
    same = fit(Observations(curves(truth, pressures, 3, rng, gain=0.0)), DESIGNED, parameters, none)
    differ = fit(Observations(curves(truth, pressures, 3, rng, gain=0.02)), DESIGNED, parameters, none)
    assert differ.half_width[0] > 3 * same.half_width[0]
    finer = other(shear_modulus=0.2, steps=52)
    more = fit(Observations(curves(finer, pressures, 3, rng, gain=0.02)), DESIGNED, parameters, none)
    assert more.half_width[0] > 0.5 * differ.half_width[0]


def test_an_estimate_on_its_bound_has_no_interval(library):
    truth = other(dead_volume=0.0)
    few = curves(truth, (0.0, 12.0, 22.0), 2, np.random.default_rng(3))
    # Pressures that read 3 % high are what a cavity smaller than none would give.
    seen = tuple(type(c)(c.run, c.indentation, c.force, 1.03 * c.rise, c.driving) for c in few)
    result = fit(Observations(seen), DESIGNED, chosen(library, "modulus", "dead-volume", priors=False))
    assert result.full[DEAD] == 0.0
    assert result.solution.bound.tolist() == [False, True]
    assert np.isnan(result.half_width[1])
    assert 0 < result.half_width[0] < 0.1


def test_fewer_than_three_runs_give_an_interval_of_points(library):
    result = fit(
        Observations(curves(DESIGNED, (22.0,), 2, np.random.default_rng(1))), DESIGNED, chosen(library, "modulus")
    )
    assert not result.covariance.clustered
    assert np.isfinite(result.half_width).all()


def test_priors_pull_only_as_far_as_the_data_are_poor(library):
    """One shallow point leaves the prior; six curves overrule it."""
    truth, rng = other(shear_modulus=0.3), np.random.default_rng(8)
    many = fit(Observations(curves(truth, (0.0, 12.0, 22.0), 2, rng)), DESIGNED, chosen(library, "modulus"))
    assert np.exp(many.full[MODULUS]) == pytest.approx(0.3, rel=0.03)
    wall = fit(
        Observations((), injections(DESIGNED, np.array([50.0, 100.0]), 3, rng)),
        DESIGNED,
        chosen(library, "wall", "offset"),
    )
    assert wall.full[OFFSET] == 0.0
    assert wall.half_width[1] == pytest.approx(1.96 * wall.parameters.prior_spread[OFFSET], rel=1e-3)


def test_gauges_that_read_too_much_move_the_estimates_as_stated(library):
    truth, parameters = other(shear_modulus=0.2), chosen(library, "modulus", "dead-volume", priors=False)
    clean = exact(truth, (0.0, 12.0, 22.0))
    result = fit(Observations(clean), DESIGNED, parameters)
    force, pressure = gain_shifts(result)
    strong = tuple(type(c)(c.run, c.indentation, 1.01 * c.force, c.rise, c.driving) for c in clean)
    high = tuple(type(c)(c.run, c.indentation, c.force, 1.01 * c.rise, 1.01 * c.driving) for c in clean)
    for seen, expected in ((strong, force), (high, pressure)):
        moved = fit(Observations(seen), DESIGNED, parameters).solution.at - result.solution.at
        # The weights follow the residuals, so that they differ a little between the two fits.
        assert moved == pytest.approx(expected, rel=0.35, abs=0.3 * result.half_width.max() * 1e-3)


def test_points_beyond_the_models_range_are_left_out(library):
    """A hard dome buckles under the plate: the points after that are not fitted, the others give the modulus."""
    hard = other(shear_modulus=2.0, wall_thickness=1.0, depth=6.9, dead_volume=3000.0)
    seen = curves(hard, (0.0, 10.0), 2, np.random.default_rng(4), 0.001)
    end = max(float(c.indentation.max()) for c in seen if c.run.driving_pressure_kPa == 0.0)
    assert end < 6.7
    past = tuple(
        type(c)(
            c.run,
            np.append(c.indentation, [6.75, 6.9]),
            np.append(c.force, c.force[-1] * np.array([0.6, 0.5])),
            np.append(c.rise, c.rise[-1] * np.array([1.1, 1.2])),
            c.driving,
        )
        if c.run.driving_pressure_kPa == 0.0
        else c
        for c in seen
    )
    result = fit(Observations(past), hard, chosen(library, "modulus", priors=False, sensor=hard))
    assert result.left_out.sum() >= 4
    assert np.exp(result.full[MODULUS]) == pytest.approx(2.0, rel=0.02)


def test_deviations_of_the_model_are_located(library):
    """A softening that the model does not have: force 5 % lower beyond 4 mm at one pressure."""
    rng = np.random.default_rng(6)
    clean = curves(DESIGNED, (0.0, 12.0, 22.0), 3, rng, 0.002)
    bent = tuple(
        type(c)(
            c.run,
            c.indentation,
            np.where((c.indentation > 4) & (c.run.driving_pressure_kPa == 12), 0.9, 1.0) * c.force,
            c.rise,
            c.driving,
        )
        for c in clean
    )
    parameters = chosen(library, "modulus", "dead-volume")
    assert misses(fit(Observations(clean), DESIGNED, parameters)) == []
    result = misses(fit(Observations(bent), DESIGNED, parameters))
    worst = max(result, key=lambda miss: abs(miss.share))
    assert (worst.driving_pressure_kPa, worst.channel) == (12.0, "force")
    assert worst.share > 0.03
    assert worst.from_mm > 3.9


def test_residuals_are_model_less_measured_by_run(library):
    seen = curves(DESIGNED, (0.0, 22.0), 2, np.random.default_rng(9))
    rows = residuals(fit(Observations(seen), DESIGNED, chosen(library, "modulus")))
    assert [row.label for row in rows] == [curve.run.label for curve in seen]
    assert all(row.force.size == curve.force.size - 1 for row, curve in zip(rows, seen, strict=True))
    assert all(0 < row.force_error < 0.05 and 0 < row.rise_error < 0.05 for row in rows)
