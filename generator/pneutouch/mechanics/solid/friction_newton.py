"""Newton's method for one step of a contact with friction.

The tangent is the consistent one, which is not symmetric where points slide: the paper's press at coefficient 0.3 takes
59 Newton steps with it (61 without friction); with the symmetric tangent for held normal tractions it is not half way
after 739. The line search uses the energy with the traction limits held at their values at its start
(`friction.FrictionTerm`), whose gradient there is the residual.

In each Newton step the status of the points (touching, sticking, sliding) is settled inside the linear model.

Every round solves the linear model for one status. If that leads to another status, the round goes only as far as the
work of the model's residual along its move falls (Matthies & Strang 1979, Int. J. Numer. Methods Eng. 14, 1613, there
for whole steps): otherwise points at the edge of the contact would come and go in turn for ever. The unknowns of the
wall away from the contact do not take part: they are eliminated once.

If a few rounds do not settle it, `friction_linear.PiecewiseLine` settles it one point after another. In thin walls,
whose points between centre and edge of the contact bear almost nothing and come and go, that saves half the rounds.

In the first step from an extrapolated state the points stick and slide as they did at the state before: only touching
is settled. The tractions at extrapolated positions do not show which points slide, and points settled by them changed
again in the next step: in 120 random presses this saves a third of the rounds.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.solid.friction import FrictionPoints, FrictionStep, FrictionTerm
from pneutouch.mechanics.solid.friction_linear import LinearContact, PointStatus, PointTractions, touched
from pneutouch.mechanics.solid.friction_system import ContactSystem, OneSidedBlocks
from pneutouch.mechanics.solid.newton import (
    GAIN,
    RESIDUAL,
    STALLED,
    NewtonFailure,
    SolidScene,
    SolverState,
    downhill,
    evaluate,
    full_tangent,
    line_search,
    rounding,
    tangent,
)
from pneutouch.mechanics.solid.object_contact import ContactEvaluation

#: Greatest number of rounds in which the status of the points is settled.
ROUNDS = 30
#: Number of rounds after which the status is settled one point after another.
_BEFORE_PIVOTS = 3
#: Number of rounds in which only touching is settled; the next step goes on from there.
_KEPT_ROUNDS = 10
#: Number of edges between the contact and the eliminated part.
_MARGIN = 2
#: A round is taken whole if the work of the residual at its end is at most this share of that at its start.
_SEARCHED = 0.1
#: Shares of a round at which the work is evaluated.
_SHARES = np.concatenate([[0.0], np.geomspace(1.0e-3, 0.1, 9), np.linspace(0.15, 1.0, 18)])
_WHOLE = np.array([0.0, 1.0])


@dataclass(frozen=True)
class _Place:
    """Point reached in the rounds: trailing unknowns and tractions ``at`` them. The residual without contact is there
    ``begun`` times its value before the step, less the force of the tractions ``balanced``."""

    unknowns: Array
    at: PointTractions
    begun: float
    balanced: PointTractions


class StepSettling:
    """Settles one Newton step from a state; ``band``: stiffness without contact, whose diagonal may be raised."""

    def __init__(self, sides: OneSidedBlocks, state: SolverState, band: Array, contact: LinearContact) -> None:
        self._sides, self._state, self._band, self._contact = sides, state, band, contact
        self._solid = contact.solid
        self._still = contact.at(np.zeros_like(state.x))
        self._first = contact.begins(self._still)

    def step(self) -> Array | None:
        """Newton step (size,); None if the linear model is not definite or its points do not settle.

        With held limits there always is a step: the diagonal is raised until the model is definite, and even an
        unsettled step lowers the energy. If the contact has ``unsettled``, an unsettled step is accepted, too.
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
        """Step (size,) with the edges before ``edge`` free of contact; None if not settled or the band was raised."""
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
        """Status settled one point after another from the start of the step, along the line to the tractions ``after``
        to which ``status`` leads; None if that fails."""
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
        """Trailing unknowns of the linear model for one status; None, with the band raised, if it is not definite."""
        begun = self._contact.under(status, self._still)
        both, one_sided = self._contact.blocks(status, begun)
        push = self._contact.force(begun)
        # The symmetric part is factorised once for its definiteness, and where there is no other.
        if first_round or one_sided is None:
            there = system.solve_definite(push, both)
            if there is None:
                full = self._solid.faces.outer.added(self._band, [both])
                lift = downhill(self._state, full, self._state.inner + push).lift
                self._band[0] += lift
                if lift:
                    return None
            elif one_sided is None:
                return there
        return system.solve(push, both if one_sided is None else both + one_sided)

    def _advanced(self, system: ContactSystem, here: _Place, there: _Place) -> tuple[_Place, bool]:
        """End ``there`` of a round and True, or the point on the way where the work of the residual is 0, and False."""
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
        """Nodal displacement (n_nodes, 2) with the given trailing unknowns; all others are 0."""
        whole = np.zeros(self._solid.size)
        whole[-unknowns.size :] = unknowns
        return self._solid.expand(whole)


