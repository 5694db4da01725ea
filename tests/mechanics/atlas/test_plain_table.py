"""The atlas beside a plain table of answers over the same box: how many nodes that would need."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import RegularGridInterpolator

from pneutouch.mechanics.atlas.respond import respond
from pneutouch.mechanics.atlas.table import shipped
from tests.mechanics.atlas.sampled import batch

VALUES, GRID = 4000, (11, 9, 7, 7, 7)


def sensitivities(points: np.ndarray) -> np.ndarray:
    """The atlas at rows of (log wall, share of the limit, log ambient, dead/(1 + dead), depth)."""
    wall, gas = np.exp(points[:, 0]), np.exp(points[:, 2])
    limit = shipped().slices(np.unique(wall)).limit_pressure[np.unique(wall, return_inverse=True)[1]]
    dead, driving = points[:, 3] / (1 - points[:, 3]), points[:, 1] * limit
    sensors = batch(
        wall_thickness=wall, ambient_pressure=gas, driving_pressure=driving, depth=points[:, 4], dead_volume=dead
    )
    return respond(sensors).lines.sensitivity


@pytest.mark.slow
def test_a_plain_table_of_answers_needs_far_more_nodes():
    """A grid over the five numbers that a press depends on, linear between its nodes: at second order, for 0.5 % everywhere."""
    low, high = (
        np.array([np.log(0.06), 0.0, np.log(0.01), 0.0, 0.2]),
        np.array([np.log(0.35), 0.95, np.log(3.0), 0.8, 0.6]),
    )
    nodes = [np.linspace(a, b, n) for a, b, n in zip(low, high, GRID, strict=True)]
    values = sensitivities(np.stack(np.meshgrid(*nodes, indexing="ij"), axis=-1).reshape(-1, 5)).reshape(GRID)
    table = RegularGridInterpolator(nodes, np.log(values))
    points = np.random.default_rng(1).uniform(low, high, (VALUES, 5))
    error = np.abs(np.exp(table(points)) / sensitivities(points) - 1.0)
    worst = error[np.isfinite(error)].max()
    needed = values.size * (worst / 0.005) ** (5 / 2)
    assert needed > 100 * shipped().recipe.walls * shipped().recipe.volumes * shipped().recipe.depths
