"""Positions as Fourier sums around the axis, and their values at equally spaced angles.

Also linear maps from nodal coefficients to fields at points of the meridian and angles around the axis.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array, Index

AngleFunction = Callable[[Array], Array]
"""An even or odd function of the phase: the angle times the number m of the harmonic."""

RADIAL, AXIAL, AROUND = range(3)
"""Components of a position: radial, axial and circumferential, at the angle of the material point."""


@dataclass(frozen=True)
class Harmonics:
    """Fourier sums to the order M = ``order`` for positions symmetric about the plane of angle 0.

    A node has one row of coefficients, ``columns`` long: r_0, z_0, then r_m, z_m, s_m for m = 1 to M. With order 0 the
    row is the position (r, z) of the axisymmetric solid. With ``stride`` 2 positions are also symmetric about the plane
    of angle 90 degrees: m is even, and a quarter of the circle has all angles. M is a multiple of ``stride``.
    """

    order: int
    stride: int = 1

    @property
    def waves(self) -> int:
        """Number n of harmonics above m = 0."""
        return self.order // self.stride

    @property
    def columns(self) -> int:
        """Number of coefficients of a node."""
        return 3 * self.waves + 2

    @property
    def around(self) -> Index:
        """Columns of the coefficients s_m, m above 0, (n,)."""
        return 4 + 3 * np.arange(self.waves)

    @cached_property
    def angles(self) -> Array:
        """Integration angles on the half circle (the quarter for ``stride`` 2), (n_angles,): 2 n + 1 midpoints.

        Sums over these angles with equal weights integrate harmonics up to 4 M + 1 exactly.
        """
        return self._midpoints(2 * self.waves + 1)

    @cached_property
    def contact_angles(self) -> Array:
        """Angles at which contact is evaluated, (n + 1,) midpoints: as many as a component has coefficients.

        At more points than coefficients, a contact with a stiff penalty cannot close at every one of them.
        """
        return self._midpoints(self.waves + 1)

    def values(self, angles: Array) -> Array:
        """Matrices (n_angles, 3, columns) that map a node's coefficients to its position's components at angles."""
        return self._rows(angles, np.cos, np.sin)

    def slopes(self, angles: Array) -> Array:
        """Matrices (n_angles, 3, columns) that map coefficients to the components' derivatives by the angle."""

        def falling(x: Array) -> Array:
            return np.asarray(-np.sin(x))

        return self._rows(angles, falling, np.cos, by_order=True)

    def turned(self, angles: Array) -> Array:
        """Matrices (n_angles, 3, columns) that map coefficients to the components of the position's derivative by the
        angle, with the rotation of the base vectors."""
        out, values = self.slopes(angles), self.values(angles)
        out[:, RADIAL] -= values[:, AROUND]
        out[:, AROUND] += values[:, RADIAL]
        return out

    def cartesian(self, angles: Array) -> Array:
        """Matrices (n_angles, 3, columns) that map coefficients to (x, y, z), x in the symmetry plane at angle 0."""
        values = self.values(angles)
        cos, sin = np.cos(angles)[:, None], np.sin(angles)[:, None]
        x = cos * values[:, RADIAL] - sin * values[:, AROUND]
        y = sin * values[:, RADIAL] + cos * values[:, AROUND]
        return np.stack([x, y, values[:, AXIAL]], axis=1)

    def cosines(self, angles: Array) -> Array:
        """Cosines (n + 1, n_angles) to the order M at equally spaced angles, orthonormal under the mean over them and
        divided by the number of angles."""
        m = self._numbers[:, None]
        return np.asarray(np.where(m > 0, np.sqrt(2.0), 1.0) * np.cos(m * angles) / angles.size)

    def lifted(self, positions: Array) -> Array:
        """Coefficients (n_nodes, columns) from axisymmetric positions (n_nodes, 2) or those of fewer harmonics."""
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


class FieldGroup(NamedTuple):
    """Fields with the same shape functions in the meridian: ``shape`` (n_blocks, n_points, n_nodes), without the first
    axis if all blocks share it, and ``rows`` (n_angles, n_fields, columns), the factors on the coefficients."""

    shape: Array
    rows: Array


