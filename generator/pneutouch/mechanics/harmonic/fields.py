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
    order 0 it is the position (r, z) of the axisymmetric solid.
    """

    order: int

    @property
    def columns(self) -> int:
        """Coefficients of a node."""
        return 3 * self.order + 2

    @property
    def around(self) -> Index:
        """Columns of s_m, m = 1 to M."""
        return 4 + 3 * np.arange(self.order)

    @cached_property
    def angles(self) -> Array:
        """Angles of integration on the half circle, (n_angles,): 2 M + 1 midpoints.

        Sums over them with equal weights integrate harmonics up to 4 M + 1 exactly.
        """
        count = 2 * self.order + 1
        return np.asarray((np.arange(count) + 0.5) * np.pi / count)

    @cached_property
    def contact_angles(self) -> Array:
        """Angles at which contact is evaluated, (M + 1,) midpoints: as many as a component has harmonics.

        At more points than that a contact with a stiff penalty cannot close at all of them.
        """
        return np.asarray((np.arange(self.order + 1) + 0.5) * np.pi / (self.order + 1))

    def values(self, angles: Array) -> Array:
        """Rows by which coefficients give the components at angles, (n_angles, 3, columns)."""
        return self._rows(angles, np.cos, np.sin)

    def slopes(self, angles: Array) -> Array:
        """The same for the derivatives of the components by the angle."""

        def falling(x: Array) -> Array:
            return np.asarray(-np.sin(x))

        return self._rows(angles, falling, np.cos, by_order=True)

    def turned(self, angles: Array) -> Array:
        """The same for the derivative of the position by the angle, in components: the base vectors turn with it."""
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
        """Cosines to the order M, orthonormal under the mean over equally spaced angles, times its weights; (M + 1,
        n_angles)."""
        m = np.arange(self.order + 1)[:, None]
        return np.asarray(np.where(m > 0, np.sqrt(2.0), 1.0) * np.cos(m * angles) / angles.size)

    def lifted(self, positions: Array) -> Array:
        """Coefficients (n, columns) of axisymmetric positions, or of fewer harmonics, (n, fewer columns)."""
        out = np.zeros((positions.shape[0], self.columns))
        out[:, : positions.shape[1]] = positions
        return out

    def _rows(self, angles: Array, even: AngleFunction, odd: AngleFunction, by_order: bool = False) -> Array:
        out = np.zeros((angles.size, 3, self.columns))
        for m in range(self.order + 1):
            factor, first = (m if by_order else 1), 0 if m == 0 else 3 * m - 1
            out[:, RADIAL, first] = out[:, AXIAL, first + 1] = factor * even(m * angles)
            if m:
                out[:, AROUND, first + 2] = factor * odd(m * angles)
        return out
