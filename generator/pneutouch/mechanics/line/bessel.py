"""The ratio I2(x)/I0(x) of modified Bessel functions, without `scipy.special`, which takes as long to load as NumPy."""

import numpy as np

from pneutouch.arrays import Complex

_FAR = 18.0
"""Beyond this argument the asymptotic series is used, below it the continued fraction; both have 10 digits there."""

_DEPTH = 48
"""Steps of the continued fraction."""

_TERMS = 16
"""Terms of the asymptotic series."""


def second_over_zeroth(x: Complex) -> Complex:
    """I2(x)/I0(x) for arguments of any shape with a positive real part no smaller than the imaginary one.

    Continued fraction I_k/I_(k-1) = 1/(2 k/x + I_(k+1)/I_k): Abramowitz and Stegun (1964), 9.6.26; asymptotic series:
    9.7.1. Without cancellation where x is small: x^2/8.
    """
    x = np.asarray(x, dtype=complex)
    far = np.abs(x) > _FAR
    ratio = np.empty_like(x)
    ratio[far], ratio[~far] = _asymptotic(x[far]), _fraction(x[~far])
    return ratio


def _fraction(x: Complex) -> Complex:
    with np.errstate(divide="ignore", invalid="ignore"):
        twice = 2.0 / x
        ratio = np.zeros_like(x)
        for k in range(_DEPTH, 1, -1):
            ratio = 1.0 / (k * twice + ratio)
        value = ratio / (twice + ratio)
    return np.asarray(np.where(x == 0.0, 0.0, value))


def _asymptotic(x: Complex) -> Complex:
    second, zeroth = (_series(order, x) for order in (2, 0))
    return np.asarray(second / zeroth)


def _series(order: int, x: Complex) -> Complex:
    """I_order(x) over exp(x)/sqrt(2 pi x)."""
    term = np.ones_like(x)
    total = np.ones_like(x)
    for k in range(1, _TERMS):
        term = -term * (4.0 * order**2 - (2.0 * k - 1.0) ** 2) / (8.0 * k * x)
        total = total + term
    return total
