"""What the model leaves out is in the intervals: walls that remember, walls that are not as designed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import norm

from pneutouch.bench.calibrate.fit import fit
from pneutouch.bench.calibrate.fitted_atlas import FLOOR, shared_of
from pneutouch.bench.calibrate.intervals import _half
from pneutouch.bench.calibrate.observations import Observations, points_of
from pneutouch.bench.calibrate.parameters import USUAL, WALL, parameters
from tests.bench.calibrate.sensors import DESIGNED, chosen, curves, other
from tests.bench.calibrate.simulated import designed, held, trial

BOTH = (USUAL, ("modulus", "dead-volume"))
PLANS = (((0.0, 22.0), 2), ((0.0, 22.0), 3), ((0.0, 12.0, 22.0), 2), ((0.0, 12.0, 22.0), 3))


def shares(library, resins, trials, plans, model="atlas"):
    """Share of the trials whose intervals of modulus and dead volume hold the truth, (parameter sets, 2)."""
    hits, count = np.zeros((len(BOTH), 2)), 0
    for resin in resins:
        nominal, material = designed(library, resin), library.load("materials", resin)
        printer = library.load("printers", "objet260-connex")
        chosen = [parameters(nominal, material, printer, names) for names in BOTH]
        for number in range(trials):
            rng = np.random.default_rng([number, *resin.encode()])
            one = trial(nominal, *plans[number % len(plans)], rng, model)
            hits += [held(one, nominal, names)[1] for names in chosen]
            count += 1
    return hits / count


@pytest.mark.slow
def test_intervals_hold_the_truth_of_simulated_sensors(library):
    """Of 12 trials at 95 %, fewer than 8 are hit with a chance of 2e-4."""
    assert np.all(shares(library, ("TangoPlus", "FLX9960"), 6, PLANS[:1]) >= 8 / 12)


@pytest.mark.slow
def test_intervals_hold_the_truth_of_200_simulated_sensors(library):
    result = shares(library, ("TangoPlus", "FLX9960"), 100, PLANS)
    assert np.all(result >= 0.90)
    assert np.all(result <= 0.995)


@pytest.mark.slow
def test_intervals_hold_the_truth_of_the_solids_sensors(library):
    """Of 8 trials at 95 %, fewer than 5 are hit with a chance of 4e-4."""
    assert np.all(shares(library, ("TangoPlus", "FLX9960"), 4, PLANS, "solid") >= 5 / 8)


def test_the_common_share_and_the_smooth_one_of_a_channel_have_the_same_variance(library):
    points = points_of(Observations(curves(other(shear_modulus=0.2), (0.0, 22.0), 2, np.random.default_rng(6))))
    shared = shared_of(points)
    for channel in np.unique(points.channels):
        of_it = (
            shared.columns[:, shared.kind == channel] / np.where(points.values == 0.0, np.inf, points.values)[:, None]
        )
        here = (points.channels == channel) & (points.values != 0.0)
        # One column is the share of all readings, the others those that vary along the travel.
        assert of_it[here, 0] == pytest.approx(1.0)
        assert (of_it[here, 1:] ** 2).sum(axis=1) == pytest.approx(1.0, abs=0.02)


@pytest.mark.parametrize("share", [0.03, 0.08])
def test_a_misfit_at_one_pressure_is_sized_by_the_residuals(library, share):
    """A force that deviates by half a wave along the travel, at one pressure, is found as large as it is, to a factor of two."""
    clean = curves(other(shear_modulus=0.2), (0.0, 12.0, 22.0), 3, np.random.default_rng(6), 0.002)
    waved = tuple(
        replace(
            c,
            force=c.force
            * (1 + share * np.sqrt(2) * np.cos(np.pi * c.indentation / 6.5) * (c.run.driving_pressure_kPa == 12)),
        )
        for c in clean
    )
    known = chosen(library, "modulus", "dead-volume")
    calm, result = fit(Observations(clean), DESIGNED, known), fit(Observations(waved), DESIGNED, known)
    assert calm.sizes == pytest.approx(FLOOR)
    assert 0.4 * share < result.sizes[0] < 2.5 * share
    assert abs(result.full[0] - np.log(0.2)) < result.half_width[0]


def test_a_wall_that_is_not_fitted_counts_with_priors_alone(library):
    """A wall off by 0.08 mm moves the modulus; its bounds are in the interval, unless priors are left aside."""
    truth = other(shear_modulus=0.2, wall_thickness=1.58)
    seen = Observations(curves(truth, (0.0, 12.0, 22.0), 3, np.random.default_rng(3), 0.002))
    names = ("modulus", "dead-volume")
    informed, bare = (fit(seen, DESIGNED, chosen(library, *names, priors=priors)) for priors in (True, False))
    off = abs(informed.solution.at[0] - np.log(0.2))
    assert bare.half_width[0] < off < informed.half_width[0]
    assert not bare.covariance.considered.any()
    moved = informed.covariance.considered[0, WALL] / informed.parameters.prior_spread[WALL]
    thick = fit(seen, other(wall_thickness=1.58), chosen(library, *names, sensor=other(wall_thickness=1.58)))
    expected = moved * np.log(1.5 / 1.58)
    assert thick.solution.at[0] - informed.solution.at[0] == pytest.approx(-expected, rel=0.25)


@pytest.mark.parametrize(("deviation", "bound"), [(1.0, 1e-9), (1.0, 0.5), (1.0, 1.0), (0.3, 1.0), (1e-9, 1.0)])
def test_an_even_error_and_a_normal_one_together(deviation, bound):
    """Against a sum over many even values; of one alone its own quantile."""
    half = _half(deviation, bound)
    at = bound * (2 * (np.arange(20000) + 0.5) / 20000 - 1)
    inside = np.mean(norm.cdf((half - at) / deviation) - norm.cdf((-half - at) / deviation))
    assert inside == pytest.approx(0.95, abs=1e-4)
