"""Intervals of few values cover what they state, and the plain bootstrap does not."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.bench.statistics import mean_of, spread_between, spread_within

TRIALS = 1500


def holds(estimate, truth):
    return estimate.low <= truth <= estimate.high


def campaigns(specimens, runs, part=0.03, repeat=0.01, seed=1):
    draw = np.random.default_rng(seed)
    means = 2.0 + part * draw.standard_normal((TRIALS, specimens, 1))
    return means + repeat * draw.standard_normal((TRIALS, specimens, runs))


def share(estimates, truth):
    return np.mean([holds(estimate, truth) for estimate in estimates])


@pytest.mark.parametrize(("specimens", "runs"), [(3, 3), (5, 3), (2, 3), (1, 3)])
def test_the_mean_is_covered(specimens, runs):
    values = campaigns(specimens, runs)
    truths = np.full(TRIALS, 2.0) if specimens > 1 else None
    if truths is None:
        # One specimen gives no scatter between specimens.
        draw = np.random.default_rng(2)
        values = 2.0 + 0.01 * draw.standard_normal((TRIALS, 1, runs))
        truths = np.full(TRIALS, 2.0)
    held = [holds(mean_of(list(trial)), truth) for trial, truth in zip(values, truths, strict=True)]
    assert 0.93 < np.mean(held) < 0.97


def test_the_percentile_bootstrap_of_three_covers_far_less_than_it_states():
    values = campaigns(3, 3).mean(axis=2)
    draws = np.random.default_rng(3).integers(0, 3, (500, 3))
    low, high = np.percentile(values[:, draws].mean(axis=2), [2.5, 97.5], axis=1)
    assert 0.65 < np.mean((low <= 2.0) & (high >= 2.0)) < 0.85


def test_standard_deviations_are_covered():
    values = campaigns(3, 3)
    assert 0.93 < share([spread_within(list(trial)) for trial in values], 0.01) < 0.97
    between = np.hypot(0.03, 0.01 / np.sqrt(3))
    assert 0.93 < share([spread_between(list(trial)) for trial in values], between) < 0.97


def test_the_mean_of_three_has_the_interval_of_student():
    estimate = mean_of([np.array([1.0]), np.array([2.0]), np.array([4.0])])
    assert estimate.value == pytest.approx(7 / 3)
    assert estimate.high - estimate.value == pytest.approx(4.302653 * np.std([1, 2, 4], ddof=1) / np.sqrt(3))
    assert (estimate.specimens, estimate.runs, estimate.over) == (3, 3, "specimens")


def test_one_value_has_no_interval():
    assert mean_of([np.array([1.0])]).low is None
    assert spread_within([np.array([1.0])]).low is None
    assert np.isnan(spread_between([np.array([1.0, 2.0])]).value)


def test_specimens_weigh_the_same_however_many_runs_they_have():
    assert mean_of([np.array([1.0, 1.0, 1.0]), np.array([3.0])]).value == 2.0
