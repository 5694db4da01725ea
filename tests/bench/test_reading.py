"""Files to blocks: what is read is what was written, and each kind of damage is told as what it is."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from pneutouch.bench.blocks import blocks_of
from pneutouch.bench.reading import read_blocks
from pneutouch.errors import InputError
from pneutouch.spec.campaign import Column, Columns, Rig
from pneutouch.units import KPA
from tests.bench.rig import HEADER, Faults, record, small, write

COLUMNS, RIG = Columns(), Rig()


@pytest.fixture(scope="module")
def samples():
    return small()


@pytest.fixture(scope="module")
def file(tmp_path_factory, samples):
    return write(tmp_path_factory.mktemp("run") / "run.csv", samples)


def read(path, columns=COLUMNS, rig=RIG):
    return read_blocks(path, columns, rig)


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


def test_blocks_are_the_means_of_the_samples(file, samples):
    blocks = read(file)
    assert blocks.rate == pytest.approx(1000) and blocks.size == 10
    whole = samples.shape[1] // 10
    parts = samples[:, : whole * 10].reshape(4, whole, 10)
    for row, values in enumerate((blocks.time, blocks.position, blocks.force, blocks.pressure)):
        assert values[:whole] == pytest.approx(parts[row].mean(axis=1), abs=5e-5)  # written with four decimals
    assert blocks.force_spread[:whole] == pytest.approx(parts[2].std(axis=1), abs=1e-5)
    assert blocks.pressure_extreme[:whole] == pytest.approx(np.abs(parts[3]).max(axis=1), abs=1e-8)
    assert blocks.first_row[:3].tolist() == [2, 12, 22]
    assert blocks.doubts == ()


def test_chunks_do_not_show(file, monkeypatch):
    once = read(file)
    monkeypatch.setattr("pneutouch.bench.csv_table.CHUNK", 7001)
    many = read(file)
    for name in ("first_row", "time", "position", "force_spread", "pressure_extreme"):
        assert getattr(many, name) == pytest.approx(getattr(once, name), rel=1e-12, abs=1e-15)


def test_units_and_signs_are_those_of_the_columns(tmp_path, samples):
    path = tmp_path / "other.csv"
    names = ["t", "z", "load", "p", "note"]
    table = np.vstack(
        [samples[0] * 1e3, -samples[1] * 1e3, samples[2] / 4.4482216152605, samples[3] / 6.894757293168e-3]
    )
    frame = pd.DataFrame(table.T, columns=names[:4]).assign(note="ok, fine")
    frame.to_csv(path, index=False)
    columns = Columns(
        time=Column(name="t", unit="ms"), position=Column(name="z", unit="um", sign=-1),
        force=Column(name="load", unit="lbf"), pressure=Column(name="p", unit="psi"),
    )  # fmt: skip
    found, expected = read(path, columns), blocks_of(path, *samples)
    for name in ("time", "position", "force", "pressure", "force_spread", "pressure_extreme"):
        assert getattr(found, name) == pytest.approx(getattr(expected, name), rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_dialects_read_alike(tmp_path, file, samples, separator):
    path = write(tmp_path / "a.csv", samples, separator=separator, before="\ufeff# rig 2\n# done by hand\n\n")
    assert np.array_equal(read(path).force, read(file).force)
    path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    assert np.array_equal(read(path).pressure, read(file).pressure)


def test_parquet_reads_as_csv(tmp_path, file):
    path = tmp_path / "run.parquet"
    pd.read_csv(file).to_parquet(path, row_group_size=5000)
    a, b = read(file), read(path)
    assert np.allclose(a.force, b.force, rtol=1e-12) and np.array_equal(a.first_row, b.first_row)
    data = path.read_bytes()
    path.write_bytes(data[: len(data) // 2])
    refuse(path, "no whole parquet file", "cut off")
    frame = pd.read_csv(file)
    frame.loc[1234, "force_N"] = np.nan
    frame.to_parquet(path)
    refuse(path, "row 1236", "column force_N")
    frame.astype({"force_N": str}).to_parquet(path)
    refuse(path, "column force_N", "must be numbers")


def test_parquet_without_pyarrow_says_what_to_install(tmp_path, file, monkeypatch):
    path = tmp_path / "run.parquet"
    path.write_bytes(b"PAR1")
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    refuse(path, 'pip install "pneutouch[parquet]"')


def test_slow_files_keep_one_sample_a_block(tmp_path):
    slow = record(faults=Faults(rate=50.0))
    blocks = read(write(tmp_path / "slow.csv", slow))
    assert (blocks.size, blocks.time.size) == (1, slow.shape[1])
    assert blocks.force == pytest.approx(slow[2], abs=1e-5)


@pytest.mark.parametrize(
    ("cell", "told"),
    [("", "empty"), ("abc", "'abc' is no finite number"), ("nan", "'nan'"), ("inf", "'inf'"), ("1_0", "'1_0'"), ("0x1F", "'0x1F'")],
)  # fmt: skip
def test_a_cell_that_is_no_number_is_named(tmp_path, file, cell, told):
    refuse(spoilt(tmp_path, file, 1234, 2, cell), "row 1234", "column force_N", told)


def test_a_row_with_too_many_or_too_few_fields_is_named(tmp_path, file):
    refuse(spoilt(tmp_path, file, 77, new="0.075,1,2\n"), "row 77: 3 fields", "header has 4")
    refuse(spoilt(tmp_path, file, 77, 3, "1,5"), "row 77: 5 fields", "point")


def test_empty_lines_count_as_rows(tmp_path, file):
    lines = file.read_text().splitlines(keepends=True)
    path = tmp_path / "gaps.csv"
    path.write_text("".join([*lines[:100], "\n", *lines[100:], "\n", "\n"]))
    assert np.array_equal(read(path).force, read(file).force)
    refuse(spoilt(tmp_path, path, 1001, 1, "x"), "row 1001", "column position_mm")


def test_headers(tmp_path, file, samples):
    refuse(
        write(tmp_path / "a.csv", samples, ("time_s", "position_mm", "Force_N", "pressure_kPa")),
        "column force_N: missing",
        "Did you mean Force_N?",
    )
    refuse(write(tmp_path / "a.csv", samples, ("time_s", "force_N", "force_N", "pressure_kPa")), "column position_mm")
    refuse(
        write(tmp_path / "a.csv", np.vstack([samples, samples[:1]]), (*HEADER, "force_N"), decimals=(6, 4, 5, 5, 3)),
        "column force_N: there 2 times",
    )
    refuse(spoilt(tmp_path, file, 1), "row 1 holds numbers")


def test_files_that_are_none(tmp_path, file):
    path = tmp_path / "a.csv"
    refuse(path, "no such file")
    refuse(tmp_path, "folder")
    for content, told in (
        (b"", "empty file"), (b"\n\n", "no header"), (",".join(HEADER).encode() + b"\n", "no rows"),
        (bytes(range(256)) * 50, "binary"), ("ä".encode("latin-1") + file.read_bytes(), "not UTF-8"),
        (file.read_text().encode("utf-16"), "UTF-16"), (file.read_bytes() + b"\0\0\0\n", "binary file"),
        (file.read_bytes()[:5000] + "é".encode("latin-1") + file.read_bytes()[5000:], "not UTF-8"),
    ):  # fmt: skip
        path.write_bytes(content)
        refuse(path, told)


def test_a_file_that_is_cut_off(tmp_path, file):
    data = file.read_bytes().rstrip(b"\n")
    row = data.count(b"\n") + 1
    path = tmp_path / "cut.csv"
    last = data.rfind(b",")
    for end in (last, last + 1):
        path.write_bytes(data[:end])
        refuse(path, f"row {row}", "cut off")
    path.write_bytes(data[:-2])
    (doubt,) = read(path).doubts
    assert "last row left out" in doubt.why and not doubt.used


def test_time_must_run_on(tmp_path, file):
    refuse(spoilt(tmp_path, file, 500, 0, "0.2"), "row 500", "column time_s", "runs backwards")
    refuse(spoilt(tmp_path, file, 500, 0, "0.497"), "row 500", "stands still")


def test_gaps_are_doubts_and_most_of_a_record_missing_is_an_error(tmp_path, samples):
    keep = np.ones(samples.shape[1], bool)
    keep[4000:4500] = False
    keep[[100, 200, 201]] = False
    long, short = read(write(tmp_path / "a.csv", samples[:, keep])).doubts
    assert long.why == "gap: 500 samples missing" and not long.used
    assert (long.start, long.end) == (pytest.approx(3.999), pytest.approx(4.5))
    assert short.why.startswith(f"3 of {samples.shape[1] - 500} samples missed, in 2 places") and short.used
    keep[2000 : int(samples.shape[1] * 0.7)] = False
    refuse(write(tmp_path / "a.csv", samples[:, keep]), "more than half", "column time_s")


def test_missed_samples_are_counted_across_chunks(tmp_path, monkeypatch):
    lossy = small(missed=0.02)
    path = write(tmp_path / "a.csv", lossy)
    monkeypatch.setattr("pneutouch.bench.csv_table.CHUNK", 3001)
    lost = round((lossy[0, -1] - lossy[0, 0]) * 1000) + 1 - lossy.shape[1]
    (doubt,) = read(path).doubts
    assert doubt.why.startswith(f"{lost} of {lossy.shape[1] + lost} samples missed")


def test_clipped_stretches_are_found(tmp_path, samples):
    top = samples[2].max() * 0.8
    clipped = samples.copy()
    clipped[2] = np.minimum(clipped[2], top)
    true = samples[0][samples[2] > top + 0.1]
    by_range = read(write(tmp_path / "a.csv", clipped), rig=Rig(force_range_N=float(top))).doubts
    flat = read(write(tmp_path / "a.csv", clipped)).doubts
    for doubts, told in ((by_range, "of the range"), (flat, "flat top")):
        (doubt,) = doubts
        assert told in doubt.why and "force clipped" in doubt.why and not doubt.used
        assert doubt.start <= true[0] + 0.05 and doubt.end >= true[-1] - 0.05
        assert doubt.end - doubt.start < true[-1] - true[0] + 0.3


def test_a_coarse_or_noiseless_channel_is_not_clipped(tmp_path, samples):
    coarse = samples.copy()
    coarse[2] = np.round(coarse[2] / 0.1) * 0.1
    assert read(write(tmp_path / "a.csv", coarse)).doubts == ()
    still = small(force_noise=0.0, pressure_noise=0.0)
    assert read(write(tmp_path / "a.csv", still)).doubts == ()


def test_a_reading_far_beyond_the_range_is_asked_about(tmp_path, samples):
    (doubt,) = read(write(tmp_path / "a.csv", samples), rig=Rig(force_range_N=0.5)).doubts
    assert "beyond the rig's range of 0.5" in doubt.why and doubt.used


@pytest.mark.parametrize(("channel", "name"), [(1, "position_mm"), (2, "force_N"), (3, "pressure_kPa")])
def test_a_dead_channel_is_named(tmp_path, samples, channel, name):
    dead = samples.copy()
    dead[channel] = 0.5 * KPA
    refuse(write(tmp_path / "a.csv", dead), f"column {name}: dead")


def test_a_leak_run_needs_time_and_pressure_alone(tmp_path, samples):
    path = tmp_path / "leak.csv"
    pd.DataFrame({"time_s": samples[0], "pressure_kPa": samples[3] / KPA}).to_csv(path, index=False)
    refuse(path, "column position_mm: missing")
    blocks = read_blocks(path, COLUMNS, RIG, plate=False)
    assert blocks.pressure == pytest.approx(blocks_of(path, *samples).pressure, rel=1e-9, abs=1e-12)
    assert not blocks.position.any() and not blocks.force.any()


MEASURE = """
import sys, time
from pathlib import Path
from pneutouch.bench.curve import curve_of
from pneutouch.bench.reading import read_blocks
from pneutouch.spec.campaign import Columns, Rig, Run
begin = time.perf_counter()
run = Run(file="x", sensor="A", resin="r", driving_pressure_kPa=12)
points = curve_of(run, read_blocks(Path(sys.argv[1]), Columns(), Rig()), Rig()).indentation.size
seconds = time.perf_counter() - begin
status = Path("/proc/self/status").read_text()
print(seconds, 1024 * int(status.split("VmHWM:")[1].split()[0]), points)
"""


def measure(path):
    """Seconds and peak bytes of a process of its own from a file to a curve, and its points.

    The peak is that of /proc: the one of getrusage begins with the parent's.
    """
    if not Path("/proc/self/status").is_file():
        pytest.skip("needs /proc")
    done = subprocess.run([sys.executable, "-c", MEASURE, str(path)], capture_output=True, text=True, check=True)
    return tuple(map(float, done.stdout.split()))


def long_file(path: Path, rest):
    from pneutouch.bench.protocol import protocol

    samples = record(faults=Faults(rate=10_000.0), what=protocol("steps", 9.25).quicker(rest))
    with path.open("w") as stream:
        stream.write(",".join(HEADER) + "\n")
        samples[3] /= KPA
        for part in np.array_split(samples, 1 + samples.shape[1] // 100_000, axis=1):
            stream.write(("%.4f,%.6f,%.8f,%.8f\n" * part.shape[1]) % tuple(part.T.ravel()))
    return path


def test_memory_does_not_grow_with_the_file(tmp_path):
    path = write(tmp_path / "a.csv", record(faults=Faults(rate=3000.0)), decimals=(12, 16, 18, 18))
    header, _, body = path.read_bytes().partition(b"\n")
    assert len(body) > 30e6
    third = tmp_path / "third.csv"
    third.write_bytes(header + b"\n" + body[: body.rfind(b"\n", 0, len(body) // 3) + 1])
    _, whole, _ = measure(path)
    _, part, points = measure(third)
    assert points >= 4
    assert whole < part + 0.25 * (len(body) * 2 / 3)


@pytest.mark.slow
def test_300_megabytes_in_20_seconds_and_500_megabytes(tmp_path):
    path = long_file(tmp_path / "long.csv", 46.0)
    assert path.stat().st_size > 290e6
    seconds, peak, points = measure(path)
    assert points == 15
    assert seconds < 20 and peak < 500e6
