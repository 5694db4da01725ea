"""Path following of one branch of equilibria as the plate comes down, and the search for the branch's end.

Each step extrapolates, solves, checks stability, and is cut if it fails. Plate also stands for any other object.
"""

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Self

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.solid.elements import Supply
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import (
    NewtonFailure,
    NewtonResult,
    NoConvergenceError,
    SolidScene,
    SolverState,
    minimise,
    stability,
)
from pneutouch.mechanics.solid.object_contact import Indenter

if TYPE_CHECKING:
    from pneutouch.mechanics.solid.friction import FrictionState

#: Longest plate travel in one solve, in R0: longer steps can land on another branch.
LONGEST = 0.06
_SHORTEST = 1.0e-4
#: Accuracy, as a share, of the work of the first step, where contact begins at a point.
_FIRST_STEP = 0.06
#: A step that loses more than this share of a full step's work has left its branch.
DISSIPATION = 0.01


@dataclass(frozen=True)
class PlateState:
    """A converged state under the plate at `height`; all nondimensional (R0, mu).

    force: on the plate.  stiffness: dF/dheight (negative).  by_height: dx/dheight, (n_nodes, 2).  pressure_rate:
    dp/dheight.  stable: the total tangent is positive definite.  friction: None for contact without friction.
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
    friction: "FrictionState | None" = None


def plate_state(scene: SolidScene, state: SolverState, height: float, iterations: int) -> PlateState:
    """Record of a converged state, with its force and the path's tangent. Raises ValueError without a plate."""
    solid, touch = scene.solid, state.touch
    if touch is None:
        raise ValueError("a state under the plate needs a plate")
    contact = solid.contact
    active = np.where(touch.traction > 0.0, -contact.stiffness, 0.0)
    tangent = stability(scene, state, solid.faces.push(contact.force(active, touch.slope)))
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
    """Energy lost between the last state of a path and `after`, as a share of the plate's work in a full step.

    It is near 0 along one branch, where d(energy)/d(height) = -force; dissipation by friction is no loss. The trapezium
    rule for the work is corrected by the curvature of the force through three states; in the first step by the slope at
    its end, and `_FIRST_STEP` is taken off the share, because this is less accurate."""
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
    # A jump releases the same energy in a step of any length, so a short step is compared with the work of a full one.
    share = lost / (max(1.0, LONGEST / abs(travel)) * (abs(work) + floor))
    return max(0.0, share - allowance)


Guides = Sequence[Sequence[PlateState]]  # Solved paths of similar domes.


class PathFollower:
    """The states of a path, and steps to further plate heights, from first contact on; heights in R0.

    ``guides``: at most two paths of domes on the same cells, the more similar first: extrapolation errs alike there.
    """

    #: 1 while the plate comes down, -1 while it goes up.
    down = 1.0

    def __init__(self, solid: SolidModel, supply: Supply, plate: Indenter, start: Array, guides: Guides = ()) -> None:
        self._solid, self._plate, self._guides = solid, plate, guides
        self.path = [self._first(SolidScene(solid, supply, plate), start)]

    def _first(self, scene: SolidScene, start: Array) -> PlateState:
        """State at first contact, solved near positions `start` (n_nodes, 2). Raises NoConvergenceError."""
        solved = minimise(scene, start)
        if isinstance(solved, NewtonFailure):
            raise NoConvergenceError("first contact", solved.why, "a finer mesh")
        return plate_state(scene, solved.state, self._plate.height, solved.iterations)

    @property
    def here(self) -> PlateState:
        """The last state of the path."""
        return self.path[-1]

    @property
    def given_up(self) -> str | None:
        """Reason why no more solves are tried after a failure; None: they are tried."""
        return None

    def feed(self, supply: Supply) -> None:
        """Replace what fills the cavity; the last state stays as it is, and the next one is solved with `supply`."""
        self.path[-1] = replace(self.here, scene=replace(self.here.scene, supply=supply))

    def left(self, height: float) -> float:
        """Travel (R0) from the last state to a height; negative if the path is already past that height."""
        return self.down * (self.here.height - height)

    def turned(self) -> Self:
        """A new follower that starts at the last state and moves the plate in the opposite direction."""
        other = copy(self)
        other.path, other.down = [self.here], -self.down
        return other

    def step(self, height: float) -> PlateState:
        """Add a state at `height` or, by a shorter step, before it, and return it. Raises NoConvergenceError."""
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
        """State at `height`, solved from an extrapolated guess, or the failure; the path is not changed."""
        scene = replace(self.here.scene, plate=self._plate.at(height))
        solved = self._least(scene, self._turning(height) + self._expected_miss(height))
        if isinstance(solved, NewtonFailure):
            solved = minimise(scene, self.here.state.x)
        if isinstance(solved, NewtonFailure):
            return solved
        return plate_state(scene, solved.state, height, solved.iterations)

    def _least(self, scene: SolidScene, x: Array) -> NewtonResult | NewtonFailure:
        """State of least energy near positions x (n_nodes, 2), or the failure."""
        return minimise(scene, x)

    def _expected_miss(self, height: float) -> Array | float:
        """Displacements (n_nodes, 2) by which extrapolation will fall short: that of the first guide, and the share of
        its difference from the second that fits the last step best; 0 without a guide that has this step."""
        ahead, here = len(self.path), self.here
        same = [path for path in self._guides if ahead < len(path) and path[0].state.x.shape == here.state.x.shape]
        travel = here.height - height
        guides = [path for path in same if abs(path[ahead - 1].height - path[ahead].height - travel) < 1.0e-9]
        if not guides:
            return 0.0
        expected = self._miss(guides[0], ahead)
        if len(guides) < 2 or ahead < 2:
            return expected
        mine, first, second = (self._miss(path, ahead - 1) for path in (self.path, *guides))
        share = np.vdot(mine - first, first - second) / max(float(np.linalg.norm(first - second)) ** 2, 1.0e-300)
        return np.asarray(expected + np.clip(share, -1.0, 2.0) * (expected - self._miss(guides[1], ahead)))

    def _miss(self, path: Sequence[PlateState], number: int) -> Array:
        """Displacements (n_nodes, 2) by which the extrapolation of a path to its state ``number`` fell short."""
        before = copy(self)
        before.path = [*path[:number]]
        return np.asarray(path[number].state.x - before._turning(path[number].height))

    def _extrapolate(self, height: float) -> Array:
        """Positions extrapolated along the path's tangent; at first contact those of the last state."""
        if len(self.path) < 2 and self.down > 0.0:
            return self.here.state.x
        return np.asarray(self.here.state.x + (height - self.here.height) * self.here.by_height)

    def _turning(self, height: float) -> Array:
        """Positions extrapolated to second order; along the tangent if the next step is over twice as long as the last
        or there are fewer than three states. Not used with friction."""
        guess = self._extrapolate(height)
        if len(self.path) < 3 or height == self.here.height:
            return guess
        before, ahead = self.path[-2], height - self.here.height
        past = self.here.height - before.height
        if 2.0 * past / ahead < 1.0:
            return guess
        return np.asarray(guess + 0.5 * ahead**2 / past * (self.here.by_height - before.by_height))