_MOST = 24
#: A full step that leaves at most this share of the residual is taken without a search. The energy with held traction
#: limits is not that of sliding points: searching by it alone halved steps close to a solution.
_BALANCES = 0.5
#: Number of rounds in which it is settled which points keep sliding.
SETTLING = 6


@dataclass(frozen=True)
class HeldState:
    """A state with friction: energy, ``residual`` (size,), force ``scale`` include friction, ``pull`` (size,) is it."""

    state: SolverState
    touch: ContactEvaluation
    points: FrictionPoints
    term: FrictionTerm
    energy: float
    residual: Array
    pull: Array
    scale: float


@dataclass(frozen=True)
class SlidingResult:
    """A converged state with friction, and the number of Newton steps."""

    held: HeldState
    iterations: int


class FrictionSolver:
    """Solver of one step with friction; ``scene`` is that at the step's end, without friction."""

    def __init__(self, scene: SolidScene, step: FrictionStep, sides: OneSidedBlocks) -> None:
        self.scene, self.step, self.sides = scene, step, sides
        self.solid = scene.solid

    def minimise(
        self, x: Array, kept: Array | None = None, max_iterations: int = _MOST
    ) -> SlidingResult | NewtonFailure:
        """Equilibrium near x (n_nodes, 2): the converged state, or the failure with its reason.

        More than ``max_iterations`` steps are taken only while each of them halves the residual.

        kept: signs of slip (n_edges, n_points) of the points in the first step, see `LinearContact`.
        """
        state = evaluate(self.scene, x)
        if state is None:
            return NewtonFailure("the starting guess turns the wall inside out")
        here, left, share, iteration = self.hold(state), np.inf, 1.0, 0
        while True:
            size = float(np.linalg.norm(here.residual))
            energy_scale = here.state.local.energy + here.scale * self.solid.wall
            if left <= GAIN * energy_scale and (
                size <= RESIDUAL * here.scale or (share > STALLED and size <= rounding(self.scene, here.state))
            ):
                return SlidingResult(here, iteration)
            if iteration >= max_iterations and share > _BALANCES:
                return NewtonFailure(f"residual {size / here.scale:.1e} after {iteration} iterations", iteration)
            step = self.direction(here, kept if iteration == 0 else None)
            slope = float(step @ here.residual)
            if slope >= 0.0:
                step = self._held_step(here)
                slope = float(step @ here.residual)
            if not np.isfinite(slope) or slope >= 0.0:
                return NewtonFailure(f"the Newton step does not go downhill (slope {slope:.2e})", iteration)
            moved = self._search(here, step, slope)
            if moved is None:
                return NewtonFailure("no step along the Newton direction lowers the energy", iteration)
            share = float(np.linalg.norm(moved.residual)) / max(size, 1.0e-300)
            here, left = moved, -slope * share**2
            iteration += 1

    def hold(self, state: SolverState) -> HeldState:
        """The evaluated ``state`` with friction at its points."""
        assert state.touch is not None
        points = self.step.at(state.x, state.touch)
        term = self.step.held(self.solid, points)
        pull = self.solid.faces.push(self.step.force(points.traction, points.slope))
        scale = state.scale + float(np.linalg.norm(pull)) + 10.0 * term.noise / RESIDUAL
        energy = state.energy + term.energy(state.x)
        return HeldState(state, state.touch, points, term, energy, state.residual + pull, pull, scale)

    def direction(self, here: HeldState, kept: Array | None = None) -> Array:
        """Newton step (size,): which points touch, stick and slide is settled inside the linear model; where that fails
        with the consistent tangent, the friction limits are held fixed."""
        band = tangent(self.scene, here.state)
        for model in (replace(self._linear(here, False), kept=kept), self._linear(here, True)):
            step = StepSettling(self.sides, here.state, band, model).step()
            if step is not None and np.isfinite(step).all():
                break
        assert step is not None
        return step

    def _linear(self, here: HeldState, held: bool) -> LinearContact:
        return LinearContact(self.solid, self.step, here.touch, here.points, held)

    def _held_step(self, here: HeldState) -> Array:
        """Newton step (size,) of the energy with the traction limits held: always a descent direction."""
        stick = here.term.at(here.state.x).blocks
        assert stick is not None
        band = self.solid.faces.outer.added(full_tangent(self.scene, here.state), [stick])
        return downhill(here.state, band, here.residual).step

    def reached(self, held: HeldState) -> ContactSystem:
        """System of wall, filling and touching points, without friction and loads; unknowns that the contact does not
        reach are eliminated."""
        touching = touched(PointTractions(held.touch.traction, held.points.traction))
        first = self.sides.first_unknown(int(touching[0])) if touching.size else 0
        band = full_tangent(self.scene, held.state)
        return ContactSystem(self.sides, band, held.state, np.zeros(self.solid.size), first)

    def by_height(self, held: HeldState, system: ContactSystem, down: float) -> tuple[Array, float, float]:
        """Rate of the unknowns (size,), force on the plate and its rate, by the plate's height along the path; system:
        from `reached` at this state; down: 1 while the plate comes down, -1 while it goes up.

        Points that slid in the step keep sliding if that lengthens their slip path; else they stick.
        """
        solid, step, touch, points = self.solid, self.step, held.touch, held.points
        contact, slope, secant = solid.contact, held.touch.slope, held.points.secant
        normal = np.where(touch.traction > 0.0, -contact.stiffness, 0.0)
        slid = np.where(points.sliding, np.sign(points.slip), 0.0)
        sign = slid
        for _ in range(SETTLING):
            sticking = (points.sticking | points.sliding) & (sign == 0.0)
            follow, stick = step.rate(sign, slope), np.where(sticking, step.stiffness, 0.0)
            load = contact.force(normal, slope) + step.force(follow * normal - stick * slope / secant, slope)
            both, one_sided = step.stick(sticking, slope), step.slide(points.traction, touch, sign)
            move = system.whole(system.solve(solid.faces.push(load), both if one_sided is None else both + one_sided))
            nodes = solid.expand(move)
            r, z = contact.positions(nodes)
            pressing = normal * (1.0 + slope * r - z)
            slips = step.change(nodes, slope) - slope / secant
            turning = slope * touch.curve / secant**2 * r
            bears = step.rate(slid, slope) * (pressing + touch.traction * turning)
            on = np.where(sign == 0.0, down * slid * (bears - step.stiffness * slips) > 0.0, down * slid * slips < 0.0)
            if (np.where(on, slid, 0.0) == sign).all():
                break
            sign = np.where(on, slid, 0.0)
        along = stick * slips + np.where(sign == 0.0, 0.0, bears)
        turned = points.traction * touch.curve / secant**3 * r
        force = float(np.vdot(contact.weight, touch.traction + points.traction * slope / secant))
        return move, force, float(np.vdot(contact.weight, pressing + along * slope / secant + turned))

    def _search(self, here: HeldState, step: Array, slope: float) -> HeldState | None:
        """State at the end of a full step if it balances the forces better, else from a line search by the energy with
        friction held; None if no step lowers that energy."""
        move = self.solid.expand(step)
        state = here.state
        noise = 1.0e-13 * (abs(here.energy) + state.local.energy + self.solid.wall)

        def trial(share: float) -> tuple[float, Callable[[], HeldState]] | None:
            there = whole if share == 1.0 else evaluate(self.scene, state.x + share * move)
            if there is None:
                return None
            return there.energy + here.term.energy(there.x) - here.energy, lambda: self.hold(there)

        whole = evaluate(self.scene, state.x + move)
        if whole is not None:
            held = self.hold(whole)
            if float(np.linalg.norm(held.residual)) <= _BALANCES * float(np.linalg.norm(here.residual)):
                return held
        return line_search(trial, step, slope, noise)
