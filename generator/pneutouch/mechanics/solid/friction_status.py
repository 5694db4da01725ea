"""State of the wall's points (touching, sticking, sliding) in the linear model of a step with friction, and their
tractions."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array, Flags, Index


@dataclass(frozen=True)
class PointStatus:
    """touching: points in contact.  bearing: those that friction may hold.  sign: of the slip of those that slide."""

    touching: Flags
    bearing: Flags
    sign: Array

    @property
    def sticking(self) -> Flags:
        """Points that friction holds."""
        return np.asarray(self.bearing & (self.sign == 0.0))

    @property
    def edges(self) -> Index:
        """Edges of the outer wall with points in contact."""
        return np.flatnonzero(self.touching.any(axis=tuple(range(1, self.touching.ndim))))

    def then(self, new: PointStatus) -> PointStatus:
        """The status to try after this one led to a new one.

        A point that would slide in reverse sticks first: else points of one sign would turn over and back.
        """
        return replace(new, sign=np.where(new.sign == -self.sign, 0.0, new.sign))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, PointStatus):
            return NotImplemented
        return bool((self.touching == other.touching).all() and (self.sign == other.sign).all())


@dataclass(frozen=True)
class PointTractions:
    """Tractions that the linear model has before they are cut: normal, and along the surface; (n_edges, n_points)."""

    normal: Array
    trial: Array

    def towards(self, other: PointTractions, share: float | Array) -> PointTractions:
        """Tractions at a share of the change to others, or at shares (n,), along a first axis."""
        return PointTractions(_between(self.normal, other.normal, share), _between(self.trial, other.trial, share))


def _between(here: Array, there: Array, share: float | Array) -> Array:
    shares = np.asarray(share)
    return np.asarray(here + shares.reshape(*shares.shape, *(1,) * here.ndim) * (there - here))


def touched(tractions: PointTractions, before: int | None = None) -> Index:
    """Edges of the outer wall, of those before a number, with points in contact."""
    normal = tractions.normal[:before]
    return np.flatnonzero((normal > 0.0).any(axis=tuple(range(1, normal.ndim))))
