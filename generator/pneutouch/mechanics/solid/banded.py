"""Banded storage of a symmetric matrix assembled from blocks, its factorisations by LAPACK and its inertia.

SciPy's LAPACK wrappers are loaded without `scipy.linalg`, which imports most of NumPy's subpackages and would take a
sixth of the processor time of ``predict`` with the solid.
"""

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from importlib.machinery import PathFinder
from importlib.util import module_from_spec
from types import MappingProxyType, ModuleType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pneutouch.arrays import Array, Index


def _wrappers() -> ModuleType:
    """SciPy's module of LAPACK wrappers, by itself; from `scipy.linalg` if that is loaded or the file is not found."""
    import scipy

    spec = None
    if "scipy.linalg" not in sys.modules:
        spec = PathFinder.find_spec("scipy.linalg._flapack", [f"{folder}/linalg" for folder in scipy.__path__])
    if spec is None or spec.loader is None:
        return import_module("scipy.linalg.lapack")
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


lapack = _wrappers()


class BlockEntries(NamedTuple):
    """Row and column in the matrix of every entry of a family of blocks, in storage order; -1 stands for a fixed degree
    of freedom (dof). Entries above the diagonal or of a fixed dof are not assembled."""

    row: Index
    column: Index


class AssemblyPattern:
    """Places in a lower band matrix of entries of blocks. A family of blocks (n_blocks, d, d) has a table (n_blocks, d)
    of dof numbers, -1 if fixed; for a family k whose blocks are not square, ``forms[k]`` gives the places instead.

    Entries of all families, in their order, form one flat vector, and those of one place are summed by `bincount`: as
    fast as a product with a sparse 0/1 matrix, without the import of SciPy's sparse matrices.
    """

    def __init__(
        self, tables: list[Index], size: int, width: int = 0, forms: Mapping[int, BlockEntries] = MappingProxyType({})
    ) -> None:
        self.size = size
        rows, cols, self._entries = [], [], []
        for family, table in enumerate(tables):
            i, j = forms.get(family) or _square(table)
            keep = np.flatnonzero((i >= j) & (j >= 0))
            rows.append(i[keep])
            cols.append(j[keep])
            self._entries.append(keep)
        i, j = np.concatenate(rows), np.concatenate(cols)
        self.width = max(width, int((i - j).max()))
        self._place = (i - j) + j * (self.width + 1)
        self._places, self._number = np.unique(self._place, return_inverse=True)
        self._free = [np.flatnonzero(table.ravel() >= 0) for table in tables]
        self._unknown = _gathered(tables, self._free)

    def matrix(self, blocks: list[Array]) -> Array:
        """Lower band (width + 1, size), Fortran ordered, of the sum of the ``blocks``, one array for each family."""
        entries = _gathered(blocks, self._entries)
        flat = np.asarray(np.bincount(self._place, entries, self.size * (self.width + 1)), dtype=np.float64)
        return flat.reshape(self.size, self.width + 1).T

    def added(self, band: Array, blocks: list[Array]) -> Array:
        """Copy of a lower band (width + 1, size) with the ``blocks`` added, one array for each family."""
        flat = band.T.flatten()
        flat[self._places] += np.bincount(self._number, _gathered(blocks, self._entries))
        return flat.reshape(self.size, self.width + 1).T

    def vector(self, blocks: list[Array]) -> Array:
        """Sum (size,) of block vectors, an array (n_blocks, d) for each family."""
        entries = _gathered(blocks, self._free)
        return np.asarray(np.bincount(self._unknown, entries, self.size), dtype=np.float64)


@dataclass(frozen=True)
class FaceSums:
    """Sums over the faces of a wall: patterns for the edges of the inner wall, for those of the outer wall, and for the
    outer edges coupled with the flange's top (None without a flange). n is the number of nodes of an edge."""

    inner: AssemblyPattern
    outer: AssemblyPattern
    fold: AssemblyPattern | None = None

    def push(self, blocks: Array) -> Array:
        """Sum (size,) of the vectors (n_edges, 2 n) of the outer wall's edges."""
        return self.outer.vector([blocks])


def _square(table: Index) -> BlockEntries:
    """Row and column of every entry of square blocks with a dof table (n_blocks, d)."""
    shape = (*table.shape, table.shape[1])
    row, column = (np.broadcast_to(t, shape).ravel() for t in (table[:, :, None], table[:, None, :]))
    return BlockEntries(row, column)


