"""Files to blocks: the values read are those written."""

from __future__ import annotations

import sys

import numpy as np
import pandas as pd
import pytest

from pneutouch.bench.reading import LEAK, read_blocks
from pneutouch.bench.source import identify
from pneutouch.spec.campaign import Column, ColumnMap
from pneutouch.units import KPA
from tests.bench.reads import COLUMNS, RIG, blocks_of, read, refuse
from tests.bench.rig import Faults, record, write


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
    assert blocks.warnings == ()


def test_chunks_do_not_show(file, monkeypatch):
    once = read(file)
    monkeypatch.setattr("pneutouch.tables.csv_table.CHUNK", 7001)
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
    columns = ColumnMap(
        time=Column(name="t", unit="ms"),
        position=Column(name="z", unit="um", sign=-1),
        force=Column(name="load", unit="lbf"),
        pressure=Column(name="p", unit="psi"),
    )
    result, expected = read(path, columns), blocks_of(path, *samples)
    for name in ("time", "position", "force", "pressure", "force_spread", "pressure_extreme"):
        assert getattr(result, name) == pytest.approx(getattr(expected, name), rel=1e-9, abs=1e-12)


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


def test_parquet_without_pyarrow_names_what_to_install(tmp_path, file, monkeypatch):
    path = tmp_path / "run.parquet"
    path.write_bytes(b"PAR1")
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    refuse(path, 'pip install "pneutouch[parquet]"')


def test_slow_files_keep_one_sample_a_block(tmp_path):
    slow = record(faults=Faults(rate=50.0))
    blocks = read(write(tmp_path / "slow.csv", slow))
    assert (blocks.size, blocks.time.size) == (1, slow.shape[1])
    assert blocks.force == pytest.approx(slow[2], abs=1e-5)


def test_a_leak_run_needs_time_and_pressure_alone(tmp_path, samples):
    path = tmp_path / "leak.csv"
    pd.DataFrame({"time_s": samples[0], "pressure_kPa": samples[3] / KPA}).to_csv(path, index=False)
    refuse(path, "column position_mm: missing")
    blocks = read_blocks(identify(path, COLUMNS, LEAK), RIG)
    assert blocks.pressure == pytest.approx(blocks_of(path, *samples).pressure, rel=1e-9, abs=1e-12)
    assert not blocks.position.any() and not blocks.force.any()
