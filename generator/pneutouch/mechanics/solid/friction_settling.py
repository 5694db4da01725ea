"""One Newton step of a contact with friction: which points touch, stick and slide is settled inside the linear model.

Every round solves the linear model of one status of the points. Where that leads to another status, the round goes only
so far as the work of the model's residual along its move falls (Matthies & Strang 1979, Int. J. Numer. Methods Eng. 14,
1613, there for whole steps): without this, points at the edge of the contact come and go in turn for ever. The unknowns
of the wall before the contact do not take part in it: they are eliminated once.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.solid.contact import ContactEvaluation
from pneutouch.mechanics.solid.elimination import LeadingElimination
from pneutouch.mechanics.solid.friction import FrictionPoints, FrictionStep
from pneutouch.mechanics.solid.friction_status import PointStatus, PointTractions, touched
from pneutouch.mechanics.solid.general_band import OneSidedBlocks
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import SolverState, downhill

#: Rounds in which the status of the points is settled.
ROUNDS = 30
#: Edges next to the contact that the eliminated part keeps away from.
_MARGIN = 2
#: A round goes to its end where the work of the residual at its end is no more than this share of that it begins with.
_SEARCHED = 0.1
#: Shares of a round at which it is looked at.
_SHARES = np.concatenate([[0.0], np.geomspace(1.0e-3, 0.1, 9), np.linspace(0.15, 1.0, 18)])
_WHOLE = np.array([0.0, 1.0])


@dataclass(frozen=True)
class LinearContact:
    """Contact and friction linear in a displacement from one set of positions.

    held: the largest tractions along the surface stay those of the points there; the model then has an energy.
    """

    solid: SolidModel
    step: FrictionStep
    touch: ContactEvaluation
    points: FrictionPoints
    held: bool = False

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
        touching, cap = at.normal > 0.0, self._cap(at.normal)
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


class _System:
    """Wall and filling in the linear model, the unknowns before the contact eliminated: K + c g g', of K the band."""

    def __init__(self, sides: OneSidedBlocks, band: Array, state: SolverState, first: int) -> None:
        self.sides, self.state = sides, state
        self.fore = LeadingElimination.of(band, first)
        self.first = first = self.fore.first
        both = np.stack([state.inner, state.by_volume], axis=1)
        self._solved = self.fore.leading(both[:first])
        self._rest = both[first:] - self.fore.onto_rest(self._solved)
        g = state.by_volume[:first]
        load, soft = (float(g @ one) for one in self._solved.T)
        self._share = state.filling.rate / (1.0 + state.filling.rate * soft)
        self._rest[:, 0] -= self._share * load * self._rest[:, 1]

    @cached_property
    def _wide(self) -> Array:
        return self.sides.widened(self.fore.rest)

    @property
    def begun(self) -> Array:
        """Residual of the trailing unknowns without a move, the leading ones in balance."""
        return self._rest[:, 0]

    def solve(self, push: Array, blocks: Array) -> Array:
        """Trailing unknowns under the contact's forces and blocks, by LU."""
        return self._filled(self.sides.solve_widened(self._wide, blocks, self._load(push), self.first))

    def solve_definite(self, push: Array, blocks: Array) -> Array | None:
        """The same by Cholesky for symmetric blocks; None where the matrix is not positive definite."""
        solved = self.sides.solve_definite(self.fore.rest, blocks, self._load(push), self.first)
        return None if solved is None else self._filled(solved)

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


@dataclass(frozen=True)
class _Place:
    """Where the rounds have come to: trailing unknowns and tractions there. The residual but for the contact's is a
    share of that without a move, less the force of ``balanced``."""

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

    def step(self) -> Array | None:
        """Newton step (size,); None where the linear model is not definite or its points do not settle.

        With held tractions there always is one: the diagonal is raised until the model is definite, and a step that is
        not settled lowers its energy all the same.
        """
        touching = touched(self._still)
        edge = int(touching[0]) if touching.size else self._still.normal.shape[0] - 1
        while True:
            kept = max(edge - _MARGIN, 0)
            step = self._settle(self._sides.first_unknown(kept))
            if step is None and self._contact.held:
                continue
            if step is None or not np.isfinite(step).all():
                return step
            met = touched(self._contact.at(self._solid.expand(step)), kept)
            if met.size == 0:
                return step
            edge = int(met[0])

    def _settle(self, first: int) -> Array | None:
        """A step with the unknowns before ``first`` free of contact; None also where the band was raised."""
        contact, system = self._contact, _System(self._sides, self._band, self._state, first)
        none = PointTractions(np.zeros_like(self._still.normal), np.zeros_like(self._still.trial))
        place, status = _Place(np.zeros_like(system.begun), self._still, 1.0, none), contact.status(self._still)
        for k in range(ROUNDS):
            there = self._solve(system, status, k == 0)
            if there is None:
                return None
            after = contact.at(self._trailing(there))
            new = contact.status(after)
            if new == status or not np.isfinite(there).all():
                return system.whole(there)
            place, whole = self._advanced(system, place, _Place(there, after, 0.0, contact.under(status, after)))
            if not whole:
                status = contact.status(place.at)
            elif contact.held:
                status = new
            else:
                status = status.then(new)
        return system.whole(place.unknowns) if contact.held else None

    def _solve(self, system: _System, status: PointStatus, first_round: bool) -> Array | None:
        """The linear model of one status; None where it is not definite, the band then raised for another try."""
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

    def _advanced(self, system: _System, here: _Place, there: _Place) -> tuple[_Place, bool]:
        """As far towards the end of a round as the work of the residual falls, and whether that is its end."""
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
