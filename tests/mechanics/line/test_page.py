"""The stored numbers of docs/background/dynamics.md are what the code gives today."""

from __future__ import annotations

import pytest
from benchmarks.dynamics import measure
from benchmarks.store import stored


def test_peaks_and_tubes_are_those_of_today():
    found, known = measure(), stored("dynamics")
    for one, other in zip(found["peaks"], known["peaks"], strict=True):
        assert one == pytest.approx(other)
        # Published and computed first peaks.
        assert one[5] == pytest.approx(one[3], rel=0.05) and one[6] == pytest.approx(one[4], rel=0.05)
    for one, other in zip(found["tubes"], known["tubes"], strict=True):
        assert one == pytest.approx(other)
