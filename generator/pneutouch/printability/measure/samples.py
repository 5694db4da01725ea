"""Points spread over a surface, the same ones every time."""

from dataclasses import dataclass
from typing import cast

import numpy as np

from pneutouch.arrays import Array, Indices
from pneutouch.printability.measure.surface import SurfaceMesh

SPACING = 0.5
"""Points lie about this far apart, mm, on parts small enough."""

MOST = 9000
"""Points of a part; a larger one gets a wider spacing, and still one point on every face group."""

_INSET = 0.02
"""Distance of a point near an edge from it, mm."""

_GOLDEN = (0.7548776662466927, 0.5698402909980532)
"""Steps of the R2 sequence, which fills a square evenly (Roberts 2018): powers of 1/1.3247, the plastic number."""


@dataclass(frozen=True)
class SurfaceSamples:
    """Points (n, 3) in mm, the face each lies on (n,), and the area each stands for (n,), mm2.

    Points right near drawn edges stand for no area: they are there because a taper is thinnest at its edge.
    """

    points: Array
    faces: Indices
    areas: Array


def sample(surface: SurfaceMesh, spacing: float = SPACING, most: int = MOST) -> SurfaceSamples:
    """Spread points by area, and put one in the middle of the largest face of every smooth group at least.

    Every face of a mesh with fewer than ``most`` faces gets one: curved faces are cut finely, so they are seen finely.
    """
    areas = surface.areas
    counts = _counts(surface, spacing, most)
    faces = np.repeat(np.arange(len(areas)), counts)
    first = np.concatenate([[0], np.cumsum(counts)[:-1]])
    serial = np.arange(len(faces)) - first[faces]
    u, v = np.mod(0.5 + np.outer(serial, _GOLDEN), 1.0).T
    fold = u + v > 1
    u, v = np.where(fold, 1 - u, u), np.where(fold, 1 - v, v)
    # A single point sits in the middle; the first of the sequence does not.
    u, v = (np.where(counts[faces] == 1, 1 / 3, w) for w in (u, v))
    weights = 0.98 * np.column_stack([1 - u - v, u, v]) + 0.02 / 3
    points = np.einsum("nk,nkd->nd", weights, surface.corners[faces])
    near, near_faces = _near_edges(surface, spacing)
    return SurfaceSamples(
        np.concatenate([points, near]),
        np.concatenate([faces, near_faces]),
        np.concatenate([areas[faces] / counts[faces], np.zeros(len(near_faces))]),
    )


def _near_edges(surface: SurfaceMesh, spacing: float) -> tuple[Array, Indices]:
    """Points on both faces near each drawn edge, in its middle and, where it is long, near its ends."""
    edges = surface.edges
    drawn = np.flatnonzero(surface.creases)
    ends = surface.vertices[edges.ends[drawn]]
    long = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) > 2 * spacing
    points, faces = [], []
    for share, rows in ((0.5, np.arange(len(drawn))), (0.03, np.flatnonzero(long)), (0.97, np.flatnonzero(long))):
        on_edge = (1 - share) * ends[rows, 0] + share * ends[rows, 1]
        for side in (0, 1):
            face = edges.faces[drawn[rows], side]
            inwards = surface.corners[face].mean(axis=1) - on_edge
            length = np.linalg.norm(inwards, axis=1, keepdims=True)
            points.append(on_edge + inwards * np.minimum(_INSET / np.maximum(length, _INSET), 0.3))
            faces.append(face)
    return np.concatenate(points), np.concatenate(faces)


def _counts(surface: SurfaceMesh, spacing: float, most: int) -> Indices:
    """Points of each face."""
    areas = surface.areas
    quota = max(spacing**2, float(areas.sum()) / most)
    steps = np.floor(np.concatenate([[0.0], np.cumsum(areas)]) / quota + 0.5)
    counts = np.diff(steps).astype(np.int64)
    if len(areas) <= most:
        return cast(Indices, np.maximum(counts, areas > 0))
    order = np.lexsort((areas, surface.groups))
    last = np.append(np.flatnonzero(np.diff(surface.groups[order])), len(order) - 1)
    counts[order[last]] = np.maximum(counts[order[last]], 1)
    return counts
