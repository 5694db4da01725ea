"""Records of known sensors to curves: the law of the record is recovered, and faults are reported."""

from __future__ import annotations

import itertools
import re
from dataclasses import replace

import numpy as np
import pytest

from pneutouch.bench.curve import LOADING_POINTS, curve_of
from pneutouch.bench.excursions import excursions, position_noise
from pneutouch.bench.indents import HOLD, protocol
from pneutouch.errors import InputError
from pneutouch.mechanics.response import figures
from pneutouch.spec.campaign import Rig
from pneutouch.units import KPA
from tests.bench.curves import FILE, LAWS, curve, whys
from tests.bench.reads import blocks_of
from tests.bench.rig import Faults, Sensor, record, run_of, small


@pytest.mark.parametrize(("sensor", "bias"), [(LAWS[0], 0.01), (LAWS[1], 0.05), (LAWS[2], 0.09), (LAWS[3], 0.04)])
@pytest.mark.parametrize("kind", ["steps", "saturation"])
def test_points_are_those_of_the_law(kind, sensor, bias):
    faults = Faults(rate=4000.0, missed=0.01, backlash=0.1)
    result = curve(record(kind, sensor, faults), kind, sensor)
    depths = np.array(protocol(kind, 9.25).depths)
    assert result.indentation[0] == result.force[0] == result.rise[0] == 0
    # The shallowest is touched with less than 0.1 N, five times the noise of one sample.
    onset = np.array([one.onset for one in result.indents[1:]]) - faults.zero
    assert abs(np.median(onset)) < bias
    assert np.abs(onset - np.median(onset)).max() < 0.08
    # Every travel is counted from one place, the first contact of the run's first indentations.
    start = depths - result.indentation[1:]
    assert np.ptp(start) < 0.006 and abs(start.mean()) < bias + 0.03
    force = sensor.force(depths)
    assert result.force[1:] == pytest.approx(force, abs=0.002)
    assert result.rise[1:] == pytest.approx(sensor.slope * force, abs=0.01 * KPA)
    assert result.driving == pytest.approx(sensor.driving, abs=0.005 * KPA)
    # The two shallowest may end before the force to which the others are fitted.
    light = [why for why in whys(result) if ": too light" in why]
    assert all(why.startswith(("indentation 1:", "indentation 2:")) for why in light)
    borrowed = [number for number, one in enumerate(result.indents, start=1) if not one.fitted]
    assert [why.partition(":")[0] for why in light] == [f"indentation {number}" for number in borrowed]
    assert borrowed or sensor is not LAWS[2]
    (missed,) = (why for why in whys(result) if why not in light)
    assert "samples missed" in missed


def test_the_sensitivity_is_that_put_in():
    sensor = Sensor(0.3, 1.4, 1.9 * KPA)
    result = curve(record(sensor=sensor), sensor=sensor)
    message = figures(result.indentation, result.force, result.rise / KPA)
    assert message is not None and message.sensitivity == pytest.approx(1.9, rel=2e-3) and message.r_squared > 0.9999


def test_a_filter_moves_the_onset_by_at_most_the_travel_in_its_delay():
    for tau in (0.005, 0.02):
        result = curve(record(sensor=LAWS[3], faults=Faults(rate=2000.0, filter=tau)))
        onset = np.median([one.onset for one in result.indents]) - 41.3
        assert 0.0 < onset < 5.0 * tau
        assert result.force[-1] == pytest.approx(LAWS[3].force(6.9375), abs=0.005)


def test_noise_is_that_of_samples_and_drift_that_of_a_leak():
    result = curve(record(faults=Faults(rate=2000.0, leak=0.02 * KPA)))
    assert result.noise[0] == pytest.approx(0.02, rel=0.03)
    assert result.noise[1] == pytest.approx(0.03 * KPA, rel=0.03)
    assert result.drift[0] == pytest.approx(-0.02 * KPA, rel=0.1)
    fast = curve(record(faults=Faults(rate=2000.0, leak=0.1 * KPA)))
    (leak,) = (why for why in whys(fast) if why.startswith("pressure without"))
    message = re.fullmatch(r"pressure without contact drifts by (\S+) kPa a minute, .*", leak)
    assert message is not None and float(message[1]) == pytest.approx(-6.0, rel=0.02)
    quiet = curve(record(faults=Faults(rate=2000.0)))
    assert quiet.warnings == () and abs(quiet.drift[0]) < 1e-3 * KPA


