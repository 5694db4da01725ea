"""Energy of an isotropic law at general deformation gradients, with its first and second derivatives.

All are weighted by the share of the points in the integral. A law of the first invariant and det F alone needs no
principal axes.

A law is an energy of a = |F|^2 and j = det F of a plane and of the stretch h across it (`laws.strain`). In the
principal axes each pair of stretches with the third gives one such plane, and all derivatives by F follow: those by the
stretches, and for the two shears of a pair 2 W_a for each alone and -W_j for both. Smooth where stretches coincide.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.laws.hyperelastic import Hyperelastic
from pneutouch.mechanics.laws.strain import (
    BY_A,
    BY_AA,
    BY_AH,
    BY_AJ,
    BY_H,
    BY_HH,
    BY_J,
    BY_JH,
    BY_JJ,
    VALUE,
    Jet,
    Strain,
)

_PAIRS = ((0, 1, 2), (1, 2, 0), (2, 0, 1))


class LawFields(Protocol):
    """A law at deformation gradients (n, 3, 3), weighted."""

    @property
    def energy(self) -> float:
        """Sum over the points."""
        ...

    def stress(self) -> Array:
        """Derivative of the energy by F, (n, 3, 3)."""
        ...

    def moduli(self, pressure: Array) -> Array:
        """Second derivative of the energy plus ``pressure`` (n,) times det F by F, (n, 9, 9), rows of F one by one."""
        ...


class GradientLaw:
    """A law for deformation gradients."""

    def __init__(self, law: Hyperelastic) -> None:
        self._law = law
        self._first_only = _of_first_invariant(law)

    def at(self, gradient: Array, cofactor: Array, volume: Array, weight: Array) -> LawFields:
        """The law at gradients (n, 3, 3) with their cofactors and determinants (n,), all positive, and weights (n,)."""
        if not self._first_only:
            return PrincipalFields(self._law, gradient, weight)
        flat = gradient.reshape(-1, 9)
        # With h = 1 the first invariant of (a, j, h) is that of |F|^2 = a + 1 and det F = j.
        squared = np.einsum("ni,ni->n", flat, flat) - 1.0
        jets = self._law.energy(Strain(squared, volume, np.ones_like(volume))).data * weight
        return FirstInvariantFields(flat, cofactor.reshape(-1, 9), jets)


@dataclass(frozen=True)
class FirstInvariantFields:
    """A law of |F|^2 and det F: gradients and cofactors (n, 9), weighted jets (10, n) by a = |F|^2 and j = det F."""

    gradient: Array
    cofactor: Array
    jets: Array

    @property
    def energy(self) -> float:
        """Sum over the points."""
        return float(self.jets[VALUE].sum())

    def stress(self) -> Array:
        """Derivative of the energy by F, (n, 3, 3)."""
        by_gradient = 2.0 * self.jets[BY_A, :, None] * self.gradient + self.jets[BY_J, :, None] * self.cofactor
        return np.asarray(by_gradient.reshape(-1, 3, 3))

    def moduli(self, pressure: Array) -> Array:
        """Second derivative of the energy plus ``pressure`` (n,) times det F by F, (n, 9, 9), rows of F one by one."""
        jets = self.jets
        left = np.stack([2.0 * self.gradient, self.cofactor], axis=1)
        form = np.ascontiguousarray(jets[[BY_AA, BY_AJ, BY_AJ, BY_JJ]].T).reshape(-1, 2, 2)
        out = np.matmul(np.ascontiguousarray(np.swapaxes(left, 1, 2)), np.matmul(form, left))
        out += (((jets[BY_J] + pressure)[:, None] * self.gradient) @ _BY_COFACTOR).reshape(-1, 9, 9)
        out.reshape(-1, 81)[:, ::10] += 2.0 * jets[BY_A, :, None]
        return np.asarray(out)


def _by_cofactor() -> Array:
    """Derivative of the cofactors by F as a linear map of F, (9, 81)."""
    out = np.zeros((3, 3, 3, 3, 3, 3))
    turns = [(i, (i + 1) % 3, (i + 2) % 3) for i in range(3)]
    for i, k, m in turns:
        for a, b, c in turns:
            out[m, c, i, a, k, b] = out[m, c, k, b, i, a] = 1.0
            out[m, c, i, b, k, a] = out[m, c, k, a, i, b] = -1.0
    return out.reshape(9, 81)


_BY_COFACTOR = _by_cofactor()


class _OtherInvariantError(Exception):
    """A law needs more than the first invariant."""


class _FirstInvariant(Strain):
    """Strains that have the first invariant alone."""

    @property
    def second(self) -> Jet:
        raise _OtherInvariantError

    def power_sum(self, alpha: float) -> Jet:
        raise _OtherInvariantError


def _of_first_invariant(law: Hyperelastic) -> bool:
    one = np.ones(1)
    try:
        law.energy(_FirstInvariant(2.0 * one, one, one))
    except _OtherInvariantError:
        return False
    return True


class PrincipalFields:
    """A law of any kind, by the principal stretches and axes of the gradients."""

    def __init__(self, law: Hyperelastic, gradient: Array, weight: Array) -> None:
        self._left, stretch, self._right = np.linalg.svd(gradient)
        self._stretch = s = np.ascontiguousarray(stretch.T)
        one, two, three = ([*pair] for pair in zip(*_PAIRS, strict=True))
        a, j, h = s[one] ** 2 + s[two] ** 2, s[one] * s[two], s[three]
        self._jets = law.energy(Strain(a.ravel(), j.ravel(), h.ravel())).data.reshape(10, 3, -1) * weight

    @property
    def energy(self) -> float:
        """Sum over the points."""
        return float(self._jets[VALUE, 0].sum())

    def stress(self) -> Array:
        """Derivative of the energy by F, (n, 3, 3)."""
        s, jet = self._stretch, self._jets[:, 0]
        along = [2.0 * s[0] * jet[BY_A] + s[1] * jet[BY_J], 2.0 * s[1] * jet[BY_A] + s[0] * jet[BY_J], jet[BY_H]]
        return np.asarray(np.matmul(self._left * np.stack(along, axis=1)[:, None, :], self._right))

    def moduli(self, pressure: Array) -> Array:
        """Second derivative of the energy plus ``pressure`` (n,) times det F by F, (n, 9, 9), rows of F one by one."""
        n, s, jets = pressure.size, self._stretch, self._jets
        form = np.zeros((n, 3, 3, 3, 3))
        _add_stretches(form, s, jets[:, 0], pressure)
        for pair, (i, k, other) in enumerate(_PAIRS):
            alone, both = 2.0 * jets[BY_A, pair], -(jets[BY_J, pair] + pressure * s[other])
            form[:, i, k, i, k] = form[:, k, i, k, i] = alone
            form[:, i, k, k, i] = form[:, k, i, i, k] = both
        right = np.swapaxes(self._right, 1, 2)
        axes = (self._left[:, :, None, :, None] * right[:, None, :, None, :]).reshape(n, 9, 9)
        return np.asarray(np.matmul(np.matmul(axes, form.reshape(n, 9, 9)), np.swapaxes(axes, 1, 2)))


def _add_stretches(form: Array, s: Array, jet: Array, pressure: Array) -> None:
    """Put the second derivatives by the principal stretches in their places."""
    both = jet[BY_J] + 4.0 * s[0] * s[1] * jet[BY_AA] + 2.0 * (s[0] ** 2 + s[1] ** 2) * jet[BY_AJ]
    both += s[0] * s[1] * jet[BY_JJ]
    second = {(2, 2): jet[BY_HH], (0, 1): both + pressure * s[2]}
    for i, k in ((0, 1), (1, 0)):
        second[i, i] = 2.0 * jet[BY_A] + 4.0 * s[i] * (s[i] * jet[BY_AA] + s[k] * jet[BY_AJ]) + s[k] ** 2 * jet[BY_JJ]
        second[i, 2] = 2.0 * s[i] * jet[BY_AH] + s[k] * jet[BY_JH] + pressure * s[k]
    for (i, k), value in second.items():
        form[:, i, i, k, k] = form[:, k, k, i, i] = value
