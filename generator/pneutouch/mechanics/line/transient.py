"""Signals through a gain, by its Laplace transform inverted on a line to the right of the imaginary axis.

With F the transform and a > 0, f(t) = exp(a t) times the inverse Fourier transform of F(a + i w) (Dubner and Abate,
J. ACM 15(1), 115, 1968). Nothing wraps around the end of the record: what would is damped by exp(-a T). The last
frequencies are faded by Lanczos' sigma factors, so that a sharp step does not ring at the sampling rate.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array, Complex
from pneutouch.mechanics.line.band import gain_at, highest_frequency
from pneutouch.mechanics.line.dynamics import SensorDynamics

_DAMPING = 14.0
"""Damping of the inverse transform, a T: the part that wraps around has 1e-6 of its size, and rounding grows to
1e-10."""

_STEPS = 2048
"""Samples of a step response."""

_PERIODS = 12.0
"""Length of a step response, in periods of the frequency where the gain first leaves the slow one by a tenth."""


@dataclass(frozen=True, slots=True)
class StepFigures:
    """Figures of the pressure at the gauge after a step, the wall as stiff as it is at once.

    Attributes:
        delay: From the step to half of the final value, s.
        rise_time: From 10 to 90 % of the final value, s: the first front.
        overshoot: Greatest value over the final one, less 1; 0 if there is none.
        time, reading: The response, s and over its final value.
    """

    delay: float
    rise_time: float
    overshoot: float
    time: Array
    reading: Array


def through(gain: Callable[[Complex], Complex], signal: Array, step: float, *, sharp: bool = True) -> Array:
    """A signal (n,) of even steps (s), 0 before its first sample, after a gain over s.

    The gain is a function of s (m,), or gives several at once as (k, m): the result is (n,) or (k, n). ``sharp``
    signals jump: their last frequencies are faded; a smooth one keeps all of its size.
    """
    kept = signal.size
    # Where the record ends, its last value falls to 0 as sharply as a step: that lies behind what is kept.
    signal = np.pad(signal, (0, kept // 8 + 64), mode="edge")
    count = signal.size
    time = step * np.arange(count)
    damping = _DAMPING / (step * count)
    spectrum = np.fft.rfft(signal * np.exp(-damping * time))
    frequency = np.fft.rfftfreq(count, step)
    fade = np.sinc(frequency * 2.0 * step) if sharp else np.ones_like(frequency)
    answer = np.fft.irfft(
        spectrum * fade * gain(np.asarray(damping + 2j * np.pi * frequency, dtype=np.complex128)), count
    )
    return np.asarray((answer * np.exp(damping * time))[..., :kept])


def step_figures(dynamics: SensorDynamics) -> StepFigures:
    """The step response of a state, its rise time and its overshoot."""
    fast = dynamics.at_once()
    time, reading = step_response(fast, _PERIODS / _leaving(fast))
    overshoot = max(0.0, float(reading.max()) - 1.0)
    # The first front is shorter than the record: once more over little more than it. What comes later does not count.
    front = step_response(fast, 1.25 * _reaches(time, reading, 0.9) + 8.0 * (time[1] - time[0]))
    start, half, end = (_reaches(*front, share) for share in (0.1, 0.5, 0.9))
    return StepFigures(half, end - start, overshoot, time, reading)


def step_response(dynamics: SensorDynamics, duration: float) -> tuple[Array, Array]:
    """Time since the step (s), a little of it before, and the reading over its final value, (n,) each."""
    step, before = duration / _STEPS, _STEPS // 64
    signal = np.ones(_STEPS)
    signal[:before], signal[before] = 0.0, 0.5
    time = np.asarray(step * (np.arange(_STEPS) - before), dtype=np.float64)
    return time, through(dynamics.gain, signal, step)


def _leaving(dynamics: SensorDynamics) -> float:
    """Frequency in Hz at which the line changes the gain by a tenth from that of gas and wall alone."""
    top = highest_frequency(dynamics)
    grid = np.geomspace(1e-5 * top, top, 200)
    off = np.abs(gain_at(dynamics, grid) / gain_at(replace(dynamics, lumped=True), grid) - 1.0) > 0.1
    return float(grid[np.argmax(off)]) if off.any() else top


def _reaches(time: Array, reading: Array, share: float) -> float:
    """Time at which the response first reaches a share of its final value."""
    k = int(np.argmax(reading >= share))
    if k == 0:
        return float(time[-1])
    before, after = reading[k - 1], reading[k]
    return float(time[k - 1] + (share - before) / (after - before) * (time[k] - time[k - 1]))
