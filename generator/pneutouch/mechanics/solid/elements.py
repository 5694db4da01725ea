"""Shape functions, quadrature and strain operators of a mesh (total Lagrangian), the volume that its wall encloses, and
the potentials of what fills it. All is nondimensional: lengths in R0, volumes in R0^3, pressures in mu.
"""

from dataclasses import dataclass
from math import log1p
from typing import NamedTuple, Protocol

import numpy as np

from pneutouch.arrays import Array, Index

F_RR, F_RZ, F_ZR, F_ZZ, HOOP = range(5)
"""Strain components of a point: the in-plane deformation gradient by (R, Z) and the hoop stretch r/R."""

IN_PLANE = slice(F_RR, HOOP)

RADIAL, AXIAL = slice(0, None, 2), slice(1, None, 2)
"""Slices of the unknowns of a cell or an edge in r and in z: the interleaved positions of its nodes."""


def area_ratio(strains: Array) -> Array:
    """Determinant of the in-plane deformation gradient of strains (..., 5)."""
    return np.asarray(strains[..., F_RR] * strains[..., F_ZZ] - strains[..., F_RZ] * strains[..., F_ZR])


_CORNERS = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], dtype=float)
_MIDDLES = np.array([(0, -1), (1, 0), (0, 1), (-1, 0)], dtype=float)


def line_shapes(x: Array, nodes: int) -> tuple[Array, Array]:
    """Values and derivatives (n_points, nodes) at x (n_points,) in [-1, 1] of the shape functions of an edge with 2 or
    3 nodes: start, end, (middle)."""
    if nodes == 2:
        return np.stack([0.5 - 0.5 * x, 0.5 + 0.5 * x], axis=1), np.tile([-0.5, 0.5], (x.size, 1))
    values = np.stack([0.5 * x * (x - 1.0), 0.5 * x * (x + 1.0), 1.0 - x * x], axis=1)
    return values, np.stack([x - 0.5, x + 0.5, -2.0 * x], axis=1)


def _tensor(points: Array, per_side: int) -> tuple[Array, Array]:
    """Lagrange shapes (n_points, per_side**2) and their gradients (n_points, per_side**2, 2), nodes as in
    `SolidMesh`."""
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
    """Gauss points (n*n, 2) on [-1, 1]^2 of the n x n rule, and their weights (n*n,)."""
    x, w = np.polynomial.legendre.leggauss(n)
    grid = np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1).reshape(-1, 2)
    return grid, np.outer(w, w).ravel()


def positions(nodes: Array, cells: Index, points: Array) -> Array:
    """Positions (n_cells, n_points, 2) in every cell of the points with local coordinates ``points`` (n_points, 2)."""
    return np.asarray(np.einsum("qa,eai->eqi", cell_shapes(points, cells.shape[1])[0], nodes[cells]))


