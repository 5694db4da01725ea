"""Newton steps of a wall with harmonics under an object: which points touch is carried from step to step.

The solid's own step starts at the points that the present positions bring into the object, with their tractions in the
curvature of the contact. Along a round object a step of the path overshoots by far more than the penetration of a
state in balance: the tractions there belong to the stiff penalty, and the tangent has negative modes. Here tractions
are unknowns of their own, as in primal-dual methods: those of the last quadratic model are in the curvature, and the
next model starts from them (Hintermüller, Ito and Kunisch 2002, SIAM J. Optim. 13(3), doi:10.1137/S1052623401383558).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.mechanics.harmonic.point_sets import PointSets
from pneutouch.mechanics.solid.contact import ContactEvaluation
from pneutouch.mechanics.solid.newton import NewtonDirection, SolidScene, SolverState, tangent

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
        self._contact, self._push = scene.solid.contact, scene.solid.push
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
