"""States alone against the whole result: where inflation ends changes nothing before."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.errors import BeyondLimitError
from pneutouch.mechanics.models.solid import solid_result, solid_states
from pneutouch.units import KPA
from tests.mechanics.solid.test_graded import sensor


def test_states_alone_are_those_of_the_whole_result():
    pressures = np.array([0.0, 12.0]) * KPA
    one = sensor(0.0, 0.0)
    whole, alone = solid_result(one, pressures), solid_states(one, pressures)
    for a, b in zip(whole.states, alone, strict=True):
        assert a.figures == b.figures
        assert np.array_equal(a.force, b.force)
        assert a.events == b.events


def test_states_alone_are_refused_beyond_the_same_limit_point():
    one = sensor(0.0, 0.0)
    limit = solid_result(one, np.array([]), past_limit=1.0).limits.limit_point
    with pytest.raises(BeyondLimitError) as refused:
        solid_states(one, np.array([1.01 * limit]))
    assert refused.value.limit == pytest.approx(limit, rel=1e-9)
