"""A live session: tare, force, drift, losses, and what is recorded, by a sensor that is known in closed form."""

from __future__ import annotations

import csv
import math
import random

import pytest

from pneutouch.errors import InputError
from pneutouch.workflows.live.protocol import DeviceSample, sample_line
from pneutouch.workflows.live.recording import Recording
from pneutouch.workflows.live.session import KEPT_S
from tests.workflows.live.devices import REST_kPa, closed_form, force_at, line, rest


def test_the_force_of_a_tared_session_is_that_of_the_sensor():
    session = closed_form()
    assert session.state.link == "waiting" and session.newest() is None
    session.take(rest(50))
    assert session.state.status == "TARING" and session.newest().reading is None
    session.take(rest(160, 50) + line(210, 0.25))
    state, point = session.state, session.newest()
    assert state.status == "OK" and state.link == "reading" and state.rate_Hz == pytest.approx(100.0)
    assert state.driving_pressures_kPa[0] == pytest.approx(REST_kPa, abs=1e-3)
    # The reader interpolates linearly between 33 columns.
    assert point.reading.force_N == pytest.approx(force_at(0.25), rel=0.005)
    assert 0.0 < point.reading.uncertainty_N < point.reading.force_N
    assert session.greatest_force_N == point.reading.force_N


def test_an_unsteady_tare_gives_no_zero_and_no_force():
    session = closed_form()
    session.take(b"".join(line(k, 0.3 * (k % 2)) for k in range(210)))
    assert session.state.status == "UNSTEADY_TARE" and not session.tared
    assert session.newest().reading is None and math.isnan(session.greatest_force_N)
    session.tare()
    session.take(rest(210, 210) + line(420, 0.5))
    assert session.newest().reading.force_N == pytest.approx(force_at(0.5), rel=0.005)


def test_a_slow_drift_is_followed_and_a_touch_is_not():
    session = closed_form()
    session.take(rest())
    # 0.15 mK a second of warmer air, over an hour's share of it.
    number, drift = 202, 0.0
    for _ in range(3000):
        drift += 1e-6
        session.take(sample_line(DeviceSample(number, 10.0 * number, (REST_kPa + drift,))))
        number += 1
    state = session.state
    assert state.drift_kPa == pytest.approx(drift, rel=0.6) and state.drift_kPa > 0.0
    zero = state.driving_pressures_kPa[0]
    session.take(b"".join(line(number + k, 0.4) for k in range(300)))
    assert session.state.driving_pressures_kPa[0] == pytest.approx(zero, abs=1e-4)


def test_losses_and_damage_are_counted_and_said():
    session = closed_form()
    session.take(rest())
    damaged = line(202)[:-8] + b"9" + line(202)[-7:]
    session.take(damaged + line(203) + line(210))
    state = session.state
    assert (state.lost, state.damaged, state.samples) == (1 + 6, 1, 202 + 2)
    assert len(state.said) >= 3


def test_a_device_with_another_number_of_cells_is_no_device_of_this_sensor():
    session = closed_form()
    session.take(b"".join(sample_line(DeviceSample(k, 10.0 * k, (12.0, 12.0))) for k in range(50)))
    assert session.samples == 0 and session.state.damaged == 50 and session.heard


def test_only_the_last_seconds_are_kept():
    session = closed_form()
    for start in range(0, 12_000, 1000):
        session.take(b"".join(line(k) for k in range(start, start + 1000)))
    points = session.since(0)
    assert len(points) <= 100 * KEPT_S + 2
    assert points[-1].time_s - points[0].time_s <= KEPT_S
    assert [one.number for one in session.since(points[-3].number)] == [one.number for one in points[-2:]]


