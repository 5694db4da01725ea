"""The object moves sideways at the height that it was pressed to, in the plane of symmetry, and friction takes the wall
along."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.harmonic.contact import HarmonicContact, X, Y
from pneutouch.mechanics.harmonic.friction_path import SlidObject, SurfaceFrictionFollower, held_back
from pneutouch.mechanics.solid.continuation import PlateState
from pneutouch.mechanics.solid.descend import descend
from pneutouch.mechanics.solid.events import DETAIL, OBJECT_EDGE
from pneutouch.mechanics.solid.friction import FrictionPoints

STEPS = 10
"""Equal steps of the travel at which states are returned."""

ENDED_BEFORE = "the press ended before its depth"


@dataclass(frozen=True)
class ShearState:
    """One equilibrium; mm, N, MPa.

    travel: of the object along x.  force, sideways, moment: as of `press.OffAxisState`.  rise: of the pressure over the
    driving one.  sliding: share of the vertical tractions at points that slid in the step to here; of the first state
    in the last step of the press.  positions: coefficients, see `fields.Harmonics`.
    """

    travel: float
    force: float
    sideways: float
    moment: float
    rise: float
    sliding: float
    positions: Array


@dataclass(frozen=True)
class ShearPath:
    """States at equal steps of the travel, from the end of the press on.

    stiffness: initial slope of the force against the travel, with all points sticking, N/mm.  slips_from: travel of the
    first solved state at which all points slide, or None.  ended: why the path ended before the whole travel, or None.
    """

    states: list[ShearState]
    stiffness: float | None
    slips_from: float | None
    ended: str | None

    @property
    def peak(self) -> float | None:
        """Sideways force where it is greatest against the travel, N; None without states."""
        if len(self.states) < 2:
            return None
        sense = np.sign(self.states[-1].travel)
        return float(min(sense * s.sideways for s in self.states)) * float(sense)

    def column(self, name: str) -> Array:
        """One field of every state, (n_states,)."""
        return np.array([getattr(s, name) for s in self.states])


def not_sheared() -> ShearPath:
    """A path without states, after a press that ended before its depth."""
    return ShearPath([], None, None, ENDED_BEFORE)


def shear(pressed: SurfaceFrictionFollower, travel: float, driving_pressure: float) -> ShearPath:
    """Move the object of a press from its newest state by a travel along x (mm, not zero); pressure in MPa."""
    length = pressed.here.scene.solid.length
    follower = pressed.slid(float(np.sign(travel)))
    recorder = _ShearRecorder(follower, driving_pressure)
    solved, ended = [recorder.state(follower.here)], None
    for k in range(1, STEPS + 1):
        begun = len(follower.path)
        jump = descend(follower, abs(travel) / length * k / STEPS)
        for state in follower.path[begun:]:
            if recorder.beyond_edge(state):
                ended = f"{DETAIL[OBJECT_EDGE]}, at {recorder.travel(state):.3g} mm"
                break
            solved.append(recorder.state(state))
        if ended is None and jump is not None:
            ended = f"{jump.kind} at {recorder.travel(follower.here):.3g} mm: {jump.why}"
        if ended is not None:
            break
    step = abs(travel) / STEPS
    at_steps = [s for s in solved if abs(abs(s.travel) / step - round(abs(s.travel) / step)) < 1.0e-9]
    slides = (s.travel for s in solved[1:] if s.sliding == 1.0)
    first = follower.path[0]
    return ShearPath(at_steps, -first.stiffness * first.scene.solid.mu * length, next(slides, None), ended)


def _share(load: Array, points: FrictionPoints) -> float:
    """Share of a load that sliding points bear, exactly 1 where none sticks."""
    if not points.sticking.any():
        return 1.0
    return float(load[points.sliding].sum()) / float(load.sum())


class _ShearRecorder:
    """Turns solver states into dimensional ones."""

    def __init__(self, follower: SurfaceFrictionFollower, driving_pressure: float) -> None:
        self._solid, self._driving = follower.here.scene.solid, driving_pressure
        plate = follower.plate
        assert isinstance(plate, SlidObject)
        self._object = plate

    def travel(self, state: PlateState) -> float:
        """Travel along x, mm."""
        return self._object.at(state.height).along * self._solid.length

    def state(self, state: PlateState) -> ShearState:
        """Reported figures of one converged state."""
        contact, touch, friction = self._solid.contact, state.state.touch, state.friction
        assert touch is not None and friction is not None and isinstance(contact, HarmonicContact)
        length, mu = self._solid.length, self._solid.mu
        (sideways, _, force), moment = contact.resultant(state.state.x, touch, held_back(state))
        load = contact.weight * touch.traction
        return ShearState(
            travel=self.travel(state),
            force=force * mu * length**2,
            sideways=sideways * mu * length**2,
            moment=moment[1] * mu * length**3,
            rise=state.state.filling.pressure * mu - self._driving,
            sliding=_share(load, friction.points),
            positions=state.state.x * length,
        )

    def beyond_edge(self, state: PlateState) -> bool:
        """True if the contact has come to the edge of the object."""
        contact, touch = self._solid.contact, state.state.touch
        assert touch is not None and isinstance(contact, HarmonicContact)
        place = contact.points(state.state.x)[touch.traction > 0.0]
        far = self._object.at(state.height).distance(place[:, X], place[:, Y]).max(initial=0.0)
        return bool(far > self._object.span[1])
