"""2,000 random presses: each reaches its depth, or ends by an event or an error that names its kind."""

import pytest

from tests.stability.random_scenes import DOMES, PRESSES, ends

PARTS = 50


@pytest.mark.slow
def test_the_presses_of_a_random_dome_end():
    assert len(ends(3)) == PRESSES


@pytest.mark.slow
@pytest.mark.parametrize("part", range(PARTS))
def test_random_presses_end(part):
    for seed in range(part * DOMES // PARTS, (part + 1) * DOMES // PARTS):
        assert len(ends(seed)) == PRESSES
