"""Energy of the wall's law and volume of the cavity for a body without rotational symmetry, with their derivatives.

A law is an energy of a = |F|^2 and j = det F of a plane and of the stretch h across it (`laws.strain`). In the
principal axes each pair of stretches, with the third across, is such a plane, and all derivatives by F follow: those by
the stretches, and for the two shears of a pair 2 W_a on the diagonal and -W_j off it. Smooth where stretches coincide.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from pneutouch.arrays import Array, Index
from pneutouch.mechanics.harmonic.fields import AROUND, AXIAL, RADIAL, FieldGroup, FieldOperator, Harmonics
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
from pneutouch.mechanics.solid.banded import BlockEntries
from pneutouch.mechanics.solid.elements import Cavity, line_shapes

_PAIRS = ((0, 1, 2), (1, 2, 0), (2, 0, 1))


class LawFields(Protocol):
    """Interface: weighted energy of a law at n deformation gradients F (n, 3, 3), and its derivatives."""

    @property
    def energy(self) -> float:
        """Weighted energy, summed over the points."""
        ...

    def stress(self) -> Array:
        """Derivative of the energy by F, (n, 3, 3)."""
        ...

    def moduli(self, pressure: Array) -> Array:
        """Second derivative by F (row by row) of the energy plus ``pressure`` (n,) times det F, (n, 9, 9)."""
        ...


class GradientLaw:
    """A law as a function of deformation gradients, by the faster form if it needs only the first invariant."""

    def __init__(self, law: Hyperelastic) -> None:
        self._law = law
        self._first_only = _of_first_invariant(law)

    def at(self, gradient: Array, cofactor: Array, volume: Array, weight: Array) -> LawFields:
        """Energy at gradients (n, 3, 3), with cofactors (n, 3, 3), positive determinants (n,) and weights (n,)."""
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
        """Weighted energy, summed over the points."""
        return float(self.jets[VALUE].sum())

    def stress(self) -> Array:
        """Derivative of the energy by F, (n, 3, 3)."""
        by_gradient = 2.0 * self.jets[BY_A, :, None] * self.gradient + self.jets[BY_J, :, None] * self.cofactor
        return np.asarray(by_gradient.reshape(-1, 3, 3))

    def moduli(self, pressure: Array) -> Array:
        """Second derivative by F (row by row) of the energy plus ``pressure`` (n,) times det F, (n, 9, 9)."""
        jets = self.jets
        left = np.stack([2.0 * self.gradient, self.cofactor], axis=1)
        form = np.ascontiguousarray(jets[[BY_AA, BY_AJ, BY_AJ, BY_JJ]].T).reshape(-1, 2, 2)
        out = np.matmul(np.ascontiguousarray(np.swapaxes(left, 1, 2)), np.matmul(form, left))
        out += (((jets[BY_J] + pressure)[:, None] * self.gradient) @ _BY_COFACTOR).reshape(-1, 9, 9)
        out.reshape(-1, 81)[:, ::10] += 2.0 * jets[BY_A, :, None]
        return np.asarray(out)


def _by_cofactor() -> Array:
    """Matrix (9, 81) that maps F, row by row, to the derivative of its cofactors by F."""
    out = np.zeros((3, 3, 3, 3, 3, 3))
    turns = [(i, (i + 1) % 3, (i + 2) % 3) for i in range(3)]
    for i, k, m in turns:
        for a, b, c in turns:
            out[m, c, i, a, k, b] = out[m, c, k, b, i, a] = 1.0
            out[m, c, i, b, k, a] = out[m, c, k, a, i, b] = -1.0
    return out.reshape(9, 81)


_BY_COFACTOR = _by_cofactor()


class _OtherInvariantError(Exception):
    """Raised when a law needs more than the first invariant."""


class _FirstInvariant(Strain):
    """Strains that raise `_OtherInvariantError` if a law asks for more than the first invariant."""

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
    """Weighted energy of a law of any kind, by the principal stretches and axes of the gradients."""

    def __init__(self, law: Hyperelastic, gradient: Array, weight: Array) -> None:
        self._left, stretch, self._right = np.linalg.svd(gradient)
        self._stretch = s = np.ascontiguousarray(stretch.T)
        one, two, three = ([*pair] for pair in zip(*_PAIRS, strict=True))
        a, j, h = s[one] ** 2 + s[two] ** 2, s[one] * s[two], s[three]
        self._jets = law.energy(Strain(a.ravel(), j.ravel(), h.ravel())).data.reshape(10, 3, -1) * weight

    @property
    def energy(self) -> float:
        """Weighted energy, summed over the points."""
        return float(self._jets[VALUE, 0].sum())

    def stress(self) -> Array:
        """Derivative of the energy by F, (n, 3, 3)."""
        s, jet = self._stretch, self._jets[:, 0]
        along = [2.0 * s[0] * jet[BY_A] + s[1] * jet[BY_J], 2.0 * s[1] * jet[BY_A] + s[0] * jet[BY_J], jet[BY_H]]
        return np.asarray(np.matmul(self._left * np.stack(along, axis=1)[:, None, :], self._right))

    def moduli(self, pressure: Array) -> Array:
        """Second derivative by F (row by row) of the energy plus ``pressure`` (n,) times det F, (n, 9, 9)."""
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
    """Write the second derivatives by the principal stretches s (3, n) into ``form`` (n, 3, 3, 3, 3), in place."""
    both = jet[BY_J] + 4.0 * s[0] * s[1] * jet[BY_AA] + 2.0 * (s[0] ** 2 + s[1] ** 2) * jet[BY_AJ]
    both += s[0] * s[1] * jet[BY_JJ]
    second = {(2, 2): jet[BY_HH], (0, 1): both + pressure * s[2]}
    for i, k in ((0, 1), (1, 0)):
        second[i, i] = 2.0 * jet[BY_A] + 4.0 * s[i] * (s[i] * jet[BY_AA] + s[k] * jet[BY_AJ]) + s[k] ** 2 * jet[BY_JJ]
        second[i, 2] = 2.0 * s[i] * jet[BY_AH] + s[k] * jet[BY_JH] + pressure * s[k]
    for (i, k), value in second.items():
        form[:, i, i, k, k] = form[:, k, k, i, i] = value


_FIELDS = 3
"""Number of fields of a group: components of a position or of one of its derivatives."""


class NodePairOperator(FieldOperator):
    """A `FieldOperator` of groups of three components that stores a stiffness by pairs of nodes a <= b of a block.

    The coefficients of a node are ordered by component: all radial, all axial, all circumferential.
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
        """Rows and columns in the matrix of the entries of `stiffness`; ``dofs`` (n_mesh_nodes, columns): unknowns."""
        table = dofs[self._nodes][:, :, self.order]
        shape = (*self._picked.shape[:1], self.order.size, self.order.size)
        row = np.broadcast_to(table[:, self.first, :, None], (len(table), *shape))
        column = np.broadcast_to(table[:, self.second, None, :], (len(table), *shape))
        other = np.broadcast_to((self.first != self.second)[:, None, None], row.shape)
        # Of a pair of different nodes one entry stands for both triangles.
        high, low = np.where(other, np.maximum(row, column), row), np.where(other, np.minimum(row, column), column)
        return BlockEntries(high.ravel(), low.ravel())

    def picked(self, blocks: Array) -> Array:
        """Entries of blocks (n_blocks, n, n) by pairs of nodes, in the form of `stiffness`."""
        flat = blocks.reshape(blocks.shape[0], -1)
        return np.asarray(flat.take(self._picked.reshape(self.first.size, -1), axis=1))

    def stiffness(self, by_fields: Array) -> Array:
        """Second derivative (n_blocks, n_pairs, columns**2) by the coefficients of pairs of nodes, from that by the
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
    """Columns of the coefficients of each component: radial, axial, circumferential."""
    later = 3 * np.arange(1, harmonics.waves + 1) - 1
    parts: list[Index] = [np.empty(0, np.intp)] * _FIELDS
    parts[RADIAL], parts[AXIAL] = np.append(0, later), np.append(1, later + 1)
    parts[AROUND] = harmonics.around
    return parts


def _separate(rows: Array, parts: list[Index]) -> bool:
    """True if each component depends only on the coefficients of that component."""
    alone = np.zeros(rows.shape[1:], dtype=bool)
    for component, part in enumerate(parts):
        alone[component, part] = True
    return not rows[:, ~alone].any()


def _waves(left: Array, right: Array, parts: list[tuple[slice, slice]]) -> list[Array]:
    """Products of the factors of two groups at the angles, (n_angles * fields * 3, columns of a part * all columns),
    for each part (fields, columns) of the left group."""
    out = []
    for fields, columns in parts:
        product = np.einsum("afc,agd->afgcd", left[:, fields, columns], right)
        out.append(np.ascontiguousarray(product.reshape(product.shape[0] * product.shape[1] * _FIELDS, -1)))
    return out


_R, _S, _TURN_R, _TURN_S, _TURN_Z, _ALONG_R, _ALONG_Z, _ALONG_S = range(8)
"""Fields of the surface: radial and circumferential position, and derivatives by the angle and along the meridian."""

_PRODUCTS = (
    (0.5, _R, _TURN_S, _ALONG_Z),
    (-0.5, _R, _TURN_Z, _ALONG_S),
    (0.5, _S, _TURN_Z, _ALONG_R),
    (-0.5, _S, _TURN_R, _ALONG_Z),
)
"""Terms of half the horizontal position times the surface normal, whose flux is the volume above the first point's
plane (divergence theorem). On a surface of revolution it is r^2 z'/2."""


