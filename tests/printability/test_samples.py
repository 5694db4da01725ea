"""Points spread over a part: as many as its area asks for, evenly, each for its share of the area."""

from __future__ import annotations

import manifold3d
import numpy as np
import pytest

from pneutouch.printability.measure.surface import SurfaceMesh, sample

SIDES = (20.0, 12.0, 6.0)


def box() -> SurfaceMesh:
    mesh = manifold3d.Manifold.cube(SIDES).to_mesh()
    return SurfaceMesh(np.array(mesh.vert_properties[:, :3]), np.array(mesh.tri_verts).astype(np.int64))


@pytest.mark.parametrize("spacing", [0.5, 1.0, 2.0])
def test_a_face_has_a_point_for_each_square_of_the_spacing(spacing):
    surface = box()
    samples = sample(surface, spacing)
    spread = samples.areas > 0.0
    counts = np.bincount(samples.faces[spread], minlength=len(surface.areas))
    assert np.abs(counts - surface.areas / spacing**2).max() <= 1.0
    assert samples.areas.sum() == pytest.approx(surface.areas.sum(), rel=1e-12)


def test_no_part_of_a_face_is_left_out():
    """Every square of 2 mm of the largest side holds about as many points as another."""
    samples = sample(box(), 0.5)
    top = samples.points[(samples.areas > 0.0) & (np.abs(samples.points[:, 2] - SIDES[2]) < 1e-9)]
    counts = np.histogram2d(top[:, 0], top[:, 1], bins=(10, 6), range=((0.0, SIDES[0]), (0.0, SIDES[1])))[0]
    assert counts.min() >= 10
    assert counts.max() <= 22
