"""Statistics of readings: mean, standard deviation, and the fits and formulas of the coupons.

Intervals of few measurements follow Student's t for a mean over specimens, chi-square for a standard deviation.

Three specimens with three runs each are what a lab has. The percentile bootstrap of three values covers far less than
it states (tests/bench/test_interval.py measures about 75 % for 95 %). For few values Hesterberg (Am. Stat. 69, 371-386,
2015, DOI 10.1080/00031305.2015.1089789, sections 4.5 and 5.3) uses the bootstrap's standard error, widened by
sqrt(n/(n-1)), times t with n - 1 degrees of freedom. For a mean the bootstrap's standard error is known without
drawing, sqrt((n-1)/n) s/sqrt(n), so that the half width is s/sqrt(n) times t. Specimens are drawn with all their runs:
drawing runs as well would count their scatter twice (Davison & Hinkley, Bootstrap Methods, 1997, section 3.8). Widening
does not improve the bootstrap of a standard deviation of three; chi-square is exact for normal values.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array


@dataclass(frozen=True, slots=True)
class Mean:
    """Mean of ``count`` values and the standard deviation of a single value (ddof 1)."""

    value: float
    spread: float
    count: int

    @property
    def error(self) -> float:
        """Standard error of the mean."""
        return self.spread / math.sqrt(self.count)


def mean(values: Sequence[float]) -> Mean:
    """Mean of at least two values. Raises ValueError for fewer values."""
    if len(values) < 2:
        raise ValueError("a spread needs at least two values")
    readings = np.asarray(values, float)
    return Mean(float(readings.mean()), float(readings.std(ddof=1)), len(values))


def neo_hookean(stretch: Array, stress: Array) -> tuple[float, float]:
    """Shear modulus in MPa and its standard error: least squares of stress = mu (stretch - stretch^-2).

    ``stress`` is force over the undeformed cross-section, MPa; both (n,), n >= 2. Uniaxial tension of an incompressible
    neo-Hookean solid (Treloar, The Physics of Rubber Elasticity, 3rd ed., eq. 5.12).
    """
    shape = stretch - stretch**-2
    modulus = float(shape @ stress / (shape @ shape))
    rest = stress - modulus * shape
    return modulus, float(np.sqrt(rest @ rest / (len(stress) - 1) / (shape @ shape)))


def secant_modulus(stretch: Array, stress: Array, strain: float) -> float | None:
    """Secant modulus in MPa at a strain, interpolated on the curve from the origin; None past the curve's end."""
    strains = np.concatenate([[0.0], stretch - 1])
    if strains.max() < strain:
        return None
    order = np.argsort(strains, kind="stable")
    return float(np.interp(strain, strains[order], np.concatenate([[0.0], stress])[order]) / strain)


def shear_from_young(modulus: float, poisson_ratio: float) -> float:
    """Shear modulus E / (2 (1 + nu)), MPa, as in the paper's Table 1."""
    return modulus / (2 * (1 + poisson_ratio))


def dead_volume(cavity: Mean, over_cap_kPa: Mean, over_plug_kPa: Mean, gauge_kPa: float = 0.0) -> Mean:
    """Dead volume from the pressures that the same push of air gives over a cap and over a plug with a cavity.

    Boyle: p_a V_d = p_b (V_d + V_c), so V_d = V_c p_b / (p_a - p_b); syringe and ambient pressure cancel. Volumes in
    one unit, gauge pressures in one unit, ``gauge_kPa`` the gauge's own standard uncertainty. ``spread`` is the
    standard uncertainty of the result, by the derivatives (JCGM 100, 5.1.2). Raises ValueError if the plug's pressure
    is not the lower one."""
    a, b, volume = over_cap_kPa.value, over_plug_kPa.value, cavity.value
    if b >= a:
        raise ValueError("the pressure over the plug must be lower than over the cap")
    gap = a - b
    by_volume = b / gap * cavity.error
    by_cap = volume * b / gap**2 * math.hypot(over_cap_kPa.error, gauge_kPa)
    by_plug = volume * a / gap**2 * math.hypot(over_plug_kPa.error, gauge_kPa)
    return Mean(volume * b / gap, math.hypot(by_volume, by_cap, by_plug), 1)


LEVEL = 0.95
"""Probability of every interval."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """A figure with its interval, in the figure's unit.

    Attributes:
        value: Mean over specimens of their means over runs; or a standard deviation.
        low: Lower end of the 95 % interval, None if there is none.
        high: Upper end of the 95 % interval, None if there is none.
        specimens: Number of specimens behind the value.
        runs: Number of runs behind the value.
        over: Repetitions that the interval is over: "specimens", "runs", or "" without an interval.
    """

    value: float
    low: float | None
    high: float | None
    specimens: int
    runs: int
    over: str


def mean_of(groups: Sequence[Array]) -> Estimate:
    """Mean over specimens of their means over runs; ``groups`` has one array of runs, not empty, for each specimen.

    With one specimen the interval is over its runs and does not cover other specimens; one value has no interval.
    """
    from scipy.special import stdtrit

    runs = sum(len(group) for group in groups)
    if len(groups) > 1:
        drawn, over = np.array([float(np.mean(group)) for group in groups]), "specimens"
    else:
        drawn, over = np.asarray(groups[0], float), "runs"
    value = float(drawn.mean())
    if drawn.size < 2:
        return Estimate(value, None, None, len(groups), runs, "")
    # Student's t at the upper end of the interval.
    half = float(stdtrit(drawn.size - 1, 0.5 * (1 + LEVEL))) * float(drawn.std(ddof=1)) / np.sqrt(drawn.size)
    return Estimate(value, value - half, value + half, len(groups), runs, over)


def spread_between(groups: Sequence[Array]) -> Estimate:
    """Standard deviation (ddof 1) of the specimens' means, with some scatter of runs in it; NaN for one specimen."""
    means = np.array([float(np.mean(group)) for group in groups])
    return _spread(float(means.std(ddof=1)) if means.size > 1 else None, means.size - 1, groups, "specimens")


def spread_within(groups: Sequence[Array]) -> Estimate:
    """Standard deviation between the runs of a specimen, pooled over specimens; NaN if none has two runs."""
    freedom = sum(len(group) - 1 for group in groups)
    squares = sum(float(((group - np.mean(group)) ** 2).sum()) for group in groups)
    return _spread(float(np.sqrt(squares / freedom)) if freedom else None, freedom, groups, "runs")


def _spread(value: float | None, freedom: int, groups: Sequence[Array], over: str) -> Estimate:
    runs = sum(len(group) for group in groups)
    if value is None:
        return Estimate(float("nan"), None, None, len(groups), runs, "")
    low, high = _chi_square(freedom)
    return Estimate(value, value * low, value * high, len(groups), runs, over)


def _chi_square(freedom: int) -> tuple[float, float]:
    """Factors on an estimated standard deviation that give the lower and upper end of its interval."""
    from scipy.special import gammaincinv

    tails = 0.5 * (1 + LEVEL), 0.5 * (1 - LEVEL)
    low, high = (float(np.sqrt(0.5 * freedom / gammaincinv(0.5 * freedom, tail))) for tail in tails)
    return low, high


def widened(estimate: Estimate, reading: float) -> Estimate:
    """Widen an interval by a relative reading error that all runs share: half widths are added as squares."""
    if estimate.low is None or estimate.high is None or reading == 0:
        return estimate
    half = float(np.hypot(0.5 * (estimate.high - estimate.low), reading * estimate.value))
    middle = 0.5 * (estimate.high + estimate.low)
    return replace(estimate, low=middle - half, high=middle + half)
