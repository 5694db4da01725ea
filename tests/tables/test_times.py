"""Times of day in a recording become seconds, whatever the chunks, and midnight may pass."""

from __future__ import annotations

from datetime import datetime, timedelta

import numpy as np
import pytest

from pneutouch.errors import InputError
from pneutouch.tables import csv_table
from pneutouch.tables.read import whole


@pytest.mark.parametrize("chunk", [40, 4 * 2**20])
@pytest.mark.parametrize(
    ("first", "form"), [(86399.0, "{h}:{m:02d}:{s:06.3f}"), (3 * 3600.0, "{h:02d}:{m:02d}:{s:06.3f}")]
)
def test_times_of_day_are_seconds_from_the_first(chunk, first, form, tmp_path, monkeypatch):
    monkeypatch.setattr(csv_table, "CHUNK", chunk)
    passed = np.arange(0.0, 4.0, 0.25)
    day = (first + passed) % 86400.0
    rows = [
        f"{form.format(h=int(t // 3600), m=int(t // 60 % 60), s=t % 60)},{value:.3f}"
        for t, value in zip(day, passed, strict=True)
    ]
    path = tmp_path / "run.csv"
    path.write_text("time,force_N\n" + "\n".join(rows) + "\n")
    _, (time, force) = whole(path, ["time", "force_N"])
    np.testing.assert_allclose(time, passed, atol=1e-9)
    np.testing.assert_allclose(force, passed)


@pytest.mark.parametrize("chunk", [60, 4 * 2**20])
@pytest.mark.parametrize(
    "form", ["%m/%d/%Y %I:%M:%S.%f %p", "%d.%m.%Y %H:%M:%S.%f", "%d-%m-%y %H:%M:%S.%f", "%I:%M:%S.%f %p"]
)
@pytest.mark.parametrize("begin", ["2026-11-26T11:59:58", "2026-11-30T23:59:58", "2027-03-04T00:59:58"])
def test_dates_of_any_order_and_hours_of_half_a_day_are_seconds_from_the_first(
    chunk, form, begin, tmp_path, monkeypatch
):
    monkeypatch.setattr(csv_table, "CHUNK", chunk)
    passed = np.arange(0.0, 4.0, 0.25)
    times = [datetime.fromisoformat(begin) + timedelta(seconds=second) for second in passed]
    rows = [f"{time.strftime(form)};{value:.3f}" for time, value in zip(times, passed, strict=True)]
    path = tmp_path / "run.csv"
    path.write_text("timestamp;force_N\n" + "\n".join(rows) + "\n")
    _, (time, force) = whole(path, ["timestamp", "force_N"])
    np.testing.assert_allclose(time, passed, atol=1e-9)
    np.testing.assert_allclose(force, passed)


@pytest.mark.parametrize(
    ("form", "step"),
    [("%H:%M:%S:%f", 0.25), ("%m/%d/%Y %H:%M", 60.0), ("%d.%m.%Y %I:%M %p", 60.0), ("%Y-%m-%d %H:%M", 60.0)],
)
def test_parts_of_a_second_behind_a_colon_and_dates_without_seconds_are_read(form, step, tmp_path):
    passed = step * np.arange(8.0)
    begin = datetime.fromisoformat("2026-01-05T11:58:00")
    times = [(begin + timedelta(seconds=second)).strftime(form) for second in passed]
    path = tmp_path / "run.csv"
    path.write_text("timestamp,force_N\n" + "".join(f"{time},{k}\n" for k, time in enumerate(times)))
    _, (time, _) = whole(path, ["timestamp", "force_N"])
    np.testing.assert_allclose(time, passed, atol=1e-9)


def test_an_impossible_time_of_day_is_refused_with_its_row(tmp_path):
    path = tmp_path / "run.csv"
    path.write_text("time,force_N\n10:00:00,1\n10:00:01,2\n10:61:02,3\n")
    with pytest.raises(InputError, match="10:61:02"):
        whole(path, ["time", "force_N"])
