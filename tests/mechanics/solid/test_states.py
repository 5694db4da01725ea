"""States alone against the whole result: where inflation ends changes nothing before."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.catalogue import Library
from pneutouch.errors import BeyondLimitError
from pneutouch.mechanics.models.solid import solid_result, solid_states
from pneutouch.mechanics.paper_sensor import material_sensor
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


def test_the_pressed_walls_stand_under_the_plate_at_their_indentations():
    """Also between the steps of the test, where the solver divides one that is too long for it."""
    one = material_sensor(Library.default().load("materials", "TangoPlus")).replace(depth=6.9, steps=3, waves=0)
    (state,) = solid_result(one, np.array([0.0])).states
    walls = state.walls
    assert len(walls.indentation) == len(walls.inner) == len(walls.outer) > 4
    np.testing.assert_allclose(walls.outer[:, :, 1].max(axis=1), state.apex_outer - walls.indentation, atol=1e-3)
