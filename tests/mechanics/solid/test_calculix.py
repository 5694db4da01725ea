"""The same inflation by CalculiX, an independent program, where it is installed."""

from __future__ import annotations

import shutil

import pytest
from benchmarks.calculix_sweep import calculix_limit
from benchmarks.scenes import PAPER, Scene
from benchmarks.speed_accuracy import solid_limit


@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX (ccx) is not installed: the comparison is not made")
def test_limit_pressure_agrees_with_calculix():
    """Eight-node cells with reduced integration; its pressure rises by at least 0.2 % an increment."""
    theirs, increments, _, _ = calculix_limit(PAPER, 24, 2)
    assert increments > 5
    assert solid_limit(Scene("paper", PAPER, 0.0), 24, 2) == pytest.approx(theirs, rel=5e-3)
