"""Level sets on a grid against shapes with known volumes, and how far the surfaces' meshes are off."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.parts.specimen import Box
from pneutouch.parts.specimen.surfaces import SURFACES, MarchingGrid, PeriodicSurface, between, level_set
from tests.parts.specimen.shapes import STEP, body

BOX = Box((0.0, 0.0, 0.0), (2.0, 2.0, 2.0))


def sphere(points):
    return np.linalg.norm(points - 1.0, axis=1)


def field(grid, wave):
    nodes = np.stack(np.meshgrid(*grid.lines(), indexing="ij"), axis=-1)
    return wave(nodes.reshape(-1, 3)).reshape(grid.shape)


@pytest.mark.parametrize("steps", [16, 32])
def test_a_ball_and_a_shell(steps):
    grid = MarchingGrid(BOX, (steps, steps, steps))
    values = field(grid, sphere)
    ball = between(grid, sphere, values, None, 0.8)
    assert body(ball).is_closed()
    assert ball.volume == pytest.approx(4 / 3 * np.pi * 0.8**3, rel=4 / steps**2 * 2)
    shell = between(grid, sphere, values, 0.5, 0.8)
    assert shell.volume == pytest.approx(4 / 3 * np.pi * (0.8**3 - 0.5**3), rel=4 / steps**2 * 2)


def test_a_plane_cut_by_the_box_is_exact():
    def height(points):
        return points[:, 2] + 0.3 * points[:, 0]

    grid = MarchingGrid(BOX, (5, 7, 4))
    part = between(grid, height, field(grid, height), None, 1.13)
    assert body(part).is_closed()
    assert part.volume == pytest.approx(2 * 2 * (1.13 - 0.3), rel=1e-9)


@pytest.mark.parametrize("kind", SURFACES)
@pytest.mark.parametrize("level", [0.0, 0.4])
def test_surfaces_keep_the_finest_step_but_for_a_hundredth_of_them(kind, level):
    surface, box = PeriodicSurface(kind, 5.0, "network", STEP), Box((0.0, 0.0, 0.0), (5.0, 5.0, 5.0))
    grid, wave = surface.grid(box), surface.at(box)
    mesh = level_set(grid, wave, surface.values(grid), level)
    corners = mesh.vertices[mesh.triangles]
    points = np.concatenate([mesh.vertices, corners.mean(axis=1), 0.5 * (corners[:, 0] + corners[:, 1])])
    slopes = [(wave(points + 1e-4 * e) - wave(points - 1e-4 * e)) / 2e-4 for e in np.eye(3)]
    off = np.abs(wave(points) - level) / np.linalg.norm(slopes, axis=0)
    assert np.percentile(off, 99) <= STEP
    assert off.max() <= 2 * STEP
