"""Files that are cut, damaged or no tables: each fault is reported with its row and column."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from pneutouch.spec.campaign import Column, ColumnMap
from tests.bench.reads import read, refuse, spoilt
from tests.bench.rig import HEADER, write


@pytest.mark.parametrize(
    ("cell", "words"),
    [
        ("", "empty"),
        ("abc", "'abc' is no finite number"),
        ("nan", "'nan'"),
        ("inf", "'inf'"),
        ("1_0", "'1_0'"),
        ("0x1F", "'0x1F'"),
    ],
)
def test_a_cell_that_is_no_number_is_named(tmp_path, file, cell, words):
    refuse(spoilt(tmp_path, file, 1234, 2, cell), "row 1234", "column force_N", words)


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
        write(tmp_path / "a.csv", samples, ("time_s", "position_mm", "Moment_Nm", "pressure_kPa")),
        "column force_N: missing from the header",
        "no column of force",
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
    for content, words in (
        (b"", "empty file"),
        (b"\n\n", "no header"),
        (",".join(HEADER).encode() + b"\n", "no rows"),
        (bytes(range(256)) * 50, "binary"),
        (file.read_text().encode("utf-16")[:-1], "not utf-16 text"),
        (file.read_bytes() + b"\0\0\0\n", "binary file"),
        (file.read_bytes()[:400_000] + "é".encode("latin-1") + file.read_bytes()[400_000:], "not UTF-8"),
    ):
        path.write_bytes(content)
        refuse(path, words)


def test_a_file_that_is_cut_off(tmp_path, file):
    data = file.read_bytes().rstrip(b"\n")
    row = data.count(b"\n") + 1
    path = tmp_path / "cut.csv"
    last = data.rfind(b",")
    for end in (last, last + 1):
        path.write_bytes(data[:end])
        refuse(path, f"row {row}", "cut off")
    path.write_bytes(data[:-2])
    (warning,) = read(path).warnings
    assert "last row left out" in warning.why and not warning.used


def test_time_must_run_on(tmp_path, file):
    refuse(spoilt(tmp_path, file, 500, 0, "0.2"), "row 500", "column time_s", "runs backwards")
    refuse(spoilt(tmp_path, file, 500, 0, "0.497"), "row 500", "stands still")


def test_a_row_cut_within_text_is_quoted(tmp_path):
    """The sixtieth byte may be the first half of a letter."""
    path = tmp_path / "a.csv"
    for before in range(4):
        path.write_text("time_s,position_mm,force_N,pressure_kPa\n1,2,3,4\n2,3,4,5\n" + "x" * before + "é" * 60)
        refuse(path, "row 4", "ends within this row", "éé")


def test_rows_end_at_line_feeds_alone(tmp_path, file):
    """A form feed, or a line mark of Unicode, is no end of a row: the rows after it keep their numbers."""
    lines = file.read_text().splitlines(keepends=True)
    path = tmp_path / "a.csv"
    for mark in ("\x0c", "\x0b", "\x1c", "\x85", "\u2028", "\u2029"):
        lines[0] = "time_s,position_mm,force_N,pressure_kPa,note\n"
        rows = [line.replace("\n", f",a{mark}b\n") for line in lines[1:200]]
        path.write_text("".join([lines[0], *rows]), newline="")
        assert read(path).first_row[1] == 12
        path.write_text("".join([lines[0], *rows[:150], "1,2,3\n", *rows[150:]]), newline="")
        refuse(path, "row 152: 3 fields")
        path.write_text("".join([lines[0], *rows[:150], "1,2,?,4,x\n", *rows[150:]]), newline="")
        refuse(path, "row 152: column force_N: '?'")


def test_carriage_returns_within_rows_are_reported(tmp_path, file):
    path = tmp_path / "a.csv"
    path.write_bytes(file.read_bytes()[:9000].replace(b"\n", b"\r"))
    refuse(path, "row 1: carriage returns")
    path.write_bytes(file.read_bytes().replace(b"\n0.100", b"\r0.100", 1))
    refuse(path, "row 101: a carriage return within it")


def test_a_last_row_without_line_end_must_be_whole(tmp_path, file):
    path = tmp_path / "a.csv"
    row = file.read_bytes().count(b"\n") + 1
    for end, words in ((b"99,1,2,3,4", "5 fields"), (b"99,1,1e999,3", "column force_N: '1e999' is no finite number")):
        path.write_bytes(file.read_bytes() + end)
        refuse(path, f"row {row}", words)


def test_whole_numbers_beyond_2_to_53_are_refused(tmp_path, file):
    path = tmp_path / "run.parquet"
    frame = pd.read_csv(file)
    time = (frame["time_s"] * 1e3).round().astype("int64")
    ms = ColumnMap(time=Column(name="time_s", unit="ms"))
    frame.assign(time_s=time).to_parquet(path)
    assert read(path, ms).time.size > 100
    time.iloc[77:] += 2**53
    frame.assign(time_s=time).to_parquet(path)
    refuse(path, "row 79: column time_s: 9007199254741069 is beyond 2^53", columns=ms)
