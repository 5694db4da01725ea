"""Path following with friction while the plate comes down or goes up: each accepted state stores the places at which
its points stick, and every step, including a cut or repeated one, starts from these places."""

from dataclasses import replace
from typing import Self

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.solid.continuation import PathFollower, PlateState
from pneutouch.mechanics.solid.elements import Supply, TermState
from pneutouch.mechanics.solid.friction import TANGENTIAL, FrictionState, FrictionStep
from pneutouch.mechanics.solid.friction_newton import FrictionSolver, SlidingResult
from pneutouch.mechanics.solid.friction_system import OneSidedBlocks
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import NewtonFailure, NoConvergenceError, SolidScene, evaluate, stability
from pneutouch.mechanics.solid.object_contact import Indenter

#: Coefficient used for a surface that grips. A point about to leave, with a normal traction a hundredth of the
#: tangential one, is released gradually: with an infinite coefficient it would neither stay nor leave. The paper's
#: presses have the same sensitivities as with an infinite coefficient to five digits.
GRIP = 100.0
#: Share of its present speed that a free point keeps on average until it is held: next to the edge of a held zone the
#: speed grows with the square root of the distance, as at a crack tip, and the distance closes linearly.
_KEPT_SPEED = 2.0 / 3.0


class FrictionFollower(PathFollower):
    """A `PathFollower` with friction between plate and wall; ``coefficient`` is inf for a surface that grips."""

    def __init__(self, solid: SolidModel, supply: Supply, plate: Indenter, start: Array, coefficient: float) -> None:
        self._sides = OneSidedBlocks(solid)
        self._coefficient = min(coefficient, GRIP)
        self._stiffness = TANGENTIAL * solid.contact.stiffness
        super().__init__(solid, supply, plate, start)

    def _first(self, scene: SolidScene, start: Array) -> PlateState:
        self._bare = scene
        solver = self._solver(self._plate.height, self._places(start))
        solved = solver.minimise(start)
        if isinstance(solved, NewtonFailure):
            raise NoConvergenceError("first contact", solved.why, "a finer mesh")
        return friction_plate_state(solver, solved, None)

    def feed(self, supply: Supply) -> None:
        """Replace what fills the cavity as in `PathFollower.feed`; the places of rest are unchanged."""
        super().feed(supply)
        self._bare = replace(self._bare, supply=supply)

    def _solver(self, height: float, rest: Array) -> FrictionSolver:
        plate = self._plate.at(height)
        step = FrictionStep(self._solid.contact, plate, self._coefficient, rest, self._stiffness)
        return FrictionSolver(replace(self._bare, plate=plate), step, self._sides)

    def turned(self) -> Self:
        """A follower that starts at the last state in the opposite direction, with all points sticking at first."""
        other = super().turned()
        other.path = [other._stuck()]
        return other

    def _stuck(self) -> PlateState:
        """The last state, with the rates by height that it has if all touching points stick."""
        here = self.here
        assert here.friction is not None
        solver = self._solver(here.height, _known(here.friction.rest, self._places(here.state.x)))
        state = evaluate(solver.scene, here.state.x)
        assert state is not None
        held = solver.hold(state)
        touching, none = held.points.sticking | held.points.sliding, np.zeros_like(held.points.sliding)
        held = replace(held, points=replace(held.points, sticking=touching, sliding=none))
        move, force, stiffness = solver.by_height(held, solver.reached(held), self.down)
        rate = -state.filling.rate * float(state.by_volume @ move)
        by_height = self._solid.expand(move)
        return replace(here, force=force, by_height=by_height, stiffness=stiffness, pressure_rate=rate)

    def _places(self, x: Array) -> Array:
        """Radii (n_edges, n_points) of the points of the wall at positions x (n_nodes, 2)."""
        return self._solid.contact.positions(x)[0]

    def solve(self, height: float) -> PlateState | NewtonFailure:
        """State at `height`, solved from extrapolated positions, or the failure; the path is not changed."""
        solver = self._towards(height)
        kept = self._signs() if len(self.path) > 1 else None
        guess = self._extrapolate(height)
        solved = solver.minimise(guess, kept)
        # If a step fails for another reason, it also fails from the last state, in twice the time.
        if isinstance(solved, NewtonFailure) and evaluate(solver.scene, guess) is None:
            solved = solver.minimise(self.here.state.x, kept)
        if isinstance(solved, NewtonFailure):
            return solved
        return friction_plate_state(solver, solved, self.here, self.down)

    def _towards(self, height: float) -> FrictionSolver:
        """The solver of the step to a height."""
        assert self.here.friction is not None
        return self._solver(height, _known(self.here.friction.rest, self._ahead(height)))

    def _signs(self) -> Array | None:
        """Signs of slip (n_edges, n_points) at the last state; a point without contact takes the sign of the next
        touching one towards the clamp, and beyond the contact that of its edge."""
        assert self.here.friction is not None
        points = self.here.friction.points
        sign = np.where(points.sliding, np.sign(points.slip), 0.0)
        touching = np.flatnonzero(points.sticking | points.sliding)
        if touching.size == 0:
            return sign
        last = np.searchsorted(touching, np.arange(sign.size), side="right") - 1
        return np.asarray(sign.ravel()[touching[np.maximum(last, 0)]].reshape(sign.shape))

    def _ahead(self, height: float) -> Array:
        """Radii (n_edges, n_points) at which points touch, or will on the way to `height`. Outside the contact's edge
        the gap grows with the square of the distance; the wall slows down linearly to the point where it is held."""
        here = self.here
        assert here.state.touch is not None
        contact, touch = self._solid.contact, here.state.touch
        r, _ = contact.positions(here.state.x)
        if len(self.path) > 1:
            rate_r, rate_z = contact.positions(here.by_height)
            travel = height - here.height
            closing = (1.0 + touch.slope * rate_r - rate_z) * travel
            r = r + approach(touch.gap, closing) * rate_r * travel
        return np.asarray(r)