#: Accuracy to which a jump is located, in R0.
JUMP_WITHIN = 5.0e-4
#: Distance beyond a stall at which a second equilibrium is first searched, in R0.
_BEYOND_STALL = 3.5e-3
_MOST_TRIES = 40
#: Number of times that, with friction, the end of a suspect step is tried again from half way; mostly sufficient.
_RETRIES = 2
#: Two equilibria whose positions differ by more than this, in R0, are distinct.
_APART = 1.0e-3
#: Least growth factor of the wall's speed over three states that approach a limit point.
_GROWS = 2.0


@dataclass(frozen=True)
class PathJump:
    """End of a path: its kind as in `SolidEvent`, the plate height (R0) of the last state before it, and the reason."""

    kind: str
    height: float
    why: str


def descend(follower: PathFollower, height: float) -> PathJump | None:
    """Continue the path to `height` (R0); returns None, or the jump before which the path ends."""
    if not follower.here.stable:
        return PathJump("unstable", follower.here.height, "the state itself is unstable with its gas shut in")
    while follower.left(height) > 1.0e-12:
        before = follower.here
        if before.friction is not None:
            # Cut steps that try the remaining travel again and again cost far more than bisection.
            end = before.height - follower.down * min(follower.left(height), LONGEST)
            ahead = follower.solve(end)
            if not isinstance(ahead, NewtonFailure) and _sound(follower.path, ahead):
                follower.path.append(ahead)
                continue
        else:
            try:
                end = follower.step(height).height
            except NoConvergenceError as failure:
                return PathJump("lost", before.height, failure.why)
            after = follower.path.pop()
            if _sound(follower.path, after):
                follower.path.append(after)
                continue
        jump = _close_in(follower, end)
        if jump is not None:
            return jump
    return None


def _sound(path: list[PlateState], after: PlateState) -> bool:
    return after.stable and lost_work(path, after) <= DISSIPATION


