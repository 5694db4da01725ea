"""A thinned run shows what was in it, at its place."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from pneutouch.bench.record import MOST, MeasuredCurve, SuspectInterval, trace
from pneutouch.report.fit_charts import evidence_svg
from pneutouch.units import KPA
from tests.bench.reads import blocks_of
from tests.bench.rig import run_of


def long_run(size=60_000, wild=()):
    """Ten minutes of blocks; ``wild`` are blocks and what is added to the force there."""
    time = np.arange(size) / 100.0
    force = 2 + np.sin(time / 20)
    for at, more in wild:
        force[at] += more
    return blocks_of(Path("run.csv"), time, 5 - np.cos(time / 20), force, 12 * KPA + 0.1 * KPA * force)


@pytest.mark.parametrize("at", [1, 30_017, 59_990])
@pytest.mark.parametrize("more", [3.0, -3.0])
def test_a_single_block_is_seen_near_its_time(at, more):
    blocks = long_run(wild=[(at, more)])
    thinned = trace(blocks)
    assert thinned.time.size <= MOST
    far = np.abs(thinned.force - (2 + np.sin(thinned.time / 20))) > 1.0
    assert far.sum() == 1 and thinned.force[far][0] == blocks.force[at]
    assert abs(thinned.time[far][0] - blocks.time[at]) < 600 / MOST * 2


def test_extremes_of_a_stretch_come_in_their_order():
    blocks = long_run(wild=[(30_003, 3.0), (30_007, -3.0), (40_003, -3.0), (40_007, 3.0)])
    thinned = trace(blocks)
    wild = thinned.force - (2 + np.sin(thinned.time / 20))
    assert np.sign(wild[np.abs(wild) > 1]).tolist() == [1, -1, -1, 1]


def test_all_channels_are_within_the_run_and_time_runs_on():
    blocks, thinned = long_run(), trace(long_run())
    assert (np.diff(thinned.time) > 0).all()
    assert (thinned.time[0], thinned.time[-1]) == (blocks.time[0], blocks.time[-1])
    assert thinned.position == pytest.approx(5 - np.cos(thinned.time / 20), abs=1e-9)
    for key in ("force", "pressure"):
        values, all_of_them = getattr(thinned, key), getattr(blocks, key)
        assert (values.min(), values.max()) == (all_of_them.min(), all_of_them.max())


def test_a_short_run_is_whole():
    blocks = long_run(MOST)
    thinned = trace(blocks)
    for key in ("time", "position", "force", "pressure"):
        assert np.array_equal(getattr(thinned, key), getattr(blocks, key))


def test_a_note_marks_nothing_and_a_warning_does():
    def drawn(*warnings):
        zero = np.array([0.0, 1.0])
        return evidence_svg(
            MeasuredCurve(run_of(), zero, zero, zero, 0.0, warnings=warnings), trace(long_run(500)), False
        )

    note = SuspectInterval(0.0, 5.0, "3 of 5000 samples missed", True, "note")
    assert drawn(note) == drawn()
    assert "doubtful" in drawn(note, SuspectInterval(1.0, 2.0, "gap", False, "gap")) and "doubtful" not in drawn()
