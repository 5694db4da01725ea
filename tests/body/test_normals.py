"""Normals of a mesh: those of the exact surface where it is smooth, one a face along edges."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.body import Body
from pneutouch.body.solid import corner_normals


@pytest.fixture(scope="module")
def membrane(evaluated):
    return evaluated("paper-dome", model="atlas").assembly.solid("membrane")


def test_normals_on_the_dome_are_those_of_the_sphere(membrane):
    body = membrane.mesh(0.02)
    normals, corners = corner_normals(body), body.corners
    radius = np.linalg.norm(corners, axis=2)
    for surface, side in ((9.25, -1.0), (10.75, 1.0)):
        on = (np.abs(radius - surface) < 0.03).all(axis=1) & (corners[..., 2].min(axis=1) > 1.5)
        assert on.sum() > 300
        cosine = np.einsum("ijk,ijk->ij", normals[on], side * corners[on] / radius[on][..., None])
        # A flat facet of this mesh is up to five degrees off; half a degree is not seen.
        assert np.degrees(np.arccos(np.clip(cosine, -1, 1))).max() < 0.6


def test_every_face_of_a_cube_keeps_its_own_normal(membrane):
    from manifold3d import Manifold

    mesh = Manifold.cube((2.0, 3.0, 4.0)).to_mesh64()
    points, triangles = np.array(mesh.vert_properties[:, :3]), mesh.tri_verts.astype(np.int64)
    cube = Body("cube", "connector", membrane.material, points, triangles)
    a, b, c = np.moveaxis(cube.corners, 1, 0)
    flat = np.cross(b - a, c - a)
    flat /= np.linalg.norm(flat, axis=1, keepdims=True)
    np.testing.assert_allclose(corner_normals(cube), np.repeat(flat[:, None], 3, axis=1), atol=1e-12)


def test_the_rim_of_the_dome_stays_an_edge(membrane):
    body = membrane.mesh(0.02)
    normals = corner_normals(body).reshape(-1, 3)
    low = body.corners.reshape(-1, 3)[:, 2] < body.vertices[:, 2].min() + 1e-9
    down = normals[low][:, 2]
    assert ((np.abs(down + 1) < 1e-9) | (np.abs(down) < 1e-9)).all()


def test_a_triangle_without_area_has_no_influence(membrane):
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [2, 0, 0]])
    body = Body("flat", "connector", membrane.material, points, np.array([[0, 1, 2], [0, 1, 3]]))
    np.testing.assert_allclose(corner_normals(body)[0], np.tile([0.0, 0.0, 1.0], (3, 1)))
    assert np.isfinite(corner_normals(body)).all()
