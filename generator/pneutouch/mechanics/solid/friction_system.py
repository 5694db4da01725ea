"""Linear systems of a wall and its filling, reduced to the unknowns that the contact can reach.

The banded matrix is symmetric apart from blocks of the outer wall. The leading unknowns, away from the contact, are
eliminated once, while the blocks of the trailing unknowns change.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pneutouch.arrays import Array, Index
from pneutouch.mechanics.solid.banded import lapack, solve_definite
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import SolverState


class OneSidedBlocks:
    """Band matrices with added blocks (n_edges, 2 n, 2 n) of the outer wall, in LAPACK's layouts of general and of
    symmetric bands, for all unknowns or for those from ``first`` on, if the blocks before are zero."""

    def __init__(self, solid: SolidModel) -> None:
        self._table = table = solid.dofs[solid.mesh.outer].reshape(len(solid.mesh.outer), -1)
        n = table.shape[1]
        i = np.broadcast_to(table[:, :, None], (*table.shape, n)).ravel()
        j = np.broadcast_to(table[:, None, :], (*table.shape, n)).ravel()
        self._width = width = solid.faces.outer.width
        self._entries = np.flatnonzero((i >= 0) & (j >= 0))
        self._places, self._number = np.unique(
            (2 * width + i - j + j * (3 * width + 1))[self._entries], return_inverse=True
        )
        self._lower = np.flatnonzero((i >= j) & (j >= 0))
        self._lower_places, self._lower_number = np.unique((i - j + j * (width + 1))[self._lower], return_inverse=True)

    def first_unknown(self, edge: int) -> int:
        """Lowest unknown of an edge of the outer wall and of all edges after it, towards the axis."""
        rest = self._table[edge:]
        return int(rest[rest >= 0].min())

    def widened(self, band: Array) -> Array:
        """Lower band (width + 1, size) as a transposed general band (size, 3 width + 1), with space for fill-in."""
        width, n = self._width, band.shape[1]
        full = np.zeros((n, 3 * width + 1))
        full[:, 2 * width :] = band.T
        for k in range(1, width + 1):
            full[k:, 2 * width - k] = band[k, : n - k]
        return full

    def solve(self, band: Array, blocks: Array, b: Array) -> Array:
        """Solution x of (lower band + blocks) x = b (size, n_rhs) by LU; not finite if the matrix is singular."""
        return self.solve_widened(self.widened(band), blocks, b)

    def solve_widened(self, wide: Array, blocks: Array, b: Array, first: int = 0) -> Array:
        """`solve` with a band in the form of `widened`, for the unknowns from ``first`` on."""
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
        """Matrix R X^-1 R' (n, n) with X = symmetric band + blocks by LU, the band in the form of `widened`, for the
        unknowns from ``first`` on; rows: R, (n, size). Not finite if X is singular."""
        width = self._width
        factor, pivots, info = lapack.dgbtrf(self._with_blocks(wide, blocks, first).T, width, width, overwrite_ab=1)
        if info:
            return np.full((rows.shape[0],) * 2, np.nan)
        return np.asarray(rows @ lapack.dgbtrs(factor, width, width, rows.T, pivots)[0])

    def spread(self, rows: Array, first: int, size: int) -> Array:
        """Rows (n, size) for the unknowns from ``first`` on, from rows for the unknowns of the last edges, (n, n_edges,
        2 n_nodes)."""
        table = self._table[-rows.shape[1] :]
        out = np.zeros((rows.shape[0], size + 1))
        # Fixed unknowns, with number -1, are written to an extra last column, which is left out.
        for k, places in enumerate(np.where(table >= 0, table - first, size)):
            out[:, places] += rows[:, k]
        return out[:, :size]

    def solve_definite(self, band: Array, blocks: Array, b: Array, first: int = 0) -> Array | None:
        """Solution x of (lower band + symmetric blocks) x = b by Cholesky; None if that matrix is not definite."""
        full = band.T.copy()
        _add(
            full,
            self._lower_places - first * (self._width + 1),
            np.asarray(np.bincount(self._lower_number, blocks.ravel()[self._lower]), dtype=np.float64),
        )
        return solve_definite(full.T, b)


def _add(matrix: Array, places: Index, values: Array) -> None:
    """Add values at ascending places of the flat matrix; places before its start are skipped."""
    begin = int(np.searchsorted(places, 0))
    matrix.reshape(-1)[places[begin:]] += values[begin:]


@dataclass(frozen=True)
class LeadingElimination:
    """Symmetric band [[A, B'], [B, D]] with its first unknowns, whose A is positive definite, eliminated.

    first: number of eliminated unknowns.  factor: of A, (width + 1, first).  across: nonzero part of B, (width, width),
    between the last leading and first trailing unknowns.  rest: trailing band D - B A^-1 B', (width + 1, size - first).
    """

    first: int
    factor: Array
    across: Array
    rest: Array

    @classmethod
    def of(cls, band: Array, first: int) -> "LeadingElimination":
        """Eliminate at most ``first`` unknowns; none if they are too few to matter or A is not definite."""
        width, size = band.shape[0] - 1, band.shape[1]
        first = min(first, size - width)
        whole = cls(0, band[:, :0], np.zeros((width, width)), band)
        if first < width:
            return whole
        factor, info = lapack.dpbtrf(band[:, :first], lower=1)
        if info:
            return whole
        across, last = np.zeros((width, width)), np.zeros((width, width))
        i, j = np.triu_indices(width)
        across[i, j] = band[width + i - j, first - width + j]
        last[j, i] = factor[j - i, first - width + i]
        half, _ = lapack.dtrtrs(last, across.T, lower=1)
        rest = band[:, first:].copy(order="F")
        taken = half.T @ half
        rest[j - i, i] -= taken[j, i]
        return cls(first, factor, across, rest)

    def leading(self, b: Array) -> Array:
        """Product A^-1 b, (first, n_rhs)."""
        return np.asarray(lapack.dpbtrs(self.factor, b, lower=1)[0] if self.first else b)

    def onto_rest(self, x: Array) -> Array:
        """Product B x, (size - first, n_rhs), for leading unknowns x (first, n_rhs)."""
        out = np.zeros((self.rest.shape[1], x.shape[1]))
        if self.first:
            width = self.across.shape[0]
            out[:width] = self.across @ x[-width:]
        return out

    def onto_leading(self, x: Array) -> Array:
        """Product B' x, (first, n_rhs), for trailing unknowns x (size - first, n_rhs)."""
        out = np.zeros((self.first, x.shape[1]))
        if self.first:
            width = self.across.shape[0]
            out[-width:] = self.across.T @ x[:width]
        return out


class ContactSystem:
    """System K + c g g' with a lower band K, the gradient g of the volume and the stiffness c of the filling; at most
    the unknowns before ``first`` are eliminated; ``load`` (size,) is the residual without the contact."""

    def __init__(self, sides: OneSidedBlocks, band: Array, state: SolverState, load: Array, first: int) -> None:
        self.sides, self.state = sides, state
        self.fore = LeadingElimination.of(band, first)
        self.first = first = self.fore.first
        both = np.stack([load, state.by_volume], axis=1)
        self._solved = self.fore.leading(both[:first])
        self._rest = both[first:] - self.fore.onto_rest(self._solved)
        g = state.by_volume[:first]
        pull, soft = (float(g @ one) for one in self._solved.T)
        self._share = state.filling.rate / (1.0 + state.filling.rate * soft)
        self._rest[:, 0] -= self._share * pull * self._rest[:, 1]

    @cached_property
    def _wide(self) -> Array:
        return self.sides.widened(self.fore.rest)

    @property
    def begun(self) -> Array:
        """Residual of the trailing unknowns before a move, with the leading ones in equilibrium."""
        return self._rest[:, 0]

    def solve(self, push: Array, blocks: Array) -> Array:
        """Trailing unknowns of the move that balances load and contact forces ``push`` (size,), with its blocks; LU."""
        return self._filled(self.sides.solve_widened(self._wide, blocks, self._load(push), self.first))

    def solve_definite(self, push: Array, blocks: Array) -> Array | None:
        """`solve` by Cholesky, for symmetric blocks; None if band and blocks are not positive definite."""
        solved = self.sides.solve_definite(self.fore.rest, blocks, self._load(push), self.first)
        return None if solved is None else self._filled(solved)

    def response(self, blocks: Array, rows: Array) -> Array:
        """Matrix R M^-1 R' (n, n) with M the system plus blocks; rows: R in the form for `OneSidedBlocks.spread`."""
        g = self._rest[:, 1]
        both = np.concatenate([self.sides.spread(rows, self.first, g.size), g[None]])
        out = self.sides.response(self._wide, blocks, both, self.first)
        gas = self._share / (1.0 + self._share * float(out[-1, -1]))
        return np.asarray(out[:-1, :-1] - gas * np.multiply.outer(out[:-1, -1], out[-1, :-1]))

    def definite(self, blocks: Array) -> bool:
        """True if K with symmetric blocks is positive definite, and so the whole system; the filling can still make the
        system definite if not."""
        # Leading unknowns were eliminated only where their own part is definite.
        return self.sides.solve_definite(self.fore.rest, blocks, self._rest, self.first) is not None

    def _load(self, push: Array) -> Array:
        return np.stack([-self.begun - push[self.first :], self._rest[:, 1]], axis=1)

    def _filled(self, solved: Array) -> Array:
        plain, soft = solved.T
        g = self._rest[:, 1]
        return np.asarray(plain - soft * (self._share * float(g @ plain) / (1.0 + self._share * float(g @ soft))))

    def whole(self, trailing: Array) -> Array:
        """All unknowns (size,) of a move from its trailing ones."""
        first = self.first
        if not first:
            return trailing
        pulled = self.fore.leading(self.fore.onto_leading(trailing[:, None]))[:, 0]
        lead = -self._solved[:, 0] - pulled
        g = self.state.by_volume
        lead -= self._solved[:, 1] * self._share * float(g[:first] @ lead + g[first:] @ trailing)
        return np.concatenate([lead, trailing])
