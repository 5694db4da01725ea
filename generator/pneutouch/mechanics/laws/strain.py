"""Isochoric invariants of an axisymmetric deformation, and the one mechanism that differentiates an energy of them.

An axisymmetric deformation has the in-plane gradient F (2 x 2) and the hoop stretch h = r/R.  Every isotropic energy
is a function of a = |F|^2, j = det F and h, so a law is written once as energy and its first and second derivatives
by (a, j, h) follow from second-order Taylor arithmetic (`Jet`).  Energies are isochoric: they see lambda_i J^(-1/3).
The volumetric part is K/2 (J - 1)^2 and lives in the element, where J is averaged.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from pneutouch.arrays import Array

_PAIRS = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))


class Jet:
    """Value, gradient and Hessian by (a, j, h) of a scalar at n points: rows of `data`, shape (10, n).

    Row 0 is the value, rows 1..3 the gradient, rows 4..9 the Hessian entries aa, aj, ah, jj, jh, hh.
    """

    __slots__ = ("data",)
    __array_priority__ = 1.0

    def __init__(self, data: Array) -> None:
        self.data = data

    def __add__(self, other: Jet | float) -> Jet:
        if isinstance(other, Jet):
            return Jet(self.data + other.data)
        out = self.data.copy()
        out[0] += other
        return Jet(out)

    def __sub__(self, other: Jet | float) -> Jet:
        return self + (-1.0) * other

    def __mul__(self, other: Jet | float) -> Jet:
        if not isinstance(other, Jet):
            return Jet(self.data * other)
        x, y = self.data, other.data
        out = x[0] * y + y[0] * x
        out[0] = x[0] * y[0]
        for row, (i, k) in enumerate(_PAIRS, start=4):
            out[row] += x[1 + i] * y[1 + k] + x[1 + k] * y[1 + i]
        return Jet(out)

    __radd__ = __add__
    __rmul__ = __mul__

    def chain(self, value: Array, first: Array, second: Array) -> Jet:
        """f(self), given f, f' and f'' at the value of self; each of shape (n,)."""
        out = first * self.data
        out[0] = value
        for row, (i, k) in enumerate(_PAIRS, start=4):
            out[row] += second * self.data[1 + i] * self.data[1 + k]
        return Jet(out)

    def power(self, exponent: float) -> Jet:
        """Self ** exponent, for a positive value."""
        base = self.data[0]
        value = base**exponent
        return self.chain(value, exponent * value / base, exponent * (exponent - 1.0) * value / base**2)


def _monomial(a: Array, j: Array, h: Array, powers: tuple[int, float, float]) -> Jet:
    """Jet of a^n j^p h^q with n 0 or 1; a, j, h of shape (n_points,)."""
    n, p, q = powers
    out = np.zeros((10, a.size))
    plain = j**p * h**q
    out[0] = plain * a if n else plain
    by_j, by_h = p / j, q / h
    out[2], out[3] = out[0] * by_j, out[0] * by_h
    out[7], out[8], out[9] = out[2] * ((p - 1.0) / j), out[2] * by_h, out[3] * ((q - 1.0) / h)
    if n:
        out[1], out[5], out[6] = plain, plain * by_j, plain * by_h
    return Jet(out)


def _even_power(x: Array, alpha: float) -> tuple[Array, Array, Array]:
    """E(x) = [(1+sqrt x)^alpha + (1-sqrt x)^alpha]/2 and its two derivatives, 0 <= x < 1.

    E is analytic at x = 0 (equal stretches) though its two terms are not: below x = 0.1 its binomial series is used
    (16 terms, truncation under 1e-14), above it the closed form and the hypergeometric equation E satisfies.
    """
    x = np.maximum(x, 0.0)
    value, first, second = np.zeros_like(x), np.zeros_like(x), np.zeros_like(x)
    small = np.minimum(x, 0.1)
    coefficient, power = 1.0, np.ones_like(x)
    terms: list[float] = []
    for k in range(17):
        terms.append(coefficient)
        coefficient *= (alpha - 2 * k) * (alpha - 2 * k - 1) / ((2 * k + 1) * (2 * k + 2))
    for k, c in enumerate(terms):
        value += c * power
        if k + 1 < len(terms):
            first += (k + 1) * terms[k + 1] * power
        if k + 2 < len(terms):
            second += (k + 2) * (k + 1) * terms[k + 2] * power
        power = power * small
    far = x > 0.1
    if far.any():
        y = x[far]
        root = np.sqrt(y)
        up, down = (1.0 + root) ** (alpha - 1.0), (1.0 - root) ** (alpha - 1.0)
        value[far] = 0.5 * (up * (1.0 + root) + down * (1.0 - root))
        first[far] = alpha * (up - down) / (4.0 * root)
        ab = alpha * (alpha - 1.0) / 4.0
        second[far] = (ab * value[far] - (0.5 - (1.5 - alpha) * y) * first[far]) / (y * (1.0 - y))
    return value, first, second


class Strain:
    """Isochoric invariants at points, as jets; a = |F|^2, j = det F > 0, h > 0, each of shape (n_points,)."""

    def __init__(self, a: Array, j: Array, h: Array) -> None:
        self.a, self.j, self.h = a, j, h

    @cached_property
    def first(self) -> Jet:
        """J^(-2/3) (lambda_1^2 + lambda_2^2 + lambda_3^2)."""
        third = 1.0 / 3.0
        return self._monomial((1, -2 * third, -2 * third)) + self._monomial((0, -2 * third, 4 * third))

    @cached_property
    def second(self) -> Jet:
        """J^(-4/3) (l1^2 l2^2 + l2^2 l3^2 + l3^2 l1^2)."""
        third = 1.0 / 3.0
        return self._monomial((0, 2 * third, -4 * third)) + self._monomial((1, -4 * third, 2 * third))

    def power_sum(self, alpha: float) -> Jet:
        """J^(-alpha/3) (l1^alpha + l2^alpha + l3^alpha), smooth where in-plane stretches coincide."""
        n = self.a.size
        total, ratio = np.zeros((10, n)), np.zeros((10, n))
        total[0], total[1], total[2] = self.a + 2.0 * self.j, 1.0, 2.0
        ratio[0], ratio[1], ratio[2] = self.a - 2.0 * self.j, 1.0, -2.0
        square = Jet(total)
        spread = Jet(ratio) * square.power(-1.0)
        in_plane: Jet = (2.0 ** (1.0 - alpha)) * (
            square.power(alpha / 2.0) * spread.chain(*_even_power(spread.data[0], alpha))
        )
        return in_plane * self._monomial((0, -alpha / 3, -alpha / 3)) + self._monomial((0, -alpha / 3, 2 * alpha / 3))

    def _monomial(self, powers: tuple[int, float, float]) -> Jet:
        return _monomial(self.a, self.j, self.h, powers)
