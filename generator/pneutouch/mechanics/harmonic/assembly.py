"""Stiffness of the cells by pairs of nodes: each pair once, so that half of the symmetric blocks is never formed.

The volume inside a wall that is no body of revolution.
"""

from __future__ import annotations

import numpy as np

from pneutouch.arrays import Array, Index
from pneutouch.mechanics.harmonic.fields import AROUND, AXIAL, RADIAL, FieldGroup, FieldOperator, Harmonics
from pneutouch.mechanics.solid.banded import BlockEntries
from pneutouch.mechanics.solid.cavity import Cavity
from pneutouch.mechanics.solid.elements import line_shapes

_FIELDS = 3
"""Fields of a group: the components of a position or of one of its derivatives."""


class NodePairOperator(FieldOperator):
    """A `FieldOperator` of groups of three components whose stiffness comes by pairs of nodes a <= b of a block.

    The coefficients of a node stand in the order of its components: all outwards, all along the axis, all around.
    """

    def __init__(self, groups: list[FieldGroup], nodes: Index, signs: Array, harmonics: Harmonics) -> None:
        super().__init__(groups, nodes, signs)
        width, parts = harmonics.columns, _columns(harmonics)
        self.order = np.concatenate(parts)
        self.first, self.second = np.triu_indices(nodes.shape[1])
        spans = np.cumsum([0, *(part.size for part in parts)])
        apart = [(slice(i, i + 1), slice(*spans[i : i + 2])) for i in range(_FIELDS)]
        whole = [(slice(0, _FIELDS), slice(0, width))]
        self._parts = [apart if _separate(rows, parts) else whole for _, rows in groups]
        rows = [rows[:, :, self.order] for _, rows in groups]
        n = len(groups)
        self._pairs = [(k, i) for k in range(n) for i in range(k, n)]
        self._waves = [_waves(rows[k], rows[i], self._parts[k]) for k, i in self._pairs]
        shape = self._shape[:, :, :, self.first][:, :, :, None] * self._shape[:, :, None][..., self.second]
        self._products = np.ascontiguousarray(shape.reshape(nodes.shape[0], -1, self.first.size).swapaxes(1, 2))
        ordered = signs[nodes][:, :, self.order]
        both = ordered[:, self.first, :, None] * ordered[:, self.second, None, :]
        self._turned_pairs = both.reshape(*both.shape[:2], -1)[self._turned]
        place = np.arange(nodes.shape[1])[:, None] * width + self.order
        self._picked = place[self.first][:, :, None] * (nodes.shape[1] * width) + place[self.second][:, None, :]

    def entries(self, dofs: Index) -> BlockEntries:
        """Rows and columns of the entries of `stiffness` for unknowns (n_mesh_nodes, columns)."""
        table = dofs[self._nodes][:, :, self.order]
        shape = (*self._picked.shape[:1], self.order.size, self.order.size)
        row = np.broadcast_to(table[:, self.first, :, None], (len(table), *shape))
        column = np.broadcast_to(table[:, self.second, None, :], (len(table), *shape))
        other = np.broadcast_to((self.first != self.second)[:, None, None], row.shape)
        # Of a pair of different nodes one entry stands for both triangles.
        high, low = np.where(other, np.maximum(row, column), row), np.where(other, np.minimum(row, column), column)
        return BlockEntries(high.ravel(), low.ravel())

    def picked(self, blocks: Array) -> Array:
        """Blocks (n_blocks, n, n) by pairs of nodes, as `stiffness` gives them."""
        flat = blocks.reshape(blocks.shape[0], -1)
        return np.asarray(flat.take(self._picked.reshape(self.first.size, -1), axis=1))

    def stiffness(self, by_fields: Array) -> Array:
        """Second derivative by the coefficients of pairs of nodes, (n_blocks, n_pairs, columns columns), of one by the
        fields, (n_blocks, n_points, n_angles, n_fields, n_fields)."""
        blocks, points, angles = by_fields.shape[:3]
        n, width = len(self._groups), self.columns
        form = by_fields.reshape(blocks, points, angles, n, _FIELDS, n, _FIELDS)
        inner = np.empty((blocks, points, n, n, width, width))
        for (k, i), waves in zip(self._pairs, self._waves, strict=True):
            for (fields, columns), wave in zip(self._parts[k], waves, strict=True):
                flat = form[:, :, :, k, fields, i].reshape(blocks * points, -1)
                inner[:, :, k, i, columns] = (flat @ wave).reshape(blocks, points, -1, width)
            if i != k:
                inner[:, :, i, k] = np.swapaxes(inner[:, :, k, i], 2, 3)
        out = np.matmul(self._products, inner.reshape(blocks, points * n * n, -1))
        out[self._turned] *= self._turned_pairs
        return np.asarray(out)


