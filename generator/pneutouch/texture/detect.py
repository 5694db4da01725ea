"""Detection of a pattern at a target frequency: amplitude over the noise floor, and how often noise alone reaches it.

Shuffled samples give white noise, against which every peak of a red spectrum seems significant. A record with
randomised phases (Theiler et al. 1992, doi 10.1016/0167-2789(92)90102-S) keeps its lines, so that no line ever stands
out. Shuffled blocks whiten everything slower than a block, including the tested pattern, or keep the pattern. So
surrogates are typical realisations (Schreiber & Schmitz 2000, doi 10.1016/S0167-2789(00)00043-9, sec. 4): Gaussian
noise, phases and magnitudes random, with a smooth spectrum fitted between the lines.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.errors import InputError
from pneutouch.texture.scalogram import HIGHEST_SHARE, MORSE, VOICES, Morse, Ridge, ridge, time_average
from pneutouch.texture.signal import OVERSAMPLING, Signal, decimated

DEGREE = 3
"""Degree of the polynomial of ln power over ln frequency: 0 for white noise, 1 for a power law, 3 for low-passed noise
plus a floor."""

_CLIP = 3.0
"""Limit of a bin's relative excess over the fit: other lines hardly bend it, and 2 % of noise bins are clipped."""


@dataclass(frozen=True, slots=True)
class BackgroundFitter:
    """Fits noise spectra to records of one length at ``rate`` Hz: ``taper`` (n,), flags of the ``bins`` in use, range
    ``low`` to ``high`` Hz."""

    rate: float
    taper: Array
    bins: Flags
    low: float
    high: float

    def design(self, frequency: Array) -> Array:
        """Powers of ln f scaled to [-1, 1], (m, DEGREE + 1), constant outside the range, where no fit is valid."""
        centre, half = np.log(self.low * self.high) / 2, np.log(self.high / self.low) / 2
        place = (np.log(np.clip(frequency, self.low, self.high)) - centre) / half
        return np.stack([place**k for k in range(DEGREE + 1)], axis=-1)

    def fit(self, values: Array) -> Array:
        """Coefficients (..., DEGREE + 1) of ln of the two-sided power density, MPa^2/Hz, of records (..., n).

        Whittle's likelihood by scoring: a periodogram is exponentially distributed about the density, so this is a
        generalised linear model with logarithmic link and unit weights.
        """
        count = len(self.taper)
        power = np.abs(np.fft.rfft(detrended(values) * self.taper)) ** 2 / (self.rate * (self.taper @ self.taper))
        frequency = np.asarray(np.fft.rfftfreq(count, 1 / self.rate)[self.bins], float)
        observed, design = np.maximum(power[..., self.bins], np.finfo(float).tiny), self.design(frequency)
        solver = np.linalg.pinv(design).T
        # The mean of ln of an exponential variable is 0.577, Euler's constant, below ln of its mean.
        coefficients = (np.log(observed) + np.euler_gamma) @ solver
        for _ in range(12):
            excess = observed * np.exp(-coefficients @ design.T) - 1
            coefficients = coefficients + np.minimum(excess, _CLIP) @ solver
        return coefficients

    def density(self, coefficients: Array, frequency: Array) -> Array:
        """Two-sided power density (..., m) at ``frequency`` (m,) Hz."""
        return np.asarray(np.exp(coefficients @ self.design(frequency).T))

    def spectrum(self, coefficients: Array, voices: Array, wavelet: Morse) -> Array:
        """Root mean square |W| of noise with that density at voices (k,) Hz, (..., k), through each voice's filter."""
        ratio = np.linspace(0.02, 2.0, 200)
        gain = wavelet.response(ratio) ** 2 * (ratio[1] - ratio[0])
        density = self.density(coefficients, (voices[:, None] * ratio).ravel())
        shaped = density.reshape(*density.shape[:-1], len(voices), len(ratio))
        return np.asarray(np.sqrt(shaped @ gain * voices))

    def draw(self, coefficients: Array, number: int, rng: "np.random.Generator") -> Array:
        """Draw ``number`` records of noise, (number, n): halves of periodic noise, so that ends do not meet."""
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
    """Fitter for records of ``count`` samples at ``rate`` Hz over ``low`` to ``high`` Hz, leaving out ``lines`` (m,)
    Hz.

    Left out around each line are a relative distance ``band`` and the two bins over which the Hann taper spreads a
    tone; around ``overtones`` (k,) Hz only those two bins."""
    frequency = np.fft.rfftfreq(count, 1 / rate)
    spread = 2 * rate / count
    clear = (np.abs(frequency[:, None] - lines) > band * lines + spread).all(axis=1)
    clear &= (np.abs(frequency[:, None] - overtones) > spread).all(axis=1)
    taper = np.sin(np.pi * (np.arange(count) + 0.5) / count) ** 2
    return BackgroundFitter(rate, taper, clear & (frequency >= low) & (frequency <= high), low, high)


