"""A plate that comes down with friction and goes up again: the loop that friction alone makes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.solid.continuation import PlateState, descend
from pneutouch.mechanics.solid.indent import PressSettings, follower_of
from pneutouch.mechanics.solid.inflate import FreeState, first_touch
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.viscous.runs import hysteresis


@dataclass(frozen=True)
class LoopBranch:
    """One direction of a loop: indentation (mm), contact force (N), pressure rise (MPa), all (n_states,) in the order
    of the travel, and the work of the plate in it (N mm), negative while it goes up."""

    indentation: Array
    force: Array
    rise: Array
    work: float


@dataclass(frozen=True)
class FrictionLoop:
    """A press and its release.

    dissipated: what friction turned to heat, N mm, summed point by point.  ended: why the press or the release stopped
    before its end, or None; a press that stopped is released from where it stopped.
    """

    loading: LoopBranch
    unloading: LoopBranch
    dissipated: float
    ended: str | None

    @property
    def lost_share(self) -> float:
        """Work that the plate does not get back, over the work that it did."""
        return (self.loading.work + self.unloading.work) / self.loading.work

    def hysteresis(self) -> tuple[float, float]:
        """Both usual measures of the pressure rise over the force, see `response.hysteresis`."""
        there, back = self.loading, self.unloading
        return hysteresis(there.force, there.rise, back.force, back.rise)


def friction_loop(solid: SolidModel, free: FreeState, press: PressSettings) -> FrictionLoop:
    """Bring the plate down to the depth of a press in its steps and up again to first contact, the gas shut in.

    Points of the wall stick, slide back and are released as they are; nothing but friction loses work. Raises
    NoConvergenceError only if not even first contact has an equilibrium.
    """
    touch = first_touch(solid, free, press.body, press.plate_diameter, press.plate_rim)
    top, depth = touch.body.height, press.depth / solid.length
    follower, jump = follower_of(solid, free, press, touch), None
    for share in np.arange(1, press.steps + 1) / press.steps:
        jump = jump or descend(follower, top - depth * float(share))
    deepest = top - follower.here.height
    back, jump_back = follower.turned(), None
    for share in np.arange(press.steps - 1, -1, -1) / press.steps:
        jump_back = jump_back or descend(back, top - deepest * float(share))
    spent = sum(s.friction.dissipated for s in (*follower.path[1:], *back.path[1:]) if s.friction is not None)
    ended = [f"{one.kind}: {one.why}" for one in (jump, jump_back) if one is not None]
    return FrictionLoop(
        _branch(solid, free, top, follower.path),
        _branch(solid, free, top, back.path),
        spent * solid.mu * solid.length**3,
        "; ".join(ended) or None,
    )


def _branch(solid: SolidModel, free: FreeState, top: float, path: list[PlateState]) -> LoopBranch:
    length, mu = solid.length, solid.mu
    travel = np.array([top - s.height for s in path]) * length
    force = np.array([s.force for s in path]) * mu * length**2
    rise = np.array([s.state.filling.pressure for s in path]) * mu - free.pressure
    slope = -np.array([s.stiffness for s in path]) * mu * length
    if len(path) < 2:
        return LoopBranch(travel, force, rise, 0.0)
    span = np.diff(travel)
    if force[0] < 1.0e-9 * force.max():
        # The stiffness at first contact is that of a point.
        slope[0] = 2.0 * (force[1] - force[0]) / span[0] - slope[1]
    work = 0.5 * span * (force[1:] + force[:-1]) - span**2 / 12.0 * np.diff(slope)
    return LoopBranch(travel, force, rise, float(work.sum()))