def _columns(harmonics: Harmonics) -> list[Index]:
    """Columns of the coefficients of each component."""
    later = 3 * np.arange(1, harmonics.waves + 1) - 1
    parts: list[Index] = [np.empty(0, np.intp)] * _FIELDS
    parts[RADIAL], parts[AXIAL] = np.append(0, later), np.append(1, later + 1)
    parts[AROUND] = harmonics.around
    return parts


def _separate(rows: Array, parts: list[Index]) -> bool:
    """True if each component depends on the coefficients of that component alone."""
    alone = np.zeros(rows.shape[1:], dtype=bool)
    for component, part in enumerate(parts):
        alone[component, part] = True
    return not rows[:, ~alone].any()


def _waves(left: Array, right: Array, parts: list[tuple[slice, slice]]) -> list[Array]:
    """Products of two rows of coefficients at the angles, (n_angles fields 3, columns of the part times all columns),
    for each part of the left one."""
    out = []
    for fields, columns in parts:
        product = np.einsum("afc,agd->afgcd", left[:, fields, columns], right)
        out.append(np.ascontiguousarray(product.reshape(product.shape[0] * product.shape[1] * _FIELDS, -1)))
    return out


_R, _S, _TURN_R, _TURN_S, _TURN_Z, _ALONG_R, _ALONG_Z, _ALONG_S = range(8)
"""Fields of the surface: position outwards and around, and its derivatives by the angle and along the meridian."""

_PRODUCTS = (
    (0.5, _R, _TURN_S, _ALONG_Z),
    (-0.5, _R, _TURN_Z, _ALONG_S),
    (0.5, _S, _TURN_Z, _ALONG_R),
    (-0.5, _S, _TURN_R, _ALONG_Z),
)
"""Half the horizontal position times the normal of the surface: its flux is the volume above the first point's plane
(divergence theorem). On a surface of revolution it is r^2 z'/2."""


class HarmonicCavity(Cavity):
    """The volume as a cubic polynomial of the coefficients, integrated exactly along the meridian and the angle."""

    def __init__(self, edges: Index, harmonics: Harmonics, signs: Array) -> None:
        super().__init__(edges)
        x, w = np.polynomial.legendre.leggauss(edges.shape[1])
        value, slope = line_shapes(x, edges.shape[1])
        angles = harmonics.angles
        values, turned = harmonics.values(angles), harmonics.turned(angles)
        rows = np.concatenate([values[:, [RADIAL, AROUND]], turned[:, [RADIAL, AROUND, AXIAL]]], axis=1)
        groups = [FieldGroup(value, rows), FieldGroup(slope, values)]
        self._operator = FieldOperator(groups, edges, signs)
        self._measure = (2.0 * np.pi / angles.size) * w[:, None]

    def volume(self, nodes: Array) -> float:
        """Enclosed volume of coefficients (n_nodes, columns)."""
        return self._volume(self._operator.fields(nodes))

    def gradient(self, nodes: Array) -> tuple[float, Array]:
        """Volume and its derivative by edge coefficients, (n_edges, n columns)."""
        fields = self._operator.fields(nodes)
        by_field = np.zeros_like(fields)
        for factor, *three in _PRODUCTS:
            for i, k, m in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
                by_field[..., three[i]] += factor * self._measure * fields[..., three[k]] * fields[..., three[m]]
        return self._volume(fields), self._operator.forces(by_field)

    def hessian(self, nodes: Array) -> Array:
        """Second derivative by edge coefficients, (n_edges, n columns, n columns)."""
        fields = self._operator.fields(nodes)
        by_fields = np.zeros((*fields.shape, fields.shape[3]))
        for factor, *three in _PRODUCTS:
            for i, k, m in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
                value = factor * self._measure * fields[..., three[m]]
                by_fields[..., three[i], three[k]] += value
                by_fields[..., three[k], three[i]] += value
        return self._operator.stiffness(by_fields)

    def _volume(self, fields: Array) -> float:
        parts = (factor * fields[..., i] * fields[..., k] * fields[..., m] for factor, i, k, m in _PRODUCTS)
        return float(np.vdot(np.broadcast_to(self._measure, fields.shape[:3]), sum(parts)))
