"""Readings of a sensor that is known in closed form: force, statuses, other conditions, and the zero."""

from __future__ import annotations

import itertools
import json
import math
import random

import jsonschema
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pneutouch.export.reader.reading import ForceReader, Status
from pneutouch.export.reader.render import SCHEMA, f32
from tests.export.reader.records import AMBIENT_KPA, TOP_KPA, record, single

DRIVING = st.floats(0.0, TOP_KPA)


def tared(driving_kPa, *, noise_kPa=0.0, **more):
    reader = ForceReader(record(**more))
    status = reader.tare([driving_kPa - noise_kPa, driving_kPa + noise_kPa])
    assert status in (Status.OK, Status.ABOVE_RATING)
    return reader


def force(driving_kPa, rise_kPa):
    share = rise_kPa / (10 + driving_kPa / 10)
    return (1 + driving_kPa / 20) * share * (1 + share)


def test_the_document_follows_its_schema_and_a_changed_one_does_not():
    schema = json.loads(SCHEMA.read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    jsonschema.validate(record(), schema)
    jsonschema.validate(record(relative=False), schema)
    for key in record():
        broken = {name: value for name, value in record().items() if name != key}
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate(broken, schema)


@given(DRIVING, st.floats(0.0, 1.0))
def test_the_force_is_that_of_the_closed_form_between_the_rows_and_columns(driving, share):
    rise = share * (10 + driving / 10)
    reading = tared(driving).read(driving + rise)
    if reading.status == Status.BEYOND_RANGE:
        assert share > 1 - 1e-6
    else:
        assert reading.force_N == pytest.approx(force(driving, reading.rise_kPa), abs=0.0005 * 4.4)


@given(DRIVING)
def test_no_rise_is_no_force_exactly_and_less_is_no_negative_one(driving):
    reader = tared(driving)
    assert reader.read(reader.driving_pressure_kPa).force_N == 0.0
    assert reader.read(reader.driving_pressure_kPa - 0.02).force_N == 0.0
    assert reader.read(reader.driving_pressure_kPa - 0.2).status == Status.BELOW_ZERO


@given(DRIVING, st.lists(st.floats(0.0, 10.0), min_size=2, max_size=30), st.floats(-4.9, 4.9), st.floats(98.4, 104.3))
def test_more_pressure_is_never_less_force(driving, rises, change, ambient):
    reader = tared(driving)
    readings = [reader.read(driving + rise, 20.0 + change, ambient) for rise in sorted(rises)]
    forces = [reading.force_N for reading in readings if reading.status <= Status.ABOVE_RATING]
    assert all(more >= less - 1e-9 for less, more in itertools.pairwise(forces))


def test_warm_gas_is_not_a_touch_and_a_touch_on_it_is_that_at_its_pressure():
    reader = tared(5.0)
    content = (5 + AMBIENT_KPA) * 2.0 * 1.05
    warm = content * (297.15 / 293.15)
    now = 5.0
    for _ in range(50):  # pressure at which the dome of 2 (1 + p/100) mL holds that gas
        now += 0.2 * (warm / (2.0 * (1 + 0.01 * now)) - AMBIENT_KPA - now)
    assert reader.read(now, 24.0).rise_kPa == pytest.approx(0.0, abs=2e-4)
    assert reader.read(now + 3.0, 24.0).force_N == pytest.approx(force(now, 3.0), abs=0.003)
    assert reader.read(now + 3.0, 20.0).force_N > force(now, 3.0)


def test_at_another_ambient_pressure_the_same_wall_and_cavity_have_the_same_force():
    """The table's press from 6 kPa to 10 kPa: its cavity, with the gas that holds 10 kPa at 103 kPa around it."""
    volume = (6 + AMBIENT_KPA) * 2.0 * 1.06 / (10 + AMBIENT_KPA)
    ambient = 103.0
    driving = next(
        p / 1e4 for p in range(50_000, 70_000) if (p / 1e4 + ambient) * 2 * (1 + p / 1e6) > (10 + ambient) * volume
    )
    reader = ForceReader(record())
    assert reader.tare([driving], 20.0, ambient) == Status.OK
    assert reader.read(10.0).force_N == pytest.approx(force(6.0, 4.0), rel=2e-3)


@pytest.mark.parametrize(
    ("status", "gauge", "more"),
    [
        (Status.NOT_A_NUMBER, math.nan, {}),
        (Status.NOT_A_NUMBER, math.inf, {}),
        (Status.NOT_A_NUMBER, 12.0, {"temperature_C": math.nan}),
        (Status.NOT_A_NUMBER, 12.0, {"ambient_pressure_kPa": math.nan}),
        (Status.GAUGE_SATURATED, 90.0, {}),
        (Status.CONDITIONS, 12.0, {"temperature_C": 25.5}),
        (Status.CONDITIONS, 12.0, {"ambient_pressure_kPa": 95.0}),
        (Status.BELOW_ZERO, 9.0, {}),
        (Status.BEYOND_RANGE, 22.0, {}),
        (Status.OK, 12.0, {}),
    ],
)
def test_a_reading_outside_the_box_has_a_status_and_no_force(status, gauge, more):
    reading = tared(10.0).read(gauge, **more)
    assert reading.status == status
    assert math.isnan(reading.force_N) == (status > Status.ABOVE_RATING)


def test_a_tare_that_cannot_be_leaves_the_reader_without_a_zero():
    for samples, more, status in (
        ([], {}, Status.NOT_A_NUMBER),
        ([1.0, math.nan], {}, Status.NOT_A_NUMBER),
        ([1.0, 95.0], {}, Status.GAUGE_SATURATED),
        ([30.0], {}, Status.DRIVING_PRESSURE),
        ([-0.2], {}, Status.DRIVING_PRESSURE),
        ([1.0], {"ambient_pressure_kPa": 80.0}, Status.CONDITIONS),
    ):
        reader = tared(10.0)
        assert reader.tare(samples, **more) == status
        assert reader.read(12.0).status == Status.NOT_TARED
    assert tared(-0.05).read(1.0).status == Status.OK
    assert tared(21.0).read(24.0).status == Status.ABOVE_RATING
    assert not math.isnan(tared(21.0).read(24.0).force_N)


def test_the_uncertainty_holds_the_gauges_noise_as_the_tare_found_it():
    quiet, loud = tared(10.0).read(14.0), tared(10.0, noise_kPa=0.02).read(14.0)
    slope = (tared(10.0).read(14.01).force_N - quiet.force_N) / 0.01
    noise = math.sqrt(8e-4 * 1.5)  # two readings at +-0.02: variance 8e-4, of the mean half of it
    assert quiet.uncertainty_N == pytest.approx((0.05 + 0.01 * 4 * 4 / 11) * quiet.force_N, rel=1e-3)
    assert loud.uncertainty_N == pytest.approx(math.hypot(quiet.uncertainty_N, slope * noise), rel=1e-3)
    assert math.isnan(tared(10.0, relative=False).read(14.0).uncertainty_N)


def test_readings_that_scatter_by_more_than_a_gauge_does_are_no_tare():
    """A disturbed tare would widen the threshold of a touch, and a touch below it would be learnt as zero."""
    reader = ForceReader(record())
    most = record()["zero"]["noise_most_kPa"]
    assert reader.tare([10.0 - 0.1, 10.0 + 0.1]) == Status.UNSTEADY_TARE
    assert reader.read(12.0).status == Status.NOT_TARED
    assert reader.tare([10.0 - 0.7 * most, 10.0 + 0.7 * most]) == Status.OK


def test_readings_that_do_not_scatter_know_their_zero_to_one_step_alone():
    known = record()
    known["zero"]["noise_least_kPa"] = 0.02
    reader = ForceReader(known)
    reader.tare([10.0] * 200)
    slope = (reader.read(14.01).force_N - reader.read(14.0).force_N) / 0.01
    share = tared(10.0).read(14.0).uncertainty_N
    expected = math.hypot(share, slope * math.hypot(0.02, 0.02))
    assert reader.read(14.0).uncertainty_N == pytest.approx(expected, rel=1e-3)


def test_a_table_of_another_form_is_refused():
    with pytest.raises(ValueError, match="format 99: this module reads format pneutouch/reader/1"):
        ForceReader({**record(), "format": 99})


SECONDS = 0.2


def followed(seconds, pressure, *, noise_kPa=0.004, driving=10.0):
    """A reader after a signal (kPa over s) with the gauge's noise, tracked all along."""
    draw = random.Random(1)
    reader = ForceReader(record())
    reader.tare([driving + draw.gauss(0.0, noise_kPa) for _ in range(200)])
    for k in range(int(seconds / SECONDS)):
        reader.track(pressure(k * SECONDS) + draw.gauss(0.0, noise_kPa), SECONDS)
    return reader


def test_the_drift_of_indoor_air_is_followed():
    reader = followed(3600.0, lambda t: 10.0 + 0.3 * 2.0 * t / 3600)
    assert reader.drift_kPa == pytest.approx(0.6, abs=0.01)
    assert not reader.touched
    assert reader.read(10.6).force_N == pytest.approx(0.0, abs=0.002)


def test_a_slow_press_that_is_held_for_an_hour_is_not_learnt():
    reader = followed(3660.0, lambda t: 10.0 + 0.4 * min(t / 60.0, 1.0))
    assert reader.touched
    assert abs(reader.drift_kPa) < 0.01
    assert reader.read(10.4).force_N == pytest.approx(force(10.0, 0.4), rel=0.03)


def test_after_a_touch_the_zero_is_that_before_it():
    reader = followed(600.0, lambda t: 10.0 + (2.0 if 100 < t < 500 else 0.0))
    assert not reader.touched
    assert abs(reader.drift_kPa) < 0.005


def test_a_drift_beyond_what_indoor_air_can_make_is_not_followed():
    reader = followed(5 * 3600.0, lambda t: 10.0 - 0.3 * 2.0 * t / 3600)
    assert reader.drift_kPa == pytest.approx(-1.5, abs=0.01)
    assert reader.read(10.0 - 3.0).status == Status.BELOW_ZERO


@settings(max_examples=25)
@given(st.floats(0.05, 3.0), st.floats(1.0, 120.0))
def test_no_press_faster_than_a_drift_is_learnt(rise, seconds):
    reader = followed(seconds + 300.0, lambda t: 10.0 + rise * min(t / seconds, 1.0), noise_kPa=0.002)
    assert reader.touched
    assert abs(reader.drift_kPa) < 0.012


def test_literals_of_c_are_float32():
    assert [f32(1.0), f32(0.1), f32(1e-7), f32(-3.5)] == ["1.0f", "0.1f", "1e-07f", "-3.5f"]
    assert single(0.1) != 0.1