def test_filtered_noise_is_not_underestimated():
    """Noise that is alike from sample to sample is mostly between blocks."""
    samples = record(faults=Faults(force_noise=0.0))
    rng = np.random.default_rng(5)
    slow = np.repeat(rng.normal(0, 0.02, samples.shape[1] // 20 + 1), 20)[: samples.shape[1]]
    samples[2] += slow
    assert curve(samples).noise[0] == pytest.approx(0.02, rel=0.1)


def test_a_reset_does_not_enter_the_driving_pressure():
    """In every rest the cavity is vented and filled again."""
    blocks = blocks_of(FILE, *record())
    assert blocks.pressure.min() < 1 * KPA
    result = curve_of(run_of(), blocks, Rig())
    assert [one.driving for one in result.indents] == pytest.approx([12 * KPA] * 14, abs=0.02 * KPA)


def test_times_are_those_of_the_protocol():
    faults = Faults(rate=2000.0, backlash=0.0)
    what = protocol("saturation", 9.25)
    result = curve(record("saturation", faults=faults, what=what), "saturation")
    knots, travels = what.knots()
    for k, one in enumerate(result.indents):
        rest, down, up = knots[4 * k + 1], knots[4 * k + 2], knots[4 * k + 3]
        assert one.hold == (pytest.approx(down, abs=0.03), pytest.approx(up, abs=0.03))
        assert one.contact == pytest.approx(rest + 1.0 / 5.0, abs=0.03)
        assert one.read[0] == pytest.approx(up - HOLD / 4, abs=0.1) and up - 0.1 < one.read[1] < up
        assert up < one.release <= knots[4 * k + 4]
        assert one.release == pytest.approx(up + travels[4 * k + 3] / 5.0, abs=0.12)


@pytest.mark.parametrize("rate", [100.0, 500.0])
def test_slow_rigs_are_read_too(rate):
    result = curve(record(faults=Faults(rate=rate)))
    force = LAWS[1].force(np.array(protocol("steps", 9.25).depths))
    count = result.force.size - 1
    assert count >= 13
    assert result.force[1:] == pytest.approx(force[-count:], abs=0.015)
    assert result.indentation[3:] == pytest.approx(np.array(protocol("steps", 9.25).depths)[2 - 14 :], abs=0.2)


def test_a_run_in_a_wrong_unit_is_cut_all_the_same():
    right, samples = curve(small()), small()
    samples *= np.array([[1.0], [1e3], [1e-3], [1e3]])
    wrong = curve(samples)
    assert wrong.indentation == pytest.approx(1e3 * right.indentation, rel=1e-6)
    assert wrong.force == pytest.approx(1e-3 * right.force, rel=1e-6)
    assert any("position covers" in why for why in whys(wrong))
    samples[0] *= 1e3  # now of one sample a block, so that the onset is less sharp
    assert curve(samples).indentation == pytest.approx(1e3 * right.indentation, rel=0.1)


@pytest.mark.parametrize("rest", [2.0, 0.0])
def test_a_loop_has_its_branches(rest):
    sensor = LAWS[1]
    what = replace(protocol("loop", 9.25), rest=rest)
    result = curve(record("loop", sensor, Faults(rate=5000.0, backlash=0.0), what), "loop", sensor)
    assert len(result.loop) == 3 and result.indentation.size == LOADING_POINTS + 1
    assert result.indentation[-1] == pytest.approx(6.9375, abs=0.05)
    assert result.force == pytest.approx(sensor.force(result.indentation), abs=0.06)
    for force_in, rise_in, force_out, rise_out in result.loop:
        assert force_in[0] < 0.05 and force_in[-1] == pytest.approx(sensor.force(6.9375), rel=0.01)
        assert force_out[0] == pytest.approx(force_in[-1]) and force_out[-1] < 0.1
        assert np.all(np.diff(force_in[10:]) > 0) and np.all(np.diff(force_out[:-10]) < 0)
        for force, rise in ((force_in, rise_in), (force_out, rise_out)):
            assert rise == pytest.approx(sensor.slope * force, abs=0.1 * KPA)


def test_relaxation_is_followed():
    what = protocol("relaxation", 9.25).quicker(5.0)
    samples = record("relaxation", faults=Faults(rate=500.0), what=what)
    begin = what.knots()[0][2]
    held = samples[0] > begin
    samples[2, held] -= 0.4 * (1 - np.exp(-(samples[0, held] - begin) / 100.0))
    result = curve(samples, "relaxation")
    assert result.relaxation is not None
    since, force, rise = result.relaxation
    assert since[-1] == pytest.approx(600.0, abs=0.5)
    middle = slice(50, -50)
    expected = LAWS[1].force(6.9375) - 0.4 * (1 - np.exp(-since / 100.0))
    assert force[middle] == pytest.approx(expected[middle], abs=0.05)
    assert rise.mean() == pytest.approx(2.5 * KPA * LAWS[1].force(6.9375), rel=0.01)
    assert result.indentation.size == LOADING_POINTS + 1 and len(result.indents) == 1


def test_no_contact_is_reported():
    samples = small()
    samples[2] = 0.13 + np.random.default_rng(1).normal(0, 0.02, samples.shape[1])
    with pytest.raises(InputError, match=r"run\.csv: no contact: the force never leaves its noise: at most 0\.0\d+ N"):
        curve(samples)


def test_an_indentation_without_contact_is_a_warning():
    what = replace(protocol("steps", 9.25), depths=(-0.3, 2.0, 4.0), rest=4.0)
    result = curve(record(what=what))
    assert whys(result, used=False) == ["indentation 1: no contact found"]
    assert np.isnan(result.indents[0].contact) and result.indentation.size == 3


def test_a_plate_that_stays_or_moves_backwards():
    samples = small()
    with pytest.raises(InputError, match=r"position=-position_mm"):
        curve(samples * np.array([[1], [-1], [1], [1]]))
    samples[1] = 3.0 + np.random.default_rng(1).normal(0, 0.003, samples.shape[1])
    with pytest.raises(InputError, match="never moves"):
        curve(samples)
    with pytest.raises(InputError, match="no plate"):
        curve(small(), "leak")


def test_holds_that_are_short_or_not_settled():
    short = curve(record(what=replace(protocol("steps", 9.25), depths=(2.0, 4.0), rest=4.0, hold=1.0)))
    assert [why.split(":")[1] for why in whys(short)] == [" held for 0.99 s, usual are 4 s"] * 2
    samples = small()
    late = curve(small()).indents[2].read
    samples[2] += np.where((samples[0] > late[0]) & (samples[0] < late[1] + 0.2), -(samples[0] - late[0]) * 0.5, 0.0)
    (message,) = whys(curve(samples))
    assert message.startswith("indentation 3: force not settled: changes by -")


def test_depths_out_of_order_or_twice():
    what = replace(protocol("steps", 9.25), rest=4.0)
    result = curve(record(what=replace(what, depths=(4.0, 2.0, 3.0))))
    assert np.all(np.diff(result.indentation) > 0)
    assert [why for why in whys(result) if why.startswith("out of order")]
    twice = curve(record(what=replace(what, depths=(2.0, 4.0, 4.0)), faults=Faults(rate=10_000.0)))
    assert [why for why in whys(twice) if why.startswith("two indentations at one depth")]


def test_a_record_that_ends_or_begins_with_the_plate_in():
    samples = small()
    holds = [one.hold for one in curve(samples).indents]
    ends = curve(samples[:, samples[0] < holds[2][1] - 0.2])
    assert ends.indentation.size == 4
    assert whys(ends) == ["indentation 3: no release: the force does not go back"]
    begins = curve(samples[:, samples[0] > holds[0][0] + 0.5])
    assert begins.indentation.size == 3
    (left_out,) = [w for w in begins.warnings if w.why == "the record begins with the plate in; left out"]
    assert not left_out.used and left_out.end < begins.indents[0].contact


def test_excursions_survive_wild_positions():
    samples = small()
    clean, _ = excursions(blocks_of(FILE, *samples))
    samples[1, 5000:5010] = 60.0
    wild, pressed = excursions(blocks_of(FILE, *samples))
    assert not pressed and [one.hold for one in wild] == [one.hold for one in clean]


def test_the_noise_of_the_position_is_not_its_motion():
    rng, size = np.random.default_rng(2), 4000
    for place, slope in itertools.product((0.0, 50.0), (0.0, 0.05)):
        noise = position_noise(place + slope * np.arange(size) + rng.normal(0, 0.004, size))
        assert noise == pytest.approx(0.004, rel=0.06)
