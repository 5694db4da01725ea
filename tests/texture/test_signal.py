"""Signals from arrays and files: what cannot be read is said with its row and value."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.errors import InputError
from pneutouch.texture.signal import RecordColumns, read_signal, signal
from tests.refusals import refused

GOOD = "time_s,pressure_kPa,force_N\n" + "".join(f"{0.1 * k:.1f},{1 + 0.01 * k},0\n" for k in range(10))


def written(tmp_path, text):
    path = tmp_path / "run.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_file_is_read_in_si_units(tmp_path):
    found = read_signal(written(tmp_path, GOOD))
    assert found.rate == pytest.approx(10.0)
    assert found.pressure[0] == pytest.approx(1e-3)
    assert found.duration == pytest.approx(0.9)
    other = read_signal(
        written(tmp_path, GOOD.replace("time_s", "t").replace("pressure_kPa", "p")), RecordColumns("t", "p")
    )
    assert np.array_equal(found.pressure, other.pressure)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", ["empty file"]),
        ("time_s\n0\n", ["column pressure_kPa: missing", "separated by commas"]),
        (GOOD.replace("pressure_kPa", "presure_kPa"), ["column pressure_kPa: missing", "Did you mean presure_kPa"]),
        (GOOD.replace("0.3,1.03", "0.3,abc"), ["row 5", "pressure_kPa", "'abc' is no finite number"]),
        (GOOD.replace("0.3,1.03", "0.3,"), ["row 5", "empty"]),
        (GOOD.replace("0.3,1.03", "0.3,nan"), ["row 5", "pressure_kPa: 'nan'", "finite"]),
        (GOOD.replace("0.3,1.03,0\n", ""), ["row 5", "a gap of 0.2 s", "0.1 s"]),
        (GOOD.replace("0.3,1.03", "0.15,1.03"), ["row 5", "must run forwards"]),
        (GOOD.replace("0.3,1.03", "0.2,1.03"), ["row 5", "must run forwards"]),
        (GOOD.replace("0.3,1.03", "0.34,1.03"), ["row 5", "even steps"]),
        ("time_s,pressure_kPa\n0,1\n1,2\n", ["2 rows; a signal needs at least 4"]),
        ("time_s,pressure_kPa,time_s\n0,1,0\n", ["column time_s: there 2 times"]),
    ],
)
def test_what_cannot_be_read_is_said(tmp_path, text, words):
    with pytest.raises(InputError) as error:
        read_signal(written(tmp_path, text))
    assert "run.csv" in str(error.value)
    assert all(word in str(error.value) for word in words), str(error.value)


def test_files_that_are_none(tmp_path):
    for path, words in ((tmp_path / "no.csv", "no such file"), (tmp_path, "this is a folder")):
        with pytest.raises(InputError, match=words):
            read_signal(path)
    binary = tmp_path / "x.csv"
    binary.write_bytes(b"time_s,pressure_kPa\n\xff\x81")
    with refused("row 2"):
        read_signal(binary)


def test_rounded_times_are_even():
    time = np.round(np.arange(2000) / 7000.0, 6)
    assert signal(time, np.ones(2000)).rate == pytest.approx(7000.0, rel=1e-3)
