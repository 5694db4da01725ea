"""Isochoric invariants of an axisymmetric deformation, and the derivatives of energies that are functions of them.

An axisymmetric deformation has the in-plane gradient F (2 x 2) and the hoop stretch h = r/R.  Every isotropic energy is
a function of a = |F|^2, j = det F and h.  A law is therefore written only as an energy; its first and second
derivatives by (a, j, h) follow from second-order Taylor arithmetic (`Jet`).  Energies are isochoric: they depend on
lambda_i J^(-1/3).  The volumetric part K/2 (J - 1)^2 belongs to the element, where J is averaged.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from pneutouch.arrays import Array

VALUE, BY_A, BY_J, BY_H, BY_AA, BY_AJ, BY_AH, BY_JJ, BY_JH, BY_HH = range(10)
"""Rows of a `Jet`: the value and its first and second derivatives by a, j and h."""

GRADIENT = slice(BY_A, BY_H + 1)

HESSIAN = ((BY_AA, BY_AJ, BY_AH), (BY_AJ, BY_JJ, BY_JH), (BY_AH, BY_JH, BY_HH))
"""Rows of the second derivatives as a symmetric matrix."""

_FIRST = (BY_A, BY_J, BY_H)
_PRODUCTS = tuple((HESSIAN[i][k], _FIRST[i], _FIRST[k]) for i in range(3) for k in range(i, 3))
"""Row of each second derivative, and rows of the two first derivatives whose product the chain rule adds to it."""


class Jet:
    """Value, gradient and Hessian by (a, j, h) of a scalar at n points: rows of `data`, shape (10, n)."""

    __slots__ = ("data",)
    __array_priority__ = 1.0

    def __init__(self, data: Array) -> None:
        self.data = data

    def __add__(self, other: Jet | float) -> Jet:
        if isinstance(other, Jet):
            return Jet(self.data + other.data)
        out = self.data.copy()
        out[VALUE] += other
        return Jet(out)

    def __sub__(self, other: Jet | float) -> Jet:
        return self + (-1.0) * other

    def __mul__(self, other: Jet | float) -> Jet:
        if not isinstance(other, Jet):
            return Jet(self.data * other)
        x, y = self.data, other.data
        out = x[VALUE] * y + y[VALUE] * x
        out[VALUE] = x[VALUE] * y[VALUE]
        for row, i, k in _PRODUCTS:
            out[row] += x[i] * y[k] + x[k] * y[i]
        return Jet(out)

    __radd__ = __add__
    __rmul__ = __mul__

    def chain(self, value: Array, first: Array, second: Array) -> Jet:
        """Jet of f(self), from ``value`` f, ``first`` f' and ``second`` f'' at the value of self, (n,) each."""
        out = first * self.data
        out[VALUE] = value
        for row, i, k in _PRODUCTS:
            out[row] += second * self.data[i] * self.data[k]
        return Jet(out)

    def power(self, exponent: float) -> Jet:
        """Jet of self ** exponent, for a positive value."""
        base = self.data[VALUE]
        value = base**exponent
        return self.chain(value, exponent * value / base, exponent * (exponent - 1.0) * value / base**2)


def _monomial(a: Array, j: Array, h: Array, powers: tuple[int, float, float]) -> Jet:
    """Jet of a^n j^p h^q with n = 0 or 1; a, j, h of shape (n_points,)."""
    n, p, q = powers
    out = np.zeros((10, a.size))
    plain = j**p * h**q
    out[VALUE] = plain * a if n else plain
    by_j, by_h = p / j, q / h
    out[BY_J], out[BY_H] = out[VALUE] * by_j, out[VALUE] * by_h
    out[BY_JJ], out[BY_JH], out[BY_HH] = out[BY_J] * ((p - 1.0) / j), out[BY_J] * by_h, out[BY_H] * ((q - 1.0) / h)
    if n:
        out[BY_A], out[BY_AJ], out[BY_AH] = plain, plain * by_j, plain * by_h
    return Jet(out)


def _even_power(x: Array, alpha: float) -> tuple[Array, Array, Array]:
    """E(x) = [(1+sqrt x)^alpha + (1-sqrt x)^alpha]/2 and its two derivatives, 0 <= x < 1.

    E is analytic at x = 0 (equal stretches) although its two terms are not: up to x = 0.1 its binomial series is used
    (17 terms, truncation under 1e-14), above it the closed form and the hypergeometric equation that E satisfies.
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
    """Isochoric invariants at points, as jets, from a = |F|^2, j = det F > 0 and h > 0, (n_points,) each."""

    def __init__(self, a: Array, j: Array, h: Array) -> None:
        self.a, self.j, self.h = a, j, h

    @cached_property
    def first(self) -> Jet:
        """First invariant J^(-2/3) (l1^2 + l2^2 + l3^2) of the stretches l1, l2, l3, with J = j h."""
        third = 1.0 / 3.0
        return self._monomial((1, -2 * third, -2 * third)) + self._monomial((0, -2 * third, 4 * third))

    @cached_property
    def second(self) -> Jet:
        """Second invariant J^(-4/3) (l1^2 l2^2 + l2^2 l3^2 + l3^2 l1^2), with J = j h."""
        third = 1.0 / 3.0
        return self._monomial((0, 2 * third, -4 * third)) + self._monomial((1, -4 * third, 2 * third))

    def power_sum(self, alpha: float) -> Jet:
        """Sum J^(-alpha/3) (l1^alpha + l2^alpha + l3^alpha), smooth where the in-plane stretches coincide; J = j h."""
        n = self.a.size
        total, ratio = np.zeros((10, n)), np.zeros((10, n))
        total[VALUE], total[BY_A], total[BY_J] = self.a + 2.0 * self.j, 1.0, 2.0
        ratio[VALUE], ratio[BY_A], ratio[BY_J] = self.a - 2.0 * self.j, 1.0, -2.0
        square = Jet(total)
        spread = Jet(ratio) * square.power(-1.0)
        in_plane: Jet = (2.0 ** (1.0 - alpha)) * (
            square.power(alpha / 2.0) * spread.chain(*_even_power(spread.data[VALUE], alpha))
        )
        return in_plane * self._monomial((0, -alpha / 3, -alpha / 3)) + self._monomial((0, -alpha / 3, 2 * alpha / 3))

    def _monomial(self, powers: tuple[int, float, float]) -> Jet:
        return _monomial(self.a, self.j, self.h, powers)
