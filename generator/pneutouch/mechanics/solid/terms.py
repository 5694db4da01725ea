"""Further parts of the total energy of a scene, in addition to wall, filling and plate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from pneutouch.arrays import Array


@dataclass(frozen=True)
class TermState:
    """A further part of the total energy at one set of positions: its energy, its gradient (size,), and its second
    derivative as ``blocks`` of `SolidModel.contact_pattern` (edges of the outer wall) and ``inner_blocks`` of
    `SolidModel.edge_pattern` (edges of the inner wall), (n_edges, 2 n, 2 n) each, and ``fold_blocks`` of
    `SolidModel.fold_pattern` (edges of the outer wall with the flange's top); ``around`` by displacements of the edges
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