def detrended(values: Array) -> Array:
    """Records (..., n) without their linear trends."""
    place = np.linspace(-1.0, 1.0, values.shape[-1])
    centred = values - values.mean(axis=-1, keepdims=True)
    return np.asarray(centred - (centred @ place / (place @ place))[..., None] * place)


BAND = 0.15
"""Relative deviation of a pattern from its target frequency that is allowed: 11 % by pitch and speed in the paper."""

CYCLES = 3.0
"""Number of cycles of the target frequency that must lie outside the cone of influence."""

SURROGATES = 999
LEVEL = 0.05

_OVERTONES = (2.0, 3.0)
"""Overtones of a target frequency, at which a pattern with edges has lines too; the bins over which the taper spreads
them are no noise.

Only these two: patterns whose frequencies are multiples of one another would leave no noise between them."""

_APART = 0.25
"""Distance in ln f from a line within which the wavelet spectrum is not taken as noise: a tone leaks 15 % that far."""

_BELOW, _ABOVE = 4.0, 8.0
"""Range of noise around the target frequency: from a quarter of it, if the record allows that, to eight times it."""

_LEAST_QUIET = 3
"""Least number of voices away from lines for a median."""


@dataclass(frozen=True, slots=True)
class Detection:
    """Result at one target frequency; frequencies in Hz, amplitudes in MPa.

    Attributes:
        target: The target frequency.
        frequency: Frequency at which the time-averaged amplitude is greatest within `BAND`.
        amplitude: Time-averaged amplitude at ``frequency``.
        floor: Noise at the target frequency: the time-averaged amplitude expected without a line.
        threshold: Ratio of amplitude to floor that noise alone exceeds in the share ``level`` of records.
        p_value: Share of noise records with at least that ratio (Phipson & Smyth 2010, doi 10.2202/1544-6115.1585: the
            record itself is counted, so never 0), for this frequency only.
        surrogates: Number of noise records.
        level: Level of significance.
        is_ridge: True if the amplitude has a maximum inside the band, not just the slope of another line.
    """

    target: float
    frequency: float
    amplitude: float
    floor: float
    threshold: float
    p_value: float
    surrogates: int
    level: float
    is_ridge: bool

    @property
    def ratio(self) -> float:
        """Ratio of amplitude to floor."""
        return self.amplitude / self.floor

    @property
    def detected(self) -> bool:
        """True if noise alone reaches the ratio in no more than ``level`` of records."""
        return self.p_value <= self.level


@dataclass(frozen=True, slots=True)
class _Reader:
    """Reads amplitude and floor at one target frequency, in the same way from the measured record and from noise."""

    fitter: BackgroundFitter
    target: float
    voices: Array
    quiet: Flags

    def read(self, values: Array) -> tuple[Ridge, Array]:
        """Highest point in the band, and floor (MPa), (...) each, of records (..., n)."""
        amplitude = time_average(values, self.fitter.rate, self.voices)
        peak = ridge(amplitude, self.voices, self.target / (1 + BAND), self.target * (1 + BAND))
        coefficients = self.fitter.fit(values)
        # The median is of the spectrum over its expected course: even white noise reads as the square root of f.
        expected = self.fitter.spectrum(coefficients, np.append(self.voices, self.target), MORSE)
        level = np.median((amplitude / expected[..., :-1])[..., self.quiet], axis=-1)
        return peak, level * expected[..., -1]


def detect(
    given: Signal,
    target: Sequence[float],
    surrogates: int = SURROGATES,
    level: float = LEVEL,
    seed: int = 0,
    where: str = "signal",
) -> tuple[Detection, ...]:
    """Detections at the target frequencies (Hz), in the given order; ``where`` names the signal in messages.

    The statistic is the ratio of the highest time-averaged |W| within ``BAND`` of the target frequency, outside the
    cone of influence, to the floor: the median ratio of the time-averaged spectrum to its expected course
    (`BackgroundFitter.spectrum`) away from all target frequencies, times that course at the target. Noise records are
    evaluated in the same way, including the fit. A pattern that fills part of the record counts with that part. Each
    frequency is judged separately: of twenty, one passes by chance. Raises InputError for frequencies that sampling or
    length of the record cannot resolve, a constant signal, and too few surrogates.
    """
    _check(given, target, surrogates, level, where)
    lines = np.asarray(target, float)
    return tuple(_detect(given, float(frequency), lines, surrogates, level, seed, where) for frequency in target)


