"""What a channel cannot have measured: gaps, clips, spikes and dead channels are reported with their intervals."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from pneutouch.bench.reading import _check_alive
from pneutouch.errors import InputError
from pneutouch.spec.campaign import Column, ColumnMap, Rig
from pneutouch.units import KPA
from tests.bench.reads import read, refuse
from tests.bench.rig import Faults, record, small, write


@pytest.fixture(scope="module")
def samples():
    return small()


def test_gaps_are_warnings_and_most_of_a_record_missing_is_an_error(tmp_path, samples):
    keep = np.ones(samples.shape[1], bool)
    keep[4000:4500] = False
    keep[[100, 200, 201]] = False
    long, short = read(write(tmp_path / "a.csv", samples[:, keep])).warnings
    assert long.why == "gap: 500 samples missing" and not long.used
    assert (long.start, long.end) == (pytest.approx(3.999), pytest.approx(4.5))
    assert short.why.startswith(f"3 of {samples.shape[1] - 500} samples missed, in 2 places") and short.used
    keep[2000 : int(samples.shape[1] * 0.7)] = False
    refuse(write(tmp_path / "a.csv", samples[:, keep]), "more than half", "column time_s")


def test_missed_samples_are_counted_across_chunks(tmp_path, monkeypatch):
    lossy = small(missed=0.02)
    path = write(tmp_path / "a.csv", lossy)
    monkeypatch.setattr("pneutouch.tables.csv_table.CHUNK", 3001)
    lost = round((lossy[0, -1] - lossy[0, 0]) * 1000) + 1 - lossy.shape[1]
    (warning,) = read(path).warnings
    assert warning.why.startswith(f"{lost} of {lossy.shape[1] + lost} samples missed")


def test_clipped_stretches_are_found(tmp_path, samples):
    top = samples[2].max() * 0.8
    clipped = samples.copy()
    clipped[2] = np.minimum(clipped[2], top)
    true = samples[0][samples[2] > top + 0.1]
    by_range = read(write(tmp_path / "a.csv", clipped), rig=Rig(force_range_N=float(top))).warnings
    flat = read(write(tmp_path / "a.csv", clipped)).warnings
    for warnings, words in ((by_range, "of the range"), (flat, "flat top")):
        (warning,) = warnings
        assert words in warning.why and "force clipped" in warning.why and not warning.used
        assert warning.start <= true[0] + 0.05 and warning.end >= true[-1] - 0.05
        assert warning.end - warning.start < true[-1] - true[0] + 0.3


def test_a_coarse_or_noiseless_channel_is_not_clipped(tmp_path, samples):
    coarse = samples.copy()
    coarse[2] = np.round(coarse[2] / 0.1) * 0.1
    assert read(write(tmp_path / "a.csv", coarse)).warnings == ()
    still = small(force_noise=0.0, pressure_noise=0.0)
    assert read(write(tmp_path / "a.csv", still)).warnings == ()


def test_a_reading_far_beyond_the_range_is_questioned(tmp_path, samples):
    (warning,) = read(write(tmp_path / "a.csv", samples), rig=Rig(force_range_N=0.5)).warnings
    assert "beyond the rig's range of 0.5" in warning.why and warning.used
    # All of the record, but for what a mean of some readings leaves out at its ends.
    every = read(write(tmp_path / "b.csv", samples)).time
    assert (warning.start, warning.end) == (every[0], every[-1])


@pytest.mark.parametrize(("channel", "name"), [(1, "position_mm"), (2, "force_N"), (3, "pressure_kPa")])
def test_a_dead_channel_is_named(tmp_path, samples, channel, name):
    dead = samples.copy()
    dead[channel] = 0.5 * KPA
    refuse(write(tmp_path / "a.csv", dead), f"column {name}: dead")


def test_a_plate_that_stands_still_is_dead_only_where_the_force_shows_a_press():
    """A leak is recorded with the plate at rest."""
    rng = np.random.default_rng(1)
    still = {
        "position": np.full(50, 3.0),
        "force_spread": np.full(50, 0.02),
        "size": 50,
        "file": "a.csv",
        "first_row": [2],
    }
    names = {"position": "position_mm", "force": "force_N", "pressure": "pressure_kPa"}
    _check_alive(SimpleNamespace(**still, force=0.02 * rng.standard_normal(50)), names)
    with pytest.raises(InputError, match=r"column position_mm: dead: .* from row 2 on while the force changes"):
        _check_alive(SimpleNamespace(**still, force=np.linspace(0.0, 8.0, 50)), names)


def test_a_spike_hides_no_clipping(tmp_path, samples):
    top = samples[2].max() * 0.8
    clipped = samples.copy()
    clipped[2] = np.minimum(clipped[2], top)
    spiked = clipped.copy()
    spiked[2, 700] = 1.3 * top
    rig = Rig(force_range_N=float(top))
    (alone,) = read(write(tmp_path / "a.csv", clipped), rig=rig).warnings
    spike, still = sorted(read(write(tmp_path / "a.csv", spiked), rig=rig).warnings)
    assert still == alone and still.kind == "clipped"
    assert spike.kind == "spike" and "force spike" in spike.why and not spike.used
    assert spike.start <= 0.7 <= spike.end and spike.end - spike.start < 0.05
    # Nor a flat top far below the range.
    spiked[2, 700] = 60.0
    spike, still = sorted(read(write(tmp_path / "a.csv", spiked)).warnings)
    assert (
        spike.kind == "spike"
        and "flat top" in still.why
        and still.end - still.start == pytest.approx(alone.end - alone.start, abs=0.3)
    )


def test_many_spikes_are_no_unit(tmp_path, samples):
    """Half a second of them in all, and yet none lasts."""
    spiked = samples.copy()
    spiked[2, 300:9000:170] = 55.0
    warnings = read(write(tmp_path / "a.csv", spiked)).warnings
    assert len(warnings) > 50 and {warning.kind for warning in warnings} == {"spike"}


def test_a_few_missed_samples_are_a_note(tmp_path):
    few = small(rate=4000.0)
    keep = np.ones(few.shape[1], bool)
    keep[[500, 900, 901]] = False
    (note,) = read(write(tmp_path / "a.csv", few[:, keep])).warnings
    assert note.kind == "note" and note.used and note.why.startswith(f"3 of {few.shape[1]} samples missed, in 2 places")
    keep[902] = False
    (burst,) = read(write(tmp_path / "a.csv", few[:, keep])).warnings
    assert burst.kind == "other"
    keep[902] = True
    keep[1000 : few.shape[1] : 900] = False
    (often,) = read(write(tmp_path / "a.csv", few[:, keep])).warnings
    assert often.kind == "other"


@pytest.mark.parametrize("value", ["3e307", "-1e200"])
def test_a_number_that_overflows_in_inner_units_is_named(tmp_path, samples, value):
    path = write(tmp_path / "a.csv", samples)
    lines = path.read_text().splitlines(keepends=True)
    cells = lines[99].split(",")
    lines[99] = ",".join([cells[0], value, *cells[2:]])
    path.write_text("".join(lines))
    columns = ColumnMap(position=Column(name="position_mm", unit="m"))
    refuse(path, "row 100", "column position_mm", "e+", "no instrument reads that", columns=columns)


def test_a_gap_across_a_move_kills_no_channel(tmp_path):
    """The one block after the gap has moved farthest; it is no evidence on force and pressure."""
    slow = record(faults=Faults(rate=100.0))
    rests = np.flatnonzero(slow[1] < slow[1].min() + 0.1)
    holds = np.flatnonzero(slow[1] > slow[1].max() - 0.1)
    keep = np.ones(slow.shape[1], bool)
    keep[rests[rests < holds[0]][-1] : holds[0] + 5] = False
    (gap, *_) = read(write(tmp_path / "a.csv", slow[:, keep])).warnings
    assert gap.kind == "gap" and not gap.used
