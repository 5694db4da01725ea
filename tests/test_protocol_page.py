"""Readings of the paper's rig, the emulator of its presses, the sampler, and what the stored fit says of Table S1."""

import json

import numpy as np
import pytest
from benchmarks import protocol_fit as fit
from benchmarks.protocol import HELD_OUT, NODES, POINTS, RIMS, STEP, Reading, held_out, places, sensitivities, solved
from benchmarks.store import stored
from scipy.stats import multivariate_normal

from pneutouch.evaluation.table_s1 import PRESSURES

KNOWN = stored("protocol")
NODE_MM = STEP * np.arange(1, NODES + 1)


def rig(limit=np.inf, offset=0.0, grown=0.0, hold=1.0):
    return Reading(*(np.array([value]) for value in (limit, offset, grown, hold)))


def curve(force, rise, end=np.nan, growth=0.0):
    """A press as a row of the emulator's table."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.concatenate([np.log(force), np.log(rise), [np.log(end - 5.0), np.log(growth)]])[None, :]


BENT = curve(3.0 * NODE_MM**1.5, 3.9 * NODE_MM**2, growth=0.6)


def slope(travel, force, rise):
    return np.polyfit(force(travel), rise(travel), 1)[0]


def test_a_straight_curve_gives_its_slope_whatever_the_rig_does():
    straight = curve(4.0 * NODE_MM, 8.0 * NODE_MM, growth=0.5)
    for one in (rig(), rig(limit=15.0), rig(offset=0.37), rig(grown=1.0)):
        assert sensitivities(straight, 22.0, one) == pytest.approx(2.0, rel=1e-9)


def test_steps_end_at_the_force_that_the_rig_bears_at_the_buckling_and_at_the_gauge():
    def expected(last):
        return slope(STEP * np.arange(last + 1), lambda z: 3.0 * z**1.5, lambda z: 3.9 * z**2)

    assert sensitivities(BENT, 0.0, rig()) == pytest.approx(expected(10), rel=1e-9)  # 3.9 z^2 is 97.5 kPa at 5 mm.
    assert sensitivities(BENT, 40.0, rig()) == pytest.approx(expected(7), rel=1e-9)
    assert sensitivities(BENT, 0.0, rig(limit=24.1)) == pytest.approx(expected(8), rel=1e-9)  # 24 N at 4 mm.
    buckles = np.array(BENT)
    buckles[0, 2 * NODES] = np.log(0.001)
    buckles[0, NODES : 2 * NODES] -= np.log(2.0)
    assert 2.0 * sensitivities(buckles, 0.0, rig()) == pytest.approx(expected(10), rel=1e-9)


def test_an_offset_loses_travel_growth_adds_it_and_a_force_that_relaxes_divides():
    lost = slope(np.append(0.0, STEP * np.arange(1, 11) - 0.2), lambda z: 3.0 * z**1.5, lambda z: 3.9 * z**2)
    assert sensitivities(BENT, 0.0, rig(offset=0.2)) == pytest.approx(lost, rel=0.01)
    assert sensitivities(BENT, 0.0, rig(offset=0.2)) < sensitivities(BENT, 0.0, rig())
    assert sensitivities(BENT, 22.0, rig(grown=1.0)) > sensitivities(BENT, 22.0, rig())
    assert sensitivities(BENT, 0.0, rig(grown=1.0)) == sensitivities(BENT, 0.0, rig())
    assert 1.2 * sensitivities(BENT, 0.0, rig(hold=1.2)) == pytest.approx(sensitivities(BENT, 0.0, rig()), rel=1e-12)


@pytest.mark.parametrize("rim", [RIMS[0], pytest.param(RIMS[1], marks=pytest.mark.slow)])
def test_a_stored_press_is_what_the_solid_gives_today(rim):
    # The softest of the places held out: the quickest.
    k = POINTS + int(np.argmin(places()[POINTS : POINTS + HELD_OUT, 0] + 9.0 * (places()[POINTS:, 0] < 0.11)))
    for pressure in PRESSURES:
        known = fit.emulator().known[rim][f"{pressure:g}"][k]
        today = solved(places()[k], rim, pressure)
        assert np.array(known[: 2 * NODES]) == pytest.approx(np.append(today.force, today.rise), abs=1e-3)
        assert known[-1] == pytest.approx(today.growth, abs=1e-3)


def test_the_emulator_gives_presses_that_it_has_not_seen():
    off = np.abs(held_out(fit.emulator()))
    assert np.median(off) < 0.006
    assert np.sqrt(np.mean(off**2)) < 0.02


def test_the_sampler_finds_a_normal_posterior_and_its_evidence():
    middle, spread = np.array([0.4, 0.6, 0.5]), np.array([[4.0, 2.4, 0.0], [2.4, 3.0, 0.5], [0.0, 0.5, 1.0]]) * 1e-3
    inverse = np.linalg.inv(spread)
    found = fit.sample(lambda x: -0.5 * np.einsum("ni,ij,nj->n", x - middle, inverse, x - middle), 3, 7, 2000, 15)
    deviation = np.sqrt(np.diag(spread))
    assert found.shares.mean(axis=0) == pytest.approx(middle, abs=0.1 * deviation.max())
    assert np.abs((np.cov(found.shares.T) - spread) / np.outer(deviation, deviation)).max() < 0.12
    assert found.log_evidence == pytest.approx(0.5 * np.log(np.linalg.det(2.0 * np.pi * spread)), abs=0.15)


def test_the_likelihood_is_that_of_two_correlated_cells_for_each_resin():
    off, own, repeatability = np.array([[[0.05, -0.02], [0.1, 0.12]]]), np.array([0.03]), np.array([0.01, 0.002])
    covariances = [(0.03**2 + r**2) * np.eye(2) + fit.PRINTS**2 for r in repeatability]
    logs = [multivariate_normal(cov=c).logpdf(d) for d, c in zip(off[0], covariances, strict=True)]
    assert fit.log_likelihood(off, own, repeatability) == pytest.approx(sum(logs))
    assert fit.log_likelihood(np.full((1, 2, 2), np.nan), own, repeatability) == -np.inf


def test_the_ratio_is_scored_beside_the_cells():
    for row in (KNOWN["summary"]["default"], *KNOWN["summary"]["hypotheses"]):
        table = (1.0 + np.array(row["cells"])) * fit.measured().sensitivity
        truth = fit.measured().sensitivity
        known = (table[:, 1] / table[:, 0]) / (truth[:, 1] / truth[:, 0]) - 1.0
        assert row["ratios"] == pytest.approx(known.tolist())
        assert row["ratios_met"] == int((np.abs(known) <= 0.08).sum())


def test_the_summary_is_that_of_the_stored_draws():
    def same(one, other):
        if isinstance(one, dict):
            assert one.keys() == other.keys()
            return all(same(one[key], other[key]) for key in one)
        if isinstance(one, list):
            return len(one) == len(other) and all(map(same, one, other))
        return one == (pytest.approx(other, rel=1e-6, abs=1e-9) if isinstance(other, float) else other)

    assert same(json.loads(json.dumps(fit.reduced(KNOWN))), KNOWN["summary"])


@pytest.mark.slow
def test_a_posterior_drawn_anew_is_the_stored_one():
    name = "moduli in their ranges"
    found = fit.fitted(name, seed=3)
    assert found.log_evidence == pytest.approx(KNOWN["evidence"][name], abs=0.6)


def test_two_runs_of_the_posterior_agree():
    for row in KNOWN["summary"]["unknowns"]:
        assert row["runs_differ"] < 0.35, row["name"]
    assert KNOWN["summary"]["evidences_differ"] < 1.0
