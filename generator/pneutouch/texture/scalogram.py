"""Scalogram: wavelet transform of a signal over times and voices (frequencies), its cone of influence and its ridges.

The analytic Morse wavelet transform preserves amplitude: a sinusoid of amplitude A gives |W| = A at its frequency.

Psi(w) = U(w) a w^beta exp(-w^gamma), P^2 = beta gamma (Lilly & Olhede 2012, doi 10.1109/TSP.2012.2210890), with a such
that Psi is 2 at its peak w = (beta/gamma)^(1/gamma): L1 normalisation, for which equal amplitudes read the same at
every frequency. gamma = 3 and P^2 = 60 are the defaults of MATLAB's ``cwt``, which the paper's figure 9 states."""

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
"""Voices per octave, MATLAB's default: the half-power band spans three of them."""

HIGHEST_SHARE = 0.4
"""Greatest voice over sampling rate: less than a quarter octave below the Nyquist frequency the wavelet is cut off."""

_SUPPORT = 4.5
"""Half length of a wavelet in e-folding times: its envelope has fallen to 1e-9 or less there."""

_CUT = 1e-9
"""Response below which bins of the spectrum are left out of a time average."""


@dataclass(frozen=True, slots=True)
class Morse:
    """A Morse wavelet of order zero: ``gamma`` is its symmetry, ``time_bandwidth`` its P^2."""

    gamma: float = 3.0
    time_bandwidth: float = 60.0

    @property
    def beta(self) -> float:
        """Exponent beta = P^2 / gamma."""
        return self.time_bandwidth / self.gamma

    def log_response(self, offset: Array) -> Array:
        """Logarithm of a voice's response to a tone over its peak; ``offset`` is ln(tone over voice), any shape."""
        return self.beta * (offset - np.expm1(self.gamma * offset) / self.gamma)

    def response(self, ratio: Array) -> Array:
        """Response of a voice at ``ratio`` = frequency over voice, any shape: 2 at 1; 0 for zero and negative
        frequencies."""
        with np.errstate(over="ignore"):
            offset = np.log(np.where(ratio > 0, ratio, 1.0))
            return np.where(ratio > 0, 2.0 * np.exp(self.log_response(offset)), 0.0)

    def e_folding(self, frequency: Array | float) -> Array:
        """Time in s over which the wavelet's magnitude falls to 1/e, its power to e^-2, for voices in Hz, any shape.

        By P's definition the envelope is exp(-(w t / P)^2 / 2) about its middle (Lilly & Olhede 2012, sec. II), so t =
        sqrt(2) P / w: half of Lilly's footprint (2017, doi 10.1098/rspa.2016.0776), and the e-folding time with which
        Torrence & Compo (1998, doi 10.1175/1520-0477(1998)079<0061:APGTWA>2.0.CO;2) draw the cone of influence.
        """
        return np.asarray(math.sqrt(2 * self.time_bandwidth) / (2 * math.pi * frequency))


MORSE = Morse()


def voices(low: float, high: float, per_octave: int = VOICES) -> Array:
    """Frequencies in Hz, ascending, (k,): from ``low`` by steps of 2^(1/per_octave) to the first not below ``high``."""
    count = math.ceil(per_octave * math.log2(high / low) - 1e-9) + 1
    return low * 2.0 ** (np.arange(count) / per_octave)


def transform(
    values: Array, rate: float, frequency: Array, wavelet: Morse = MORSE, boundary: Boundary = "reflect"
) -> Complex:
    """Wavelet transform of ``values`` (..., n), sampled at ``rate`` Hz, at voices ``frequency`` (k,) Hz: (..., k, n).

    ``boundary`` sets the values beyond the ends: ``reflect`` mirrors the record at its first and last sample, ``zero``
    continues with its mean. Neither is data: values within `Morse.e_folding` of the ends are affected. Raises
    ValueError for voices above ``HIGHEST_SHARE`` of the rate."""
    import scipy.fft

    spectrum, pad, total = _spectrum(values, rate, frequency, wavelet, boundary)
    count = values.shape[-1]
    magnitudes = np.empty((*values.shape[:-1], len(frequency), count), complex)
    for k, (filtered, _) in enumerate(_filtered(spectrum, rate / total, frequency, wavelet, 0.0)):
        magnitudes[..., k, :] = scipy.fft.ifft(filtered, total)[..., pad : pad + count]
    return magnitudes


def time_average(values: Array, rate: float, frequency: Array, wavelet: Morse = MORSE) -> Array:
    """Mean of |W| over the times outside the cone of influence, (..., k), with mirrored ends; see `transform`.

    Every voice is sampled as coarsely as its band allows: exact samples of the same transform, in a tenth of the time.
    Raises ValueError if a voice's cone covers the record."""
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
    """Half spectrum of the padded record, number of samples padded in front, and padded length."""
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
    """Half spectrum times each voice's response, up to where that falls below ``cut``, and the voice's e-folding time.

    A half spectrum padded with zeros to the full length gives the analytic signal, without negative frequencies.
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
        """Amplitudes |W| in MPa, (k, n)."""
        return np.abs(self.values)

    @property
    def inside(self) -> Flags:
        """Flags (k, n) of points free of influence from the record's ends: at least an e-folding time from both."""
        edge = self.wavelet.e_folding(self.frequency)[:, None]
        both = (self.time - self.time[0] >= edge) & (self.time[-1] - self.time >= edge)
        return np.asarray(both, bool)


class Ridge(NamedTuple):
    """Frequency in Hz and amplitude of a highest point, (...); ``inner`` is False without a maximum inside."""

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
    """Scalogram of a signal from ``low`` to ``high`` Hz, decimated for ``high`` first.

    Raises InputError for an empty range and for one that the signal's sampling cannot resolve.
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
    """Highest point between ``low`` and ``high`` Hz of amplitudes (..., k) at evenly spaced voices (k,), ascending.

    It is the vertex of a parabola through the logarithms of three voices over ln f, without the wavelet's own deviation
    from a parabola: for a pure tone only rounding remains. Raises ValueError without a voice and its neighbours in the
    range.
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
    """Offset in ln f of the maximum of ``logs`` (3, ...) from the middle voice, and logarithm of its height."""
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
