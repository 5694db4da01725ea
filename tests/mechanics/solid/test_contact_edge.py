"""Where a contact ends between two of its points."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.mechanics.solid.object_contact import _edge


@pytest.mark.parametrize("edge", [1.0, 1.03, 1.1])
def test_it_is_where_a_gap_that_opens_with_the_square_of_the_distance_begins(edge):
    radii = np.array([1.0, 1.1, 1.2])
    assert _edge(radii, 7.0 * (radii[1:] - edge) ** 2) == pytest.approx(edge, rel=1e-12)


def test_a_gap_that_does_not_open_further_leaves_the_middle():
    assert _edge(np.array([1.0, 1.1, 1.2]), np.array([4e-4, 1e-4])) == pytest.approx(1.05, rel=1e-12)


def test_at_the_end_of_the_wall_it_is_the_last_point_that_touches():
    assert _edge(np.array([1.0, 1.1]), np.array([1e-4])) == 1.0
