"""Uniform B-splines: few numbers, smooth derivatives, and a value from a handful of products."""

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from pneutouch.arrays import Array, Index


@lru_cache
def pieces(degree: int) -> Array:
    """Powers of the position u in a cell to the degree + 1 B-splines that live there, (degree + 1, degree + 1).

    Row k holds the factors of u^k. By the recursion of de Boor (1972) on uniform knots.
    """
    rows = np.ones((1, 1))
    for d in range(1, degree + 1):
        more = np.zeros((d + 1, d + 1))
        for j in range(d + 1):
            # N_j^d = ((u + d - j) N_{j-1}^{d-1} + (1 + j - u) N_j^{d-1}) / d in the cell's own numbering.
            if j > 0:
                more[:-1, j] += (d - j) * rows[:, j - 1]
                more[1:, j] += rows[:, j - 1]
            if j < d:
                more[:-1, j] += (1 + j) * rows[:, j]
                more[1:, j] -= rows[:, j]
        rows = more / d
    return rows


@dataclass(frozen=True)
class SplineAxis:
    """An interval cut into cells; it carries cells + degree coefficients.

    The cells are equal in z = sqrt(x - low + stretch^2), finest at the low end, or in x where ``stretch`` is None.
    """

    low: float
    high: float
    cells: int
    degree: int
    stretch: float | None = None

    @property
    def size(self) -> int:
        """Number of coefficients."""
        return self.cells + self.degree

    @cached_property
    def _spacing(self) -> float:
        """Length of a cell in z."""
        ends = self._stretched(np.array([self.low, self.high]))
        return float(ends[1] - ends[0]) / self.cells

    def _stretched(self, x: Array) -> Array:
        if self.stretch is None:
            return x - self.low
        return np.sqrt(np.maximum(x - self.low, 0.0) + self.stretch**2) - self.stretch

    def even(self, count: int) -> Array:
        """Points of even distance in z from end to end, (count,)."""
        z = np.linspace(0.0, self._spacing * self.cells, count)
        return self.low + (z if self.stretch is None else z * (z + 2 * self.stretch))

    @cached_property
    def _derivatives(self) -> Array:
        """Piece matrices of value and first two derivatives by z, side by side; (degree + 1, 3 (degree + 1))."""
        value = pieces(self.degree)
        n = self.degree + 1
        power = np.arange(1.0, n)
        first, second = np.zeros_like(value), np.zeros_like(value)
        first[:-1] = power[:, None] * value[1:]
        second[:-1] = power[:, None] * first[1:]
        return np.concatenate([value, first / self._spacing, second / self._spacing**2], axis=1)

    def basis(self, x: Array) -> tuple[Index, Array]:
        """First coefficient of each x and the weights of value, slope and curvature: (n,) and (n, 3, degree + 1).

        Beyond the ends the last cell's polynomial goes on.
        """
        z, cell, powers = self._powers(x)
        weight = (powers @ self._derivatives).reshape(cell.size, 3, self.degree + 1)
        if self.stretch is not None:
            rate = (0.5 / (z + self.stretch))[:, None]
            weight[:, 2] = rate**2 * (weight[:, 2] - 2.0 * rate * weight[:, 1])
            weight[:, 1] *= rate
        return cell, weight

    def values(self, x: Array) -> tuple[Index, Array]:
        """First coefficient of each x and the weights of the value alone: (n,) and (n, degree + 1)."""
        _, cell, powers = self._powers(x)
        return cell, powers @ pieces(self.degree)

    def _powers(self, x: Array) -> tuple[Array, Index, Array]:
        """z, its cell (n,) and the powers of the place in the cell, (n, degree + 1)."""
        z = self._stretched(x)
        u = z / self._spacing
        cell = np.minimum(np.maximum(np.floor(u), 0), self.cells - 1).astype(np.intp)
        u = u - cell
        powers = np.empty((u.size, self.degree + 1))
        powers[:, 0] = 1.0
        for k in range(1, self.degree + 1):
            np.multiply(powers[:, k - 1], u, out=powers[:, k])
        return z, cell, powers

    def rows(self, x: Array, order: int = 0) -> Array:
        """The weights of one derivative as full rows, (n, size)."""
        cell, weight = self.basis(x)
        out = np.zeros((x.size, self.size))
        np.put_along_axis(out, cell[:, None] + np.arange(self.degree + 1), weight[:, order], axis=1)
        return out
