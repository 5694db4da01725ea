"""Contact and friction linear in a displacement: the model in which a Newton step is settled."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.solid.contact import ContactEvaluation
from pneutouch.mechanics.solid.friction import FrictionPoints, FrictionStep
from pneutouch.mechanics.solid.friction_pivots import PiecewiseLine
from pneutouch.mechanics.solid.friction_status import PointStatus, PointTractions
from pneutouch.mechanics.solid.kinematics import AXIAL, RADIAL
from pneutouch.mechanics.solid.model import SolidModel


@dataclass(frozen=True)
class LinearContact:
    """Contact and friction linear in a displacement from one set of positions.

    held: the largest tractions along the surface stay those of the points there; the model then has an energy.  kept:
    signs of slip (n_edges, n_points), 0 for points that stick, which all points keep, however large their tractions.
    unsettled: a step whose points are not settled will do, as the next one starts from the tractions that it leads to.
    """

    solid: SolidModel
    step: FrictionStep
    touch: ContactEvaluation
    points: FrictionPoints
    held: bool = False
    kept: Array | None = None
    unsettled: bool = False
    #: Whether the tractions are linear in pieces of the displacement.
    IN_PIECES: ClassVar[bool] = True

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

    def rows(self, begin: int) -> Array:
        """Rates of the tractions of the points of edges from one on, normal first, by the unknowns of these edges:
        (2 n, n_edges, 2 n_nodes), each point with rates by its own edge alone."""
        contact, slope, secant = self.solid.contact, self.touch.slope[begin:], self.points.secant[begin:]
        n_edges, n_points = slope.shape
        out = np.zeros((2, n_edges, n_points, n_edges, 2 * contact.shape.shape[1]))
        edge = np.arange(n_edges)
        for k, (by_r, by_z) in enumerate(
            [
                (-contact.stiffness * slope, np.full(slope.shape, contact.stiffness)),
                (self.step.stiffness / secant, self.step.stiffness * slope / secant),
            ]
        ):
            out[k, edge, :, edge, RADIAL] = by_r[..., None] * contact.shape
            out[k, edge, :, edge, AXIAL] = by_z[..., None] * contact.shape
        return out.reshape(2 * slope.size, n_edges, -1)

    def line(
        self, status: PointStatus, begun: PointTractions, ended: PointTractions, response: Array, edge: int
    ) -> PiecewiseLine:
        """The line from tractions ``begun`` towards those ``ended`` that a status leads to, of the points of the edges
        from one on; response: (2 n, 2 n) of their tractions to loads of `rows`, with that status."""
        local = PointStatus(status.touching[edge:].ravel(), status.bearing[edge:].ravel(), status.sign[edge:].ravel())
        first, last = (PointTractions(at.normal[edge:].ravel(), at.trial[edge:].ravel()) for at in (begun, ended))
        areas = self._weight[edge:].ravel() / np.array([[self.solid.contact.stiffness], [self.step.stiffness]])
        grip = (self.points.cap if self.held else self._grip)[edge:].ravel()
        return PiecewiseLine(local, first, last, response, areas, grip, self.held)

    def _cap(self, normal: Array) -> Array:
        return self.points.cap if self.held else self._grip * np.maximum(normal, 0.0)

    def begins(self, still: PointTractions) -> PointStatus:
        """The status that is tried first, where a step begins with tractions ``still``."""
        return self.status(still)

    def status(self, at: PointTractions) -> PointStatus:
        """State of the points: those that touch, stick and slide."""
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
