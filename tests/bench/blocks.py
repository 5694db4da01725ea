"""Blocks of samples in memory."""

from pathlib import Path

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.record import BlockCollector, Blocks


def blocks_of(
    file: Path,
    time: Array,
    position: Array,
    force: Array,
    pressure: Array,
    rate: float | None = None,
    size: int | None = None,
) -> Blocks:
    """Blocks of samples in memory, (n,) each, s, mm, N, MPa, without range checks. Raises as `BlockCollector`."""
    collector = BlockCollector(file, rate, size, len(time))
    collector.take(np.arange(len(time), dtype=float) + 2, np.vstack([time, position, force, pressure]).astype(float))
    return collector.blocks()
