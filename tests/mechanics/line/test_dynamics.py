"""The reading over frequency: wall, gas and line together, and the figures of it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from benchmarks.dynamics import BERGH_TIJDEMAN
from hypothesis import given, settings
from hypothesis import strategies as st

from pneutouch.mechanics.line.dynamics import GasLine, SensorDynamics, on_axis
from pneutouch.mechanics.line.elements import ADIABATIC, AirState, Duct, GasVolume
from pneutouch.mechanics.line.transient import GAS, LINE, WALL, band_figures, gain_at, with_end

AIR = AirState(0.101325)
DOME = GasVolume(1657.0, 3 * math.pi * 9.25**2)
TUBE = GasLine((Duct(8.5, 0.5), Duct(300.0, 1.25)), AIR)
SENSOR = SensorDynamics(DOME, TUBE, 5e4)


@pytest.mark.parametrize(("radius", "length", "volume", "peak", "gain"), BERGH_TIJDEMAN)
def test_the_peaks_of_bergh_and_tijdeman_are_met(radius, length, volume, peak, gain):
    line = GasLine((Duct(length, radius), GasVolume(volume)), AirState(0.101325, 288.15))
    got = band_figures(SensorDynamics(DOME, line, math.inf))
    assert got.resonance == pytest.approx(peak, rel=0.05)
    assert got.resonance_gain == pytest.approx(gain, rel=0.05)


def test_a_slow_change_has_the_gain_of_one():
    assert gain_at(SENSOR, np.array([1e-6]))[0] == pytest.approx(1.0, abs=1e-5)


def test_a_rigid_dome_reads_adiabatic_over_isothermal_when_fast():
    """Boyle's response while slow, 1.4 times it while fast; in between less, and the wall's give takes from it."""
    short = GasLine((Duct(0.01, 5.0),), AIR)
    rigid, soft = (SensorDynamics(DOME, short, c) for c in (0.0, 1e4))
    assert gain_at(rigid, np.array([3e3]))[0] == pytest.approx(ADIABATIC, rel=0.02)
    assert rigid.fast_gas == ADIABATIC
    share = (1657.0 + short.volume) / AIR.pressure / 1e4
    assert soft.fast_gas == pytest.approx((1 + share) / (1 + share / ADIABATIC), rel=1e-5)
    assert gain_at(soft, np.array([3e3]))[0] == pytest.approx(soft.fast_gas, rel=0.02)
    assert gain_at(SensorDynamics(DOME, short, math.inf), np.array([3e3]))[0] == pytest.approx(1.0, rel=1e-6)


def test_a_wall_that_relaxes_reads_less_of_a_quick_force():
    """The gas takes less of a force that the wall carries; at once it is the elastic wall of the instantaneous modulus."""
    relaxing = replace(SENSOR, excess=(0.3, 0.5), times=(0.1, 10.0), isothermal=True, lumped=True)
    assert gain_at(relaxing, np.array([1e3]))[0] == pytest.approx(relaxing.fast_wall, rel=1e-3)
    assert gain_at(relaxing, np.array([1e-6]))[0] == pytest.approx(1.0, rel=1e-4)
    share = relaxing.gas_share
    assert relaxing.fast_wall == pytest.approx((1 + share) / (1 + 1.8 * share))
    assert (np.diff(gain_at(relaxing, np.geomspace(1e-4, 1e3, 50))) < 0).all()


def test_what_ends_the_narrow_band_is_named():
    assert band_figures(SENSOR).limited_by == GAS
    relaxing = replace(SENSOR, excess=(0.5,), times=(10.0,))
    assert band_figures(relaxing).limited_by == WALL
    long_line = GasLine((Duct(20000.0, 0.5),), AIR)
    assert band_figures(SensorDynamics(GasVolume(10.0), long_line, 5e4)).limited_by == LINE


def test_the_narrow_band_ends_where_the_gain_is_five_percent_off():
    got = band_figures(SENSOR)
    assert abs(gain_at(SENSOR, np.array([got.within_tolerance]))[0] - 1) == pytest.approx(0.05, rel=1e-4)
    below = gain_at(SENSOR, np.linspace(1e-3, 0.999 * got.within_tolerance, 500))
    assert (np.abs(below - 1) < 0.05).all()


@pytest.mark.parametrize("line", [TUBE, GasLine((Duct(1000.0, 0.2),), AIR)])
def test_the_bandwidth_ends_three_decibels_off(line):
    state = SensorDynamics(DOME, line, 5e4)
    got = band_figures(state)
    edge = gain_at(state, np.array([got.bandwidth]))[0]
    assert min(abs(edge - 0.5**0.5), abs(edge - 2**0.5)) < 1e-4
    below = gain_at(state, np.linspace(1e-3, 0.999 * got.bandwidth, 500))
    assert (below > 0.5**0.5).all() and (below < 2**0.5).all()


def test_no_line_has_no_resonance():
    got = band_figures(SensorDynamics(DOME, GasLine((), AIR), 5e4))
    assert got.resonance is None and got.resonance_gain is None and got.bandwidth is None


@settings(max_examples=8, deadline=None)
@given(st.floats(20.0, 3000.0), st.floats(1.1, 3.0), st.floats(0.5, 3.0), st.floats(1e2, 1e6))
def test_a_longer_tube_is_never_quicker(length, longer, radius, compliance):
    one, two = (
        band_figures(SensorDynamics(DOME, GasLine((Duct(size, radius),), AIR), compliance))
        for size in (length, longer * length)
    )
    if one.resonance is None or two.resonance is None:
        return
    assert two.resonance < one.resonance


def test_gas_alone_and_line_alone_make_the_whole_where_one_is_ideal():
    assert gain_at(replace(SENSOR, isothermal=True, lumped=True), np.array([0.1, 10.0, 1000.0])) == pytest.approx(1.0)
    cavity, gauge = SENSOR.both(on_axis([30.0]))
    assert gauge == pytest.approx(cavity * TUBE.seen(on_axis([30.0])).transfer)


@pytest.mark.parametrize("length", [200.0, 400.0, 1000.0, 2000.0])
def test_gas_in_the_gauge_lowers_the_resonance_as_far_as_measured_tubes_are_below_the_line(length):
    """Tubes of 1.37 mm bore driven at one end: 6 to 25 % lower, the more the shorter the tube, with 150 mm3 at the end."""
    tube = SensorDynamics(DOME, GasLine((Duct(length, 0.685), GasVolume(4.7)), AIR), math.inf)
    with_more, _ = with_end(tube, 145.3)
    longer = SensorDynamics(DOME, GasLine((Duct(length, 0.685), GasVolume(150.0)), AIR), math.inf)
    assert with_more == pytest.approx(band_figures(longer).resonance, rel=1e-3)
    assert 1.03 < band_figures(tube).resonance / with_more < 1.5
