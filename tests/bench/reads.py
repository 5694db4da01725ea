"""Files read with the usual columns and rig, and how a file is spoilt."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.bench.reading import PLATE, read_blocks
from pneutouch.bench.record import BlockCollector
from pneutouch.bench.source import identify
from pneutouch.errors import InputError
from pneutouch.spec.campaign import ColumnMap, Rig

COLUMNS, RIG = ColumnMap(), Rig()


def read(path, columns=COLUMNS, rig=RIG):
    return read_blocks(identify(path, columns, PLATE), rig)


def refuse(path, *texts, columns=COLUMNS, rig=RIG):
    with pytest.raises(InputError) as caught:
        read(path, columns, rig)
    assert str(caught.value).startswith(f"{path}: ")
    for text in texts:
        assert text in str(caught.value)


def spoilt(tmp_path, file, row, old=None, new=""):
    """A copy of a file with a row changed: whole, or a cell of it (the header is row 1)."""
    lines = file.read_text().splitlines(keepends=True)
    cells = lines[row - 1].rstrip("\n").split(",")
    if old is None:
        lines[row - 1] = new
    else:
        cells[old] = new
        lines[row - 1] = ",".join(cells) + "\n"
    path = tmp_path / "spoilt.csv"
    path.write_text("".join(lines))
    return path


def blocks_of(file, time, *samples, rate=None, size=None):
    """Blocks of samples in memory, (n,) each, s, mm, N, MPa, without range checks."""
    collector = BlockCollector(file, rate, size, len(time))
    collector.take(np.arange(len(time), dtype=float) + 2, np.vstack([time, *samples]).astype(float))
    return collector.blocks()
