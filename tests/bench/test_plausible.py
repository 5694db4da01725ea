"""Each wrong unit, sign, exchange and mixture is reported as such, and a correct run passes without a question."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pneutouch.bench.curve import curve_of
from pneutouch.bench.questions import check_leak, outliers
from pneutouch.bench.reading import LEAK, PLATE, read_blocks
from pneutouch.bench.record import MeasuredCurve
from pneutouch.bench.run_checks import ExpectedRun, check_plausible
from pneutouch.bench.source import identify
from pneutouch.errors import InputError
from pneutouch.spec.campaign import ColumnMap, Rig
from pneutouch.tables.unit_words import UNITS
from pneutouch.units import KPA
from tests.bench.rig import HEADER, Sensor, run_of, small, write

SENSOR = Sensor()
DEPTH = 5.0
TRAVEL = np.linspace(0.0, 1.0, 200)


def predicted(depth, force, rise):
    """A prediction that grows as travel^1.5 to a force, N, and a rise, MPa, at a depth, mm."""
    return ExpectedRun(depth * TRAVEL, force * TRAVEL**1.5, rise * TRAVEL**1.5)


EXPECTED = predicted(DEPTH, 2.9, 7.2 * KPA)
COLUMNS, RIG = ColumnMap(), Rig()


@pytest.fixture(scope="module")
def samples():
    return small()


def analyse(tmp_path, samples, columns=COLUMNS, header=HEADER, expected=EXPECTED, sensor=SENSOR):
    path = write(tmp_path / "run.csv", samples, header)
    curve = curve_of(run_of(sensor=sensor), read_blocks(identify(path, columns, PLATE), RIG), RIG)
    return check_plausible(curve, columns, expected, path)


def refused(tmp_path, samples, *texts, **more):
    with pytest.raises(InputError) as caught:
        analyse(tmp_path, samples, **more)
    for text in ("run.csv", *texts):
        assert text in str(caught.value)


def declared(**units):
    given = ColumnMap().model_dump()
    for key, unit in units.items():
        given[key]["unit"] = unit
    return ColumnMap.model_validate(given)


def ideal(
    force=SENSOR.force, slope=SENSOR.slope, deepest=6.9, factor=(1.0, 1.0, 1.0), driving=12.0, name="A1", number=1
):
    """A curve without a rig, its channels multiplied as by a wrong unit."""
    depth = np.linspace(0, deepest, 15)
    pressed = force(depth)
    run = run_of(run=number).model_copy(
        update={"sensor": name, "driving_pressure_kPa": driving, "file": f"{name}-{number}.csv"}
    )
    return MeasuredCurve(
        run, depth * factor[0], pressed * factor[1], slope * pressed * factor[2], driving=driving * KPA * factor[2]
    )


def test_a_right_run_is_left_alone(tmp_path, samples):
    assert analyse(tmp_path, samples) == ()


@pytest.mark.parametrize(
    ("key", "unit", "units"),
    [
        ("force", "mN", "mN"),
        ("force", "kN", "kN"),
        ("force", "gf", "gf"),
        ("force", "lbf", "lbf"),
        ("force", "kgf", "kgf"),
        ("pressure", "Pa", "Pa"),
        ("pressure", "psi", "psi"),
        ("pressure", "MPa", "MPa"),
        ("pressure", "hPa", 'hPa" or "mbar'),
        ("pressure", "mmHg", "mmHg"),
        ("position", "um", "um"),
        ("position", "m", "m"),
        ("position", "in", "in"),
    ],
)
def test_every_wrong_unit_is_identified(tmp_path, samples, key, unit, units):
    """The file is written in ``unit``; the campaign states N, kPa and mm."""
    row, inner = {"position": (1, 1.0), "force": (2, 1.0), "pressure": (3, KPA)}[key]
    wrong = samples.copy()
    wrong[row] *= inner / UNITS[key][unit]
    path = tmp_path / "run.csv"
    values = wrong * np.array([[1], [1], [1], [1 / KPA]])
    path.write_text(",".join(HEADER) + "\n" + ("%.6f,%.9g,%.9g,%.9g\n" * values.shape[1]) % tuple(values.T.ravel()))
    curve = curve_of(run_of(), read_blocks(identify(path, COLUMNS, PLATE), RIG), RIG)
    name = getattr(COLUMNS, key).name
    with pytest.raises(InputError) as caught:
        check_plausible(curve, COLUMNS, EXPECTED, path)
    assert str(caught.value).startswith(f"{path}: column {name}: ")
    assert f'its unit looks like "{units}"' in str(caught.value)
    assert caught.value.remedy.startswith(f"give `columns` {key}={name}:{unit}, or in a campaign")
    right = declared(**{key: unit})
    result = curve_of(run_of(), read_blocks(identify(path, right, PLATE), RIG), RIG)
    assert check_plausible(result, right, EXPECTED, path) == ()


def test_the_message_has_the_numbers(tmp_path):
    curve = ideal(factor=(1, 1e3, 1))
    with pytest.raises(InputError) as caught:
        check_plausible(curve, COLUMNS, predicted(6.9, 4.2, 11 * KPA), Path("run.csv"))
    words = str(caught.value)
    assert words == (
        "run.csv: column force_N: reads 4.5e+03 N at 6.9 mm where the prediction has 4.2 N, 1079 times it; its unit looks like "
        '"mN"; give `columns` force=force_N:mN, or in a campaign set columns.force = { name = "force_N", unit = "mN" }'
    )


@pytest.mark.parametrize("expected", [EXPECTED, None])
def test_time_in_milliseconds_is_asked_about_with_the_unit(tmp_path, samples, expected):
    slow = samples * np.array([[1e3], [1], [1], [1]])
    asked = [text for text in analyse(tmp_path, slow, expected=expected) if "column time_s" in text]
    assert len(asked) == 1 and "time=time_s:ms" in asked[0]


def test_what_no_unit_explains_is_a_question_with_its_keys():
    words = check_plausible(ideal(factor=(1, 20.0, 1)), COLUMNS, predicted(6.9, 2.9, 7.2 * KPA), Path("run.csv"))
    assert len(words) == 1 and "column force_N" in words[0] and "no unit explains that" in words[0]
    assert "runs.resin" in words[0] and "design" in words[0]


@pytest.mark.parametrize(("times", "left"), [(185.0, "1.8 times"), (50.0, "0.49 times")])
def test_far_from_the_prediction_a_unit_explains_a_reading_that_it_brings_near(times, left):
    """A column in gf read as N, of a sensor twice as stiff as predicted or half as stiff: no sensor is 185 times."""
    expected = predicted(6.9, float(SENSOR.force(6.9)), SENSOR.slope * float(SENSOR.force(6.9)))
    with pytest.raises(InputError) as caught:
        check_plausible(ideal(factor=(1, times, 1)), COLUMNS, expected, Path("run.csv"))
    assert f'its unit looks like "gf", {left} the prediction then' in str(caught.value)


@pytest.mark.parametrize("times", [0.03, 0.06])
def test_a_rise_far_too_small_is_a_question_about_a_leak_or_a_dead_volume(times):
    """Of a sensor with a long tube it is right, and no unit may be taken for it."""
    expected = predicted(6.9, float(SENSOR.force(6.9)), SENSOR.slope * float(SENSOR.force(6.9)))
    (words,) = check_plausible(ideal(factor=(1, 1, times), driving=0.0), COLUMNS, expected, Path("run.csv"))
    assert "column pressure_kPa" in words and "pneumatics.dead_volume_mL" in words


def test_a_zero_far_below_is_a_question():
    low = replace(ideal(deepest=DEPTH), driving=-3.5 * KPA)
    (words,) = check_plausible(low, COLUMNS, None, Path("run.csv"))
    assert "-3.5 kPa before contact" in words and "not zeroed" in words


@settings(max_examples=50, deadline=None)
@given(force=st.floats(0.45, 2.2), rise=st.floats(0.45, 2.2), depth=st.floats(0.5, 2.0))
def test_no_question_within_a_factor_of_two(force, rise, depth):
    measured = ideal(deepest=depth * DEPTH, factor=(1, force, rise), driving=0.0)
    true = float(SENSOR.force(DEPTH))
    # A swap is detected by magnitudes where there is no driving pressure; these numbers are far from each other's.
    expected = predicted(DEPTH, true, 40 * SENSOR.slope * true)
    measured = replace(measured, rise=40 * measured.rise)
    assert check_plausible(measured, COLUMNS, expected, Path("run.csv")) == ()


@pytest.mark.parametrize("driving", [0.0, 12.0, 22.0])
def test_exchanged_columns_are_reported(tmp_path, driving):
    sensor = replace(SENSOR, driving=driving * KPA)
    samples = small(sensor=sensor)
    swapped = (HEADER[0], HEADER[1], HEADER[3], HEADER[2])
    refused(tmp_path, samples, "force_N and pressure_kPa look swapped", header=swapped, sensor=sensor)
    assert analyse(tmp_path, samples, sensor=sensor) == ()


@pytest.mark.parametrize(
    ("row", "words"), [(1, "position=-position_mm"), (2, "force=-force_N"), (3, "pressure=-pressure_kPa")]
)
def test_wrong_signs_are_reported(tmp_path, samples, row, words):
    wrong = samples.copy()
    wrong[row] *= -1
    refused(tmp_path, wrong, words, "sign = -1 }")


@pytest.mark.parametrize("expected", [EXPECTED, None])
def test_another_driving_pressure_is_refused_until_answered(tmp_path, samples, expected):
    sensor = replace(SENSOR, driving=22 * KPA)
    said = "column pressure_kPa: 12 kPa before contact", "driving_pressure_kPa = 22", "driving_pressure_kPa = 12 below"
    refused(tmp_path, samples, *said, sensor=sensor, expected=expected)
    assert analyse(tmp_path, samples, expected=expected) == ()


def test_a_driving_pressure_a_little_off_is_a_question(tmp_path, samples):
    (words,) = analyse(tmp_path, samples, sensor=replace(SENSOR, driving=14 * KPA))
    assert "column pressure_kPa: 12 kPa before contact" in words and "driving_pressure_kPa = 14" in words
    assert analyse(tmp_path, samples, sensor=replace(SENSOR, driving=12.9 * KPA)) == ()


@pytest.mark.parametrize("driving", [0.0, 12.0])
@pytest.mark.parametrize("expected", [EXPECTED, None])
def test_an_absolute_pressure_is_refused_with_the_unit_that_subtracts_the_ambient(driving, expected):
    absolute = replace(ideal(deepest=DEPTH, driving=driving), driving=(driving + 101.3) * KPA)
    with pytest.raises(InputError, match=r'unit = "kPa_abs"'):
        check_plausible(absolute, COLUMNS, expected, Path("run.csv"))


def test_the_odd_one_of_three_is_named():
    other = ideal(lambda d: 1.5 * SENSOR.force(d), number=3)
    runs = [ideal(number=1), ideal(lambda d: 1.02 * SENSOR.force(d), number=2), other]
    ((result, why),) = outliers(runs)
    assert result is other and why.startswith("force at 6.9 mm is 1.49 times that of the other 2 runs of sensor A1")
    ((result, why),) = outliers([*runs[:2], ideal(slope=0.7 * SENSOR.slope, number=3)])
    assert result.run.run == 3 and "slope of pressure over force is 0.70 times" in why


def test_of_two_that_differ_both_are_named():
    runs = [ideal(number=1), ideal(lambda d: 1.5 * SENSOR.force(d), number=2)]
    assert [curve.run.run for curve, _ in outliers(runs)] == [1, 2]


@settings(max_examples=30, deadline=None)
@given(st.lists(st.floats(0.95, 1.05), min_size=2, max_size=6))
def test_runs_alike_and_other_sensors_are_left_alone(factors):
    alike = [ideal(lambda d, f=f: f * SENSOR.force(d), number=k + 1) for k, f in enumerate(factors)]
    stiffer = ideal(lambda d: 3 * SENSOR.force(d), name="B1")
    inflated = ideal(lambda d: 2 * SENSOR.force(d), driving=22.0)
    assert outliers([*alike, stiffer, inflated]) == []


def test_a_sign_that_was_turned_is_turned_back_by_leaving_the_minus_out():
    turned = ColumnMap.model_validate({"force": {"name": "force_N", "unit": "N", "sign": -1}})
    with pytest.raises(InputError, match=r'give `columns` force=force_N:N, or .* unit = "N" }'):
        check_plausible(ideal(factor=(1, -1, 1)), turned, None, Path("run.csv"))


@pytest.mark.parametrize(
    ("factor", "words"),
    [((1, -1, 1), "force=-force_N"), ((1, 1, -1), "pressure=-pressure_kPa"), ((-1, 1, 1), "position=-position_mm")],
)
def test_signs_are_checked_without_a_prediction(factor, words):
    with pytest.raises(InputError, match=words):
        check_plausible(ideal(factor=factor), COLUMNS, None, Path("run.csv"))


def test_without_a_prediction_time_and_driving_pressure_are_checked_and_magnitudes_not(tmp_path, samples):
    assert analyse(tmp_path, samples, expected=None) == ()
    assert check_plausible(ideal(factor=(1, 20.0, 1)), COLUMNS, None, Path("run.csv")) == ()
    (words,) = analyse(tmp_path, samples, sensor=replace(SENSOR, driving=14 * KPA), expected=None)
    assert "driving_pressure_kPa = 14" in words


def leak(tmp_path, driving=22.0, top=100.0, start=22.0, constant=3600.0):
    """Questions about 300 s of a line that begins at ``start`` kPa, read by a gauge that stops at ``top``."""
    time = np.arange(0, 300, 0.1)
    rng = np.random.default_rng(3)
    pressure = np.minimum(start * np.exp(-time / constant) + rng.normal(0, 0.03, time.size), top)
    path = tmp_path / "leak.csv"
    np.savetxt(path, np.stack([time, pressure], axis=1), "%.5f", ",", header="time_s,pressure_kPa", comments="")
    run = run_of("leak").model_copy(update={"driving_pressure_kPa": driving})
    return check_leak(read_blocks(identify(path, COLUMNS, LEAK), RIG), run, RIG)


def test_a_leak_run_at_its_pressure_is_left_alone(tmp_path):
    assert leak(tmp_path) == ()
    assert leak(tmp_path, constant=30.0) == ()  # a great leak is a finding, no fault of the file


def test_a_leak_run_at_another_pressure(tmp_path):
    for driving in (12.0, 0.0):
        (words,) = leak(tmp_path, driving)
        assert "begins at 22 kPa" in words and f"driving_pressure_kPa = {driving:g}" in words
    for start in (2.0, 90.0):
        with pytest.raises(InputError, match=r"leak\.csv: a leak run that begins at .*driving_pressure_kPa = 22"):
            leak(tmp_path, start=start)


def test_a_vented_leak_run_is_questioned_beyond_a_regulators_scatter(tmp_path):
    assert leak(tmp_path, 0.0, start=0.8) == ()
    assert "begins at 1.19 kPa" in leak(tmp_path, 0.0, start=1.2)[0]


def test_a_leak_run_that_is_clipped(tmp_path):
    (words,) = leak(tmp_path, 99.0, start=100.0, top=100.0, constant=3600.0)
    assert "are clipped" in words
    with pytest.raises(
        InputError, match=r"leak\.csv: a leak run of 300 s of which 300 s are clipped .*range of 100 kPa"
    ):
        leak(tmp_path, 99.0, start=105.0, top=100.0, constant=1e5)


@given(start=st.floats(1.5, 3.0), noise=st.sampled_from([0.0, 1.0]))
@settings(max_examples=20)
def test_a_curve_from_inside_the_dome_is_refused_as_zeroed_there_or_as_lost_in_the_noise(start, noise):
    """Its force at the start decides which: what is below the noise was not seen."""
    travel = np.linspace(0.0, 7.0, 60)
    expected = ExpectedRun(travel, travel**2, travel**1.5 * KPA)
    depth = np.linspace(0.0, 7.0 - start, 12)
    curve = MeasuredCurve(
        run_of().model_copy(update={"driving_pressure_kPa": 0.0}),
        depth,
        (depth + start) ** 2 - start**2,
        ((depth + start) ** 1.5 - start**1.5) * KPA,
        driving=0.0,
        noise=(noise * start**2, 0.0),
    )
    with pytest.raises(InputError) as caught:
        check_plausible(curve, COLUMNS, expected, Path("run.csv"))
    (found,) = re.findall(r"([\d.]+) mm late" if noise else r"from ([\d.]+) mm inside the dome", str(caught.value))
    assert float(found) == pytest.approx(start, abs=0.15)
