"""Newton's method for one step of a contact with friction.

The tangent is the consistent one, which is not symmetric where points slide: the paper's press at coefficient 0.3 takes
59 Newton steps with it (61 without friction), and with the symmetric tangent of held normal tractions it has not come
half way after 739. The line search goes by the energy with the largest tractions held as they are where it begins
(`friction.FrictionTerm`), whose gradient there is the residual.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.solid.contact import ContactEvaluation
from pneutouch.mechanics.solid.friction import FrictionPoints, FrictionStep, FrictionTerm
from pneutouch.mechanics.solid.friction_linear import LinearContact
from pneutouch.mechanics.solid.friction_settling import StepSettling
from pneutouch.mechanics.solid.friction_status import PointTractions, touched
from pneutouch.mechanics.solid.friction_system import ContactSystem
from pneutouch.mechanics.solid.general_band import OneSidedBlocks
from pneutouch.mechanics.solid.line_search import line_search
from pneutouch.mechanics.solid.newton import (
    GAIN,
    RESIDUAL,
    NewtonFailure,
    SolidScene,
    SolverState,
    downhill,
    evaluate,
    full_tangent,
    tangent,
)

_MOST = 24
#: A full step that leaves no more than this share of the residual is taken without a search. The energy with the
#: largest tractions held is not that of points that slide: by it alone, steps next to a solution were cut by half.
_BALANCES = 0.5
#: Rounds in which is settled which points slide on.
SETTLING = 6


@dataclass(frozen=True)
class HeldState:
    """A state of the scene with friction at its points; residual: of both (size,); scale: of the forces in it."""

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
    """A converged state."""

    held: HeldState
    iterations: int


class FrictionSolver:
    """Solves the steps of one scene's path; ``scene`` without friction."""

    def __init__(self, scene: SolidScene, step: FrictionStep, sides: OneSidedBlocks) -> None:
        self.scene, self.step, self.sides = scene, step, sides
        self.solid = scene.solid

    def minimise(
        self, x: Array, kept: Array | None = None, max_iterations: int = _MOST
    ) -> SlidingResult | NewtonFailure:
        """Equilibrium near x (n_nodes, 2). Returns the state, or why there is none; never an unconverged state.

        More than ``max_iterations`` steps are taken only where each of them halves the residual.

        kept: signs of slip (n_edges, n_points) of the points in the first step, see `friction_settling`.
        """
        state = evaluate(self.scene, x)
        if state is None:
            return NewtonFailure("the starting guess turns the wall inside out")
        here, left, halved, iteration = self.hold(state), np.inf, False, 0
        while True:
            size = float(np.linalg.norm(here.residual))
            if size <= RESIDUAL * here.scale and left <= GAIN * self._energy_scale(here):
                return SlidingResult(here, iteration)
            if iteration >= max_iterations and not halved:
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
            here, left, halved = moved, -slope * share**2, share <= _BALANCES
            iteration += 1

    def hold(self, state: SolverState) -> HeldState:
        """Friction at an evaluated state."""
        assert state.touch is not None
        points = self.step.at(state.x, state.touch)
        term = self.step.held(self.solid, points)
        pull = self.solid.push(self.step.force(points.traction, points.slope))
        scale = state.scale + float(np.linalg.norm(pull)) + 10.0 * term.noise / RESIDUAL
        energy = state.energy + term.energy(state.x)
        return HeldState(state, state.touch, points, term, energy, state.residual + pull, pull, scale)

    def _energy_scale(self, here: HeldState) -> float:
        return here.state.local.energy + here.scale * self.solid.wall

    def direction(self, here: HeldState, kept: Array | None = None) -> Array:
        """Newton step (size,): which points touch, stick and slide is settled inside the linear model; with the largest
        tractions held where the consistent one is not definite or does not settle."""
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
        """Newton step (size,) of the energy with the largest tractions held: downhill always."""
        stick = here.term.at(here.state.x).blocks
        assert stick is not None
        band = self.solid.contact_pattern.added(full_tangent(self.scene, here.state), [stick])
        return downhill(here.state, band, here.residual).step

    def reached(self, held: HeldState) -> ContactSystem:
        """Wall, filling and the points that touch, without friction; unknowns that the contact does not reach are
        eliminated."""
        touching = touched(PointTractions(held.touch.traction, held.points.traction))
        first = self.sides.first_unknown(int(touching[0])) if touching.size else 0
        band = full_tangent(self.scene, held.state)
        return ContactSystem(self.sides, band, held.state, np.zeros(self.solid.size), first)

    def by_height(self, held: HeldState, system: ContactSystem, down: float) -> tuple[Array, float, float]:
        """Rate of the unknowns (size,), force on the plate and its rate, by the plate's height where it goes on;
        system: `reached` there; down: 1 while the plate comes down, -1 while it goes up.

        Points that slid in the step slide on where that lengthens their path, else they stick.
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
            move = system.whole(system.solve(solid.push(load), both if one_sided is None else both + one_sided))
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
        """The state at the end of a step that balances the forces better, else of a line search by the energy with
        friction held; None if no step lowers it."""
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
