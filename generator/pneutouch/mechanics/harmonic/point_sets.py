"""The least of a quadratic model under an object for one set of touching points after another.

Sets differ in few points. A point that comes or goes changes the tangent by one rank, so the tangent is factored for
one set, and other sets are solved for by Woodbury's identity; the inertia of its small matrix shows whether the
changed tangent is positive definite (Haynsworth 1968, Linear Algebra Appl. 1(1), doi:10.1016/0024-3795(68)90050-5).
"""

from __future__ import annotations

import numpy as np

from pneutouch.arrays import Array, Flags, Index
from pneutouch.mechanics.solid import lapack
from pneutouch.mechanics.solid.contact import ContactEvaluation
from pneutouch.mechanics.solid.newton import NewtonDirection, SolidScene, SolverState, downhill, with_contact

_MOST = 24
"""Points by which a set may differ from the factored one: their solutions cost as much as two factorisations."""


class PointSets:
    """Newton steps of one state with sets of points in contact, of the shape of the points.

    ``held`` has the tractions that act on the curvature of the object, ``start`` are those of the state, not clipped.
    """

    def __init__(self, scene: SolidScene, state: SolverState, held: ContactEvaluation, start: Array, band: Array):
        self._scene, self._state, self._held, self._start, self._band = scene, state, held, start, band
        contact = scene.solid.contact
        self._soft = (contact.weight / contact.stiffness).ravel()
        self._factor: Array | None = None

    def load(self, active: Flags) -> Array:
        """Gradient of the energy with the tractions of a set alone (size,)."""
        return self._state.inner + self._force(np.where(active, self._start, 0.0))

    def at(self, active: Flags) -> NewtonDirection:
        """The step to the least of the model with a set of touching points."""
        changed = None if self._factor is None else np.flatnonzero(active != self._base)
        if changed is None or changed.size > _MOST:
            changed = self._factored(active)
        newton = None if changed is None else self._changed(active, changed)
        if newton is not None:
            return newton
        newton = downhill(self._state, with_contact(self._scene, self._band, self._held, active), self.load(active))
        if newton.lift:
            # What made this tangent definite is kept for the rest of the sets: fewer failed factorisations.
            self._band = self._band.copy(order="F")
            self._band[0] += newton.lift
            self._factor = None
        return newton

    def _factored(self, active: Flags) -> Index | None:
        """Factor the tangent for a set; no changed points, or None if it is not positive definite."""
        factor, info = lapack.dpbtrf(with_contact(self._scene, self._band, self._held, active), lower=1)
        self._factor = None
        if info:
            return None
        self._factor, self._base = factor, active
        rhs = np.stack([-self.load(active), self._state.by_volume], axis=1)
        self._solution = lapack.dpbtrs(factor, rhs, lower=1)[0]
        self._number: dict[int, int] = {}
        self._pushes, self._moves = np.empty((rhs.shape[0], 0)), np.empty((rhs.shape[0], 0))
        return np.empty(0, np.intp)

    def _changed(self, active: Flags, changed: Index) -> NewtonDirection | None:
        """The step with some points of the factored set changed; None if the tangent is not positive definite."""
        solution = self._solution
        if changed.size:
            columns = self._known(changed)
            push, move = self._pushes[:, columns], self._moves[:, columns]
            sign = np.where(active.ravel()[changed], 1.0, -1.0)
            solution = solution.copy()
            solution[:, 0] -= move @ (sign * self._start.ravel()[changed])
            small = np.diag(sign * self._soft[changed]) + push.T @ move
            small = 0.5 * (small + small.T)
            if int((np.linalg.eigvalsh(small) > 0.0).sum()) != int((sign > 0.0).sum()):
                return None
            solution -= move @ np.linalg.solve(small, push.T @ solution)
        plain, soft = solution.T
        rate, by_volume = self._state.filling.rate, self._state.by_volume
        denominator = 1.0 + rate * float(by_volume @ soft)
        step = plain - soft * (rate * float(by_volume @ plain) / denominator)
        return NewtonDirection(step, soft, denominator, True, True) if denominator > 0.0 else None

    def _known(self, points: Index) -> list[int]:
        """Columns of points among the unit loads and their solutions, which are kept."""
        new = [int(p) for p in points if int(p) not in self._number]
        if new:
            loads = np.stack([self._unit(p) for p in new], axis=1)
            self._number.update({p: len(self._number) + k for k, p in enumerate(new)})
            self._pushes = np.concatenate([self._pushes, loads], axis=1)
            self._moves = np.concatenate([self._moves, lapack.dpbtrs(self._factor, loads, lower=1)[0]], axis=1)
        return [self._number[int(p)] for p in points]

    def _unit(self, point: int) -> Array:
        traction = np.zeros(self._start.size)
        traction[point] = 1.0
        return self._force(traction.reshape(self._start.shape))

    def _force(self, traction: Array) -> Array:
        solid = self._scene.solid
        return solid.push(solid.contact.force(traction, self._held.slope))
