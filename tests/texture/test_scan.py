"""The dome at its preload and the scan: curves, controls, first order against the whole curve, noise and refusals."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pneutouch.errors import InputError
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.sensor import Dome, GasCircuit, IndentationProtocol, Sensor, WallMaterial
from pneutouch.shape.hemisphere import Hemisphere
from pneutouch.texture.separate import BarPattern, amplitudes, noise_amplitude, recommend, separate
from pneutouch.texture.sliding import Recorder, ScanPath, gain, pressure_amplitude, record, scan, touch, touches
from pneutouch.texture.substrate import BarRow, MatrixLayer, Substrate
from pneutouch.units import GAUGE_LIMIT, KPA, STANDARD_ATMOSPHERE

SENSOR = Sensor(
    Dome(Hemisphere(9.25, 1.5)),
    WallMaterial(0.17, 0.49, break_stretch=2.7),
    GasCircuit(ambient_pressure=STANDARD_ATMOSPHERE, dead_volume=0.0, gauge_limit=GAUGE_LIMIT),
    IndentationProtocol(plate_radius=15.0, depth=0.75 * 9.25, steps=14),
)
MATRIX = MatrixLayer(8.0, 0.206, 0.49)
QUIET = Recorder(rate=500.0, noise=0.0, step=0.0)


def bars(pitch=6.0, depth=2.0) -> BarRow:
    near = np.arange(pitch / 4, 60.0 - pitch / 2, pitch)
    return BarRow("bars", pitch, pitch / 2, 1.5, depth, np.stack([near, near + pitch / 2], axis=1))


def ground(radius: float, *rows: BarRow) -> Substrate:
    return Substrate(MATRIX, rows or (bars(),), 60.0, radius)


@given(pressure=st.floats(0.0, 30.0), preload=st.floats(0.1, 1.5))
@settings(max_examples=15)
def test_touch_reaches_its_preload_on_a_rising_curve(pressure, preload):
    found = touch(SENSOR, pressure * KPA, preload)
    assert found.force_at(np.array([found.indentation]))[0] == pytest.approx(preload, rel=1e-9)
    step = 1e-3
    near = found.indentation + np.array([-step, step])
    assert np.diff(found.force_at(near))[0] / (2 * step) == pytest.approx(found.stiffness, rel=0.01)
    assert np.diff(found.pressure_at(near))[0] / (2 * step) == pytest.approx(found.pressure_slope, rel=0.02)
    assert found.pressure == pytest.approx(found.pressure_at(np.array([found.indentation]))[0])
    assert 0 < found.contact_radius < SENSOR.dome.inner_radius + SENSOR.dome.wall_thickness


def test_many_at_once_are_the_same_as_one_by_one():
    pressures = np.array([0.0, 5.0, 22.0]) * KPA
    found = touches(batch_of(SENSOR, pressures), 0.5)
    for k, pressure in enumerate(pressures):
        one = touch(SENSOR, float(pressure), 0.5)
        assert found.indentation[k] == pytest.approx(one.indentation, rel=1e-6)
        assert found.contact_radius[k] == pytest.approx(one.contact_radius, rel=1e-6)
        assert found.pressure_slope[k] == pytest.approx(one.pressure_slope, rel=1e-6)
    assert np.isnan(touches(batch_of(SENSOR, pressures), 1e6).indentation).all()


def test_gas_is_boyles_and_dead_volume_costs_pressure():
    rises = [touch(SENSOR.replace(dead_volume=v), 10 * KPA, 0.5).pressure for v in (0.0, 2e3, 2e4, 1e7)]
    assert rises == sorted(rises, reverse=True)
    assert rises[-1] == pytest.approx(10 * KPA, rel=1e-4)
    # Without any change of pressure there is nothing to read.
    assert touch(SENSOR.replace(dead_volume=1e7), 10 * KPA, 0.5).pressure_slope < 1e-3 * KPA


def test_atlas_and_solid_tell_the_same_touch():
    one = touch(SENSOR, 12 * KPA, 0.5)
    other = touch(SENSOR.replace(poisson_ratio=0.4901), 12 * KPA, 0.5)
    assert (one.model, other.model) == ("atlas", "solid")
    assert other.stiffness == pytest.approx(one.stiffness, rel=0.03)
    assert other.contact_radius == pytest.approx(one.contact_radius, rel=0.08)
    assert other.pressure_slope == pytest.approx(one.pressure_slope, rel=0.03)


def test_held_height_gives_the_first_order_amplitude_and_held_force_none():
    at = touch(SENSOR, 22 * KPA, 0.5)
    under = ground(at.contact_radius)
    found = scan(at, under, ScanPath(6.0, 54.0, 4.0), QUIET)
    spectrum = np.abs(np.fft.rfft(found.clean[:-1])) * 2 / (len(found.clean) - 1)
    own = pressure_amplitude(at, under, under.bars[0])
    assert spectrum[8] == pytest.approx(own, rel=0.02)
    held = scan(at, under, ScanPath(6.0, 54.0, 4.0, "force"), QUIET)
    assert np.ptp(held.clean) == 0.0 and pressure_amplitude(at, under, under.bars[0], "force") == 0.0
    # What the height does at a held force is what the dome would have to take at a held height.
    swing = np.abs(np.fft.rfft(held.height[:-1]))[8] * 2 / (len(held.height) - 1)
    mean = float(under.compliance(4096).mean())
    assert swing * at.pressure_slope / (1 + at.stiffness * mean) == pytest.approx(own, rel=1e-3)
    assert not found.height.any()


def test_gain_is_the_series_spring_formula():
    at = touch(SENSOR, 0.0, 0.5)
    # physics.md 4.2: S delta0 k_s dk_l/(k_l + k_s)^2 in terms of compliance c = 1/k_s and dome stiffness k.
    c, dc = 0.3, 1e-6
    force = [at.preload * (1 / at.stiffness + c) / (1 / at.stiffness + c + d) for d in (0.0, dc)]
    slope = at.pressure_slope / at.stiffness * (force[1] - force[0]) / dc
    assert gain(at, c) == pytest.approx(slope, rel=1e-5)


def test_rigid_or_bare_specimens_show_nothing():
    at = touch(SENSOR, 0.0, 0.5)
    for under in (Substrate(MATRIX, (), 60.0, at.contact_radius), ground(at.contact_radius, bars(depth=8.0))):
        assert np.ptp(scan(at, under, ScanPath(6.0, 54.0, 4.0), QUIET).clean) < 1e-9 * KPA


def test_patterns_stand_beside_the_signal_and_noise_is_the_seeds():
    at = touch(SENSOR, 22 * KPA, 0.5)
    under, way = ground(at.contact_radius), ScanPath(6.0, 54.0, 4.0)
    one, same, other = (scan(at, under, way, Recorder(seed=s)) for s in (1, 1, 2))
    assert (one.signal.pressure == same.signal.pressure).all()
    assert (one.signal.pressure != other.signal.pressure).any()
    assert len(one.place) == 120_001 and one.signal.rate == pytest.approx(10_000.0)
    assert one.pattern(under.bars[0]).mean() == pytest.approx(0.5, abs=0.001)


def test_recorder_steps_and_clips():
    given_, recorder = np.array([0.0, 0.4, 0.6, 200.0]) * KPA, Recorder(noise=0.0, step=1.0 * KPA)
    assert record(given_, recorder) / KPA == pytest.approx([0.0, 0.0, 1.0, 100.0])
    noisy = record(np.zeros(100_000), Recorder(step=0.0, noise=0.015 * KPA))
    assert noisy.std() == pytest.approx(0.015 * KPA, rel=0.02)


@pytest.mark.parametrize(
    ("pressure", "preload", "word"),
    [
        (0.0, 0.0, "more than 0"),
        (0.0, np.nan, "more than 0"),
        (0.0, 1e4, "reaches"),
        (-1.0, 0.5, "0 or more"),
        (45.0, 0.5, "limit point"),
        (150.0, 0.5, "range of 100 kPa"),
    ],
)
def test_touch_refuses_what_cannot_be(pressure, preload, word):
    with pytest.raises(InputError, match=word):
        touch(SENSOR, pressure * KPA, preload)


def test_scan_refuses_paths_noise_and_pitches():
    at = touch(SENSOR, 0.0, 0.5)
    for way, rows, recorder, word in (
        (ScanPath(5.0, 5.0, 4.0), bars(), QUIET, "shorter than the patch"),
        (ScanPath(5.0, 50.0, 0.0), bars(), QUIET, "speed"),
        (ScanPath(5.0, 50.0, 4.0), bars(1.5), QUIET, r"times the patch, whose radius is 3.58 mm"),
        (ScanPath(5.0, 50.0, 4.0), bars(), Recorder(noise=-1.0), "noise"),
    ):
        with pytest.raises(InputError, match=word):
            scan(at, ground(at.contact_radius, rows), way, recorder)


def test_noise_amplitude_is_what_white_noise_reads_as():
    from pneutouch.texture.scalogram import time_average

    values = np.random.default_rng(3).standard_normal((40, 6000))
    found = time_average(values, 200.0, np.array([1.0, 2.0]))
    for k, frequency in enumerate((1.0, 2.0)):
        assert found[:, k].mean() == pytest.approx(noise_amplitude(frequency, 1.0, 200.0), rel=0.05)


def test_recommendation_is_the_highest_amplitude():
    best = recommend(BarPattern(6.0, 2.0), SENSOR, MATRIX, 22 * KPA)
    assert best.amplitude == np.max(best.amplitudes) >= best.unpressurised
    with pytest.raises(InputError, match="depth"):
        recommend(BarPattern(6.0, 9.0), SENSOR, MATRIX, 22 * KPA)
    with pytest.raises(InputError, match="no driving pressure"):
        recommend(BarPattern(6.0, 2.0), SENSOR, MATRIX, 22 * KPA, preload=1e5)


def test_separation_takes_the_states_that_lean_most():
    pressures = np.array([0.0, 10.0, 22.0, 30.0]) * KPA
    batch, patterns = batch_of(SENSOR, pressures), (BarPattern(3.0, 0.0), BarPattern(6.0, 2.0))
    found = separate(batch, np.zeros(4), 0.5, MATRIX, patterns, (1e-9, 1e-9))
    each = amplitudes(batch, 0.5, MATRIX, list(patterns))
    ratio = each[:, 0] / each[:, 1]
    assert found.contrast == pytest.approx([ratio.max() / ratio.min()])
    assert found.pressures[0] == pytest.approx([pressures[ratio.argmax()], pressures[ratio.argmin()]])
    assert not separate(batch, np.zeros(4), 0.5, MATRIX, patterns, (1.0, 1.0)).dome.size


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(1, 6))
def test_the_stiff_state_shows_both_patterns_whatever_the_noise(seed, library):
    from pneutouch.spec.options import ScanOptions
    from pneutouch.workflows.scan import run_scan

    (seen,) = run_scan(
        "texture-specimen", "paper-dome", ScanOptions(driving_pressures_kPa=[22.0], seed=seed), library=library
    ).seen
    for found, true in zip(seen.detections, (4 / 3, 2 / 3, 2 / 3), strict=True):
        assert found.detected
        assert found.frequency == pytest.approx(true, rel=0.03)


def test_a_sensor_held_at_a_force_rises_over_a_bar(library):
    from pneutouch.spec.options import ScanOptions
    from pneutouch.workflows.scan import run_scan

    run = run_scan(
        "texture-specimen", "paper-dome", ScanOptions(driving_pressures_kPa=[22.0], control="force"), library=library
    )
    scan = run.seen[0].scan
    over = scan.pattern(run.bars[2]) > 0.5
    late = scan.place > 34.0
    assert scan.height[over & late].mean() > scan.height[~over & late].mean()
