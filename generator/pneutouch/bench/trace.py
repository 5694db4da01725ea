"""A run thinned for looking at: few enough points to plot, and where it was read."""

from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array, Indices
from pneutouch.bench.record import Blocks

MOST = 3000
"""Points of a trace: more than a page shows. Even, as two are kept of each stretch."""


class Trace(NamedTuple):
    """A run thinned, (n,): s, mm, N, MPa.

    Two points stand for each stretch of it: time and position are those of its first and its last block, force and
    pressure its least and greatest, whichever came first before the other. So a spike or a short clip is seen, at most
    a stretch off its time.
    """

    time: Array
    position: Array
    force: Array
    pressure: Array


def trace(blocks: Blocks) -> Trace:
    """The blocks as they are where they are at most `MOST`, else thinned evenly to that."""
    size = blocks.time.size
    if size <= MOST:
        return Trace(blocks.time.copy(), blocks.position.copy(), blocks.force.copy(), blocks.pressure.copy())
    edges = np.linspace(0, size, MOST // 2 + 1).astype(int)
    ends = np.stack([edges[:-1], edges[1:] - 1], axis=1).ravel()
    return Trace(blocks.time[ends], blocks.position[ends], _span(blocks.force, edges), _span(blocks.pressure, edges))


def _span(values: Array, edges: Indices) -> Array:
    """Least and greatest of the stretches between ``edges`` (m + 1,), in the order in which they come, (2 m,)."""
    starts = edges[:-1]
    within = np.repeat(np.arange(starts.size), np.diff(edges))
    place = np.arange(values.size)
    low, high = np.minimum.reduceat(values, starts), np.maximum.reduceat(values, starts)
    never = values.size
    first_low = np.minimum.reduceat(np.where(values == low[within], place, never), starts)
    first_high = np.minimum.reduceat(np.where(values == high[within], place, never), starts)
    falls = first_high < first_low
    return np.stack([np.where(falls, high, low), np.where(falls, low, high)], axis=1).ravel()
