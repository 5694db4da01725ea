"""Banded systems whose matrix is symmetric but for blocks of the outer wall."""

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.solid import lapack
from pneutouch.mechanics.solid.model import SolidModel


class OneSidedBlocks:
    """Where blocks (n_edges, 2 n, 2 n) of the outer wall stand in LAPACK's layout for general banded matrices."""

    def __init__(self, solid: SolidModel) -> None:
        table = solid.dofs[solid.mesh.outer].reshape(len(solid.mesh.outer), -1)
        n = table.shape[1]
        i = np.broadcast_to(table[:, :, None], (*table.shape, n)).ravel()
        j = np.broadcast_to(table[:, None, :], (*table.shape, n)).ravel()
        self._entries = np.flatnonzero((i >= 0) & (j >= 0))
        self._width = width = solid.contact_pattern.width
        place = (2 * width + i - j + j * (3 * width + 1))[self._entries]
        self._places, self._number = np.unique(place, return_inverse=True)

    def solve(self, band: Array, blocks: Array, b: Array) -> Array:
        """X of (symmetric band + blocks) x = b (size, n_rhs) by LU; not finite where the matrix is singular."""
        width, n = self._width, band.shape[1]
        full = np.zeros((n, 3 * width + 1))
        full[:, 2 * width :] = band.T
        for k in range(1, width + 1):
            full[k:, 2 * width - k] = band[k, : n - k]
        full.reshape(-1)[self._places] += np.bincount(self._number, blocks.ravel()[self._entries])
        _, _, x, info = lapack.dgbsv(width, width, full.T, b, overwrite_ab=1)
        return x if info == 0 else np.full_like(b, np.nan)
