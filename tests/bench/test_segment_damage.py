"""Records with gaps, clips and spikes: the points that they spoil are left out and reported, the others stay."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from pneutouch.bench.curve import curve_of
from pneutouch.bench.reading import PLATE, read_blocks
from pneutouch.bench.record import SuspectInterval
from pneutouch.bench.run_warnings import MOST
from pneutouch.bench.source import identify
from pneutouch.errors import InputError
from pneutouch.spec.campaign import ColumnMap, Rig
from tests.bench.curves import FILE, curve, whys
from tests.bench.reads import blocks_of
from tests.bench.rig import run_of, small, write


def test_clipped_points_are_left_out_and_reported():
    samples = small()
    blocks = blocks_of(FILE, *samples)
    third = curve(samples).indents[2]
    clipped = replace(
        blocks, warnings=(SuspectInterval(third.hold[0], third.hold[1], "force clipped: at the top", False),)
    )
    result = curve_of(run_of(), clipped, Rig())
    assert result.indentation.size == 3
    assert any(
        why.startswith("indentation 3, ") and "left out: force clipped" in why for why in whys(result, used=False)
    )
    everywhere = replace(blocks, warnings=(SuspectInterval(0.0, 1e3, "force clipped", False),))
    with pytest.raises(InputError, match=r"none of 3 indentations can be used: .*clipped"):
        curve_of(run_of(), everywhere, Rig())


def test_a_gap_in_what_is_read_leaves_the_point_out_and_elsewhere_not():
    samples = small()
    one = curve(samples).indents[1]
    time = samples[0]
    lost = (time > one.read[0] - 0.05) & (time < one.read[1])
    gone = curve(samples[:, ~lost])
    assert gone.indentation.size == 3
    assert any("left out: most of its samples are missing" in why for why in whys(gone, used=False))
    lost = (time > one.hold[0] + 0.3) & (time < one.hold[0] + 0.9)
    kept = curve(samples[:, ~lost])
    assert kept.indentation.size == 4
    assert kept.force == pytest.approx(curve(samples).force, abs=1e-3)
    assert any(why.startswith("gap: ") for why in whys(kept))


@pytest.mark.parametrize("first", [-1.0, 0.0, 0.2, 0.45])
def test_a_gap_that_swallows_the_begin_of_the_window(first):
    """What is left of it, down to a block, does not stand for it."""
    samples = small()
    one = curve(samples).indents[1]
    begin, end = one.read
    time, whole = samples[0], end - begin
    lost = (time > begin + first * whole) & (time < end - 0.02)
    result = curve(samples[:, ~lost])
    assert result.indentation.size == 3
    assert result.indents[1].read == (pytest.approx(begin, abs=0.03), pytest.approx(end, abs=0.03))
    lost = (time > begin + 0.6 * whole) & (time < end)
    assert curve(samples[:, ~lost]).indentation.size == 4


def test_gaps_beyond_those_listed_count_too():
    samples = small(depths=(1.0, 2.0, 3.0, 4.0, 5.0))
    one, time = curve(samples).indents[-1], samples[0]
    keep = np.ones(time.size, bool)
    for start in np.arange(0.3, 0.3 + 0.5 * (MOST + 4), 0.5):
        keep[(time > start) & (time < start + 0.15)] = False
    # Two gaps in the window, each less than half of it.
    whole = one.read[1] - one.read[0]
    for start in (0.1, 0.55):
        keep[(time > one.read[0] + start * whole) & (time < one.read[0] + (start + 0.4) * whole)] = False
    result = curve(samples[:, keep])
    assert any(why.startswith("indentation 5, ") and "missing" in why for why in whys(result, used=False))
    listed = [warning for warning in result.warnings if warning.kind == "gap"]
    assert len(listed) == MOST + 1 and sum("6 more gaps: " in warning.why for warning in listed) == 1


def test_a_spike_while_read_leaves_the_point_out_and_elsewhere_not(tmp_path):
    samples = small()
    one = curve(samples).indents[1]
    for at, size in ((one.read[0] + 0.1, 3), (one.hold[0] + 0.3, 4)):
        spiked = samples.copy()
        spiked[2, np.searchsorted(samples[0], at)] = 60.0
        blocks = read_blocks(identify(write(tmp_path / "run.csv", spiked), ColumnMap(), PLATE), Rig())
        result = curve_of(run_of(), blocks, Rig())
        assert result.indentation.size == size and any("force spike: 60 N" in why for why in whys(result))