def _close_in(follower: PathFollower, end: float) -> PathJump | None:
    """Bisect between the last sound state and the height ``end``, where the state is not sound or not found; returns
    the jump, or None if the path reaches ``end`` on one branch after all.

    A state may be sound when it is approached in shorter steps, so the last bracket is repeated in short steps."""
    begun = follower.here
    beyond: PlateState | NewtonFailure = NewtonFailure("no equilibrium follows without a jump")
    bad, tried_from_here = end, False
    retries = _RETRIES if follower.here.friction is not None else 0
    for _ in range(_MOST_TRIES):
        here = follower.here
        closed = follower.left(bad) <= JUMP_WITHIN
        if closed and tried_from_here:
            break
        if follower.given_up is not None:
            return _limit_point(follower.path) or PathJump("lost", here.height, follower.given_up)
        again = retries > 0 and not tried_from_here and here is not begun
        retries -= again
        height = bad if closed or again else 0.5 * (here.height + bad)
        other = follower.solve(height)
        if isinstance(other, NewtonFailure) or not _sound(follower.path, other):
            beyond, bad, tried_from_here = other, height, True
            continue
        follower.path.append(other)
        if follower.left(end) <= 1.0e-12:
            return None
        bad, tried_from_here = end if closed or again else bad, False
    if isinstance(beyond, NewtonFailure):
        return _past_a_stall(follower, end, beyond)
    return _jump(follower.path, beyond)


def _past_a_stall(follower: PathFollower, end: float, stalled: NewtonFailure) -> PathJump | None:
    """End of a path at a failed solve, which by itself does not show another branch: the states a little beyond decide.
    None if the path continues soundly there, as it may after a height at which friction releases a point.

    With friction there is no energy to minimise, and often nothing is found: a limit point is tried first."""
    here = follower.here
    if here.friction is not None and (turn := _limit_point(follower.path)) is not None:
        return turn
    for further in (1, 2, 4, 8):
        other = follower.solve(here.height - follower.down * further * _BEYOND_STALL)
        if isinstance(other, NewtonFailure):
            continue
        if _sound(follower.path, other):
            if further * _BEYOND_STALL < follower.left(end):
                follower.path.append(other)
                return None
        elif _stays_away(here, other):
            return _jump(follower.path, other)
    return PathJump("lost", here.height, stalled.why)


def _limit_point(path: list[PlateState]) -> PathJump | None:
    """Jump of a path whose last states approach a limit point; None if they do not."""
    if not _turns_back(path):
        return None
    here = path[-1]
    why = f"the wall moves {_speed(here):.0f} times as far as the object, and the path turns back"
    return PathJump(_kind(here, here.by_height), here.height, f"{why}; {_place(here, here.by_height)}")


def _turns_back(path: list[PlateState]) -> bool:
    """True if the last three states approach a limit point.

    Near it the wall's speed grows with the inverse square root of the distance left, so its inverse square falls
    linearly to 0 (Seydel 2010, Practical Bifurcation and Stability Analysis, 2.2, doi:10.1007/978-1-4419-1740-9)."""
    if len(path) < 3:
        return False
    height = np.array([state.height for state in path[-3:]])
    left = np.array([_speed(state) for state in path[-3:]]) ** -2.0
    if (np.diff(left) >= 0.0).any() or left[0] < _GROWS**2 * left[-1]:
        return False
    ends = height[1:] - left[1:] * np.diff(height) / np.diff(left)
    return bool((np.abs(ends - height[-1]) <= (_BEYOND_STALL, JUMP_WITHIN)).all())


def _speed(state: PlateState) -> float:
    """Greatest speed of a wall node relative to that of the object."""
    return float(np.linalg.norm(state.by_height, axis=1).max())


def _stays_away(here: PlateState, other: PlateState) -> bool:
    """True if, with the plate moved back to ``here``, the wall of ``other`` stays apart with less energy: a jump."""
    back = minimise(here.scene, other.state.x)
    if isinstance(back, NewtonFailure):
        return False
    moved = float(np.abs(back.state.x - here.state.x).max())
    return moved > _APART and back.state.energy < here.state.energy


def _jump(path: list[PlateState], after: PlateState) -> PathJump:
    here = path[-1]
    return PathJump(_kind(here, after.state.x - here.state.x), here.height, _describe(path, after))


def _kind(here: PlateState, move: Array) -> str:
    """Kind of a jump: clamp_fold if the node that moves most is within a wall thickness of the clamp, else snap."""
    solid = here.scene.solid
    moved = solid.rest[np.linalg.norm(move, axis=1).argmax()]
    held = solid.rest[solid.mesh.clamped]
    near = held.size > 0 and np.linalg.norm(held - moved, axis=1).min() < solid.wall
    return "clamp_fold" if near else "snap"


def _place(here: PlateState, move: Array) -> str:
    r, z = here.scene.solid.mesh.nodes[np.linalg.norm(move, axis=1).argmax()]
    return f"the wall point at rest at r {r:.2f}, z {z:.2f} mm moves most"


def _describe(path: list[PlateState], after: PlateState) -> str:
    place = _place(after, after.state.x - path[-1].state.x)
    if not after.stable:
        return f"the tangent has a negative mode; {place}"
    share = 100.0 * lost_work(path, after)
    change = 100.0 * (after.force / max(path[-1].force, 1.0e-300) - 1.0)
    return f"the force changes by {change:.1f} % at once and {share:.0f} % of a step's work is lost; {place}"