def read_rows(path):
    with path.open() as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def test_a_recording_holds_every_sample_of_its_time_and_the_columns_that_are_sent(tmp_path):
    session = closed_form()
    session.take(rest())
    recording = Recording(tmp_path / "runs" / "one.csv", "# simulated")
    session.record(recording)
    session.take(b"".join(line(202 + k, 0.1, force_N=0.5) for k in range(100)))
    assert recording.cut_off.exists() and not recording.path.exists()
    assert session.state.recording == str(recording.path) and session.recorded() == pytest.approx(0.99)
    assert session.stop_recording() is recording
    assert recording.close() == recording.path and not recording.cut_off.exists()
    rows = read_rows(recording.path)
    assert list(rows[0]) == ["time_s", "force_N", "pressure_kPa"] and len(rows) == 100
    assert [float(row["time_s"]) for row in rows] == pytest.approx([0.01 * k for k in range(100)])
    assert {row["force_N"] for row in rows} == {"0.5"}
    assert float(rows[0]["pressure_kPa"]) == pytest.approx(REST_kPa + 1.12, abs=0.01)


def test_what_was_recorded_is_on_the_disk_without_an_end(tmp_path):
    recording = Recording(tmp_path / "one.csv")
    for k in range(10):
        recording.add(DeviceSample(k, 10.0 * k, (1.0,)), 0.01)
    recording.flush()
    # As after a power cut: the file was never closed.
    assert len(read_rows(recording.cut_off)) == 10
    recording.abandon()
    with pytest.raises(InputError) as error:
        Recording(tmp_path / "one.csv").check()
    assert error.value.file == str(recording.cut_off)


def test_a_recording_never_replaces_another(tmp_path):
    (tmp_path / "one.csv").write_text("mine")
    session = closed_form()
    with pytest.raises(InputError):
        session.record(Recording(tmp_path / "one.csv"))
    assert (tmp_path / "one.csv").read_text() == "mine"


def test_a_full_disk_ends_the_recording_and_is_told(tmp_path):
    session = closed_form()
    session.take(rest())
    recording = Recording(tmp_path / "one.csv")
    session.record(recording)
    session.take(line(202))

    def full(text):
        raise OSError(28, "No space left on device")

    recording._file.write = full
    session.take(line(203) + line(204))
    assert session.failure.errno == 28 and session.state.recording is None and session.samples == 205


def test_pieces_of_any_length_give_the_same_session():
    stream = rest() + b"".join(line(202 + k, 0.01 * (k % 50)) for k in range(200))
    whole, pieces = closed_form(), closed_form()
    whole.take(stream)
    draw, at = random.Random(3), 0
    while at < len(stream):
        size = draw.randint(1, 200)
        pieces.take(stream[at : at + size])
        at += size
    assert [one[2:] for one in whole.since(0)] == [one[2:] for one in pieces.since(0)]


def test_columns_are_those_that_the_device_was_seen_to_send(tmp_path):
    session = closed_form()
    session.take(rest(202) + b"".join(line(202 + k, force_N=0.5) for k in range(50)))
    recording = Recording(tmp_path / "one.csv")
    session.record(recording)
    # The first sample has no force: its amplifier was not ready.
    session.take(line(252) + line(253, force_N=0.7))
    session.stop_recording().close()
    assert [row["force_N"] for row in read_rows(recording.path)] == ["", "0.7"]


def test_a_tare_by_hand_during_a_run_is_whole_and_one_of_the_run_ends_with_it(tmp_path):
    session = closed_form()
    session.take(rest())
    session.record(Recording(tmp_path / "one.csv"))
    session.walk(lambda seconds: ("wait", 1.0), lambda seconds: seconds > 100.0)
    assert not session.tared
    session.tare()
    session.take(rest(220, 202))
    assert session.tared and session.state.status == "OK"
    session.walk(lambda seconds: ("wait", 1.0), lambda seconds: True)
    session.take(rest(20, 422))
    assert session.state.status == "TARING"
    session.stop_recording().close()
    session.walk(None)
    session.take(rest(20, 442))
    assert session.state.status == "NOT_TARED" and not session.tared


def test_a_disk_that_is_full_as_the_device_is_pulled_ends_the_recording_alone(tmp_path):
    session = closed_form()
    session.take(rest())
    recording = Recording(tmp_path / "one.csv")
    session.record(recording)
    session.take(line(202))

    def full():
        raise OSError(28, "No space left on device")

    recording.flush = full
    session.plugged(False)
    assert session.failure.errno == 28 and session.link == "unplugged" and session.state.recording is None
