"""A banded system whose leading unknowns are eliminated once, while blocks of the trailing ones change."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.solid import lapack


@dataclass(frozen=True)
class LeadingElimination:
    """Symmetric band [[A, B'], [B, D]] with its first unknowns, of which A is positive definite, eliminated.

    first: how many.  factor: of A, (width + 1, first).  across: what B holds, (width, width), between the last leading
    and the first trailing unknowns.  rest: the trailing band D - B A^-1 B', (width + 1, size - first).
    """

    first: int
    factor: Array
    across: Array
    rest: Array

    @classmethod
    def of(cls, band: Array, first: int) -> LeadingElimination:
        """Eliminate ``first`` unknowns or fewer: none where they are too few to matter or A is not definite."""
        width, size = band.shape[0] - 1, band.shape[1]
        first = min(first, size - width)
        whole = cls(0, band[:, :0], np.zeros((width, width)), band)
        if first < width:
            return whole
        factor, info = lapack.dpbtrf(band[:, :first], lower=1)
        if info:
            return whole
        across, last = np.zeros((width, width)), np.zeros((width, width))
        i, j = np.triu_indices(width)
        across[i, j] = band[width + i - j, first - width + j]
        last[j, i] = factor[j - i, first - width + i]
        half, _ = lapack.dtrtrs(last, across.T, lower=1)
        rest = band[:, first:].copy(order="F")
        taken = half.T @ half
        rest[j - i, i] -= taken[j, i]
        return cls(first, factor, across, rest)

    def leading(self, b: Array) -> Array:
        """A^-1 b, (first, n_rhs)."""
        x: Array = lapack.dpbtrs(self.factor, b, lower=1)[0] if self.first else b
        return x

    def onto_rest(self, x: Array) -> Array:
        """B x, (size - first, n_rhs), of leading unknowns x (first, n_rhs)."""
        out = np.zeros((self.rest.shape[1], x.shape[1]))
        if self.first:
            width = self.across.shape[0]
            out[:width] = self.across @ x[-width:]
        return out

    def onto_leading(self, x: Array) -> Array:
        """B' x, (first, n_rhs), of trailing unknowns x (size - first, n_rhs)."""
        out = np.zeros((self.first, x.shape[1]))
        if self.first:
            width = self.across.shape[0]
            out[-width:] = self.across.T @ x[:width]
        return out
