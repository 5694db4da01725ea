"""Derivatives against samples: twice the standard deviation of the logarithm, and for the sensitivity the interval too.

A k = 2 interval holds more than 95.45 % where one rectangular source dominates (a rectangle ends at 1.73 standard
uncertainties), so intervals are compared for the sensitivity alone, which many sources make.
"""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.mechanics.atlas.figures import FIGURES, SENSITIVITY
from pneutouch.mechanics.uncertainty.document import monte_carlo
from tests.mechanics.uncertainty.designs import TEN, batch_for, budget_for

FLOOR = 0.01
"""Expanded uncertainties below a per cent: rare other ends of the range, which no three points see."""


def compare(library, case, count):
    batch = batch_for(library, case)
    found = budget_for(library, batch, case.resin, case.near_paper)
    sampled = monte_carlo(batch, found.sources, count=count)
    for i, name in enumerate(FIGURES):
        if max(2 * sampled.standard[i], found.expanded[i, 0]) > FLOOR:
            assert found.expanded[i, 0] == pytest.approx(2 * sampled.standard[i], rel=0.10), name
    assert found.expanded[SENSITIVITY, 0] == pytest.approx(sampled.half_width[SENSITIVITY], rel=0.10)
    assert (found.expanded[:, 0] > 0.9 * sampled.half_width)[sampled.half_width > FLOOR].all()
    assert sampled.lost.max() < 0.01


@pytest.mark.slow
@pytest.mark.parametrize("case", [TEN[1], TEN[5]], ids=lambda case: case.resin)
def test_a_few_thousand_samples_agree(library, case):
    compare(library, case, 4000)


@pytest.mark.slow
@pytest.mark.parametrize("case", TEN, ids=lambda case: f"{case.resin}-{case.driving_pressure}")
def test_twenty_thousand_samples_agree(library, case):
    compare(library, case, 20_000)


def test_the_same_seed_gives_the_same_samples(library):
    batch = batch_for(library, TEN[0])
    sources = budget_for(library, batch, "TangoPlus", True).sources
    one, two, other = (monte_carlo(batch, sources, count=300, seed=seed) for seed in (3, 3, 4))
    assert np.array_equal(one.standard, two.standard)
    assert not np.array_equal(one.standard, other.standard)


def test_samples_beyond_the_limit_point_are_counted(library):
    """33 of 39.6 kPa: a modulus down to 0.10 MPa of 0.17 snaps many of them."""
    case = TEN[0]._replace(driving_pressure=0.033)
    batch = batch_for(library, case)
    found = budget_for(library, batch, case.resin, True)
    lost = monte_carlo(batch, found.sources, count=1000).lost
    # Uniform ln(mu/0.17) over +-0.497 with 6 % more: below ln(33/39.6) = -0.182 in (0.497 - 0.182)/0.993 of the cases.
    assert lost[FIGURES.index("apex_height_outer_mm")] == pytest.approx(0.317, abs=0.05)
    assert lost[FIGURES.index("limit_pressure_kPa")] == 0.0
