"""A run thinned for looking at: few enough points to plot, and where it was read."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pneutouch.bench.record import Blocks
from pneutouch.meridian.segments import Array

MOST = 3000
"""Points of a trace: more than a page shows."""


class Trace(NamedTuple):
    """Every k-th block of a run, (n,): s, mm, N, MPa."""

    time: Array
    position: Array
    force: Array
    pressure: Array


def trace(blocks: Blocks) -> Trace:
    """The blocks thinned evenly to at most `MOST`."""
    every = max(1, int(np.ceil(blocks.time.size / MOST)))
    return Trace(*(np.array(part[::every]) for part in (blocks.time, blocks.position, blocks.force, blocks.pressure)))
