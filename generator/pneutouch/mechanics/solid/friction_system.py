"""The wall and its filling without the contact, as a system of the unknowns that the contact can reach."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.solid.elimination import LeadingElimination
from pneutouch.mechanics.solid.general_band import OneSidedBlocks
from pneutouch.mechanics.solid.newton import SolverState


class ContactSystem:
    """K + c g g', K a band, g the gradient of the volume and c the stiffness of the filling, the unknowns before
    ``first`` eliminated once; ``load`` (size,) are all forces but those of the contact."""

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
        """Residual of the trailing unknowns without a move, the leading ones in balance."""
        return self._rest[:, 0]

    def solve(self, push: Array, blocks: Array) -> Array:
        """Trailing unknowns under the contact's forces (size,) and blocks, by LU."""
        return self._filled(self.sides.solve_widened(self._wide, blocks, self._load(push), self.first))

    def solve_definite(self, push: Array, blocks: Array) -> Array | None:
        """Solution by Cholesky for symmetric blocks; None if the matrix is not positive definite."""
        solved = self.sides.solve_definite(self.fore.rest, blocks, self._load(push), self.first)
        return None if solved is None else self._filled(solved)

    def response(self, blocks: Array, rows: Array) -> Array:
        """R M^-1 R' (n, n) with M the system and blocks; rows: R as `OneSidedBlocks.spread` takes them."""
        g = self._rest[:, 1]
        both = np.concatenate([self.sides.spread(rows, self.first, g.size), g[None]])
        out = self.sides.response(self._wide, blocks, both, self.first)
        gas = self._share / (1.0 + self._share * float(out[-1, -1]))
        return np.asarray(out[:-1, :-1] - gas * np.multiply.outer(out[:-1, -1], out[-1, :-1]))

    def definite(self, blocks: Array) -> bool:
        """True if K with symmetric blocks is positive definite; False also if that is not known."""
        # Leading unknowns were eliminated only where their own part is definite.
        return self.sides.solve_definite(self.fore.rest, blocks, self._rest, self.first) is not None

    def _load(self, push: Array) -> Array:
        return np.stack([-self.begun - push[self.first :], self._rest[:, 1]], axis=1)

    def _filled(self, solved: Array) -> Array:
        plain, soft = solved.T
        g = self._rest[:, 1]
        return np.asarray(plain - soft * (self._share * float(g @ plain) / (1.0 + self._share * float(g @ soft))))

    def whole(self, trailing: Array) -> Array:
        """All unknowns (size,) where the trailing ones are given."""
        first = self.first
        if not first:
            return trailing
        pulled = self.fore.leading(self.fore.onto_leading(trailing[:, None]))[:, 0]
        lead = -self._solved[:, 0] - pulled
        g = self.state.by_volume
        lead -= self._solved[:, 1] * self._share * float(g[:first] @ lead + g[first:] @ trailing)
        return np.concatenate([lead, trailing])