class FieldOperator:
    """Maps nodal coefficients to fields at the points and angles of cells or edges (blocks), and derivatives back.

    ``nodes`` (n_blocks, n_nodes): nodes of each block; ``signs`` (n_mesh_nodes, columns): -1 for coefficients that
    equal minus another coefficient, whose forces and stiffnesses change sign.
    """

    def __init__(self, groups: list[FieldGroup], nodes: Index, signs: Array) -> None:
        self._nodes, self._groups = nodes, groups
        self.columns = groups[0].rows.shape[2]
        self._gemm = [np.ascontiguousarray(rows.reshape(-1, self.columns)) for _, rows in groups]
        self._spans = np.cumsum([0, *(rows.shape[1] for _, rows in groups)])
        shape = np.stack([np.broadcast_to(s, (nodes.shape[0], *s.shape[-2:])) for s, _ in groups], axis=2)
        self._count = shape.shape[1], groups[0].rows.shape[0]
        self._shape = np.ascontiguousarray(shape)
        flat = shape.reshape(shape.shape[0], -1, shape.shape[3])
        self._wide = np.ascontiguousarray(np.swapaxes(flat, 1, 2))
        self._flat = np.ascontiguousarray(flat)
        sign = signs[nodes].reshape(nodes.shape[0], -1)
        self._turned = np.flatnonzero((sign < 0.0).any(axis=1))
        self._signs = sign[self._turned]

    def fields(self, x: Array) -> Array:
        """Fields (n_blocks, n_points, n_angles, n_fields) for coefficients x (n_mesh_nodes, columns)."""
        points, angles = self._count
        blocks = self._nodes.shape[0]
        along = np.matmul(self._flat, x[self._nodes]).reshape(blocks, points, len(self._groups), -1)
        parts = [
            (along[:, :, k].reshape(blocks * points, -1) @ rows.T).reshape(blocks, points, angles, -1)
            for k, rows in enumerate(self._gemm)
        ]
        return parts[0] if len(parts) == 1 else np.concatenate(parts, axis=3)

    def forces(self, by_field: Array) -> Array:
        """Derivative (n_blocks, n_nodes * columns) by the nodal coefficients, from that by the fields."""
        blocks, points = by_field.shape[:2]
        parts = [
            by_field[..., a:b].reshape(blocks * points, -1) @ rows
            for rows, a, b in zip(self._gemm, self._spans, self._spans[1:], strict=False)
        ]
        along = np.stack([part.reshape(blocks, points, -1) for part in parts], axis=2)
        out = np.matmul(self._wide, along.reshape(blocks, -1, self.columns)).reshape(blocks, -1)
        out[self._turned] *= self._signs
        return np.asarray(out)

    def stiffness(self, by_fields: Array) -> Array:
        """Second derivative (n_blocks, size, size) by the coefficients, size = n_nodes * columns, from that by the
        fields, (n_blocks, n_points, n_angles, n_fields, n_fields)."""
        blocks, points = by_fields.shape[:2]
        groups, width = len(self._groups), self.columns
        inner = np.empty((blocks, points, groups, width, width, groups))
        spans = list(zip(self._spans, self._spans[1:], strict=False))
        for k, (c, d) in enumerate(spans):
            half = np.matmul(by_fields[..., c:d], self._groups[k].rows)
            for i, (a, b) in enumerate(spans[: k + 1]):
                left = half[..., a:b, :].reshape(blocks, points, -1, width)
                block = np.matmul(self._gemm[i].T, left)
                inner[:, :, i, :, :, k] = block
                if i != k:
                    inner[:, :, k, :, :, i] = np.swapaxes(block, 2, 3)
        return self._to_nodes(inner)

    def _to_nodes(self, inner: Array) -> Array:
        """Nodal blocks from blocks by shape functions, (n_blocks, n_points, groups, columns, columns, groups)."""
        blocks, points, groups, width = inner.shape[:4]
        nodes = self._nodes.shape[1]
        right = np.matmul(inner.reshape(blocks, points, -1, groups), self._shape)
        both = np.matmul(self._wide, right.reshape(blocks, points * groups, -1))
        out = both.reshape(blocks, nodes, width, width, nodes).swapaxes(3, 4).reshape(blocks, nodes * width, -1)
        if self._turned.size:
            out[self._turned] *= self._signs[:, :, None] * self._signs[:, None, :]
        return np.asarray(out)
