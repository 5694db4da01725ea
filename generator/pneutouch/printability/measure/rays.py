"""Rays through a mesh."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from pneutouch.arrays import Array, Indices

_SELF = 1e-7
"""A hit this near the middle of a line (mm) is the surface that its middle lies on."""


@dataclass(frozen=True)
class Neighbours:
    """What lies next before and next behind the middle of each line: distances (n, 2), mm, inf where nothing, and faces
    (n, 2), -1 where nothing."""

    distances: Array
    faces: Indices


def neighbours(
    manifold: Any, middles: Array, directions: Array, reach: float, before: float | None = None
) -> Neighbours:
    """Cast lines through ``middles`` (n, 3) along unit ``directions`` (n, 3), from ``before`` mm before them to
    ``reach`` mm past them; left out, ``before`` is ``reach`` too.

    ``manifold`` is manifold3d's; its hits come in order along the line.
    """
    back = reach if before is None else before
    cast = manifold.ray_cast
    count = len(middles)
    distances, faces = np.full((count, 2), np.inf), np.full((count, 2), -1, dtype=np.int64)
    span = back + reach
    middle, margin = back / span, _SELF / span
    low, high = middle - margin, middle + margin
    starts, ends = (middles - back * directions).tolist(), (middles + reach * directions).tolist()
    for k in range(count):
        front = behind = None
        for hit in cast(starts[k], ends[k]):
            share = hit.distance
            if share < low:
                front = (share, hit.face_id)
            elif share > high:
                behind = (share, hit.face_id)
                break
        if front is not None:
            distances[k, 0], faces[k, 0] = front
        if behind is not None:
            distances[k, 1], faces[k, 1] = behind
    distances[:, 0] = np.where(faces[:, 0] >= 0, (middle - distances[:, 0]) * span, np.inf)
    distances[:, 1] = np.where(faces[:, 1] >= 0, (distances[:, 1] - middle) * span, np.inf)
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
