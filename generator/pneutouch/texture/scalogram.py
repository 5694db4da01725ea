"""A scalogram: the wavelet transform of a signal with its times, voices and cone of influence, and its ridges.

The analytic Morse wavelet transform, amplitude-true: a sinusoid of amplitude A reads |W| = A at its frequency.

Psi(w) = U(w) a w^beta exp(-w^gamma), P^2 = beta gamma (Lilly & Olhede 2012, doi 10.1109/TSP.2012.2210890), with a such
that Psi is 2 at its peak w = (beta/gamma)^(1/gamma): L1 normalisation, where equal amplitudes read the same at every
frequency. gamma = 3 and P^2 = 60 are MATLAB's ``cwt`` defaults, which the paper's figure 9 states.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from pneutouch.arrays import Array, Complex, Flags
from pneutouch.errors import InputError
from pneutouch.texture.signal import Signal, decimated

Boundary = Literal["reflect", "zero"]

VOICES = 10
"""Voices an octave, MATLAB's default: the half-power band spans three of them."""

HIGHEST_SHARE = 0.4
"""Highest voice over sampling rate: a quarter octave below the Nyquist frequency the wavelet is cut off."""

_SUPPORT = 4.5
"""E-folding times after which a wavelet is over: its envelope has then fallen to 1e-9 or less."""

_CUT = 1e-9
"""Response below which a time average leaves bins of the spectrum out."""


@dataclass(frozen=True, slots=True)
class Morse:
    """A Morse wavelet of order zero: ``gamma`` its symmetry, ``time_bandwidth`` its P^2."""

    gamma: float = 3.0
    time_bandwidth: float = 60.0

    @property
    def beta(self) -> float:
        """P^2 / gamma."""
        return self.time_bandwidth / self.gamma

    def log_response(self, offset: Array) -> Array:
        """Logarithm of a voice's response to a tone of amplitude 1, ``offset`` = ln(tone over voice), any shape."""
        return self.beta * (offset - np.expm1(self.gamma * offset) / self.gamma)

    def response(self, ratio: Array) -> Array:
        """Filter of a voice over frequency / voice, any shape: 2 at 1; 0 at 0 and below, the mirror half."""
        with np.errstate(over="ignore"):
            offset = np.log(np.where(ratio > 0, ratio, 1.0))
            return np.where(ratio > 0, 2.0 * np.exp(self.log_response(offset)), 0.0)

    def e_folding(self, frequency: Array | float) -> Array:
        """Time in s over which the wavelet's magnitude falls to 1/e, its power to e^-2, for voices in Hz, any shape.

        By P's definition the envelope is exp(-(w t / P)^2 / 2) about its middle (Lilly & Olhede 2012, sec. II), so
        t = sqrt(2) P / w: half of Lilly's footprint (2017, doi 10.1098/rspa.2016.0776), and the e-folding time by which
        Torrence & Compo (1998, doi 10.1175/1520-0477(1998)079<0061:APGTWA>2.0.CO;2) draw the cone of influence.
        """
        return np.asarray(math.sqrt(2 * self.time_bandwidth) / (2 * math.pi * frequency))


MORSE = Morse()


def voices(low: float, high: float, per_octave: int = VOICES) -> Array:
    """Frequencies in Hz, rising, (k,): from ``low`` by steps of 2^(1/per_octave) to the first at or above ``high``."""
    count = math.ceil(per_octave * math.log2(high / low) - 1e-9) + 1
    return low * 2.0 ** (np.arange(count) / per_octave)


def transform(
    values: Array, rate: float, frequency: Array, wavelet: Morse = MORSE, boundary: Boundary = "reflect"
) -> Complex:
    """Wavelet transform of ``values`` (..., n), sampled at ``rate`` Hz, at voices ``frequency`` (k,) Hz: (..., k, n).

    ``boundary`` selects what stands beyond the ends: ``reflect`` the record mirrored at its first and last sample,
    ``zero`` its mean. Neither is data: see ``e_folding``. Raises ValueError for voices above ``HIGHEST_SHARE`` of the
    rate.
    """
    import scipy.fft

    spectrum, pad, total = _spectrum(values, rate, frequency, wavelet, boundary)
    count = values.shape[-1]
    magnitudes = np.empty((*values.shape[:-1], len(frequency), count), complex)
    for k, (filtered, _) in enumerate(_filtered(spectrum, rate / total, frequency, wavelet, 0.0)):
        magnitudes[..., k, :] = scipy.fft.ifft(filtered, total)[..., pad : pad + count]
    return magnitudes


def time_average(values: Array, rate: float, frequency: Array, wavelet: Morse = MORSE) -> Array:
    """Mean of |W| over the times outside the cone of influence, (..., k), mirrored ends; arguments as ``transform``.

    Every voice is sampled as coarsely as its band allows: exact samples of the same transform, in a tenth of the time.
    Raises ValueError if a voice's cone covers the record.
    """
    import scipy.fft

    spectrum, pad, total = _spectrum(values, rate, frequency, wavelet, "reflect")
    last = (values.shape[-1] - 1) / rate
    magnitudes = np.empty((*values.shape[:-1], len(frequency)))
    for k, (filtered, edge) in enumerate(_filtered(spectrum, rate / total, frequency, wavelet, _CUT)):
        coarse = scipy.fft.next_fast_len(2 * filtered.shape[-1])
        time = np.arange(coarse) * (total / rate / coarse) - pad / rate
        inside = (time >= edge) & (time <= last - edge)
        if not inside.any():
            raise ValueError(f"the cone of influence at {frequency[k]:g} Hz covers a record of {last:g} s")
        magnitude = np.abs(scipy.fft.ifft(filtered, coarse)[..., inside])
        magnitudes[..., k] = magnitude.mean(axis=-1) * (coarse / total)
    return magnitudes


def _spectrum(
    values: Array, rate: float, frequency: Array, wavelet: Morse, boundary: Boundary
) -> tuple[Complex, int, int]:
    """Half spectrum of the padded record, samples put before it, and the padded length."""
    import scipy.fft

    if frequency.max() > HIGHEST_SHARE * rate * (1 + 1e-12):
        raise ValueError(f"{frequency.max():g} Hz: at {rate:g} Hz voices go up to {HIGHEST_SHARE * rate:g} Hz")
    count = values.shape[-1]
    pad = math.ceil(_SUPPORT * float(wavelet.e_folding(frequency.min())) * rate)
    total = scipy.fft.next_fast_len(count + 2 * pad)
    widths = [(0, 0)] * (values.ndim - 1) + [(pad, total - count - pad)]
    centred = values - values.mean(axis=-1, keepdims=True)
    padded = np.pad(centred, widths, mode="reflect") if boundary == "reflect" else np.pad(centred, widths)
    return scipy.fft.rfft(padded), pad, total


def _filtered(
    spectrum: Complex, bin_width: float, frequency: Array, wavelet: Morse, cut: float
) -> Iterator[tuple[Complex, float]]:
    """Each voice's share of the half spectrum up to where its response falls under ``cut``, with its e-folding time.

    The half spectrum padded with zeros to the full length is that of the analytic signal: no negative frequencies.
    """
    bins = np.arange(spectrum.shape[-1]) * bin_width
    for voice in frequency:
        response = wavelet.response(bins / voice)
        end = int(np.flatnonzero(response > cut)[-1]) + 1 if cut else len(bins)
        yield spectrum[..., :end] * response[:end], float(wavelet.e_folding(voice))


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
