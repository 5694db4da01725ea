"""The analytic Morse wavelet transform, amplitude-true: a sinusoid of amplitude A reads |W| = A at its frequency.

Psi(w) = U(w) a w^beta exp(-w^gamma), P^2 = beta gamma (Lilly & Olhede 2012, doi 10.1109/TSP.2012.2210890), with a such
that Psi is 2 at its peak w = (beta/gamma)^(1/gamma): L1 normalisation, where equal amplitudes read the same at every
frequency. gamma = 3 and P^2 = 60 are MATLAB's ``cwt`` defaults, which the paper's figure 9 states.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from pneutouch.arrays import Array, Complex

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
