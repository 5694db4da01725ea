"""The stored numbers of docs/background/texture.md are what the reduced model gives today."""

from __future__ import annotations

import json

import numpy as np
import pytest
from benchmarks.store import stored
from benchmarks.strip import AGILUS
from benchmarks.texture import HEIGHT, KINDS, reduced

from pneutouch.texture.substrate import BarRow, MatrixLayer, amplitude


def test_the_summary_is_that_of_the_stored_numbers():
    assert json.loads(json.dumps(reduced(stored("texture")))) == stored("texture")["summary"]


def test_stored_numbers_are_what_the_model_gives():
    for row in stored("texture")["single"]:
        width, height = KINDS[row["pitch"]]
        bars = BarRow("", row["pitch"], width, height, row["depth"], np.array([[0.0, width]]))
        ours = -float(amplitude(MatrixLayer(HEIGHT, *AGILUS), bars, np.array(row["radius"])))
        assert ours == pytest.approx(row["reduced"], rel=1e-6)
