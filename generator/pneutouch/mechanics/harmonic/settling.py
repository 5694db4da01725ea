"""Newton steps of a wall with harmonics under an object: which points touch is carried from step to step.

The solid's own step starts at the points that the present positions bring into the object, with their tractions in the
curvature of the contact. Along a round object a step of the path overshoots by far more than the penetration of a
state in balance: the tractions there belong to the stiff penalty, and the tangent has negative modes. Here tractions
are unknowns of their own, as in primal-dual methods: those of the last quadratic model are in the curvature, and the
next model starts from them (Hintermüller, Ito and Kunisch 2002, SIAM J. Optim. 13(3), doi:10.1137/S1052623401383558).

The least of a quadratic model under an object for one set of touching points after another.

Sets differ in few points. A point that comes or goes changes the tangent by one rank, so the tangent is factored for
one set, and other sets are solved for by Woodbury's identity; the inertia of its small matrix shows whether the
changed tangent is positive definite (Haynsworth 1968, Linear Algebra Appl. 1(1), doi:10.1016/0024-3795(68)90050-5).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array, Flags, Index
from pneutouch.mechanics.solid import lapack
from pneutouch.mechanics.solid.newton import NewtonDirection, SolidScene, SolverState, downhill, tangent, with_contact
from pneutouch.mechanics.solid.object_contact import ContactEvaluation

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
        return solid.faces.push(solid.contact.force(traction, self._held.slope))


_FREE = 5
"""Rounds in which each set of touching points is the one that the last one brought about."""

_ROUNDS = 12
"""All rounds of one quadratic model; the later ones search along a line."""


@dataclass(frozen=True)
class Foreseen:
    """Points that are expected to touch, and the tractions that act on the curvature of the object there; of the shape
    of the points of contact."""

    touching: Flags
    traction: Array


class ContactNewton:
    """Newton steps to one state, for `newton.minimise`, from a guess of its contact."""

    def __init__(self, foreseen: Foreseen | None = None) -> None:
        self._foreseen = foreseen

    def __call__(self, scene: SolidScene, state: SolverState) -> NewtonDirection:
        """The step at a state."""
        assert state.touch is not None
        newton, traction = _ContactModel(scene, state, state.touch, self._foreseen).least()
        self._foreseen = Foreseen(traction > 0.0, np.maximum(traction, 0.0))
        return newton


class _ContactModel:
    """The quadratic model of wall, filling and contact at a state: convex, with a slope that bends where points come
    and go. Tractions are not clipped."""

    def __init__(self, scene: SolidScene, state: SolverState, touch: ContactEvaluation, foreseen: Foreseen | None):
        self._scene, self._state, self._touch = scene, state, touch
        self._contact, self._push = scene.solid.contact, scene.solid.faces.push
        self._here = self._contact.linear(touch, np.zeros_like(state.x))
        self._foreseen = foreseen or Foreseen(self._here > 0.0, np.zeros_like(self._here))
        held = replace(touch, traction=self._foreseen.traction)
        self._sets = PointSets(scene, state, held, self._here, tangent(scene, state))

    def least(self) -> tuple[NewtonDirection, Array]:
        """The step to the least of the model, or to a lower point of it, and the tractions there.

        Each set of points brings about the next. Where sets come again, the rest of the rounds go from the last answer
        to the least of the model before the next one.
        """
        here, active = self._here, self._foreseen.touching
        step, pull, searching, seen = np.zeros_like(self._state.residual), self._state.inner, False, set[bytes]()
        for number in range(_ROUNDS):
            newton = self._sets.at(active)
            if newton.lift:
                pull = pull + newton.lift * step
            ahead = self._contact.linear(self._touch, self._scene.solid.expand(newton.step))
            following = ahead > 0.0
            if (following == active).all():
                return newton, ahead
            seen.add(active.tobytes())
            if number + 1 < _FREE and following.tobytes() not in seen:
                active = following
                continue
            pull_ahead = self._pull(active, ahead)
            if not searching and self._lower(newton.step, ahead, pull_ahead):
                share = 1.0
            else:
                move = newton.step - step
                share = self._contact.least_share(here, ahead, float(move @ pull), float(move @ pull_ahead))
            searching = True
            step, pull = step + share * (newton.step - step), pull + share * (pull_ahead - pull)
            here = here + share * (ahead - here)
            active = here > 0.0
        return replace(newton, step=step), here

    def _pull(self, active: Flags, traction: Array) -> Array:
        """Forces by which wall and filling pull if the tractions of a set of points balance them (size,)."""
        return np.asarray(-self._push(self._contact.force(np.where(active, traction, 0.0), self._touch.slope)))

    def _lower(self, step: Array, ahead: Array, pull: Array) -> bool:
        """True if the model is lower at the end of a step than at the state itself."""
        contact = self._contact
        pressed = np.maximum(ahead, 0.0) ** 2 - np.maximum(self._here, 0.0) ** 2
        change = 0.5 * float(step @ (self._state.inner + pull))
        return change + float(np.vdot(contact.weight, pressed)) / (2.0 * contact.stiffness) < 0.0
