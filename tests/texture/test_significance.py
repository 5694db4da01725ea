"""Detection: patterns in noise are found, noise alone is found as often as stated, short records are refused."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.errors import InputError
from pneutouch.texture.detect import CYCLES, LEVEL, detect, least_duration
from pneutouch.texture.signal import Signal

RATE, SECONDS = 20.0, 40.0


def noise(rng, colour):
    """White noise, or noise whose power falls as 1/f^2 above 0.05 Hz; unit standard deviation."""
    white = rng.standard_normal(int(RATE * SECONDS))
    if colour == "white":
        return white
    spectrum = np.fft.rfft(white)
    spectrum /= np.hypot(1.0, np.fft.rfftfreq(len(white), 1 / RATE) / 0.05)
    red = np.fft.irfft(spectrum, len(white))
    return red / red.std()


def record(values):
    return Signal(0.0, 1 / RATE, 1e-3 * values)


@pytest.mark.slow
@pytest.mark.parametrize("colour", ["white", "red"])
def test_a_pattern_stands_out_of_noise(colour):
    rng = np.random.default_rng(4)
    t = np.arange(int(RATE * SECONDS)) / RATE
    found = detect(record(noise(rng, colour) + 1.5 * np.cos(2 * np.pi * 0.67 * t)), [0.667, 1.333])
    assert found[0].detected
    assert found[0].is_ridge
    assert found[0].p_value <= 0.005
    assert found[0].frequency == pytest.approx(0.67, rel=0.02)
    assert found[0].amplitude == pytest.approx(1.5e-3, rel=0.2)
    assert found[0].ratio > found[0].threshold


def rate_of_alarms(colour, count, surrogates):
    found = 0
    for seed in range(count):
        rng = np.random.default_rng(9000 + seed)
        found += detect(record(noise(rng, colour)), [0.667], surrogates=surrogates, seed=seed)[0].detected
    return found


@pytest.mark.slow
@pytest.mark.parametrize("colour", ["white", "red"])
def test_noise_alone_raises_no_more_alarms_than_stated(colour):
    """30 records at 5 %: 0 to 5 alarms hold 99.7 % of the binomial distribution."""
    assert rate_of_alarms(colour, 30, 99) <= 5


@pytest.mark.slow
@pytest.mark.parametrize("colour", ["white", "red"])
def test_noise_alone_raises_as_many_alarms_as_stated(colour, capsys):
    """400 records at 5 %: 9 to 33 alarms hold 99.7 %."""
    found = rate_of_alarms(colour, 400, 199)
    with capsys.disabled():
        print(f"\n{colour} noise: {found} alarms in 400 records at a level of {LEVEL:g}")  # noqa: T201
    assert 9 <= found <= 33


def test_what_is_found_does_not_depend_on_the_order_asked():
    rng = np.random.default_rng(8)
    given = record(noise(rng, "red"))
    one, other = detect(given, [0.667, 1.333], surrogates=99), detect(given, [1.333, 0.667], surrogates=99)
    assert one == other[::-1]


def test_a_short_record_is_told_how_long_it_must_be():
    short = Signal(0.0, 0.05, np.random.default_rng(1).standard_normal(100))
    with pytest.raises(InputError, match=rf"lasts 4\.95 s and must last at least {least_duration(0.667):.4g} s"):
        detect(short, [0.667])
    assert least_duration(0.75) == pytest.approx(2 * 120**0.5 / (2 * np.pi * 0.75) + CYCLES / 0.75)


@pytest.mark.parametrize(
    ("asked", "words"), [([], "no pattern frequency"), ([-1.0], "above 0"), ([9.0], "it can be tested up to")]
)
def test_frequencies_that_cannot_be_asked(asked, words):
    with pytest.raises(InputError, match=words):
        detect(record(noise(np.random.default_rng(2), "white")), asked)


def test_a_constant_signal_has_nothing_in_it():
    with pytest.raises(InputError, match="the same throughout"):
        detect(record(np.ones(800)), [0.667])


@pytest.mark.slow
@pytest.mark.parametrize("colour", ["white", "red"])
def test_patterns_an_octave_apart_are_found_whatever_the_noise(colour):
    """Power: two lines of one amplitude, one at twice the frequency of the other, with overtones of their own."""
    t = np.arange(int(RATE * SECONDS)) / RATE
    lines = sum(
        size * np.cos(2 * np.pi * f * t + k)
        for k, (f, size) in enumerate([(0.667, 1.5), (1.333, 1.5), (2.0, 0.4), (2.667, 0.4), (4.0, 0.2)])
    )
    for seed in range(10):
        given = record(noise(np.random.default_rng(seed), colour) + lines)
        found = detect(given, [0.667, 1.333], surrogates=199, seed=seed)
        assert all(one.detected for one in found), (seed, found)


def test_the_floor_of_white_noise_is_what_the_wavelet_passes_of_it():
    from pneutouch.texture.scalogram import time_average

    floors, true = [], []
    for seed in range(8):
        values = noise(np.random.default_rng(100 + seed), "white")
        floors.append([one.floor for one in detect(record(values), [0.667, 1.333], surrogates=19, level=0.05)])
        true.append(1e-3 * time_average(values, RATE, np.array([0.667, 1.333])))
    assert np.median(floors, axis=0) == pytest.approx(np.median(true, axis=0), rel=0.5)


@pytest.mark.parametrize("power", [0.0, -2.0, -1.0])
def test_the_fit_recovers_a_known_density(power):
    """Noise of density f^power drawn a hundred times: the mean of the fits is that density within a tenth."""
    from pneutouch.texture.detect import fitter

    count = int(RATE * SECONDS)
    used = fitter(count, RATE, 0.2, 6.0, np.array([0.667]), np.array([1.333]), 0.15)
    frequency = np.fft.rfftfreq(2 * count, 1 / RATE)
    true = np.where(frequency > 0.05, np.maximum(frequency, 0.05) ** power, 0.05**power)
    rng = np.random.default_rng(3)
    shape = rng.standard_normal((100, len(frequency))) + 1j * rng.standard_normal((100, len(frequency)))
    values = np.fft.irfft(shape * np.sqrt(true * RATE * count), 2 * count)[:, :count]
    at = np.array([0.3, 0.667, 1.5, 4.0])
    found = np.exp(np.log(used.density(used.fit(values), at)).mean(axis=0))
    assert found == pytest.approx(at**power, rel=0.15)
