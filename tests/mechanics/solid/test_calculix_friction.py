"""The press with friction by CalculiX, an independent program, where it is installed."""

from __future__ import annotations

import shutil

import numpy as np
import pytest
from benchmarks.scenes import paper

from tests.mechanics.solid.calculix_presses import calculix_held, calculix_press, solid_press

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        shutil.which("ccx") is None, reason="CalculiX (ccx) is not installed: the comparison is not made"
    ),
]


@pytest.mark.parametrize("friction", [0.0, 0.6])
def test_force_under_friction_agrees_with_calculix(friction):
    """On the same cells, with the solid's pressure over the depth; from where the contact is wider than two cells."""
    sensor, cells = paper(0.91), (24, 2)
    ours = solid_press(sensor, friction, 2.4, cells, 4)
    depths, forces, pressures = (ours.column(name) for name in ("indentation", "force", "pressure"))
    theirs = calculix_press(sensor, friction, depths, pressures, cells)
    assert np.isfinite(theirs).all()
    assert forces[2:] == pytest.approx(theirs[2:], rel=0.01)


@pytest.mark.parametrize("friction", [0.0, np.inf])
def test_force_under_a_plate_that_grips_agrees_with_nodes_that_calculix_holds_where_they_touch(friction):
    """Without CalculiX's friction, which does not count slip from first touch; sliding nodes show what is left of the
    contact by nodes itself."""
    sensor, cells = paper(0.91), (96, 2)
    ours = solid_press(sensor, friction, 2.4, cells, 16)
    forces = ours.column("force")
    theirs = calculix_held(sensor, ours, cells, finer=16, grips=friction > 0.0)
    assert np.isfinite(theirs).all()
    assert forces[4:] == pytest.approx(theirs[4:], rel=0.01)
