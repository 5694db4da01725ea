"""Clamped plates and shallow caps under pressure by the equations of Föppl, von Kármán and Marguerre.

An independent reference for discs and caps: collocation at Chebyshev points, with functions that are even or odd about
the axis (Trefethen, Spectral Methods in MATLAB, 2000, ch. 11). Radii are over the rim's radius a, heights over the
thickness h, and pressures, positive from inside, are P = p a^4/(E h^4). The unknowns are f, the stress function's slope
(N_r = E h^3 f/(a^2 r)), and g, the slope of the deflection. The rim is clamped, and cannot move.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from scipy.optimize import brentq

from pneutouch.arrays import Array

_STEP, _SMALLEST_STEP = 0.02, 1e-5
"""First step in the mean deflection, over h, and the smallest; it is halved where Newton's method fails."""


class ShallowState(NamedTuple):
    """Unknowns f, g (both at the points) and P at a mean deflection (h, outwards), and dP by it."""

    unknowns: Array
    mean: float
    pressure: float
    stiffness: float


class ShallowShell:
    """A cap that rises by ``rise`` thicknesses, a plate if 0, with Poisson's ratio ``nu``, at ``points`` radii."""

    def __init__(self, rise: float, nu: float, points: int = 16) -> None:
        n = 2 * points
        x, sign = np.cos(np.pi * np.arange(n) / (n - 1)), (-1.0) ** np.arange(n)
        sign[[0, -1]] *= 2.0
        slope = np.outer(sign, 1.0 / sign) / (x[:, None] - x + np.eye(n))
        slope -= np.diag(slope.sum(axis=1))
        self._powers = [np.linalg.matrix_power(slope, order) for order in range(5)]
        self.rise, self.nu, self.points, self.r = rise, nu, points, x[:points]
        self.bending, self.lean = 1.0 / (12.0 * (1.0 - nu**2)), -2.0 * rise * self.r
        # Weights of an integral from the axis to the rim, exact for odd polynomials.
        odd = np.eye(n)[1::2]
        values = np.array([chebyshev.chebval(self.r, one) for one in odd])
        whole = np.array([np.diff(chebyshev.chebval([0.0, 1.0], chebyshev.chebint(one)))[0] for one in odd])
        self.weights = np.linalg.solve(values, whole)

    def derivative(self, order: int, parity: int = -1) -> Array:
        """Matrix (points, points) of a derivative of an even (1) or odd (-1) function."""
        n, power = self.points, self._powers[order]
        return np.asarray(power[:n, :n] + parity * power[:n, n:][:, ::-1])

    def parts(self, unknowns: Array) -> tuple[Array, Array]:
        """Stress function's slope, and slope of the deflection."""
        return unknowns[: self.points], unknowns[self.points : -1]

    def pole(self, state: ShallowState) -> float:
        """Deflection of the pole over h, outwards."""
        return -float(self.weights @ self.parts(state.unknowns)[1])

    def _system(self, unknowns: Array, mean: float) -> tuple[Array, Array]:
        """Residual of compatibility, equilibrium and mean deflection, and its derivative."""
        n, r, (f, g) = self.points, self.r, self.parts(unknowns)
        twist = r[:, None] * self.derivative(2) + self.derivative(1) - np.diag(1.0 / r)
        fits = twist @ f + g * (self.lean + 0.5 * g)
        balances = self.bending * (twist @ g) - f * (self.lean + g) - 0.5 * unknowns[-1] * r * r
        left = np.concatenate([fits, balances, [-self.weights @ (r * r * g) - mean]])
        by = np.zeros((2 * n + 1, 2 * n + 1))
        by[:n, :n], by[:n, n:-1] = twist, np.diag(self.lean + g)
        by[n:-1, :n], by[n:-1, n:-1] = -np.diag(self.lean + g), self.bending * twist - np.diag(f)
        by[n:-1, -1], by[-1, n:-1] = -0.5 * r * r, -self.weights * r * r
        # At the rim: no displacement outwards, no slope.
        by[[0, n]] = 0.0
        by[0, :n], by[n, n] = self.derivative(1)[0], 1.0
        by[0, 0] -= self.nu
        left[[0, n]] = by[0] @ unknowns, g[0]
        return left, by

    def at(self, mean: float, guess: Array | None = None) -> ShallowState | None:
        """State at a mean deflection (h, outwards) by Newton's method; None where it fails."""
        unknowns = np.zeros(2 * self.points + 1) if guess is None else guess
        for _ in range(30):
            left, by = self._system(unknowns, mean)
            step = np.linalg.solve(by, left)
            unknowns = unknowns - step
            if np.abs(step).max() < 1e-9 * (1.0 + np.abs(unknowns).max()):
                last = np.zeros_like(unknowns)
                last[-1] = 1.0
                return ShallowState(unknowns, mean, float(unknowns[-1]), float(np.linalg.solve(by, last)[-1]))
        return None

    def path(self, sign: float) -> Iterator[ShallowState]:
        """States from rest outwards (1) or inwards (-1), as far as the mean deflection grows."""
        step, before, here = _STEP, None, self.at(0.0)
        while here is not None and step > _SMALLEST_STEP:
            yield here
            ahead = None
            while ahead is None and step > _SMALLEST_STEP:
                mean, guess = here.mean + sign * step, here.unknowns
                if before is not None:
                    guess = guess + (guess - before.unknowns) * (mean - here.mean) / (here.mean - before.mean)
                ahead = self.at(mean, guess)
                step *= 1.15 if ahead is not None else 0.5
            before, here = here, ahead

    def between(self, a: ShallowState, b: ShallowState, value: Callable[[ShallowState], float]) -> ShallowState:
        """State between two neighbours at which a ``value``, of opposite signs there, passes zero."""

        def state(mean: float) -> ShallowState:
            found = self.at(mean, a.unknowns)
            assert found is not None
            return found

        return state(brentq(lambda mean: value(state(mean)), a.mean, b.mean, xtol=1e-9))

    def inflated(self, pressure: float) -> ShallowState:
        """State at a pressure P from inside."""
        for a, b in pairwise(self.path(1.0)):
            if b.pressure >= pressure:
                return self.between(a, b, lambda state: state.pressure - pressure)
        raise ValueError(f"no state at P = {pressure:g}")

    def buckling(self, most: int = 8) -> dict[int, float]:
        """Pressure P from outside at which the cap first loses its stability, by number of waves around the axis: 0 at the
        limit point, 2 to ``most`` before it.

        One wave is left out: the stress function r cos t has no stress.
        """
        out: dict[int, float] = {}
        for a, b in pairwise(self.path(-1.0)):
            for n in set(range(2, most + 1)) - set(out):
                if self._sign(a, n) != self._sign(b, n):
                    out[n] = -self.between(a, b, partial(self._sign, n=n)).pressure
            if b.stiffness <= 0.0:
                out[0] = -self.between(a, b, lambda state: state.stiffness).pressure
                break
        return {n: value for n, value in out.items() if value <= out[0]}

    def _sign(self, state: ShallowState, n: int) -> float:
        """Sign of the determinant of the equations for displacements with ``n`` waves (Huang, J. Appl. Mech. 31, 1964)."""
        m, nu, r, parity = self.points, self.nu, self.r[:, None], (-1) ** n
        f, lean = self.parts(state.unknowns)
        lean, d = self.lean + lean, [self.derivative(order, parity) for order in range(5)]
        double = d[4] + 2 * d[3] / r - (1 + 2 * n**2) * (d[2] / r**2 - d[1] / r**3) + (n**4 - 4 * n**2) * d[0] / r**4

        def bracket(slope: Array) -> Array:
            around = d[1] / r - n**2 * d[0] / r**2
            return np.asarray((self.derivative(1) @ slope)[:, None] * around + slope[:, None] / r * d[2])

        whole = np.block([[double, bracket(lean)], [-bracket(lean), self.bending * double - bracket(f)]])
        zero = np.zeros(m)
        # At the rim: no strain around it and no displacement, then no deflection and no slope.
        around = d[2] - nu * d[1] + nu * n**2 * d[0]
        still = d[3] + d[2] - (1 + (2 + nu) * n**2) * d[1] + (3 + nu) * n**2 * d[0]
        for row, left, right in ((0, around[0], zero), (1, still[0], zero), (m, zero, d[0][0]), (m + 1, zero, d[1][0])):
            whole[row] = np.concatenate([left, right])
        return float(np.linalg.slogdet(whole / np.linalg.norm(whole, axis=1)[:, None])[0])


def hencky(nu: float, terms: int = 40) -> float:
    """Deflection of the pole of a clamped membrane over a (p a/(E h))^(1/3): Hencky's power series (Z. Math. Phys. 63,
    1915), of the stress N_r = E h (p a/(E h))^(2/3) s(r^2)."""

    def series(first: float) -> tuple[Array, Array]:
        s, inverse = [first], [1.0 / first]
        for n in range(1, terms):
            s.append(-float(np.dot(inverse, inverse[::-1])) / (32.0 * n * (n + 1)))
            inverse.append(-sum(s[k] * inverse[n - k] for k in range(1, n + 1)) / first)
        return np.array(s), np.array(inverse)

    k = np.arange(terms)
    first = brentq(lambda s: float((2 * k + 1 - nu) @ series(s)[0]), 0.3, 1.0)
    return float(0.25 * (series(first)[1] / (k + 1)).sum())
