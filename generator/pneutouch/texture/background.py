"""The noise a signal would be without its lines: a smooth spectrum, and records drawn from it.

Shuffled samples make white noise, under which every peak of a red spectrum passes for a find; a record with its phases
randomised (Theiler et al. 1992, doi 10.1016/0167-2789(92)90102-S) keeps its lines, so that no line ever stands out; and
shuffled blocks whiten whatever is slower than a block, the tested pattern among it, or keep the pattern. So surrogates
are typical realisations (Schreiber & Schmitz 2000, doi 10.1016/S0167-2789(00)00043-9, sec. 4): Gaussian noise, phases
and magnitudes random, with a smooth spectrum fitted between the lines.
"""

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.texture.morse import Morse

DEGREE = 3
"""Degree of the polynomial of ln power over ln frequency: 0 is white, 1 a power law, 3 a low-passed noise and a
floor."""

_CLIP = 3.0
"""Most that a bin counts above its fit, in units of it: undeclared lines bend it little, 2 % of noise bins are cut."""


@dataclass(frozen=True, slots=True)
class BackgroundFitter:
    """Fits backgrounds to records of one length: ``taper`` (n,), the ``bins`` used, their ln f scaled to [-1, 1]."""

    rate: float
    taper: Array
    bins: Flags
    low: float
    high: float

    def design(self, frequency: Array) -> Array:
        """Powers of ln f, (m, DEGREE + 1), held at the ends of the fitted range, where the polynomial does not hold."""
        centre, half = np.log(self.low * self.high) / 2, np.log(self.high / self.low) / 2
        place = (np.log(np.clip(frequency, self.low, self.high)) - centre) / half
        return np.stack([place**k for k in range(DEGREE + 1)], axis=-1)

    def fit(self, values: Array) -> Array:
        """Coefficients (..., DEGREE + 1) of ln of the two-sided power density, MPa^2/Hz, of records (..., n).

        Whittle's likelihood by scoring: a periodogram is exponentially distributed about the density, which makes it a
        generalised linear model with logarithmic link whose weights are all one.
        """
        count = len(self.taper)
        power = np.abs(np.fft.rfft(detrended(values) * self.taper)) ** 2 / (self.rate * (self.taper @ self.taper))
        frequency = np.asarray(np.fft.rfftfreq(count, 1 / self.rate)[self.bins], float)
        observed, design = np.maximum(power[..., self.bins], np.finfo(float).tiny), self.design(frequency)
        solver = np.linalg.pinv(design).T
        # ln of an exponential variable lies 0.577 below ln of its mean, Euler's constant.
        coefficients = (np.log(observed) + np.euler_gamma) @ solver
        for _ in range(12):
            excess = observed * np.exp(-coefficients @ design.T) - 1
            coefficients = coefficients + np.minimum(excess, _CLIP) @ solver
        return coefficients

    def density(self, coefficients: Array, frequency: Array) -> Array:
        """Two-sided power density (..., m) at ``frequency`` (m,) Hz."""
        return np.asarray(np.exp(coefficients @ self.design(frequency).T))

    def spectrum(self, coefficients: Array, voices: Array, wavelet: Morse) -> Array:
        """Root mean square |W| of such noise at voices (k,) Hz, (..., k): the density through each voice's filter."""
        ratio = np.linspace(0.02, 2.0, 200)
        gain = wavelet.response(ratio) ** 2 * (ratio[1] - ratio[0])
        density = self.density(coefficients, (voices[:, None] * ratio).ravel())
        shaped = density.reshape(*density.shape[:-1], len(voices), len(ratio))
        return np.asarray(np.sqrt(shaped @ gain * voices))

    def draw(self, coefficients: Array, number: int, rng: np.random.Generator) -> Array:
        """``number`` records (number, n): pieces of periodic noise twice as long, so that their ends do not meet."""
        import scipy.fft

        count = len(self.taper)
        total = scipy.fft.next_fast_len(2 * count)
        frequency = scipy.fft.rfftfreq(total, 1 / self.rate)
        scale = np.sqrt(self.density(coefficients, frequency) * self.rate * total / 2)
        scale[0] = 0.0
        normal = rng.standard_normal((2, number, len(frequency)))
        return np.asarray(scipy.fft.irfft((normal[0] + 1j * normal[1]) * scale, total)[:, :count])


def fitter(
    count: int, rate: float, low: float, high: float, lines: Array, overtones: Array, band: float
) -> BackgroundFitter:
    """A fitter for records of ``count`` samples at ``rate`` Hz over ``low`` to ``high`` Hz, without ``lines`` (m,) Hz.

    Left out around each line are the share ``band`` and the two bins that the Hann taper spreads a tone over; clear
    ``overtones`` (k,) Hz those two bins alone.
    """
    frequency = np.fft.rfftfreq(count, 1 / rate)
    spread = 2 * rate / count
    clear = (np.abs(frequency[:, None] - lines) > band * lines + spread).all(axis=1)
    clear &= (np.abs(frequency[:, None] - overtones) > spread).all(axis=1)
    taper = np.sin(np.pi * (np.arange(count) + 0.5) / count) ** 2
    return BackgroundFitter(rate, taper, clear & (frequency >= low) & (frequency <= high), low, high)


def detrended(values: Array) -> Array:
    """Records (..., n) less their straight lines."""
    place = np.linspace(-1.0, 1.0, values.shape[-1])
    centred = values - values.mean(axis=-1, keepdims=True)
    return np.asarray(centred - (centred @ place / (place @ place))[..., None] * place)
