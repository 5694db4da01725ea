"""What force and pressure are before a contact: mean, slope and scatter."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from pneutouch.bench.first_contact import baseline


def blocks(time, force, pressure):
    spread = np.full(time.size, 0.1)
    return SimpleNamespace(time=time, force=force, pressure=pressure, force_spread=spread, pressure_spread=spread)


@pytest.mark.parametrize("count", [3, 4, 30])
def test_a_drift_is_its_slope_and_no_scatter(count):
    time = np.linspace(2.0, 5.0, count)
    found = baseline(blocks(time, 0.2 + 0.03 * time, 5.0 - 0.4 * time), 0, count)
    assert found.slope == pytest.approx((0.03, -0.4), rel=1e-9)
    assert found.mean == pytest.approx((0.2 + 0.03 * 3.5, 5.0 - 0.4 * 3.5), rel=1e-12)
    assert max(found.between) < 1e-24
    assert found.within == pytest.approx((0.01, 0.01), rel=1e-12)


def test_two_blocks_have_no_slope():
    time = np.array([0.0, 1.0])
    assert baseline(blocks(time, time, time), 0, 2).slope == (0.0, 0.0)


def test_the_scatter_is_that_of_the_noise_whatever_the_drift():
    """The mean square over the degrees of freedom that the line leaves, drawn 2000 times."""
    rng, time = np.random.default_rng(4), np.arange(6.0)
    drawn = [baseline(blocks(time, time + 0.2 * rng.standard_normal(6), time), 0, 6).between[0] for _ in range(2000)]
    assert np.mean(drawn) == pytest.approx(0.04, rel=0.05)
