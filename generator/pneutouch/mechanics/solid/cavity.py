"""The exact volume a meridian line encloses, as a cubic polynomial of its nodal positions."""

import numpy as np

from pneutouch.arrays import Array, Index
from pneutouch.mechanics.solid.elements import line_shapes
from pneutouch.mechanics.solid.kinematics import AXIAL, RADIAL


class Cavity:
    """V = pi int r^2 dz along the wetted wall from base to apex; r^2 z' is integrated exactly.

    It is the volume above the plane through the line's first point; a flat floor below adds a constant only.
    """

    def __init__(self, edges: Index) -> None:
        self.edges = edges
        x, w = np.polynomial.legendre.leggauss(edges.shape[1])
        value, slope = line_shapes(x, edges.shape[1])
        n = edges.shape[1]
        self._n = n
        self._form = np.pi * np.einsum("q,qi,qj,qk->ijk", w, value, value, slope).reshape(n * n, n)

    def _parts(self, nodes: Array) -> tuple[Array, Array, Array, Array]:
        """r, z of the edges and the form contracted with z: (n_edges, n), (n_edges, n), (n_edges, n, n)."""
        line = nodes[self.edges]
        r, z = line[..., 0], line[..., 1]
        by_z = (z @ self._form.T).reshape(-1, self._n, self._n)
        return r, z, by_z, np.matmul(by_z, r[..., None])[..., 0]

    def volume(self, nodes: Array) -> float:
        """Enclosed volume; nodes (n_nodes, 2)."""
        r, _, _, half = self._parts(nodes)
        return float(np.vdot(r, half))

    def gradient(self, nodes: Array) -> tuple[float, Array]:
        """Volume and its derivative by edge positions, (n_edges, 2 n), interleaved r, z."""
        r, _, _, half = self._parts(nodes)
        out = np.empty((r.shape[0], 2 * self._n))
        out[:, RADIAL] = 2.0 * half
        out[:, AXIAL] = (r[:, :, None] * r[:, None, :]).reshape(r.shape[0], -1) @ self._form
        return float(np.vdot(r, half)), out

    def hessian(self, nodes: Array) -> Array:
        """Second derivative by edge positions, symmetric; (n_edges, 2 n, 2 n)."""
        r, _, by_z, _ = self._parts(nodes)
        out = np.zeros((r.shape[0], 2 * self._n, 2 * self._n))
        mixed = 2.0 * (r @ self._form.reshape(self._n, -1)).reshape(-1, self._n, self._n)
        out[:, RADIAL, RADIAL] = 2.0 * by_z
        out[:, RADIAL, AXIAL] = mixed
        out[:, AXIAL, RADIAL] = np.swapaxes(mixed, 1, 2)
        return out
