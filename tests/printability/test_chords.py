"""Lengths through a part from exact surface to exact surface."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from pneutouch.printability.measure.chords import refined

RADIUS = 5.0


def test_ends_that_a_mesh_puts_off_its_surface_are_moved_onto_it():
    """Across a ball whose facets leave it by some hundredths, inwards at one end and outwards at the other."""
    start, end = np.array([[-4.97, 0.0, 0.0], [-5.02, 0.0, 0.0]]), np.array([[4.96, 0.0, 0.0], [5.03, 0.0, 0.0]])
    direction = np.tile([1.0, 0.0, 0.0], (2, 1))
    chords = SimpleNamespace(start=start, end=end, direction=direction, length=end[:, 0] - start[:, 0])
    exact = refined(chords, lambda points: np.abs(np.linalg.norm(points, axis=1) - RADIUS))
    assert exact == pytest.approx([2.0 * RADIUS] * 2, rel=1e-12)