class HarmonicCavity(Cavity):
    """The volume as a cubic polynomial of the coefficients, integrated exactly along the meridian and the angle."""

    def __init__(self, edges: Index, below: float, harmonics: Harmonics, signs: Array) -> None:
        super().__init__(edges, below)
        x, w = np.polynomial.legendre.leggauss(edges.shape[1])
        value, slope = line_shapes(x, edges.shape[1])
        angles = harmonics.angles
        values, turned = harmonics.values(angles), harmonics.turned(angles)
        rows = np.concatenate([values[:, [RADIAL, AROUND]], turned[:, [RADIAL, AROUND, AXIAL]]], axis=1)
        groups = [FieldGroup(value, rows), FieldGroup(slope, values)]
        self._operator = FieldOperator(groups, edges, signs)
        self._measure = (2.0 * np.pi / angles.size) * w[:, None]

    def volume(self, nodes: Array) -> float:
        """Enclosed volume for coefficients (n_nodes, columns)."""
        return self._volume(self._operator.fields(nodes))

    def gradient(self, nodes: Array) -> tuple[float, Array]:
        """Volume and its derivative by edge coefficients, (n_edges, n * columns) for n nodes of an edge."""
        fields = self._operator.fields(nodes)
        by_field = np.zeros_like(fields)
        for factor, *three in _PRODUCTS:
            for i, k, m in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
                by_field[..., three[i]] += factor * self._measure * fields[..., three[k]] * fields[..., three[m]]
        return self._volume(fields), self._operator.forces(by_field)

    def hessian(self, nodes: Array) -> Array:
        """Second derivative by edge coefficients, (n_edges, n * columns, n * columns)."""
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
        return float(np.vdot(np.broadcast_to(self._measure, fields.shape[:3]), sum(parts))) + self.below
