"""Signals through a gain: known series, and figures of the step response."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from pneutouch.mechanics.line.dynamics import GasLine, SensorDynamics, on_axis
from pneutouch.mechanics.line.elements import AirState, Duct, GasVolume
from pneutouch.mechanics.line.transient import _reaches, step_figures, step_response, through

AIR = AirState(0.101325)
NARROW = Duct(1000.0, 0.05)
"""So narrow that it is a line of resistance and compliance: its shear wave number is below 0.1 up to 10 Hz."""

TIME_SCALE = NARROW.length**2 * (8 * AIR.viscosity / AIR.pressure / NARROW.radius**2)
"""Resistance times compliance of the whole line, s."""


def pressed(line: tuple, compliance: float = math.inf) -> SensorDynamics:
    return SensorDynamics(GasVolume(1657.0), GasLine(line, AIR), compliance)


@pytest.mark.parametrize("load", [0.0, 0.3, 4.0])
def test_a_narrow_line_has_the_step_response_of_a_line_of_resistance_and_compliance(load):
    """1 - sum of 2/(b ((1 + load) sin b + load b cos b)) exp(-b^2 t), b tan b = 1/load: load is the end's compliance
    over the line's (Carslaw and Jaeger, Conduction of Heat in Solids, 1959, chapter XII)."""
    roots = np.array(
        [
            brentq(lambda b: load * b * math.sin(b) - math.cos(b), k * math.pi, (k + 0.5) * math.pi + 1e-9)
            for k in range(60)
        ]
    )
    weights = 2 / (roots * ((1 + load) * np.sin(roots) + load * roots * np.cos(roots)))
    end = () if not load else (GasVolume(load * NARROW.volume),)
    time, reading = step_response(pressed((NARROW, *end)), 4.0 * (1 + load) * TIME_SCALE)
    later = time > 0.03 * TIME_SCALE
    known = 1 - (weights * np.exp(-np.outer(time[later], roots**2) / TIME_SCALE)).sum(axis=1)
    assert np.abs(reading[later] - known).max() < 0.01
    assert np.abs(reading[time < -2 * (time[1] - time[0])]).max() < 0.01


def test_the_rise_time_of_that_line_is_that_of_its_series():
    got = step_figures(pressed((NARROW,)))
    time = np.linspace(0.001, 3, 20000) * TIME_SCALE
    n = np.arange(80)
    root = (2 * n + 1) * math.pi / 2
    known = 1 - (2 * (-1.0) ** n / root * np.exp(-np.outer(time, root**2) / TIME_SCALE)).sum(axis=1)
    first, half, last = (time[np.argmax(known >= share)] for share in (0.1, 0.5, 0.9))
    assert got.rise_time == pytest.approx(last - first, rel=0.01)
    assert got.delay == pytest.approx(half, rel=0.01)
    assert got.overshoot < 1e-4


def test_a_sine_comes_out_with_the_gain_and_phase_of_its_frequency():
    dynamics = pressed((Duct(300.0, 1.25),), 5e4)
    step, frequency = 1e-4, 60.0
    time = step * np.arange(20000)
    got = through(dynamics.gain, np.sin(2 * math.pi * frequency * time), step)
    gain = dynamics.gain(on_axis([frequency]))[0]
    known = np.imag(gain * np.exp(2j * math.pi * frequency * time))
    late = slice(10000, 19500)
    assert np.abs(got - known)[late].max() < 0.01 * abs(gain)


def test_nothing_comes_before_its_cause_and_nothing_wraps_around():
    dynamics = pressed((Duct(1000.0, 1.25),), 5e4)
    signal = np.zeros(8000)
    signal[6000:] = 1.0
    got = through(dynamics.gain, signal, 1e-4)
    assert np.abs(got[:5990]).max() < 5e-3
    travel = int(1000.0 / AIR.sound_speed / 1e-4)
    assert np.abs(got[: 6000 + travel - 5]).max() < 2e-2
    assert got[-1] > 0.5


def test_a_gain_of_one_leaves_a_smooth_signal_alone():
    time = np.linspace(0, 1, 4000)
    signal = np.sin(np.pi * np.clip(3 * time - 0.5, 0, 1)) ** 2
    assert through(np.ones_like, signal, 1 / 4000) == pytest.approx(signal, abs=1e-4)


def test_an_underdamped_line_overshoots_and_a_narrow_one_does_not():
    ringing = step_figures(pressed((Duct(300.0, 1.25),), 5e4))
    quiet = step_figures(pressed((Duct(300.0, 0.2),), 5e4))
    assert ringing.overshoot > 0.5 and quiet.overshoot < 0.2
    assert ringing.delay == pytest.approx(300.0 / AIR.sound_speed, rel=0.1)
    assert quiet.rise_time > 5 * ringing.rise_time


def test_a_fast_sine_keeps_its_size_where_the_gain_is_one():
    """A fifth of the sampling rate: faded as a step is, it would lose a quarter."""
    rate = 50_000.0
    time = np.arange(4000) / rate
    sine = 1.0 - np.cos(2 * math.pi * 10_000.0 * time)
    assert through(np.ones_like, sine, 1 / rate, sharp=False) == pytest.approx(sine, abs=2e-3)
    assert np.abs(through(np.ones_like, sine, 1 / rate) - sine).max() > 0.2


def test_the_moment_of_a_share_lies_between_two_times():
    time = np.linspace(0.0, 1.0, 11)
    assert _reaches(time, time**2, 0.5) == pytest.approx(0.7 + 0.1 * (0.5 - 0.49) / (0.64 - 0.49), rel=1e-12)
    assert _reaches(time, 0.4 * time, 0.5) == 1.0
