"""The Morse transform against another program, against tones and chirps, and against its own definition."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.errors import InputError
from pneutouch.texture.scalogram import HIGHEST_SHARE, MORSE, VOICES, ridge, scalogram, time_average, transform, voices
from pneutouch.texture.signal import Signal, decimated
from tests.texture.make_reference import AT, FREQUENCY, RATE, values

REFERENCE = json.loads(Path(__file__).with_name("reference.json").read_text())


def tone(rate, seconds, *parts):
    t = np.arange(int(rate * seconds)) / rate
    return t, sum(a * np.cos(2 * np.pi * f * t + phase) for a, f, phase in parts)


def middle_ridge(amplitude, frequency, low, high):
    return ridge(amplitude[:, amplitude.shape[1] // 2], frequency, low, high)


def test_equals_ssqueezepy():
    theirs = np.array(REFERENCE["real"]) + 1j * np.array(REFERENCE["imaginary"])
    ours = transform(values(), RATE, FREQUENCY[::-1])[::-1, AT]
    assert np.abs(ours - theirs).max() < 1e-6
    assert np.abs(theirs).max() > 0.5


def test_two_tones_give_back_their_amplitudes_and_frequencies():
    _, x = tone(100.0, 60.0, (0.7, 0.75, 0.0), (0.3, 1.5, 1.0))
    frequency = voices(0.3, 4.0, VOICES)
    amplitude = np.abs(transform(x, 100.0, frequency))
    for size, true in ((0.7, 0.75), (0.3, 1.5)):
        found = middle_ridge(amplitude, frequency, true / 1.2, true * 1.2)
        assert float(found.amplitude) == pytest.approx(size, rel=1e-3)
        assert float(found.frequency) == pytest.approx(true, rel=5e-3)
        assert found.inner


@given(st.floats(0.5, 3.0), st.floats(0.01, 100.0), st.floats(0, 6.28))
def test_any_tone_reads_as_itself(true, size, phase):
    _, x = tone(60.0, 40.0, (size, true, phase))
    frequency = voices(0.3, 6.0)
    found = middle_ridge(np.abs(transform(x, 60.0, frequency)), frequency, 0.35, 5.5)
    assert float(found.amplitude) == pytest.approx(size, rel=1e-3)
    assert float(found.frequency) == pytest.approx(true, rel=1e-3)


def test_linear_and_shifted_with_the_signal():
    rng = np.random.default_rng(3)
    x, y = rng.standard_normal((2, 4000))
    frequency = voices(1.0, 8.0)
    one, other, both = (transform(v, 50.0, frequency) for v in (x, y, 2 * x - 3 * y))
    assert np.allclose(both, 2 * one - 3 * other, atol=1e-12)
    shifted = transform(np.roll(x, 100), 50.0, frequency)
    inside = slice(1500, 2500)
    assert np.allclose(shifted[:, inside], one[:, slice(1400, 2400)], atol=1e-8)


def test_response_is_the_definition():
    """Psi(w) = a w^beta exp(-w^gamma) with its peak of 2 at (beta/gamma)^(1/gamma); no mean passes."""
    peak = (20 / 3) ** (1 / 3)
    assert peak == pytest.approx(1.88207, abs=1e-5)
    w = np.linspace(0.01, 4.0, 4000)
    plain = w**20 * np.exp(-(w**3))
    assert np.allclose(MORSE.response(w / peak), 2 * plain / (peak**20 * math.exp(-(peak**3))), rtol=1e-10)
    assert MORSE.response(np.array([0.0, -1.0])).tolist() == [0.0, 0.0]
    half = w[MORSE.response(w / peak) >= math.sqrt(2)]
    assert (half[-1] - half[0]) / 2 / peak == pytest.approx(0.107, abs=0.004)


def test_the_cone_is_where_the_ends_reach():
    """A step at the end of a mirrored record is felt within the cone and not outside it."""
    frequency = voices(0.5, 4.0)
    assert float(MORSE.e_folding(0.75)) == pytest.approx(math.sqrt(120) / (2 * math.pi * 0.75))
    x = np.zeros(3000)
    spike = x.copy()
    spike[0] = 1.0
    t = np.arange(3000) / 50.0
    felt = np.abs(transform(spike, 50.0, frequency) - transform(x, 50.0, frequency))
    for k, f in enumerate(frequency):
        edge = float(MORSE.e_folding(f))
        assert felt[k, t > 3.2 * edge].max() < 0.02 * felt[k].max()
        assert felt[k, t < 0.5 * edge].max() > 0.5 * felt[k].max()


def test_a_chirp_is_followed():
    t = np.arange(6000) / 100.0
    x = np.cos(2 * np.pi * (0.8 * t + 0.01 * t**2))
    frequency = voices(0.4, 4.0)
    amplitude = np.abs(transform(x, 100.0, frequency))
    for at in (1500, 3000, 4500):
        found = ridge(amplitude[:, at], frequency, 0.5, 3.5)
        assert float(found.frequency) == pytest.approx(0.8 + 0.02 * t[at], rel=0.01)


def test_time_average_is_the_transform_averaged():
    rng = np.random.default_rng(5)
    x = rng.standard_normal(3000)
    frequency = voices(1.0, 6.0)
    full = np.abs(transform(x, 50.0, frequency))
    t = np.arange(3000) / 50.0
    for k, (f, mean) in enumerate(zip(frequency, time_average(x, 50.0, frequency), strict=True)):
        edge = float(MORSE.e_folding(f))
        inside = (t >= edge) & (t <= t[-1] - edge)
        assert mean == pytest.approx(full[k, inside].mean(), rel=0.02)


def test_decimation_keeps_amplitudes_and_lets_nothing_fold_back():
    t = np.arange(200_000) / 10_000.0
    wanted, beyond = np.cos(2 * np.pi * 3.0 * t), np.cos(2 * np.pi * 22.0 * t)
    for given_, size in ((wanted, 1.0), (wanted + beyond, 1.0)):
        kept = decimated(Signal(0.0, 1e-4, given_), 4.0)
        assert kept.rate == pytest.approx(20.0, rel=0.01)
        there = np.cos(2 * np.pi * 3.0 * kept.time)
        inside = slice(40, -40)
        assert np.abs(kept.pressure - size * there)[inside].max() < 2e-4


def test_voices_beyond_the_sampling_are_refused():
    with pytest.raises(ValueError, match="voices go up to"):
        transform(np.zeros(100), 10.0, np.array([HIGHEST_SHARE * 10 * 1.1]))
    with pytest.raises(InputError, match="must be above 0 and below the second"):
        scalogram(Signal(0.0, 0.01, np.zeros(500)), 2.0, 1.0)


def test_decimation_makes_the_transform_affordable():
    """300,000 samples at 80 voices up to 8 Hz: what is transformed is a hundredth of the record."""
    signal = Signal(0.0, 1e-4, np.random.default_rng(1).standard_normal(300_000))
    assert len(scalogram(signal, 0.4, 8.0, per_octave=18).frequency) >= 78
    assert decimated(signal, 8.0).pressure.size < 3000
