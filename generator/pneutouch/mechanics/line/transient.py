"""Signals through a gain, by inversion of its Laplace transform on a line to the right of the imaginary axis.

With F the transform and a > 0, f(t) = exp(a t) times the inverse Fourier transform of F(a + i w) (Dubner and Abate, J.
ACM 15(1), 115, 1968). The part that wraps around the end of the record is damped by exp(-a T). The last frequencies are
faded by Lanczos' sigma factors, so that a sharp step does not ring at the sampling rate.

Also figures of a gain over frequency: first resonance, bandwidth, and the band within a tolerance.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array, Complex, Flags
from pneutouch.mechanics.line.dynamics import GasLine, SensorDynamics, on_axis
from pneutouch.mechanics.line.elements import GasVolume

HALF_POWER = 0.5**0.5
"""Gain at -3 dB; its inverse is the gain at +3 dB."""

TOLERANCE = 0.05
"""Greatest deviation of the gain from its slow value, 1, in the band ``within_tolerance``."""

LINE, GAS, WALL = "line", "heat exchange of the gas", "relaxation of the wall"
"""Effects that can end the band ``within_tolerance``."""

_SLOWEST = 1.0e-4
"""Lowest frequency considered, Hz: a change over some hours."""

_BEYOND = 4.0
"""Highest frequency considered, over the half-wave resonance of the ducts, which bounds the first resonance."""

_LOWEST_PEAK = 1.0e-3
"""Lowest resonance that is looked for, over the highest frequency considered."""

_NO_DUCT = 1.0e4
"""Highest frequency considered for a line without a duct, Hz."""

_POINTS_A_DECADE = 60
_ROUNDING = 1e-10
"""Relative change of the gain that counts as rounding."""

_CLOSE = 1e-7
"""Relative width to which a frequency is located."""


@dataclass(frozen=True, slots=True)
class BandFigures:
    """Frequencies in Hz; None if there is none up to ``highest``.

    Attributes:
        resonance: First maximum of the gain at the gauge, with the wall at its instantaneous stiffness.
        resonance_gain: Gain at the resonance, over the slow gain with the same wall.
        bandwidth: Frequency up to which that gain is within 3 dB: it falls in a damped line, and rises to a resonance.
        within_tolerance: Frequency up to which the gain, with relaxation of the wall, is within `TOLERANCE` of 1.
        limited_by: Effect that ends the band ``within_tolerance``: `LINE`, `GAS` or `WALL`.
        highest: Highest frequency considered.
    """

    resonance: float | None
    resonance_gain: float | None
    bandwidth: float | None
    within_tolerance: float | None
    limited_by: str | None
    highest: float


def band_figures(dynamics: SensorDynamics) -> BandFigures:
    """Resonance, bandwidth and band within the tolerance of a state."""
    fast, top = dynamics.at_once(), highest_frequency(dynamics)
    grid = np.geomspace(_SLOWEST, top, int(_POINTS_A_DECADE * np.log10(top / _SLOWEST)))
    gain = gain_at(fast, grid)
    peak = _first_peak(fast, grid, gain)
    height = None if peak is None else _one(fast, peak)
    # A sharp peak may reach out of the band between two points of the grid.
    with_peak = grid if peak is None else np.sort(np.append(grid, peak))
    bandwidth = _leaves(fast, with_peak, lambda gain: np.abs(np.log(gain)) + np.log(HALF_POWER))
    within = _leaves(dynamics, with_peak, lambda gain: np.abs(gain - 1.0) - TOLERANCE)
    return BandFigures(peak, height, bandwidth, within, None if within is None else _limit(dynamics, within), top)


def with_end(dynamics: SensorDynamics, volume: float) -> tuple[float, float] | None:
    """First resonance, Hz, and its gain with so much more gas (mm3) at the gauge; None if there is no resonance."""
    longer = GasLine((*dynamics.line.elements, GasVolume(volume)), dynamics.line.air)
    fast, top = replace(dynamics, line=longer).at_once(), highest_frequency(dynamics)
    grid = np.geomspace(_LOWEST_PEAK * top, top, _POINTS_A_DECADE * 3)
    peak = _first_peak(fast, grid, gain_at(fast, grid))
    return None if peak is None else (peak, _one(fast, peak))


def highest_frequency(dynamics: SensorDynamics) -> float:
    """Highest frequency that the figures consider, Hz."""
    length = dynamics.line.length
    return _BEYOND * dynamics.line.air.sound_speed / (2.0 * length) if length > 0.0 else _NO_DUCT


def gain_at(dynamics: SensorDynamics, frequency: Array) -> Array:
    """Magnitudes of the gain (n,) at frequencies (n,), Hz."""
    return np.abs(dynamics.gain(on_axis(frequency)))


def _one(dynamics: SensorDynamics, frequency: float) -> float:
    return float(gain_at(dynamics, np.array([frequency]))[0])


def _first(where: Flags) -> int | None:
    """Index of the first True; None if there is none."""
    return int(np.argmax(where)) if where.any() else None


def _first_peak(dynamics: SensorDynamics, grid: Array, gain: Array) -> float | None:
    """Frequency (Hz) of the first maximum of ``gain`` inside ``grid``, located by refinement; None without one."""
    # Where the gain is 1, rounding produces maxima.
    at = _first((gain[1:-1] > (1.0 + _ROUNDING) * gain[:-2]) & (gain[1:-1] > gain[2:]))
    if at is None:
        return None
    low, high = grid[at], grid[at + 2]
    while high - low > _CLOSE * high:
        near = np.linspace(low, high, 33)
        k = int(np.clip(np.argmax(gain_at(dynamics, near)), 1, near.size - 2))
        low, high = near[k - 1], near[k + 1]
    return float(0.5 * (low + high))


def _leaves(dynamics: SensorDynamics, grid: Array, excess: Callable[[Array], Array]) -> float | None:
    """Lowest frequency (Hz) at which ``excess``, a function of the gain, turns positive; None if it does not."""
    at = _first(excess(gain_at(dynamics, grid)) > 0.0)
    if at is None:
        return None
    low, high = grid[max(at - 1, 0)], grid[at]
    while high - low > _CLOSE * high:
        near = np.linspace(low, high, 33)
        k = max(int(np.argmax(excess(gain_at(dynamics, near)) > 0.0)), 1)
        low, high = near[k - 1], near[k]
    return float(0.5 * (low + high))


def _limit(dynamics: SensorDynamics, frequency: float) -> str:
    """Name of the effect that, acting alone, changes the gain most at a frequency (Hz)."""
    elastic = replace(dynamics, excess=(), times=())
    alone = {
        LINE: replace(elastic, isothermal=True),
        GAS: replace(elastic, lumped=True),
        WALL: replace(dynamics, isothermal=True, lumped=True),
    }
    return max(alone, key=lambda name: abs(_one(alone[name], frequency) - 1.0))


_DAMPING = 14.0
"""Damping a T of the inverse transform: wrap-around falls to 1e-6 of its size, and rounding errors grow to 1e-10."""

_STEPS = 2048
"""Number of samples of a step response."""

_PERIODS = 12.0
"""Length of a step response, in periods of the frequency where the line first changes the gain by a tenth."""


@dataclass(frozen=True, slots=True)
class StepFigures:
    """Figures of the pressure at the gauge after a step, with the wall at its instantaneous stiffness.

    Attributes:
        delay: Time from the step to half of the final value, s.
        rise_time: Time from 10 to 90 % of the final value, s: the first front.
        overshoot: Greatest value over the final value, minus 1; 0 if there is none.
        time, reading: The response: time in s, and reading over its final value.
    """

    delay: float
    rise_time: float
    overshoot: float
    time: Array
    reading: Array


def through(gain: Callable[[Complex], Complex], signal: Array, step: float, *, sharp: bool = True) -> Array:
    """A signal (n,) at equal time steps (s), zero before its first sample, after it has passed a gain.

    The gain is a function of s (m,) that returns (m,), or (k, m) for several gains: the result is (n,) or (k, n). For a
    ``sharp`` signal, which jumps, the last frequencies are faded; a smooth signal keeps its full amplitude.
    """
    kept = signal.size
    # At the end of the record the value falls to 0 as sharply as a step: the padding puts this behind what is kept.
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
    """Response of a state to a step, with its delay, rise time and overshoot."""
    fast = dynamics.at_once()
    time, reading = step_response(fast, _PERIODS / _leaving(fast))
    overshoot = max(0.0, float(reading.max()) - 1.0)
    # The first front is shorter than the record: it is computed again on a shorter one. Later parts do not count.
    front = step_response(fast, 1.25 * _reaches(time, reading, 0.9) + 8.0 * (time[1] - time[0]))
    start, half, end = (_reaches(*front, share) for share in (0.1, 0.5, 0.9))
    return StepFigures(half, end - start, overshoot, time, reading)


def step_response(dynamics: SensorDynamics, duration: float) -> tuple[Array, Array]:
    """Time (s) since the step, from just before it over a duration (s), and reading over its final value, (n,) each."""
    step, before = duration / _STEPS, _STEPS // 64
    signal = np.ones(_STEPS)
    signal[:before], signal[before] = 0.0, 0.5
    time = np.asarray(step * (np.arange(_STEPS) - before), dtype=np.float64)
    return time, through(dynamics.gain, signal, step)


def _leaving(dynamics: SensorDynamics) -> float:
    """Frequency (Hz) at which the gain first differs by a tenth from that with the line as a mere volume."""
    top = highest_frequency(dynamics)
    grid = np.geomspace(1e-5 * top, top, 200)
    off = np.abs(gain_at(dynamics, grid) / gain_at(replace(dynamics, lumped=True), grid) - 1.0) > 0.1
    return float(grid[np.argmax(off)]) if off.any() else top


def _reaches(time: Array, reading: Array, share: float) -> float:
    """Time (s) at which the response first reaches a share of its final value; the last time if it does not."""
    k = int(np.argmax(reading >= share))
    if k == 0:
        return float(time[-1])
    before, after = reading[k - 1], reading[k]
    return float(time[k - 1] + (share - before) / (after - before) * (time[k] - time[k - 1]))
