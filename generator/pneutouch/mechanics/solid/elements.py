"""Shape functions, quadrature and the constant strain operators of a mesh (total Lagrangian).

Rows of strains and of unknowns in the arrays of the finite elements.

Further parts of the total energy of a scene, in addition to wall, filling and plate.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from pneutouch.arrays import Array, Index

F_RR, F_RZ, F_ZR, F_ZZ, HOOP = range(5)
"""Strains of a point: the in-plane deformation gradient by (R, Z) and the hoop stretch r/R."""

IN_PLANE = slice(F_RR, HOOP)

RADIAL, AXIAL = slice(0, None, 2), slice(1, None, 2)
"""Unknowns of a cell or an edge in r and in z: the positions of its nodes, interleaved."""


def area_ratio(strains: Array) -> Array:
    """Determinant of the in-plane deformation gradient of strains (..., 5)."""
    return np.asarray(strains[..., F_RR] * strains[..., F_ZZ] - strains[..., F_RZ] * strains[..., F_ZR])


_CORNERS = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], dtype=float)
_MIDDLES = np.array([(0, -1), (1, 0), (0, 1), (-1, 0)], dtype=float)


def line_shapes(x: Array, nodes: int) -> tuple[Array, Array]:
    """Shape functions and derivatives on [-1, 1], nodes in the order start, end, (mid); each (n_points, nodes)."""
    if nodes == 2:
        return np.stack([0.5 - 0.5 * x, 0.5 + 0.5 * x], axis=1), np.tile([-0.5, 0.5], (x.size, 1))
    values = np.stack([0.5 * x * (x - 1.0), 0.5 * x * (x + 1.0), 1.0 - x * x], axis=1)
    return values, np.stack([x - 0.5, x + 0.5, -2.0 * x], axis=1)


def _tensor(points: Array, per_side: int) -> tuple[Array, Array]:
    """Lagrange shapes (n_points, per_side**2) and gradients (n_points, per_side**2, 2) in the node order of
    `SolidMesh`.
    """
    (fx, dx), (fy, dy) = (line_shapes(points[:, k], per_side) for k in (0, 1))
    where = {-1.0: 0, 1.0: 1, 0.0: 2}
    spots = _CORNERS if per_side == 2 else np.concatenate([_CORNERS, _MIDDLES, [[0.0, 0.0]]])
    pairs = [(where[x], where[y]) for x, y in spots]
    value = np.stack([fx[:, i] * fy[:, k] for i, k in pairs], axis=1)
    gradient = np.stack([np.stack([dx[:, i] * fy[:, k], fx[:, i] * dy[:, k]], axis=1) for i, k in pairs], axis=1)
    return value, gradient


def cell_shapes(points: Array, nodes: int) -> tuple[Array, Array]:
    """Shape functions (n_points, nodes) and local gradients (n_points, nodes, 2) of a 4-, 8- or 9-node cell."""
    if nodes == 4:
        return _tensor(points, 2)
    value, gradient = _tensor(points, 3)
    if nodes == 9:
        return value, gradient
    # Serendipity: the centre node follows the others, c = sum(mids)/2 - sum(corners)/4.
    share = np.array([-0.25] * 4 + [0.5] * 4)
    return value[:, :8] + value[:, 8:] * share, gradient[:, :8] + gradient[:, 8:] * share[:, None]


def gauss_square(n: int) -> tuple[Array, Array]:
    """N x n Gauss points (n*n, 2) and weights on [-1, 1]^2."""
    x, w = np.polynomial.legendre.leggauss(n)
    grid = np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1).reshape(-1, 2)
    return grid, np.outer(w, w).ravel()


def positions(nodes: Array, cells: Index, points: Array) -> Array:
    """Positions (n_cells, n_points, 2) of local points of every cell."""
    return np.asarray(np.einsum("qa,eai->eqi", cell_shapes(points, cells.shape[1])[0], nodes[cells]))


def strain_operator(nodes: Array, cells: Index, points: Array) -> tuple[Array, Array, Array]:
    """Constant map from nodal positions to strain at local points of every cell.

    Returns B (n_cells, n_points, 5, 2 n_nodes) so that B x are the five strains; the reference measure
    2 pi R |dA/dxi| (n_cells, n_points) still to be weighted; and reference positions (n_cells, n_points, 2).
    """
    value, local = cell_shapes(points, cells.shape[1])
    corners = nodes[cells]
    jacobian = np.einsum("qak,eai->eqik", local, corners)
    determinant = np.linalg.det(jacobian)
    if not (np.abs(determinant).min() > 0.0 and (np.sign(determinant) == np.sign(determinant.flat[0])).all()):
        raise ValueError("a cell is inverted or degenerate in the reference mesh")
    gradient = np.einsum("qak,eqki->eqai", local, np.linalg.inv(jacobian))
    position = positions(nodes, cells, points)
    b = np.zeros((*determinant.shape, 5, 2 * cells.shape[1]))
    b[..., F_RR, RADIAL], b[..., F_RZ, RADIAL] = gradient[..., 0], gradient[..., 1]
    b[..., F_ZR, AXIAL], b[..., F_ZZ, AXIAL] = gradient[..., 0], gradient[..., 1]
    b[..., HOOP, RADIAL] = value / np.maximum(position[..., 0:1], 1e-300)
    return b, 2.0 * np.pi * position[..., 0] * np.abs(determinant), position


@dataclass(frozen=True)
class IntegrationScheme:
    """Integration of a cell: `gauss` points a side, and the modes on which J is averaged.

    pressure: 1 constant, 3 linear (1, xi, eta), 4 bilinear.  With 2 x 2 points and 4 modes J is taken point by point:
    uniformly reduced integration.
    """

    gauss: int
    pressure: int


DEFAULT_SCHEME = {4: IntegrationScheme(2, 1), 8: IntegrationScheme(2, 4), 9: IntegrationScheme(3, 3)}


def pressure_modes(points: Array, measure: Array, count: int) -> Array:
    """Modes orthonormal under the reference measure of each cell; (n_cells, count, n_points)."""
    x, y = points[:, 0], points[:, 1]
    raw = np.stack([np.ones_like(x), x, y, x * y][:count])
    root = np.sqrt(measure)[:, None, :]
    q, _ = np.linalg.qr(np.swapaxes(raw[None] * root, 1, 2))
    return np.ascontiguousarray(np.swapaxes(q, 1, 2) / root)


@dataclass(frozen=True)
class TermState:
    """A further part of the total energy at one set of positions: its energy, its gradient (size,), and its second
    derivative as ``blocks`` of `SolidModel.faces.outer` (edges of the outer wall) and ``inner_blocks`` of
    `SolidModel.faces.inner` (edges of the inner wall), (n_edges, 2 n, 2 n) each, and ``fold_blocks`` of
    `SolidModel.faces.fold` (edges of the outer wall with the flange's top); ``around`` by displacements of the edges
    of the outer wall around the axis, (n_edges, n, n). None if it has none."""

    energy: float
    gradient: Array
    blocks: Array | None = None
    inner_blocks: Array | None = None
    fold_blocks: Array | None = None
    around: Array | None = None


class EnergyTerm(Protocol):
    """Interface of an addition to the total energy of wall, filling and plate: the base below the wall, friction of one
    step.

    ``noise`` is the force that rounding leaves in its gradient.
    """

    noise: float

    def at(self, x: Array) -> TermState:
        """Energy and its derivatives at positions x (n_nodes, 2)."""
        ...
