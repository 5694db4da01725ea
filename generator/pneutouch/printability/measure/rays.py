"""Rays through a mesh."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from pneutouch.arrays import Array, Indices

_SELF = 1e-7
"""A hit this near the middle of a line (mm) is the surface that its middle lies on."""


@dataclass(frozen=True)
class Neighbours:
    """Nearest faces before and behind the middle of each line: distances (n, 2), mm, inf for none, and faces (n, 2), -1
    for none."""

    distances: Array
    faces: Indices


def neighbours(manifold: Any, middles: Array, directions: Array, reach: float) -> Neighbours:
    """Cast lines through ``middles`` (n, 3), from ``reach`` mm before along unit ``directions`` (n, 3) to as far past.

    ``manifold`` is manifold3d's; its hits come in order along the line.
    """
    cast = manifold.ray_cast
    count = len(middles)
    distances, faces = np.full((count, 2), np.inf), np.full((count, 2), -1, dtype=np.int64)
    margin = 0.5 * _SELF / reach
    low, high = 0.5 - margin, 0.5 + margin
    starts, ends = (middles - reach * directions).tolist(), (middles + reach * directions).tolist()
    for k in range(count):
        before = behind = None
        for hit in cast(starts[k], ends[k]):
            share = hit.distance
            if share < low:
                before = (share, hit.face_id)
            elif share > high:
                behind = (share, hit.face_id)
                break
        if before is not None:
            distances[k, 0], faces[k, 0] = before
        if behind is not None:
            distances[k, 1], faces[k, 1] = behind
    span = 2 * reach
    distances[:, 0] = np.where(faces[:, 0] >= 0, (0.5 - distances[:, 0]) * span, np.inf)
    distances[:, 1] = np.where(faces[:, 1] >= 0, (distances[:, 1] - 0.5) * span, np.inf)
    return Neighbours(distances, faces)


def first_hits(manifold: Any, starts: Array, directions: Array, reach: float) -> Neighbours:
    """The first hit of each ray, columns [nothing, hit] as in `Neighbours`."""
    cast = manifold.ray_cast
    count = len(starts)
    distances, faces = np.full((count, 2), np.inf), np.full((count, 2), -1, dtype=np.int64)
    begins, ends = starts.tolist(), (starts + reach * directions).tolist()
    for k in range(count):
        for hit in cast(begins[k], ends[k]):
            distances[k, 1], faces[k, 1] = hit.distance * reach, hit.face_id
            break
    return Neighbours(distances, faces)
