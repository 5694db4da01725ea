"""The scan model's check: finite elements of a strip with stiff bars under a moving patch.

The section across the bars is meshed; across the path (y) the load is a Fourier series, and each of its waves is one
linear problem on that mesh, with real displacements u, w ~ cos(qy) and v ~ sin(qy). The wave q = 0 alone is plane strain.
Nine-node displacements with a discontinuous linear pressure (Q2/P1, stable and free of locking: Boffi, Brezzi & Fortin,
Mixed Finite Element Methods, 2013, sec. 8.6), the pressure eliminated in each cell. Periodic along the path, bonded to a
rigid floor; the top carries a uniform pressure over the patch and no shear. Nothing of the reduced model is in it, but
uniform pressure and linear elasticity.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from pneutouch.arrays import Array

VERO = 2500.0 / 2.7, 0.35
"""Shear modulus in MPa and Poisson ratio of the bars: printprofiles/materials/VeroClear.toml; the ratio is assumed."""

AGILUS = 0.206, 0.49
WIDTH, WAVES = 20.0, 8
"""Period across the path, the block's width in mm, and how many waves a disc's load is given."""


@dataclass(frozen=True)
class Row:
    """Bars of one layer, mm: from ``first`` along the path every ``pitch``, tops at ``depth``."""

    pitch: float
    width: float
    height: float
    depth: float
    first: float = 0.0


@dataclass(frozen=True)
class Strip:
    """A strip of ``length`` mm along the path and ``height`` mm deep in square cells of ``cell`` mm, which must fit."""

    length: float
    height: float
    cell: float
    rows: tuple[Row, ...] = ()
    matrix: tuple[float, float] = AGILUS
    bars: tuple[float, float] = VERO

    @property
    def shape(self) -> tuple[int, int]:
        """Cells along the path and in depth."""
        return round(self.length / self.cell), round(self.height / self.cell)

    @property
    def size(self) -> int:
        """Free nodes: twice as many each way as cells, the floor's left out."""
        return 4 * self.shape[0] * self.shape[1]

    @cached_property
    def stiff(self) -> Array:
        """Which cells are bar, shape (along, deep)."""
        along, deep = self.shape
        x, z = (np.arange(along) + 0.5) * self.cell, (np.arange(deep) + 0.5) * self.cell
        found = np.zeros(self.shape, bool)
        for row in self.rows:
            found |= (
                (np.mod(x - row.first, row.pitch) < row.width)[:, None] & (z > row.depth) & (z < row.depth + row.height)
            )
        return found

    @cached_property
    def nodes(self) -> Array:
        """Node numbers of each cell, (along, deep, 9); periodic, -1 on the floor."""
        along, deep = self.shape
        i, j = np.arange(along)[:, None, None], np.arange(deep)[None, :, None]
        a, b = (g.ravel() for g in np.meshgrid(range(3), range(3), indexing="ij"))
        column, row = np.mod(2 * i + a, 2 * along), 2 * j + b
        return np.where(row == 2 * deep, -1, column * 2 * deep + row)

    def solved(self, wave: float, loads: Array) -> Array:
        """Work of unit-width loads (nodes, n), pressures down on nodes, on themselves; ``wave`` is q in 1/mm."""
        from scipy.sparse import coo_matrix
        from scipy.sparse.linalg import splu

        dofs = (3 * self.nodes[..., None] + np.arange(3)) * (self.nodes[..., None] >= 0) - (self.nodes[..., None] < 0)
        dofs = dofs.reshape(-1, 27)
        kinds = np.stack([_cell(self.cell, *self.matrix, wave), _cell(self.cell, *self.bars, wave)])
        values = kinds[self.stiff.ravel().astype(int)]
        rows, columns = np.broadcast_to(dofs[:, :, None], values.shape), np.broadcast_to(dofs[:, None, :], values.shape)
        kept = (rows >= 0) & (columns >= 0)
        whole: Any = coo_matrix(
            (values[kept], (rows[kept], columns[kept])), shape=(3 * self.size, 3 * self.size)
        ).tocsc()
        # Where q = 0 nothing couples y to the rest; the floor still holds it.
        force = np.zeros((3 * self.size, loads.shape[1]))
        force[2::3] = loads
        return np.asarray((force * splu(whole).solve(force)).sum(axis=0))

    def load(self, at: float, half: float, pressure: Callable[[Array], Array]) -> Array:
        """Nodal forces of a pressure over ``at`` +- ``half`` mm, given by the distance from ``at``; (nodes,)."""
        along, deep = self.shape
        cells = np.arange(int(np.floor((at - half) / self.cell)), int(np.ceil((at + half) / self.cell)))
        low = np.maximum((at - half) / self.cell - cells, 0.0)
        high = np.minimum((at + half) / self.cell - cells, 1.0)
        points, weights = np.polynomial.legendre.leggauss(8)
        s = low[:, None] + (high - low)[:, None] * (points + 1) / 2
        acting = pressure((cells[:, None] + s) * self.cell - at) * (high - low)[:, None] * weights / 2 * self.cell
        shape = np.stack([(1 - s) * (1 - 2 * s), 4 * s * (1 - s), s * (2 * s - 1)], axis=-1)
        found = np.zeros(self.size)
        np.add.at(
            found,
            np.mod(2 * cells[:, None] + np.arange(3), 2 * along) * 2 * deep,
            np.einsum("eq,eqn->en", acting, shape),
        )
        return found

    def strip_compliance(self, at: Array, half: float) -> Array:
        """Plane strain: mean sinking of a patch of half width ``half`` over its force per mm, mm/(N/mm), (n,) places."""
        loads = np.stack([self.load(float(x), half, np.ones_like) for x in at], axis=1)
        return self.solved(0.0, loads) / (2 * half) ** 2

    def disc_compliance(self, at: Array, radius: float, waves: int = WAVES) -> Array:
        """Mean sinking of a disc over its force, mm/N, (n,) places."""
        total = np.zeros(len(at))
        for n in range(waves):
            q = 2 * np.pi * n / WIDTH

            def across(x: Array, q: float = q) -> Array:
                chord = np.sqrt(np.maximum(radius**2 - x**2, 0.0))
                return 2 * chord / WIDTH if q == 0 else 4 * np.sin(q * chord) / (q * WIDTH)

            loads = np.stack([self.load(float(x), radius, across) for x in at], axis=1)
            total += WIDTH * (1.0 if n == 0 else 0.5) * self.solved(q, loads)
        return total / (np.pi * radius**2) ** 2