def _gathered(blocks: Sequence[NDArray[Any]], rows: Sequence[Index]) -> NDArray[Any]:
    """Entries of the blocks of all families at the flat indices ``rows``, one family after the other, in one array."""
    parts = [block.ravel().take(row) for block, row in zip(blocks, rows, strict=True)]
    return parts[0] if len(parts) == 1 else np.concatenate(parts)


_INVERSE_ITERATIONS = 12


@dataclass(frozen=True)
class BandedSolution:
    """Solution x (size, n_rhs) of K x = b, and True if K is positive definite."""

    x: Array
    definite: bool


def solve(band: Array, b: Array) -> BandedSolution:
    """Solve K x = b (size, n_rhs) with the lower band of K, by Cholesky, or by LU if K is not positive definite.

    For a singular K x is not finite.
    """
    definite = solve_definite(band, b)
    if definite is not None:
        return BandedSolution(definite, True)
    width = band.shape[0] - 1
    _, _, x, info = lapack.dgbsv(width, width, _general(band), b)
    return BandedSolution(x if info == 0 else np.full_like(b, np.nan), False)


def solve_definite(band: Array, b: Array) -> Array | None:
    """Solution of K x = b (size, n_rhs) by Cholesky, with the lower band of K; None if K is not positive definite."""
    factor, info = lapack.dpbtrf(band, lower=1)
    if info:
        return None
    return np.asarray(lapack.dpbtrs(factor, b, lower=1)[0])


def is_definite(band: Array) -> bool:
    """True if the matrix of a lower band is positive definite, by Cholesky."""
    return int(lapack.dpbtrf(band, lower=1)[1]) == 0


@dataclass(frozen=True)
class SoftestMode:
    """The eigenvalue nearest zero, its unit eigenvector (size,), and True if the matrix is positive definite."""

    value: float
    vector: Array
    definite: bool


def softest(band: Array) -> SoftestMode:
    """Softest mode of a lower band by inverse iteration from a fixed vector; value 0 if LU finds it singular."""
    width = band.shape[0] - 1
    factor, info = lapack.dpbtrf(band, lower=1)
    definite, pivots = info == 0, None
    if not definite:
        factor, pivots, info = lapack.dgbtrf(_general(band), width, width)
    vector, value = np.ones(band.shape[1]), 0.0
    for _ in range(_INVERSE_ITERATIONS if info == 0 else 0):
        vector = vector / np.linalg.norm(vector)
        if pivots is None:
            image = lapack.dpbtrs(factor, vector, lower=1)[0]
        else:
            image = lapack.dgbtrs(factor, width, width, vector, pivots)[0]
        value, vector = 1.0 / float(vector @ image), image
    return SoftestMode(value, vector / np.linalg.norm(vector), definite)


def _general(band: Array) -> Array:
    """Both triangles of a lower band in the layout of LAPACK's gb routines, (3 width + 1, size), with fill-in space."""
    width, n = band.shape[0] - 1, band.shape[1]
    full = np.zeros((3 * width + 1, n), order="F")
    full[2 * width :] = band
    for k in range(1, width + 1):
        full[2 * width - k, k:] = band[k, : n - k]
    return full


def negative_pivots(band: Array) -> int:
    """Number of negative eigenvalues of a lower band, by Sylvester's law on a block LDL^T with blocks as wide as it."""
    width, n = band.shape[0] - 1, band.shape[1]
    step = max(width, 1)
    count = 0
    carried = np.zeros((min(step, n), min(step, n)))
    for start in range(0, n, step):
        stop, reach = min(start + step, n), min(start + 2 * step, n)
        square = _dense(band, start, reach)
        m = stop - start
        square[:m, :m] -= carried
        value, vector = np.linalg.eigh(square[:m, :m])
        count += int((value < 0.0).sum())
        below = square[m:, :m] @ vector
        value = np.where(np.abs(value) > 1e-300, value, 1e-300)
        carried = (below / value) @ below.T
    return count


def _dense(band: Array, start: int, stop: int) -> Array:
    """Rows and columns from ``start`` to before ``stop`` of a lower band, as a full symmetric matrix."""
    m = stop - start
    out = np.zeros((m, m))
    flat = out.reshape(-1)
    for k in range(min(band.shape[0], m)):
        flat[k * m :: m + 1][: m - k] = flat[k : (m - k) * m : m + 1] = band[k, start : stop - k]
    return out
