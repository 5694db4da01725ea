"""Normals for shading: averaged where a surface is smooth, apart where it has an edge."""

import math

import numpy as np

from pneutouch.arrays import Array, Index
from pneutouch.body.mesh import Body

_EDGE_COSINE = math.cos(math.radians(40))
"""Cosine of the angle between two triangles from which on the line between them is drawn as an edge. Facets of an arc
within the mesh tolerance meet at a few degrees, the edges of parts at 45 degrees and more."""


def corner_normals(body: Body) -> Array:
    """Unit normals at the corners of every triangle, (m, 3, 3).

    A corner's normal is the mean of the triangles that share its vertex and lie within the edge angle of the corner's
    triangle, weighted by their angles there (Thürmer and Wüthrich 1998, DOI 10.1080/10867651.1998.10487487).
    """
    face, angle = _faces(body.corners)
    vertex, count = body.triangles.reshape(-1), 3 * len(body.triangles)
    order = np.argsort(vertex, kind="stable")
    at = vertex[order]
    start, stop = np.searchsorted(at, vertex, "left"), np.searchsorted(at, vertex, "right")
    owner, other = _pairs(start, stop)
    other = order[other]
    smooth = np.einsum("ij,ij->i", face[owner // 3], face[other // 3]) >= _EDGE_COSINE
    weighted = face[other // 3] * (angle.reshape(-1)[other] * smooth)[:, None]
    total = np.stack([np.bincount(owner, weighted[:, k], minlength=count) for k in range(3)], axis=1)
    length = np.linalg.norm(total, axis=1, keepdims=True)
    flat = np.repeat(face, 3, axis=0)
    return np.where(length > 1e-9, total / np.maximum(length, 1e-30), flat).reshape(-1, 3, 3)


def _faces(corners: Array) -> tuple[Array, Array]:
    """Unit normals (m, 3) and the angles at the corners (m, 3) of triangles (m, 3, 3); zero for those without area."""
    along = corners[:, [1, 2, 0]] - corners
    normal = np.cross(along[:, 0], -along[:, 2])
    area = np.linalg.norm(normal, axis=1)
    before = -along[:, [2, 0, 1]]
    angle = np.arctan2(area[:, None], np.einsum("ijk,ijk->ij", along, before))
    known = area > 1e-12
    return np.where(known[:, None], normal / np.maximum(area, 1e-30)[:, None], 0.0), angle * known[:, None]


def _pairs(start: Index, stop: Index) -> tuple[Index, Index]:
    """Every index from start to stop, (n,) each, and whose it is."""
    count = stop - start
    owner = np.repeat(np.arange(count.size), count)
    return owner, np.arange(owner.size) - np.repeat(np.cumsum(count) - count - start, count)
