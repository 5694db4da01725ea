"""Bringing the plate down on one branch, and how the branch ends."""

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.solid.continuation import DISSIPATION, LONGEST, PathFollower, PlateState, lost_work
from pneutouch.mechanics.solid.errors import NoConvergenceError
from pneutouch.mechanics.solid.newton import NewtonFailure, minimise

#: Position of a jump, in R0.
JUMP_WITHIN = 5.0e-4
#: How far past a stall a second equilibrium is first looked for, in R0.
_BEYOND_STALL = 3.5e-3
_MOST_TRIES = 40
#: How often, with friction, the end of a suspect step is tried again from half way: in most presses that is enough.
_RETRIES = 2
#: Two equilibria whose positions differ by more than this, in R0, are two.
_APART = 1.0e-3
#: How often the wall's speed grows at least over three states that run into a limit point.
_GROWS = 2.0


@dataclass(frozen=True)
class PathJump:
    """Plate height (R0) of the last state before the path breaks off, and why."""

    kind: str
    height: float
    why: str


def descend(follower: PathFollower, height: float) -> PathJump | None:
    """Continue the path to `height`: None, or the jump that ended it; the path then ends before the jump."""
    if not follower.here.stable:
        return PathJump("unstable", follower.here.height, "the state itself is unstable with its gas shut in")
    while follower.left(height) > 1.0e-12:
        before = follower.here
        if before.friction is not None:
            # Cut steps that try the rest of the travel again and again cost far more than bisection.
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
    """Bisect between the last sound state and a height where the next one is not sound, or is not found; None if that
    height is reached on one branch after all.

    A suspect height may prove sound when approached in shorter steps, so the last bracket is repeated in short steps.
    """
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
    """A solver that failed is no evidence of another branch: search a little further before naming the end; None if
    the path goes on soundly there, as it may behind a height where friction lets go of a point.

    With friction the search is by no energy and often finds nothing: there the end is read from the path itself.
    """
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
    """The jump of a path whose newest states run into a limit point; None if they do not."""
    if not _turns_back(path):
        return None
    here = path[-1]
    why = f"the wall moves {_speed(here):.0f} times as far as the object, and the path turns back"
    return PathJump(_kind(here, here.by_height), here.height, f"{why}; {_place(here, here.by_height)}")


def _turns_back(path: list[PlateState]) -> bool:
    """True if the last three states run into a limit point.

    Near one the wall's speed grows with the inverse root of the distance that is left: its inverse square falls evenly
    to nothing (Seydel 2010, Practical Bifurcation and Stability Analysis, sec. 2.2, doi:10.1007/978-1-4419-1740-9).
    """
    if len(path) < 3:
        return False
    height = np.array([state.height for state in path[-3:]])
    left = np.array([_speed(state) for state in path[-3:]]) ** -2.0
    if (np.diff(left) >= 0.0).any() or left[0] < _GROWS**2 * left[-1]:
        return False
    ends = height[1:] - left[1:] * np.diff(height) / np.diff(left)
    return bool((np.abs(ends - height[-1]) <= (_BEYOND_STALL, JUMP_WITHIN)).all())


def _speed(state: PlateState) -> float:
    """Largest travel of the wall over that of the object."""
    return float(np.linalg.norm(state.by_height, axis=1).max())


def _stays_away(here: PlateState, other: PlateState) -> bool:
    """True if the wall stays in another equilibrium of lower energy once the plate is moved back: a jump."""
    back = minimise(here.scene, other.state.x)
    if isinstance(back, NewtonFailure):
        return False
    moved = float(np.abs(back.state.x - here.state.x).max())
    return moved > _APART and back.state.energy < here.state.energy


def _jump(path: list[PlateState], after: PlateState) -> PathJump:
    here = path[-1]
    return PathJump(_kind(here, after.state.x - here.state.x), here.height, _describe(path, after))


def _kind(here: PlateState, move: Array) -> str:
    """clamp_fold where the wall moves most, by (n_nodes, 2), within a wall of its clamp, else snap."""
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
