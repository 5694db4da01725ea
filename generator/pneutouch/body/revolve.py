"""Revolve a sampled meridian into a closed triangle mesh, cheaper than a plain grid at the same error.

Each ring gets only as many vertices as its own radius needs, and its polygon is widened until it
encloses the area of its circle, which keeps the volume. Strips between rings of different counts are
zipped. A ring's count depends on its radius, lean and error alone: two bodies that share a planar face
with the same rings get the same triangles there.
"""

import itertools
import math
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array, Indices
from pneutouch.meridian import Meridian, MeridianVertex, sample


def circle_count(radius: float, error: float, lean: float = 1.0) -> int:
    """Array, a multiple of four, that keep a widened polygon within ``error`` mm of its circle."""
    if radius <= 0:
        return 1
    # widen() moves a vertex out by r theta^2/12 to leading order, theta being the angle between vertices.
    needed = 2 * math.pi * math.sqrt(radius * lean / (12 * error))
    count = max(8, 4 * math.ceil(needed / 4))
    while radius * lean * (widen(count) - 1) > error:
        count += 4
    return count


def widen(count: int) -> float:
    """Factor on the radius that gives a regular polygon the area of the circle."""
    if count == 1:
        return 1.0
    angle = 2 * math.pi / count
    return math.sqrt(angle / math.sin(angle))


@dataclass(frozen=True)
class RevolvedRings:
    """A revolved meridian before its strips are put together.

    ``starts`` and ``counts`` locate the vertices of a ring; ``pairs`` are the two rings of each strip, in the order
    of the meridian, and ``strips`` their triangles.
    """

    rings: list[MeridianVertex]
    counts: list[int]
    starts: list[int]
    vertices: Array
    pairs: list[tuple[int, int]]
    strips: list[Indices]


def revolve_rings(meridian: Meridian, tolerance: float) -> RevolvedRings:
    """Mesh a solid of revolution strip by strip.

    Half of ``tolerance`` (mm) goes to the meridian's chords and half to the circles'.
    """
    error = 0.5 * tolerance
    rings = sample(meridian, error)
    counts = [circle_count(ring.radius, error, ring.lean) for ring in rings]
    starts = [0, *itertools.accumulate(counts)][:-1]
    vertices = np.concatenate([_ring_points(r, n) for r, n in zip(rings, counts, strict=True)])
    pairs = [(k, k + 1) for k in range(len(rings) - 1)]
    if meridian.is_ring:
        pairs.append((len(rings) - 1, 0))
    strips = []
    for a, b in pairs:
        # Always zip from the smaller ring, so that a face is the same for both directions.
        swap = (rings[a].radius, rings[a].height) > (rings[b].radius, rings[b].height)
        one, other = (b, a) if swap else (a, b)
        strip = _zip(starts[one], counts[one], starts[other], counts[other])
        strips.append(strip[:, ::-1] if swap else strip)
    return RevolvedRings(rings, counts, starts, vertices, pairs, strips)


def revolve(meridian: Meridian, tolerance: float) -> tuple[Array, Indices]:
    """Mesh a solid of revolution within ``tolerance`` mm: vertices (n, 3) in mm, triangles (m, 3) facing outwards."""
    made = revolve_rings(meridian, tolerance)
    return made.vertices, np.concatenate(made.strips)


def _ring_points(ring: MeridianVertex, count: int) -> Array:
    angle = 2 * np.pi * np.arange(count) / count
    radius = ring.radius * widen(count)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.full(count, ring.height)])


def _zip(first: int, n: int, second: int, m: int) -> Indices:
    """Indices between two rings that start at vertex ``first`` (``n`` of them) and ``second`` (``m``).

    Walks both rings at once, always stepping on the one whose next vertex comes first.
    """
    steps = np.concatenate([np.arange(1, n + 1) / n, np.arange(1, m + 1) / m])
    on_first = np.concatenate([np.ones(n, bool), np.zeros(m, bool)])
    order = np.argsort(steps, kind="stable")
    on_first = on_first[order]
    i = np.cumsum(on_first) - on_first
    j = np.cumsum(~on_first) - ~on_first
    a, b = first + i % n, second + j % m
    ahead = np.where(on_first, first + (i + 1) % n, second + (j + 1) % m)
    triangles = np.column_stack([a, ahead, b])
    # A ring of one vertex lies on the axis; stepping along it would make triangles without area.
    return triangles[~on_first if n == 1 else on_first if m == 1 else slice(None)]
