"""Positions as Fourier sums around the axis, and their values at equally spaced angles."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pneutouch.arrays import Array, Index

AngleFunction = Callable[[Array], Array]
"""A function of the angle times the harmonic's number."""

RADIAL, AXIAL, AROUND = range(3)
"""Components of a position: outwards, along the axis and along the circle, at the angle of the material point."""


@dataclass(frozen=True)
class Harmonics:
    """Fourier sums to the order ``order`` for positions symmetric about the plane of angle 0.

    The coefficients of a node stand in one row, ``columns`` long: r_0, z_0, then r_m, z_m, s_m for m = 1 to M. With
    order 0 it is the position (r, z) of the axisymmetric solid. With ``stride`` 2 positions are symmetric about the
    plane of angle 90 degrees too: m is even, and a quarter of the circle has all angles. M is a multiple of it.
    """

    order: int
    stride: int = 1

    @property
    def waves(self) -> int:
        """Harmonics above m = 0."""
        return self.order // self.stride

    @property
    def columns(self) -> int:
        """Coefficients of a node."""
        return 3 * self.waves + 2

    @property
    def around(self) -> Index:
        """Columns of s_m, m above 0."""
        return 4 + 3 * np.arange(self.waves)

    @cached_property
    def angles(self) -> Array:
        """Angles of integration on the half circle, or on the quarter, (n_angles,): 2 n + 1 midpoints for n harmonics.

        Sums over them with equal weights integrate harmonics up to 4 M + 1 exactly.
        """
        return self._midpoints(2 * self.waves + 1)

    @cached_property
    def contact_angles(self) -> Array:
        """Angles at which contact is evaluated, (n + 1,) midpoints: as many as a component has coefficients.

        At more points than that a contact with a stiff penalty cannot close at all of them.
        """
        return self._midpoints(self.waves + 1)

    def values(self, angles: Array) -> Array:
        """Rows by which coefficients give the components at angles, (n_angles, 3, columns)."""
        return self._rows(angles, np.cos, np.sin)

    def slopes(self, angles: Array) -> Array:
        """Rows by which coefficients give the derivatives of the components by the angle."""

        def falling(x: Array) -> Array:
            return np.asarray(-np.sin(x))

        return self._rows(angles, falling, np.cos, by_order=True)

    def turned(self, angles: Array) -> Array:
        """Rows by which coefficients give the derivative of the position by the angle, in components: the base vectors
        turn with it."""
        out, values = self.slopes(angles), self.values(angles)
        out[:, RADIAL] -= values[:, AROUND]
        out[:, AROUND] += values[:, RADIAL]
        return out

    def cartesian(self, angles: Array) -> Array:
        """Rows that give (x, y, z), x in the plane of symmetry at angle 0, (n_angles, 3, columns)."""
        values = self.values(angles)
        cos, sin = np.cos(angles)[:, None], np.sin(angles)[:, None]
        x = cos * values[:, RADIAL] - sin * values[:, AROUND]
        y = sin * values[:, RADIAL] + cos * values[:, AROUND]
        return np.stack([x, y, values[:, AXIAL]], axis=1)

    def cosines(self, angles: Array) -> Array:
        """Cosines to the order M, orthonormal under the mean over equally spaced angles, times its weights; (n + 1,
        n_angles)."""
        m = self._numbers[:, None]
        return np.asarray(np.where(m > 0, np.sqrt(2.0), 1.0) * np.cos(m * angles) / angles.size)

    def lifted(self, positions: Array) -> Array:
        """Coefficients (n, columns) of axisymmetric positions, or of fewer harmonics, (n, fewer columns)."""
        out = np.zeros((positions.shape[0], self.columns))
        out[:, : positions.shape[1]] = positions
        return out

    @property
    def _numbers(self) -> Index:
        return self.stride * np.arange(self.waves + 1)

    def _midpoints(self, count: int) -> Array:
        return np.asarray((np.arange(count) + 0.5) * np.pi / (count * self.stride))

    def _rows(self, angles: Array, even: AngleFunction, odd: AngleFunction, by_order: bool = False) -> Array:
        out = np.zeros((angles.size, 3, self.columns))
        for k, m in enumerate(self._numbers):
            factor, first = (m if by_order else 1), 0 if m == 0 else 3 * k - 1
            out[:, RADIAL, first] = out[:, AXIAL, first + 1] = factor * even(m * angles)
            if m:
                out[:, AROUND, first + 2] = factor * odd(m * angles)
        return out