def strain_operator(nodes: Array, cells: Index, points: Array) -> tuple[Array, Array, Array]:
    """Constant map from nodal positions to strains at local points of every cell.

    Returns B (n_cells, n_points, 5, 2 n_nodes) so that B x are the five strains; the reference measure 2 pi R |dA/dxi|
    (n_cells, n_points), without quadrature weights; and reference positions (n_cells, n_points, 2).
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
    """Integration of a cell: `gauss` points per side, and `pressure`, the number of modes onto which the volume ratio J
    is projected: 1 constant, 3 linear (1, xi, eta), 4 bilinear. With 2 x 2 points and 4 modes J is taken point by
    point: uniformly reduced integration.
    """

    gauss: int
    pressure: int


DEFAULT_SCHEME = {4: IntegrationScheme(2, 1), 8: IntegrationScheme(2, 4), 9: IntegrationScheme(3, 3)}


def pressure_modes(points: Array, measure: Array, count: int) -> Array:
    """The first ``count`` of 1, xi, eta, xi eta at local points (n_points, 2), made orthonormal in each cell under the
    reference measure (n_cells, n_points), weights included; (n_cells, count, n_points)."""
    x, y = points[:, 0], points[:, 1]
    raw = np.stack([np.ones_like(x), x, y, x * y][:count])
    root = np.sqrt(measure)[:, None, :]
    q, _ = np.linalg.qr(np.swapaxes(raw[None] * root, 1, 2))
    return np.ascontiguousarray(np.swapaxes(q, 1, 2) / root)


@dataclass(frozen=True)
class TermState:
    """A further part of the total energy at one set of positions: energy, gradient (size,), and second derivatives,
    None where the part has none. ``blocks`` belong to `SolidModel.faces.outer` (edges of the outer wall),
    ``inner_blocks`` to `SolidModel.faces.inner` (edges of the inner wall), (n_edges, 2 n, 2 n) each, and
    ``fold_blocks`` to `SolidModel.faces.fold` (edges of the outer wall with the flange's top); ``around`` is by
    displacements of the edges of the outer wall around the axis, (n_edges, n, n)."""

    energy: float
    gradient: Array
    blocks: Array | None = None
    inner_blocks: Array | None = None
    fold_blocks: Array | None = None
    around: Array | None = None


class EnergyTerm(Protocol):
    """Part of the total energy beside wall, filling and plate: the base below the wall, its flange, friction in a step.

    ``noise`` is the error that rounding leaves in the gradient, as a force.
    """

    noise: float

    def at(self, x: Array) -> TermState:
        """Energy and its derivatives at positions x (n_nodes, 2)."""
        ...


class Cavity:
    """The volume V = pi int r^2 dz along the inner wall from base to apex; r^2 z' is integrated exactly.

    It is the volume above the plane through the wall's first point, and a constant ``below`` it.
    """

    def __init__(self, edges: Index, below: float = 0.0) -> None:
        self.edges, self.below = edges, below
        x, w = np.polynomial.legendre.leggauss(edges.shape[1])
        value, slope = line_shapes(x, edges.shape[1])
        n = edges.shape[1]
        self._n = n
        self._form = np.pi * np.einsum("q,qi,qj,qk->ijk", w, value, value, slope).reshape(n * n, n)

    def _parts(self, nodes: Array) -> tuple[Array, Array, Array, Array]:
        """Coordinates r and z of the edges' nodes (n_edges, n), the form's product with z and r (n_edges, n, n)."""
        line = nodes[self.edges]
        r, z = line[..., 0], line[..., 1]
        by_z = (z @ self._form.T).reshape(-1, self._n, self._n)
        return r, z, by_z, np.matmul(by_z, r[..., None])[..., 0]

    def volume(self, nodes: Array) -> float:
        """Enclosed volume at nodal positions (n_nodes, 2)."""
        r, _, _, half = self._parts(nodes)
        return float(np.vdot(r, half)) + self.below

    def gradient(self, nodes: Array) -> tuple[float, Array]:
        """Volume and its derivative by edge positions, (n_edges, 2 n), r and z interleaved."""
        r, _, _, half = self._parts(nodes)
        out = np.empty((r.shape[0], 2 * self._n))
        out[:, RADIAL] = 2.0 * half
        out[:, AXIAL] = (r[:, :, None] * r[:, None, :]).reshape(r.shape[0], -1) @ self._form
        return float(np.vdot(r, half)) + self.below, out

    def hessian(self, nodes: Array) -> Array:
        """Second derivative of the volume by edge positions, symmetric; (n_edges, 2 n, 2 n)."""
        r, _, by_z, _ = self._parts(nodes)
        out = np.zeros((r.shape[0], 2 * self._n, 2 * self._n))
        mixed = 2.0 * (r @ self._form.reshape(self._n, -1)).reshape(-1, self._n, self._n)
        out[:, RADIAL, RADIAL] = 2.0 * by_z
        out[:, RADIAL, AXIAL] = mixed
        out[:, AXIAL, RADIAL] = np.swapaxes(mixed, 1, 2)
        return out


class FillingState(NamedTuple):
    """Potential, gauge pressure and rate -dp/dV of a filling at one cavity volume."""

    energy: float
    pressure: float
    rate: float


class Supply(Protocol):
    """Interface of what fills the cavity: its potential depends on the cavity volume alone."""

    def at(self, volume: float) -> FillingState | None:
        """Potential, pressure and rate at a volume; None if the filling cannot have this volume."""
        ...


@dataclass(frozen=True)
class Regulator:
    """A filling at a constant gauge pressure."""

    pressure: float

    def at(self, volume: float) -> FillingState:
        """Potential -p V, pressure p and rate 0."""
        return FillingState(-self.pressure * volume, self.pressure, 0.0)


@dataclass(frozen=True)
class Liquid:
    """A nearly incompressible filling of rest volume `target`: volume control as an energy.

    The pressure follows from equilibrium; `stiffness` only sets how far V falls short of the target. Every resulting
    (p, V) is an exact point of the pressure-volume curve.
    """

    target: float
    stiffness: float

    def at(self, volume: float) -> FillingState:
        """Potential stiffness/2 (V - target)^2."""
        deficit = self.target - volume
        return FillingState(0.5 * self.stiffness * deficit * deficit, self.stiffness * deficit, self.stiffness)


@dataclass(frozen=True)
class Gas:
    """Trapped isothermal gas: absolute pressure times (V + `dead`) stays `content`; shut in at the volume `start`."""

    content: float
    ambient: float
    dead: float
    start: float

    @classmethod
    def filled(cls, pressure: float, volume: float, ambient: float, dead: float) -> "Gas":
        """The gas shut in at a gauge pressure and a cavity volume."""
        return cls((pressure + ambient) * (volume + dead), ambient, dead, volume)

    def at(self, volume: float) -> FillingState | None:
        """Potential ambient (V - start) - content ln((V + dead)/(start + dead)); None for V + dead <= 0.

        Counted from the shut-in state: with a large dead volume the rounding of the full potential would hide the work.
        """
        total = volume + self.dead
        if total <= 0.0:
            return None
        swell = volume - self.start
        absolute = self.content / total
        energy = self.ambient * swell - self.content * log1p(swell / (self.start + self.dead))
        return FillingState(energy, absolute - self.ambient, absolute / total)
