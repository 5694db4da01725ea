"""docs/background/texture.md is made of the stored numbers, and they are what the reduced model gives today."""

from __future__ import annotations

import json

import numpy as np
import pytest
from benchmarks.strip import AGILUS
from benchmarks.texture_page import DOCS, HEIGHT, KINDS
from benchmarks.texture_text import page

from pneutouch.texture.substrate import BarRow, MatrixLayer, amplitude


def stored():
    return json.loads((DOCS / "texture.json").read_text(encoding="utf-8"))


def test_page_is_made_of_the_stored_numbers():
    assert (DOCS / "texture.md").read_text(encoding="utf-8") == page(stored())


def test_stored_numbers_are_what_the_model_gives():
    for row in stored()["single"]:
        width, height = KINDS[row["pitch"]]
        bars = BarRow("", row["pitch"], width, height, row["depth"], np.array([[0.0, width]]))
        ours = -float(amplitude(MatrixLayer(HEIGHT, *AGILUS), bars, np.array(row["radius"])))
        assert ours == pytest.approx(row["reduced"], rel=1e-6)
