"""Words of the notes of a fit."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.bench.calibrate.notes import amount
from pneutouch.bench.calibrate.parameters import DEAD, FRICTION, MODULUS, OFFSET, WALL


@pytest.mark.parametrize(
    ("parameter", "deviation", "words"),
    [
        (MODULUS, np.log(1.05), "5 %"),
        (MODULUS, np.log(2.0), "a factor of 2"),
        (WALL, np.log(1.02), "2 %"),
        (DEAD, 300.0, "0.3 mL"),
        (OFFSET, 0.15, "0.15 mm"),
        (FRICTION, 0.25, "0.25"),
    ],
)
def test_a_deviation_is_stated_in_the_unit_of_its_parameter(parameter, deviation, words):
    assert amount(parameter, deviation) == words
