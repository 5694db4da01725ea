"""Banded systems whose matrix is symmetric but for blocks of the outer wall."""

import numpy as np

from pneutouch.arrays import Array, Index
from pneutouch.mechanics.solid import lapack
from pneutouch.mechanics.solid.banded import solve_definite
from pneutouch.mechanics.solid.model import SolidModel


class OneSidedBlocks:
    """Places of blocks (n_edges, 2 n, 2 n) of the outer wall in LAPACK's layouts for general banded matrices and for
    symmetric ones, of all unknowns or of those from ``first`` on, where the blocks before are zero."""

    def __init__(self, solid: SolidModel) -> None:
        self._table = table = solid.dofs[solid.mesh.outer].reshape(len(solid.mesh.outer), -1)
        n = table.shape[1]
        i = np.broadcast_to(table[:, :, None], (*table.shape, n)).ravel()
        j = np.broadcast_to(table[:, None, :], (*table.shape, n)).ravel()
        self._width = width = solid.contact_pattern.width
        self._entries = np.flatnonzero((i >= 0) & (j >= 0))
        self._places, self._number = np.unique(
            (2 * width + i - j + j * (3 * width + 1))[self._entries], return_inverse=True
        )
        self._lower = np.flatnonzero((i >= j) & (j >= 0))
        self._lower_places, self._lower_number = np.unique((i - j + j * (width + 1))[self._lower], return_inverse=True)

    def first_unknown(self, edge: int) -> int:
        """First unknown of an edge of the outer wall and of those after it, towards the axis."""
        rest = self._table[edge:]
        return int(rest[rest >= 0].min())

    def widened(self, band: Array) -> Array:
        """A symmetric band in the layout for general ones, (size, 3 width + 1), with space for fill-in."""
        width, n = self._width, band.shape[1]
        full = np.zeros((n, 3 * width + 1))
        full[:, 2 * width :] = band.T
        for k in range(1, width + 1):
            full[k:, 2 * width - k] = band[k, : n - k]
        return full

    def solve(self, band: Array, blocks: Array, b: Array) -> Array:
        """X of (symmetric band + blocks) x = b (size, n_rhs) by LU; not finite where the matrix is singular."""
        return self.solve_widened(self.widened(band), blocks, b)

    def solve_widened(self, wide: Array, blocks: Array, b: Array, first: int = 0) -> Array:
        """`solve` with a band as `widened` gives it, of the unknowns from ``first`` on."""
        width = self._width
        full = self._with_blocks(wide, blocks, first)
        _, _, x, info = lapack.dgbsv(width, width, full.T, b, overwrite_ab=1)
        return x if info == 0 else np.full_like(b, np.nan)

    def _with_blocks(self, wide: Array, blocks: Array, first: int) -> Array:
        full = wide.copy()
        values = np.asarray(np.bincount(self._number, blocks.ravel()[self._entries]), dtype=np.float64)
        _add(full, self._places - first * (3 * self._width + 1), values)
        return full

    def response(self, wide: Array, blocks: Array, rows: Array, first: int) -> Array:
        """R X^-1 R' (n, n) with X = symmetric band + blocks by LU, the band as `widened` gives it, of the unknowns from
        ``first`` on; rows: R, (n, size). Not finite where X is singular."""
        width = self._width
        factor, pivots, info = lapack.dgbtrf(self._with_blocks(wide, blocks, first).T, width, width, overwrite_ab=1)
        if info:
            return np.full((rows.shape[0],) * 2, np.nan)
        return np.asarray(rows @ lapack.dgbtrs(factor, width, width, rows.T, pivots)[0])

    def spread(self, rows: Array, first: int, size: int) -> Array:
        """Rows (n, size) of the unknowns from ``first`` on, from rows by the unknowns of the last edges,
        (n, n_edges, 2 n_nodes)."""
        table = self._table[-rows.shape[1] :]
        out = np.zeros((rows.shape[0], size + 1))
        # The unknowns that are fixed, with number -1, have the last column, which is left out.
        for k, places in enumerate(np.where(table >= 0, table - first, size)):
            out[:, places] += rows[:, k]
        return out[:, :size]

    def solve_definite(self, band: Array, blocks: Array, b: Array, first: int = 0) -> Array | None:
        """X of (band + symmetric blocks) x = b by Cholesky; None if the matrix is not positive definite."""
        full = band.T.copy()
        _add(
            full,
            self._lower_places - first * (self._width + 1),
            np.asarray(np.bincount(self._lower_number, blocks.ravel()[self._lower]), dtype=np.float64),
        )
        return solve_definite(full.T, b)


def _add(matrix: Array, places: Index, values: Array) -> None:
    """Add values at ascending places of the flat matrix, those before its beginning left out."""
    begin = int(np.searchsorted(places, 0))
    matrix.reshape(-1)[places[begin:]] += values[begin:]
