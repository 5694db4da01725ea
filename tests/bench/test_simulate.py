"""The simulated rig against what it is made of: the solid's curve, the filter's and the memory's closed forms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from pneutouch.bench.indents import RunProtocol, protocol
from pneutouch.bench.simulate.curve import line_pressure, press_curves, sensor_pressure
from pneutouch.bench.simulate.rig import RigModel, ScatterModel, WallMemory, parameters
from pneutouch.bench.simulate.runs import (
    SimulationTruth,
    _lagging,
    _shut_in,
    simulate_leak,
    simulate_run,
    specimen_figures,
    within,
)
from pneutouch.mechanics.models.solid import solid_result
from pneutouch.units import KPA
from tests.bench.truths import NO_WALL, R0, ends, line, rng

QUIET = {"wall": NO_WALL, "scatter": ScatterModel.none()}


def test_quiet_record_is_the_solids_curve_at_the_holds(sensor, pressed):
    states = solid_result(sensor.replace(depth=0.75 * R0, steps=14), np.array([0.0, 22 * KPA])).states
    for curve, state in zip(pressed.curves, states, strict=True):
        test = RunProtocol("steps", tuple(state.indentation[1:]), 4.0, 5.0, True)
        record = simulate_run(curve, test, RigModel.perfect(), 100.0, rng(), **QUIET)
        at = ends(test, 100.0)
        assert record.position[at] == pytest.approx(state.indentation[1:], rel=1e-12)
        assert record.force[at] == pytest.approx(state.force[1:], rel=1e-6)
        assert record.pressure[at] - curve.driving == pytest.approx(state.pressure_rise[1:], rel=1e-6)
        clear = record.position < 0
        assert not record.force[clear].any()
        assert record.time[-1] == pytest.approx(test.duration, abs=0.01)


def test_low_pass_has_settled_long_before_the_end_of_a_hold(pressed):
    test, rig = protocol("steps", R0).quicker(5.0), replace(RigModel.perfect(), cutoff=RigModel().cutoff)
    exact = simulate_run(pressed.curves[1], test, RigModel.perfect(), 100.0, rng(), **QUIET)
    result = simulate_run(pressed.curves[1], test, rig, 100.0, rng(), **QUIET)
    at = ends(test, 100.0)
    assert result.force[at] == pytest.approx(exact.force[at], rel=1e-9)
    moving = np.abs(np.gradient(exact.force)) > 0.05
    assert np.abs(result.force - exact.force)[moving].max() > 0.05


def test_noise_in_the_file_has_the_filtered_rms():
    rig = replace(
        RigModel.perfect(), force_noise=0.02, pressure_noise=0.03 * KPA, cutoff=20.0, pressure_step=0.02 * KPA
    )
    for rate in (100.0, 400.0):
        share = 1 - np.exp(-2 * np.pi * 20.0 / rate)
        still = simulate_leak(0.0, 1e5 / rate, rig, rate, rng(3))
        force, pressure = rig.noise(rate)
        assert force == pytest.approx(0.02 * np.sqrt(share / (2 - share)), rel=1e-12)
        assert still.force.std() == pytest.approx(force, rel=0.02)
        assert still.pressure.std() == pytest.approx(pressure, rel=0.03)
        steps = still.pressure / (0.02 * KPA)
        assert steps == pytest.approx(np.round(steps), abs=1e-9)
    # One filter step forgets by 1 - share: the correlation of neighbours.
    a = still.force - still.force.mean()
    assert (a[1:] * a[:-1]).mean() / (a * a).mean() == pytest.approx(1 - share, abs=0.02)


def test_reading_is_right_going_in_and_lags_by_the_play_coming_out():
    knots, travels = RunProtocol("loop", (7.0, 7.0), 0.0, 2.0, False).knots()
    time = np.linspace(0, knots[-1], 20_001)
    plate, read = np.interp(time, knots, travels), _lagging(time, knots, travels, 0.03)
    speed = np.gradient(plate, time)
    inward = (speed > 4.9) & (plate > -0.9)
    outward = (speed < -4.9) & (plate < 6.9)
    assert read[inward] == pytest.approx(plate[inward], abs=1e-12)
    assert read[outward] == pytest.approx(plate[outward] + 0.03, abs=1e-12)


@given(depths=st.lists(st.floats(0.1, 8.0), min_size=1, max_size=6), play=st.floats(0.0, 0.5), rest=st.floats(0.0, 5.0))
def test_reading_never_strays_beyond_the_play(depths, play, rest):
    knots, travels = RunProtocol("steps", tuple(depths), 1.0, rest, False).knots()
    time = np.linspace(0, knots[-1], 2_001)
    gap = _lagging(time, knots, travels, play) - np.interp(time, knots, travels)
    assert gap.min() >= -1e-9 and gap.max() <= play + 1e-9


def test_reset_vents_and_fills_each_time():
    curve, test = line(driving=22 * KPA), RunProtocol("steps", (1.0, 2.0, 3.0), 4.0, 30.0, True)
    scatter = replace(ScatterModel.none(), reset=0.5 * KPA)
    record = simulate_run(curve, test, RigModel.perfect(), 100.0, rng(5), wall=NO_WALL, scatter=scatter)
    starts = test.knots()[0][:-1:4]
    for start in starts:
        vented = (record.time > start + 9) & (record.time < start + 11.9)
        assert np.abs(record.pressure[vented]).max() < 0.3 * KPA
    before = [record.pressure[np.searchsorted(record.time, start + 29.9)] for start in starts]
    assert np.std(before) > 0.05 * KPA and np.abs(np.array(before) - 22 * KPA).max() < 2 * KPA
    # The rise counts from the pressure set last.
    rise = record.pressure[ends(test, 100.0)] - before
    assert rise == pytest.approx(3 * KPA * np.array(test.depths), rel=1e-3)
    kept = simulate_run(curve, replace(test, reset=False), RigModel.perfect(), 100.0, rng(5), **QUIET)
    assert kept.pressure.min() >= 22 * KPA - 1e-12


def test_drift_of_a_shut_in_gas_begins_in_every_rest_at_three_fifths():
    """Until then the regulator holds its pressure; shut in, it is within 0.005 % of it."""
    rest, drift = 30.0, 0.01 * KPA
    test = RunProtocol("steps", (1.0, 2.0), 4.0, rest, True)
    time = np.arange(0, test.knots()[0][-1], 0.01)
    pressure = _shut_in(test, time, np.full(3, 22 * KPA), drift, np.zeros_like(time))
    for start in test.knots()[0][:-1:4]:
        shut = start + 0.6 * rest
        before, after = np.interp([shut - 0.02, shut + 10.0], time, pressure)
        assert before == pytest.approx(22 * KPA, rel=5e-5)
        assert after - 22 * KPA == pytest.approx(10.0 * drift, rel=0.01)


def test_drift_is_warming_less_leak():
    rig = replace(RigModel.perfect(), temperature=0.03 * KPA / 60, leak=0.002 / 60, force_drift=0.01 / 60)
    still = simulate_leak(20 * KPA, 600.0, rig, 10.0, rng())
    assert np.polyfit(still.time, still.pressure, 1)[0] * 60 / KPA == pytest.approx(0.03 - 0.04, rel=1e-9)
    assert np.polyfit(still.time, still.force, 1)[0] * 60 == pytest.approx(0.01, rel=1e-9)
    figures = specimen_figures(line(driving=20 * KPA), SimulationTruth(rig=rig), R0, 100.0)
    assert figures["drift_pressure_kPa_per_min"] == pytest.approx(-0.01, rel=1e-9)


def test_missed_samples_are_left_out_and_the_others_stay_on_the_clock():
    still = simulate_leak(0.0, 2000.0, replace(RigModel.perfect(), missed=0.01), 100.0, rng(1))
    assert 1 - still.time.size / 200_001 == pytest.approx(0.01, rel=0.1)
    assert still.time * 100 == pytest.approx(np.round(still.time * 100), abs=1e-6)


def test_gauges_stop_at_their_range():
    rig = replace(RigModel.perfect(), force_range=10.0, pressure_range=12 * KPA)
    record = simulate_run(line(), RunProtocol("steps", (2.0, 8.0), 4.0, 1.0, False), rig, 100.0, rng(), **QUIET)
    assert record.force.max() == 10.0 and record.pressure.max() == pytest.approx(12 * KPA)


@settings(max_examples=15)
@given(share=st.floats(0.001, 0.2), tau=st.floats(0.05, 50.0), depth=st.floats(0.5, 8.0))
def test_memory_of_an_even_ramp_and_its_fading_are_the_closed_form(share, tau, depth):
    wall = WallMemory((share,), (0.0,), (tau,))
    test = RunProtocol("relaxation", (depth,), 5.0, 1.0, False)
    record = simulate_run(line(), test, RigModel.perfect(), 1000.0, rng(), wall=wall, scatter=ScatterModel.none())
    knots, _ = test.knots()
    begun = knots[1] + 1.0 / 5.0
    ramp, since = knots[2] - begun, record.time - knots[2]
    start = share * 2.0 * 5.0 * tau * (1 - np.exp(-ramp / tau))
    held = (since > 0.01) & (since < 4.9)
    over = record.force[held] - 2.0 * depth
    # Contact and stop fall between samples: the ramp is known to a sample of a millisecond.
    assert over == pytest.approx(start * np.exp(-since[held] / tau), abs=share * 2.0 * 5.0 * 2e-3)


def test_same_seed_same_record_and_another_seed_another(pressed):
    test = protocol("loop", R0)
    one, same, other = (simulate_run(pressed.curves[0], test, RigModel(), 100.0, rng(seed)) for seed in (1, 1, 2))
    assert all(np.array_equal(a, b) for a, b in zip(one, same, strict=True))
    size = min(one.force.size, other.force.size)
    assert not np.array_equal(one.force[:size], other.force[:size])


def test_runs_of_one_specimen_scatter_by_the_gain(pressed):
    curve, test = pressed.curves[1], protocol("steps", R0).quicker(1.0, 0.5)
    at = ends(test, 50.0)
    slopes = []
    for seed in range(300):
        record = simulate_run(curve, replace(test, reset=False), RigModel.perfect(), 50.0, rng(seed), wall=NO_WALL)
        slopes.append(np.polyfit(record.force[at], record.pressure[at], 1)[0])
    # The standard error of a standard deviation of 300 values is 4 %.
    assert np.std(slopes, ddof=1) / np.mean(slopes) == pytest.approx(ScatterModel().gain, rel=0.15)


def test_curve_stops_where_the_range_ends_and_the_protocol_with_it(sensor):
    result = press_curves(sensor.replace(dead_volume=4940.0), [0.0], 0.9 * R0, "solid").curves[0]
    assert result.ends is not None and result.ends[0] == "inward buckling"
    assert result.reach == pytest.approx(result.ends[1], rel=1e-3) and result.reach < 0.75 * R0
    steps = within(protocol("steps", R0), result.reach)
    assert max(steps.depths) <= result.reach < max(steps.depths) + 0.5
    assert set(within(protocol("loop", R0), result.reach).depths) == {result.reach}
    with pytest.raises(ValueError, match="beyond the curve"):
        simulate_run(result, protocol("steps", R0), RigModel(), 100.0, rng())


def test_injected_air_obeys_boyle_with_the_swelling_cavity(pressed):
    pushed = np.linspace(0.0, 500.0, 6)
    wall = CubicSpline(*(np.unique(x) for x in (pressed.inflation.volume[:40], pressed.inflation.pressure[:40])))
    for dead in (0.0, 800.0):
        p = sensor_pressure(pushed, pressed.inflation, dead, 0.101325)
        start = pressed.inflation.volume[0]
        for air, result in zip(pushed, p, strict=True):
            content = 0.101325 * (start + dead + air)
            volume = brentq(lambda v, c=content, d=dead: (wall(v) + 0.101325) * (v + d) - c, start, 2 * start)
            assert result == pytest.approx(float(wall(volume)), rel=1e-5, abs=1e-9)
        # A cavity that swells keeps the pressure below that of one that does not.
        assert np.all(p[1:] < line_pressure(pushed[1:], start + dead, 0.101325))
    assert np.isnan(sensor_pressure(np.array([1e5]), pressed.inflation, 0.0, 0.101325)).all()


def test_every_parameter_has_a_unit_and_a_reason():
    for model in (ScatterModel(), RigModel(), WallMemory()):
        for name, record_ in parameters(model).items():
            assert record_.unit and len(record_.reason) > 10, name
