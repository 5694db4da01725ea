"""A scalogram: the wavelet transform of a signal with its times, voices and cone of influence, and its ridges."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array, Complex, Flags
from pneutouch.errors import InputError
from pneutouch.texture.morse import MORSE, VOICES, Boundary, Morse, transform, voices
from pneutouch.texture.signal import Signal, decimated


@dataclass(frozen=True, slots=True)
class Scalogram:
    """Transform ``values`` (k, n) in MPa at voices ``frequency`` (k,) Hz, rising, and times ``time`` (n,) s."""

    time: Array
    frequency: Array
    values: Complex
    wavelet: Morse = MORSE

    @property
    def amplitude(self) -> Array:
        """Amplitudes in MPa, (k, n)."""
        return np.abs(self.values)

    @property
    def inside(self) -> Flags:
        """True where the record's ends do not reach, (k, n): an e-folding time or more from both."""
        edge = self.wavelet.e_folding(self.frequency)[:, None]
        both = (self.time - self.time[0] >= edge) & (self.time[-1] - self.time >= edge)
        return np.asarray(both, bool)


class Ridge(NamedTuple):
    """Frequency in Hz and amplitude of ridges, (...); ``inner`` is False where the range has no maximum inside it."""

    frequency: Array
    amplitude: Array
    inner: Flags


def scalogram(
    given: Signal,
    low: float,
    high: float,
    per_octave: int = VOICES,
    wavelet: Morse = MORSE,
    boundary: Boundary = "reflect",
) -> Scalogram:
    """Scalogram from ``low`` to ``high`` Hz of a signal, decimated for ``high`` first.

    Raises InputError for a range that is empty or that the signal's sampling cannot read.
    """
    if not 0 < low < high < math.inf:
        raise InputError(f"scalogram from {low:g} to {high:g} Hz: the first must be above 0 and below the second")
    frequency = voices(low, high, per_octave)
    kept = decimated(given, float(frequency[-1]))
    try:
        values = transform(kept.pressure, kept.rate, frequency, wavelet, boundary)
    except ValueError as error:
        raise InputError(f"scalogram up to {high:g} Hz: {error}") from None
    return Scalogram(kept.time, frequency, values, wavelet)


def ridge(amplitude: Array, frequency: Array, low: float, high: float, wavelet: Morse = MORSE) -> Ridge:
    """The highest point between ``low`` and ``high`` Hz of amplitudes (..., k) at evenly spaced voices (k,), rising.

    A parabola through the logarithms of three voices over ln f, once the wavelet's own departure from a parabola is
    taken off: of a pure tone nothing remains but rounding. Raises ValueError if no voice lies in the range.
    """
    within = np.flatnonzero((frequency >= low) & (frequency <= high))
    within = within[(within > 0) & (within < len(frequency) - 1)]
    if not within.size:
        raise ValueError(f"no voice with two neighbours between {low:g} and {high:g} Hz")
    middle = within[0] + np.argmax(amplitude[..., within], axis=-1)
    near = np.stack([np.take_along_axis(amplitude, (middle + k)[..., None], -1)[..., 0] for k in (-1, 0, 1)])
    inner = (near[1] >= near[0]) & (near[1] >= near[2])
    offset, log_peak = _vertex(
        np.log(np.maximum(near, np.finfo(float).tiny)), math.log(frequency[1] / frequency[0]), wavelet
    )
    peak = np.where(inner, np.exp(log_peak), near[1])
    return Ridge(frequency[middle] * np.exp(np.where(inner, offset, 0.0)), peak, inner)


def _vertex(logs: Array, step: float, wavelet: Morse) -> tuple[Array, Array]:
    """Offset from the middle voice and height of the maximum of ``logs`` (3, ...), in logarithms."""
    places = np.array([-step, 0.0, step]).reshape(3, *[1] * (logs.ndim - 1))
    offset = np.zeros(logs.shape[1:])
    height = logs[1]
    for _ in range(8):
        away = offset - places
        left, middle, right = logs - (wavelet.log_response(away) + wavelet.time_bandwidth / 2 * away**2)
        bend = left - 2 * middle + right
        slope = (right - left) / 2
        turn = np.where(bend < 0, -slope / np.where(bend < 0, bend, -1.0), 0.0)
        turn = np.clip(turn, -1.0, 1.0)
        offset, height = turn * step, middle + turn * (slope + turn * bend / 2)
    return offset, height