def approach(gap: Array, closing: Array) -> Array:
    """Share of its present speed that a point keeps on average over a step in which it is held once its ``gap`` is
    closed; ``closing`` is the change of the gap in the step at the present speed; arrays of one shape."""
    closes = closing < 0.0
    share = np.where(closes, np.clip(-2.0 * gap / np.where(closes, closing, -1.0), 0.0, 1.0), 1.0)
    return np.asarray(_KEPT_SPEED * share)


def _known(rest: Array, place: Array) -> Array:
    """Places of rest, with ``place`` where a point has none (NaN)."""
    return np.where(np.isnan(rest), place, rest)


def friction_plate_state(
    solver: FrictionSolver, solved: SlidingResult, before: PlateState | None, down: float = 1.0
) -> PlateState:
    """Converged state with friction, its force and the path's tangent; ``before`` is None at first contact."""
    held, step, points = solved.held, solver.step, solved.held.points
    past = None if before is None else before.friction
    friction = FrictionState.after(past, step, held.state.x, points)
    term = held.term.at(held.state.x)
    there = TermState(friction.stored, term.gradient, term.blocks, around=term.around)
    state = replace(
        held.state,
        energy=held.state.energy + friction.stored,
        residual=held.residual,
        inner=held.state.inner + held.pull,
        scale=held.scale,
        terms=(*held.state.terms, there),
    )
    scene = replace(solver.scene, terms=(*solver.scene.terms, held.term))
    system = solver.reached(held)
    move, force, stiffness = solver.by_height(held, system, down)
    assert term.blocks is not None
    rate = -state.filling.rate * float(state.by_volume @ move)
    return PlateState(
        height=step.plate.height,
        state=state,
        scene=scene,
        iterations=solved.iterations,
        force=force,
        stiffness=stiffness,
        by_height=solver.solid.expand(move),
        pressure_rate=rate,
        stable=system.definite(term.blocks) or stability(scene, state).stable,
        friction=friction,
    )
