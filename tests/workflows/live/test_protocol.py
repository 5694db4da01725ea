"""Lines of a live device: what is sent is heard, in pieces of any length, and nothing that is damaged."""

from __future__ import annotations

import math
import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.workflows.live.protocol import (
    TURN,
    DeviceClock,
    DeviceName,
    DeviceSample,
    LineReader,
    checked,
    name_line,
    sample_line,
)

_kPa = st.floats(-101.0, 900.0).map(lambda value: round(value, 4))
_beside = st.one_of(st.just(math.nan), st.floats(-50.0, 50.0).map(lambda value: round(value, 4)))
samples = st.builds(
    DeviceSample,
    st.integers(0, TURN - 1),
    st.integers(0, TURN - 1).map(float),
    st.lists(_kPa, min_size=1, max_size=9).map(tuple),
    _beside,
    _beside,
)


def same(one: DeviceSample, other: DeviceSample) -> bool:
    return repr(one) == repr(other)


@given(st.lists(samples, min_size=1, max_size=5), st.integers(1, 60))
def test_samples_are_heard_as_they_were_sent_in_pieces_of_any_length(sent, size):
    stream = b"".join(map(sample_line, sent))
    reader = LineReader()
    heard = [one for k in range(0, len(stream), size) for one in reader.feed(stream[k : k + size])]
    assert len(heard) == len(sent) and all(map(same, heard, sent))
    assert (reader.damaged, reader.received) == (0, len(stream))


@given(samples, st.integers(0, 10_000), st.integers(1, 255))
def test_a_line_with_one_wrong_byte_is_counted_and_left_out(sample, place, change):
    good, line = sample_line(sample), bytearray(sample_line(sample))
    place %= len(line) - 1
    line[place] ^= change
    reader = LineReader()
    heard = list(reader.feed(good + bytes(line) + good))
    assert all(same(one, sample) for one in heard)
    # A byte that became a line's end makes two lines of one.
    assert len(heard) == 2 and reader.damaged >= (0 if bytes(line).count(b"\n") > 1 or line[place] == 35 else 1)


def test_the_checksum_is_the_known_one_and_half_a_line_at_the_start_is_no_damage():
    # CRC-16/CCITT-FALSE of 123456789 is 29B1.
    assert checked("123456789") == b"123456789*29B1\n"
    reader = LineReader()
    whole = sample_line(DeviceSample(7, 70.0, (12.5,)))
    assert [one.number for one in reader.feed(whole[9:] + whole)] == [7] and reader.damaged == 0
    assert list(reader.feed(name_line(DeviceName("four-domes", 4)))) == [DeviceName("four-domes", 4)]


@pytest.mark.parametrize(
    "text", ["", "P1", "P2,1,10,p1.0", "P1,1,10", "P1,-1,10,p1", "P1,1,10,pone", "P1,x,10,p1", "P1,1,10,"]
)
def test_lines_of_another_content_are_no_samples(text):
    reader = LineReader()
    assert list(reader.feed(b"\n" + checked(text))) == [] and reader.damaged == 1


def test_numbers_that_a_board_cannot_print_and_letters_of_later_sketches_are_left_out():
    reader = LineReader()
    (sample,) = reader.feed(checked("P1,3,30,povf,pinf,p2.5,t21.5,q7"))
    assert sample.pressures_kPa[2] == 2.5 and all(map(math.isnan, (*sample.pressures_kPa[:2], sample.force_N)))


def test_bytes_without_an_end_take_no_memory():
    reader = LineReader()
    for _ in range(2000):
        assert list(reader.feed(b"x" * 1000)) == []
    assert len(reader._rest) <= 8192 and reader.received == 2_000_000
    reader.forget()
    assert [one.number for one in reader.feed(sample_line(DeviceSample(1, 10.0, (0.0,))))] == [1]


class _Told(list):
    def __call__(self, words):
        self.append(words)


def clocked(steps, *, first=(TURN - 3, TURN - 30)):
    """Seconds between samples by (number, ms) after the first, which is about to turn over; the clock and its words."""
    told = _Told()
    clock = DeviceClock(told)
    clock.step(DeviceSample(*first, (0.0,)), 0.0)
    return [clock.step(DeviceSample(n % TURN, t % TURN, (0.0,)), waited) for n, t, waited in steps], clock, told


def test_counters_that_turn_over_are_no_jump():
    n, t = TURN - 3, TURN - 30
    seconds, clock, told = clocked([(n + k, t + 10 * k, 0.01) for k in range(1, 20)])
    assert seconds == pytest.approx([0.01] * 19) and not told and clock.lost == 0


def test_lost_samples_are_counted_and_time_goes_on():
    _, clock, told = clocked([(1, 10, 0.01), (2, 20, 0.01), (7, 70, 0.05)], first=(0, 0))
    assert clock.lost == 4 and clock.seconds == pytest.approx(0.07) and not told


@pytest.mark.parametrize("jump", [-5000, 40_000])
def test_a_clock_that_jumps_is_said_and_time_stays_steady(jump):
    steps = [(k, 10 * k, 0.01) for k in range(1, 50)]
    steps += [(k, 10 * k + jump, 0.01) for k in range(50, 99)]
    seconds, clock, told = clocked(steps, first=(0, 0))
    assert told and clock.seconds == pytest.approx(0.98, abs=0.03) and min(seconds) > 0.0


def test_a_device_that_paused_is_no_jump_and_one_that_began_anew_counts_the_wait():
    seconds, _, told = clocked([(1, 10, 0.01), (2, 2020, 2.01)], first=(0, 0))
    assert not told and seconds[-1] == pytest.approx(2.01)
    seconds, clock, told = clocked([(90, 900, 0.01), (0, 3, 2.5)], first=(89, 890))
    assert len(told) == 1 and seconds[-1] == 2.5 and clock.lost == 0


@pytest.mark.parametrize(("rate_Hz", "count"), [(2000, 20_000), (1000, 10_000)])
def test_samples_within_one_tick_of_the_clock_follow_one_another(rate_Hz, count):
    rng = random.Random(1)
    ticks = [int(1e3 * k / rate_Hz + rng.uniform(0.0, 0.9)) for k in range(count)]
    seconds, clock, told = clocked([(k, ticks[k], 1e-3) for k in range(1, count)], first=(0, 0))
    assert not told and min(seconds) > 0.0
    assert clock.seconds == pytest.approx(count / rate_Hz, rel=0.001) and clock.rate_Hz == pytest.approx(
        rate_Hz, rel=0.1
    )


def test_a_device_that_was_away_counts_the_wait_whatever_its_counters_say():
    told = _Told()
    clock = DeviceClock(told)
    for k in range(100):
        clock.step(DeviceSample(k, 10.0 * k, (0.0,)), 0.01)
    clock.away()
    assert clock.step(DeviceSample(200, 2000.0, (0.0,)), 60.0) == pytest.approx(60.0) and clock.lost == 0 and told