def _detect(
    given: Signal, target: float, lines: Array, surrogates: int, level: float, seed: int, where: str
) -> Detection:
    reader, values = _reader(given, target, lines, where)
    peak, floor = reader.read(values)
    # The same seed for each frequency: the result at one does not depend on which others were tested before.
    noise = reader.fitter.draw(reader.fitter.fit(values), surrogates, np.random.default_rng(seed))
    noise_own, noise_floor = reader.read(detrended(noise))
    ratios = np.sort(noise_own.amplitude / noise_floor)
    as_much = int(np.count_nonzero(ratios >= float(peak.amplitude) / float(floor)))
    threshold = float(ratios[surrogates - math.floor(level * (surrogates + 1) + 1e-9)])
    return Detection(
        target=target,
        frequency=float(peak.frequency),
        amplitude=float(peak.amplitude),
        floor=float(floor),
        threshold=threshold,
        p_value=(1 + as_much) / (1 + surrogates),
        surrogates=surrogates,
        level=level,
        is_ridge=bool(peak.inner),
    )


def least_duration(frequency: float) -> float:
    """Least duration, s, of a record that can test a frequency in Hz: `CYCLES` cycles plus twice the e-folding time."""
    return 2 * float(MORSE.e_folding(np.float64(frequency))) + CYCLES / frequency


def _reader(given: Signal, target: float, lines: Array, where: str) -> tuple[_Reader, Array]:
    """Reader for one target frequency, and the signal's values, decimated and without their linear trend."""
    top = min(_ABOVE * target, HIGHEST_SHARE * given.rate)
    kept = decimated(given, top)
    # A voice of the background must have at least one cycle outside the cone.
    bottom = max(target / _BELOW, (2 * float(MORSE.e_folding(np.float64(1.0))) + 1) / kept.duration)
    voices = bottom * 2.0 ** (np.arange(math.floor(VOICES * math.log2(top / bottom) + 1e-9) + 1) / VOICES)
    quiet = np.asarray((np.abs(np.log(voices[:, None] / lines)) > _APART).all(axis=1), bool)
    overtones = np.outer(lines, _OVERTONES).ravel()
    used = fitter(len(kept.pressure), kept.rate, bottom, top, lines, overtones, BAND)
    if np.count_nonzero(quiet) < _LEAST_QUIET or np.count_nonzero(used.bins) < 2 * (DEGREE + 1):
        raise InputError(
            f"pattern frequency {target:g} Hz: the target frequencies leave no noise to compare with between "
            f"{bottom:.3g} and {top:.3g} Hz",
            file=where,
            remedy="test fewer frequencies, or give a longer record",
        )
    return _Reader(used, target, voices, quiet), detrended(kept.pressure)


def _check(given: Signal, target: Sequence[float], surrogates: int, level: float, where: str) -> None:
    if not target:
        raise InputError("no pattern frequency given", file=where, remedy="give at least one in Hz")
    if not 0 < level < 1 or math.floor(level * (surrogates + 1) + 1e-9) < 1:
        raise InputError(
            f"{surrogates} surrogates for a level of {level:g}",
            file=where,
            remedy=(
                "the level must lie between 0 and 1, and there must be at least "
                f"{math.ceil(1 / level) - 1 if 0 < level < 1 else SURROGATES}"
            ),
        )
    most = given.rate / (OVERSAMPLING * (1 + BAND))
    for frequency in target:
        if not 0 < frequency < math.inf:
            raise InputError(f"pattern frequency {frequency:g} Hz: must be a number above 0", file=where)
        if frequency > most:
            raise InputError(
                f"pattern frequency {frequency:g} Hz: sampled at {given.rate:g} Hz, it can be tested up to "
                f"{most:.4g} Hz",
                file=where,
            )
        if given.duration < least_duration(frequency) * (1 - 1e-9):
            raise InputError(
                f"pattern frequency {frequency:g} Hz: the record lasts {given.duration:.4g} s and must last at "
                f"least {least_duration(frequency):.4g} s, so that {CYCLES:g} cycles lie outside the wavelet's "
                "cone of influence",
                file=where,
            )
    if np.ptp(given.pressure) <= 1e-12 * np.abs(given.pressure).max():
        raise InputError("the pressure is the same throughout", file=where, remedy="there is nothing to detect in it")
