"""Bringing the plate down on one branch, and how the branch ends."""

from dataclasses import dataclass

import numpy as np

from pneutouch.mechanics.solid.continuation import DISSIPATION, PathFollower, PlateState, lost_work
from pneutouch.mechanics.solid.errors import NoConvergenceError
from pneutouch.mechanics.solid.newton import NewtonFailure, minimise

#: Position of a jump, in R0.
JUMP_WITHIN = 5.0e-4
#: How far past a stall a second equilibrium is first looked for, in R0.
_BEYOND_STALL = 3.5e-3
_MOST_TRIES = 40
#: Two equilibria whose positions differ by more than this, in R0, are two.
_APART = 1.0e-3


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
        try:
            after = follower.step(height)
        except NoConvergenceError as failure:
            return PathJump("lost", before.height, failure.why)
        if _sound(follower.path[:-1], after):
            continue
        jump = _close_in(follower, after.height)
        if jump is not None:
            return jump
    return None


def _sound(path: list[PlateState], after: PlateState) -> bool:
    return after.stable and lost_work(path, after) <= DISSIPATION


def _close_in(follower: PathFollower, end: float) -> PathJump | None:
    """Bisect between the last sound state and a suspect one; None if the end is reached on one branch after all.

    A suspect height may prove sound when approached in shorter steps, so the last bracket is repeated in short steps.
    """
    follower.path.pop()
    beyond: PlateState | NewtonFailure = NewtonFailure("no equilibrium follows without a jump")
    bad, tried_from_here = end, False
    for _ in range(_MOST_TRIES):
        here = follower.here
        closed = follower.left(bad) <= JUMP_WITHIN
        if closed and tried_from_here:
            break
        height = bad if closed else 0.5 * (here.height + bad)
        other = follower.solve(height)
        if isinstance(other, NewtonFailure) or not _sound(follower.path, other):
            beyond, bad, tried_from_here = other, height, True
            continue
        follower.path.append(other)
        if follower.left(end) <= 1.0e-12:
            return None
        bad, tried_from_here = end if closed else bad, False
    if isinstance(beyond, NewtonFailure):
        return _past_a_stall(follower, beyond)
    return PathJump(_kind(follower.here, beyond), follower.here.height, _describe(follower.path, beyond))


def _past_a_stall(follower: PathFollower, stalled: NewtonFailure) -> PathJump:
    """A solver that failed is no evidence of another branch: search a little further before naming the end."""
    for further in (1, 2, 4, 8):
        other = follower.solve(follower.here.height - follower.down * further * _BEYOND_STALL)
        if (
            not isinstance(other, NewtonFailure)
            and not _sound(follower.path, other)
            and _stays_away(follower.here, other)
        ):
            return PathJump(_kind(follower.here, other), follower.here.height, _describe(follower.path, other))
    return PathJump("lost", follower.here.height, stalled.why)


def _stays_away(here: PlateState, other: PlateState) -> bool:
    """Whether the wall stays in another equilibrium of lower energy once the plate is moved back: a jump."""
    back = minimise(here.scene, other.state.x)
    if isinstance(back, NewtonFailure):
        return False
    moved = float(np.abs(back.state.x - here.state.x).max())
    return moved > _APART and back.state.energy < here.state.energy


def _kind(here: PlateState, beyond: PlateState) -> str:
    """clamp_fold where the wall moves most within a wall of its clamp, else snap."""
    solid = here.scene.solid
    moved = solid.rest[np.linalg.norm(beyond.state.x - here.state.x, axis=1).argmax()]
    held = solid.rest[solid.mesh.clamped]
    near = held.size > 0 and np.linalg.norm(held - moved, axis=1).min() < solid.wall
    return "clamp_fold" if near else "snap"


def _describe(path: list[PlateState], after: PlateState) -> str:
    solid = after.scene.solid
    r, z = solid.mesh.nodes[np.linalg.norm(after.state.x - path[-1].state.x, axis=1).argmax()]
    place = f"the wall point at rest at r {r:.2f}, z {z:.2f} mm moves most"
    if not after.stable:
        return f"the tangent has a negative mode; {place}"
    share = 100.0 * lost_work(path, after)
    change = 100.0 * (after.force / max(path[-1].force, 1.0e-300) - 1.0)
    return f"the force changes by {change:.1f} % at once and {share:.0f} % of a step's work is lost; {place}"
