"""Follows one branch of equilibria as the plate comes down: predictor, solution, stability, cutback."""

from copy import copy
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.solid.errors import NoConvergenceError
from pneutouch.mechanics.solid.friction import FrictionState
from pneutouch.mechanics.solid.indenter import Indenter
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import NewtonFailure, NewtonResult, SolidScene, SolverState, minimise, stability
from pneutouch.mechanics.solid.supply import Supply

#: Longest plate travel in one solve, in R0: longer steps can land on another branch.
LONGEST = 0.06
_SHORTEST = 1.0e-4
#: The work of the first step, where contact begins at a point, is only known to this share.
_FIRST_STEP = 0.06
#: A step that loses more than this share of a full step's work has left the branch it started on.
DISSIPATION = 0.01


@dataclass(frozen=True)
class PlateState:
    """A converged state under the plate at `height`; all nondimensional (R0, mu).

    force: on the plate.  stiffness: dF/dheight (negative).  by_height: dx/dheight, (n_nodes, 2).  pressure_rate:
    dp/dheight.  stable: the total tangent is positive definite.  friction: None without.
    """

    height: float
    state: SolverState
    scene: SolidScene
    iterations: int
    force: float
    stiffness: float
    by_height: Array
    pressure_rate: float
    stable: bool
    friction: FrictionState | None = None


def plate_state(scene: SolidScene, state: SolverState, height: float, iterations: int) -> PlateState:
    """Force and the tangent of the path at a converged state."""
    solid, touch = scene.solid, state.touch
    if touch is None:
        raise ValueError("a state under the plate needs a plate")
    contact = solid.contact
    active = np.where(touch.traction > 0.0, -contact.stiffness, 0.0)
    tangent = stability(scene, state, solid.push(contact.force(active, touch.slope)))
    move = solid.expand(tangent.step)
    stiffness = float(np.vdot(contact.weight * active, contact.opening(touch, move, 1.0)))
    rate = -state.filling.rate * float(tangent.step @ state.by_volume)
    force = float(np.vdot(contact.weight, touch.traction))
    return PlateState(
        height=height,
        state=state,
        scene=scene,
        iterations=iterations,
        force=force,
        stiffness=stiffness,
        by_height=move,
        pressure_rate=rate,
        stable=tangent.stable,
    )


def lost_work(path: list[PlateState], after: PlateState) -> float:
    """Energy unaccounted for from the end of a path to `after`, as a share of the plate's work in a full step.

    Near zero along one branch, since dPi/dheight = -force there; what friction dissipates is accounted for.  The
    trapezium is corrected by the curvature of the force through three states; the first step, whose force starts at
    zero, by the slope at its end, which is coarser.
    """
    here = path[-1]
    travel = here.height - after.height
    work = 0.5 * travel * (here.force + after.force)
    floor = 1.0e-6 * here.scene.solid.wall * abs(travel)
    if len(path) > 1:
        before = path[-2]
        past = before.height - here.height
        bend = ((after.force - here.force) / travel - (here.force - before.force) / past) * 2.0 / (travel + past)
        fixed = work - travel**3 * bend / 12.0
        allowance = 0.0
    else:
        fixed = work - travel * (-after.stiffness * travel - (after.force - here.force)) / 6.0
        allowance = _FIRST_STEP
    spent = 0.0 if after.friction is None else after.friction.dissipated
    lost = abs(fixed - (after.state.energy - here.state.energy) - spent)
    # A jump releases the same energy however short the step it falls in, so short steps are held to the work of a
    # full one.
    share = lost / (max(1.0, LONGEST / abs(travel)) * (abs(work) + floor))
    return max(0.0, share - allowance)


class PathFollower:
    """Keeps the states of a path and steps to new plate heights, from first contact down."""

    #: 1 while the plate comes down, -1 while it goes up.
    down = 1.0

    def __init__(self, solid: SolidModel, supply: Supply, plate: Indenter, start: Array) -> None:
        self._solid, self._plate = solid, plate
        self.path = [self._first(SolidScene(solid, supply, plate), start)]

    def _first(self, scene: SolidScene, start: Array) -> PlateState:
        """First contact, near positions `start`."""
        solved = minimise(scene, start)
        if isinstance(solved, NewtonFailure):
            raise NoConvergenceError("first contact", solved.why, "a finer mesh")
        return plate_state(scene, solved.state, self._plate.height, solved.iterations)

    @property
    def here(self) -> PlateState:
        """The newest state."""
        return self.path[-1]

    @property
    def given_up(self) -> str | None:
        """Reason why no further solves are tried after a failure, or None."""
        return None

    def feed(self, supply: Supply) -> None:
        """Fill the cavity by another supply from here on: the next state is solved with it."""
        self.path[-1] = replace(self.here, scene=replace(self.here.scene, supply=supply))

    def left(self, height: float) -> float:
        """Travel from the newest state to a height on the path ahead; negative beyond it."""
        return self.down * (self.here.height - height)

    def turned(self) -> Self:
        """A follower that starts at the newest state in the opposite direction."""
        other = copy(self)
        other.path, other.down = [self.here], -self.down
        return other

    def step(self, height: float) -> PlateState:
        """One state further along the path, at `height` or short of it where the step had to be cut; kept."""
        travel = min(self.left(height), LONGEST)
        why = ""
        shortest = min(_SHORTEST, 0.5 * travel)
        while travel > shortest:
            state = self.solve(self.here.height - self.down * travel)
            if not isinstance(state, NewtonFailure):
                self.path.append(state)
                return state
            why = state.why
            travel *= 0.35
        where = f"plate height {self.here.height * self._solid.length:.6g} mm"
        raise NoConvergenceError(where, why, "a finer mesh or a smaller depth")

    def solve(self, height: float) -> PlateState | NewtonFailure:
        """State at `height` from the extrapolated path; not kept."""
        scene = replace(self.here.scene, plate=self._plate.at(height))
        solved = self._least(scene, self._turning(height))
        if isinstance(solved, NewtonFailure):
            solved = minimise(scene, self.here.state.x)
        if isinstance(solved, NewtonFailure):
            return solved
        return plate_state(scene, solved.state, height, solved.iterations)

    def _least(self, scene: SolidScene, x: Array) -> NewtonResult | NewtonFailure:
        """Least energy near positions x ahead."""
        return minimise(scene, x)

    def _extrapolate(self, height: float) -> Array:
        """Positions ahead along the tangent of the path; at first contact, a point, there is none."""
        if len(self.path) < 2 and self.down > 0.0:
            return self.here.state.x
        return np.asarray(self.here.state.x + (height - self.here.height) * self.here.by_height)

    def _turning(self, height: float) -> Array:
        """Positions ahead where the tangent turns on as it did in the last step, if that was half the next or longer.

        With friction it does not: points stick or slide on as they last did.
        """
        guess = self._extrapolate(height)
        if len(self.path) < 3 or height == self.here.height:
            return guess
        before, ahead = self.path[-2], height - self.here.height
        past = self.here.height - before.height
        if 2.0 * past / ahead < 1.0:
            return guess
        return np.asarray(guess + 0.5 * ahead**2 / past * (self.here.by_height - before.by_height))
