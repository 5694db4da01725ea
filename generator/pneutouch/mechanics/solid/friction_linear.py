"""Contact and friction linear in a displacement: the model in which a Newton step is settled."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.solid.contact import ContactEvaluation
from pneutouch.mechanics.solid.friction import FrictionPoints, FrictionStep
from pneutouch.mechanics.solid.friction_status import PointStatus, PointTractions
from pneutouch.mechanics.solid.model import SolidModel


@dataclass(frozen=True)
class LinearContact:
    """Contact and friction linear in a displacement from one set of positions.

    held: the largest tractions along the surface stay those of the points there; the model then has an energy.  kept:
    signs of slip (n_edges, n_points), 0 for points that stick, which all points keep, however large their tractions.
    """

    solid: SolidModel
    step: FrictionStep
    touch: ContactEvaluation
    points: FrictionPoints
    held: bool = False
    kept: Array | None = None

    @cached_property
    def _grip(self) -> Array:
        """Largest traction along the surface over the normal one."""
        return self.step.coefficient * self.points.secant

    def at(self, move: Array) -> PointTractions:
        """Tractions after a nodal displacement (n_nodes, 2)."""
        r, z = self.solid.contact.positions(move)
        slope, points = self.touch.slope, self.points
        return PointTractions(
            -self.solid.contact.stiffness * (self.touch.gap + slope * r - z),
            self.step.stiffness * (points.slip + (r + slope * z) / points.secant),
        )

    def _cap(self, normal: Array) -> Array:
        return self.points.cap if self.held else self._grip * np.maximum(normal, 0.0)

    def status(self, at: PointTractions) -> PointStatus:
        """Which points touch, stick and slide."""
        touching = at.normal > 0.0
        if self.kept is not None:
            return PointStatus(touching, touching, np.where(touching, self.kept, 0.0))
        cap = self._cap(at.normal)
        bearing = cap > 0.0 if self.held else touching
        return PointStatus(touching, bearing, np.where(bearing & (np.abs(at.trial) > cap), np.sign(at.trial), 0.0))

    def under(self, status: PointStatus, at: PointTractions) -> PointTractions:
        """Tractions of points that keep a status."""
        normal = np.where(status.touching, at.normal, 0.0)
        slides = status.sign * (self.points.cap if self.held else self._grip * normal)
        return PointTractions(normal, np.where(status.sticking, at.trial, slides))

    def force(self, tractions: PointTractions) -> Array:
        """Gradient (size,) of tractions."""
        slope = self.touch.slope
        across, along = self.solid.contact.force(tractions.normal, slope), self.step.force(tractions.trial, slope)
        return self.solid.push(across + along)

    def blocks(self, status: PointStatus, begun: PointTractions) -> tuple[Array, Array | None]:
        """Stiffness of points that keep a status, symmetric and not; ``begun``: their tractions without a move."""
        slope = self.touch.slope
        both = self.solid.contact.hessian(self.touch, status.touching) + self.step.stick(status.sticking, slope)
        return both, None if self.held else self.step.slide(begun.trial, self.touch, status.sign)

    def work(self, tractions: PointTractions, begun: PointTractions, ended: PointTractions) -> float:
        """Work of tractions over the displacement between two others."""
        normal = np.vdot(self._weight * tractions.normal, ended.normal - begun.normal) / self.solid.contact.stiffness
        return float(normal + np.vdot(self._weight * tractions.trial, ended.trial - begun.trial) / self.step.stiffness)

    def works(self, begun: PointTractions, ended: PointTractions, shares: Array) -> Array:
        """Work over the displacement between two tractions of those that the points bear at shares of it (n,), (n,)."""
        change = begun.towards(ended, shares)
        normal = np.maximum(change.normal, 0.0)
        cap = self._cap(normal)
        trial = np.minimum(np.maximum(change.trial, -cap), cap)
        across = self._weight * (ended.normal - begun.normal) / self.solid.contact.stiffness
        along = self._weight * (ended.trial - begun.trial) / self.step.stiffness
        n = shares.size
        return np.asarray(normal.reshape(n, -1) @ across.ravel() + trial.reshape(n, -1) @ along.ravel())

    @property
    def _weight(self) -> Array:
        return self.solid.contact.weight