def harmonic(values: Array, order: int = 1) -> float:
    """Signed amplitude of a harmonic of a function that is even about its first of n even places in its period."""
    return float(2 * np.fft.rfft(values)[order].real) / len(values)


def _cell(side: float, shear: float, poisson: float, wave: float) -> Array:
    """Stiffness (27, 27) of one square cell, its pressure eliminated; x, y, z displacements of each node in turn."""
    points, weights = np.polynomial.legendre.leggauss(3)
    s, t = (g.ravel() for g in np.meshgrid(points, points, indexing="ij"))
    area = np.outer(weights, weights).ravel() * side**2 / 4

    def value(u: Array) -> Array:
        return np.stack([u * (u - 1) / 2, 1 - u * u, u * (u + 1) / 2], -1)

    def slope(u: Array) -> Array:
        return np.stack([u - 0.5, -2 * u, u + 0.5], -1) * 2 / side

    n, dx, dz = (
        np.einsum("qa,qb->qab", one, other).reshape(9, 9)
        for one, other in ((value(s), value(t)), (slope(s), value(t)), (value(s), slope(t)))
    )
    zero = np.zeros_like(n)

    def strain(*parts: Array) -> Array:
        return np.stack(parts, -1).reshape(9, 27)

    normal = strain(dx, zero, zero), strain(zero, wave * n, zero), strain(zero, zero, dz)
    sheared = strain(dz, zero, dx), strain(-wave * n, dx, zero), strain(zero, dz, -wave * n)
    form = sum(2 * np.einsum("q,qi,qj->ij", area, part, part) for part in normal)
    form = form + sum(np.einsum("q,qi,qj->ij", area, part, part) for part in sheared)
    basis = np.stack([np.ones_like(s), s, t], -1)
    coupling = np.einsum("q,qm,qi->mi", area, basis, sum(normal))
    mass = np.einsum("q,qm,qn->mn", area, basis, basis)
    lame = 2 * shear * poisson / (1 - 2 * poisson)
    return np.asarray(shear * form + lame * coupling.T @ np.linalg.solve(mass, coupling))
