"""One Newton step of a contact with friction: which points touch, stick and slide is settled inside the linear model.

Every round solves the linear model of one status of the points. Where that leads to another status, the round goes only
so far as the work of the model's residual along its move falls (Matthies & Strang 1979, Int. J. Numer. Methods Eng. 14,
1613, there for whole steps): without this, points at the edge of the contact come and go in turn for ever. The unknowns
of the wall before the contact do not take part in it: they are eliminated once.

Where a few rounds do not settle it, it is settled one point after another (`friction_pivots`). In thin walls, whose
points between the centre and the edge of the contact bear next to nothing and come and go, that saves half the rounds.

The first step from an extrapolated state has its points stick and slide as they did at the state before: only which
points touch is settled. The tractions at extrapolated positions do not show what slides, and points that were
settled by them turned over again in the next step: in 120 random presses this saves a third of the rounds.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.solid.friction_linear import LinearContact
from pneutouch.mechanics.solid.friction_status import PointStatus, PointTractions, touched
from pneutouch.mechanics.solid.friction_system import ContactSystem
from pneutouch.mechanics.solid.general_band import OneSidedBlocks
from pneutouch.mechanics.solid.newton import SolverState, downhill

#: Rounds in which the status of the points is settled.
ROUNDS = 30
#: Rounds after which the rest is settled one point after another.
_BEFORE_PIVOTS = 3
#: Rounds in which it is settled only which points touch; the next step goes on from there.
_KEPT_ROUNDS = 10
#: Edges next to the contact that the eliminated part keeps away from.
_MARGIN = 2
#: A round goes to its end where the work of the residual at its end is no more than this share of that it begins with.
_SEARCHED = 0.1
#: Shares of a round at which it is looked at.
_SHARES = np.concatenate([[0.0], np.geomspace(1.0e-3, 0.1, 9), np.linspace(0.15, 1.0, 18)])
_WHOLE = np.array([0.0, 1.0])


@dataclass(frozen=True)
class _Place:
    """Current place of the rounds: trailing unknowns and tractions there. The residual but for the contact's is a share
    of that without a move, less the force of ``balanced``."""

    unknowns: Array
    at: PointTractions
    begun: float
    balanced: PointTractions


class StepSettling:
    """Settles one Newton step from a state; ``band``: the stiffness without contact, which this may raise."""

    def __init__(self, sides: OneSidedBlocks, state: SolverState, band: Array, contact: LinearContact) -> None:
        self._sides, self._state, self._band, self._contact = sides, state, band, contact
        self._solid = contact.solid
        self._still = contact.at(np.zeros_like(state.x))
        self._first = contact.begins(self._still)

    def step(self) -> Array | None:
        """Newton step (size,); None if the linear model is not definite or its points do not settle.

        With held tractions there always is one: the diagonal is raised until the model is definite, and a step that is
        not settled lowers its energy all the same. Where the contact allows it, one that is not settled will do.
        """
        touching = np.concatenate([touched(self._still), self._first.edges])
        edge = int(touching.min()) if touching.size else self._still.normal.shape[0] - 1
        while True:
            kept = max(edge - _MARGIN, 0)
            step = self._settle(kept)
            if step is None and (self._contact.held or self._contact.unsettled):
                continue
            if step is None or not np.isfinite(step).all():
                return step
            met = touched(self._contact.at(self._solid.expand(step)), kept)
            if met.size == 0:
                return step
            edge = int(met[0])

    def _settle(self, edge: int) -> Array | None:
        """A step with the edges before one free of contact; None also where the band was raised."""
        first = self._sides.first_unknown(edge)
        contact, system = self._contact, ContactSystem(self._sides, self._band, self._state, self._state.inner, first)
        none = PointTractions(np.zeros_like(self._still.normal), np.zeros_like(self._still.trial))
        place, status = _Place(np.zeros_like(system.begun), self._still, 1.0, none), self._first
        last = ROUNDS if contact.kept is None else _KEPT_ROUNDS - 1
        for k in range(ROUNDS):
            there = self._solve(system, status, k == 0)
            if there is None:
                return None
            after = contact.at(self._trailing(there))
            new = contact.status(after)
            if new == status or k == last or not np.isfinite(there).all():
                return system.whole(there)
            if contact.kept is not None:
                status = new
                continue
            if k == 0:
                begun = status, after
            if k == _BEFORE_PIVOTS and contact.IN_PIECES:
                settled = self._settled(system, edge, *begun)
                end = None if settled is None else self._solve(system, settled, False)
                if settled is not None and (end is None or np.isfinite(end).all()):
                    return None if end is None else system.whole(end)
            place, whole = self._advanced(system, place, _Place(there, after, 0.0, contact.under(status, after)))
            if not whole:
                status = contact.status(place.at)
            elif contact.held:
                status = new
            else:
                status = status.then(new)
        return system.whole(place.unknowns) if contact.held or contact.unsettled else None

    def _settled(
        self, system: ContactSystem, edge: int, status: PointStatus, after: PointTractions
    ) -> PointStatus | None:
        """The status that is settled one point after another from the start, where a status led to tractions ``after``;
        None if none is settled."""
        contact = self._contact
        both, one_sided = contact.blocks(status, contact.under(status, self._still))
        response = system.response(both if one_sided is None else both + one_sided, contact.rows(edge))
        if not np.isfinite(response).all():
            return None
        settled = contact.line(status, self._still, after, response, edge).status()
        if settled is None:
            return None
        shape = status.touching.shape
        whole = PointStatus(np.zeros(shape, dtype=bool), np.zeros(shape, dtype=bool), np.zeros(shape))
        whole.touching[edge:] = settled.touching.reshape(-1, shape[1])
        whole.bearing[edge:] = settled.bearing.reshape(-1, shape[1])
        whole.sign[edge:] = settled.sign.reshape(-1, shape[1])
        return whole

    def _solve(self, system: ContactSystem, status: PointStatus, first_round: bool) -> Array | None:
        """The linear model of one status; None if it is not definite, the band then raised for another try."""
        begun = self._contact.under(status, self._still)
        both, one_sided = self._contact.blocks(status, begun)
        push = self._contact.force(begun)
        # The symmetric part is factorised once for its definiteness, and where there is no other.
        if first_round or one_sided is None:
            there = system.solve_definite(push, both)
            if there is None:
                full = self._solid.contact_pattern.added(self._band, [both])
                lift = downhill(self._state, full, self._state.inner + push).lift
                self._band[0] += lift
                if lift:
                    return None
            elif one_sided is None:
                return there
        return system.solve(push, both if one_sided is None else both + one_sided)

    def _advanced(self, system: ContactSystem, here: _Place, there: _Place) -> tuple[_Place, bool]:
        """Place towards the end of a round up to which the work of the residual falls, and whether that is its end."""
        contact, move = self._contact, there.unknowns - here.unknowns
        begun = here.begun * float(move @ system.begun) - contact.work(here.balanced, here.at, there.at)
        ended = -contact.work(there.balanced, here.at, there.at)
        first, last = np.array([begun, ended]) + contact.works(here.at, there.at, _WHOLE)
        if first >= 0.0 or last <= -_SEARCHED * first:
            return there, True
        works = begun + _SHARES * (ended - begun) + contact.works(here.at, there.at, _SHARES)
        k = int(np.argmax(works > 0.0))
        share = float(_SHARES[k - 1] - works[k - 1] * (_SHARES[k] - _SHARES[k - 1]) / (works[k] - works[k - 1]))
        return _Place(
            here.unknowns + share * move,
            here.at.towards(there.at, share),
            (1.0 - share) * here.begun,
            here.balanced.towards(there.balanced, share),
        ), False

    def _trailing(self, unknowns: Array) -> Array:
        """Nodal displacement (n_nodes, 2) of trailing unknowns, the others at rest."""
        whole = np.zeros(self._solid.size)
        whole[-unknowns.size :] = unknowns
        return self._solid.expand(whole)
