"""Path following with friction and harmonics: the object comes down, and can then move sideways.

It moves sideways in the plane of symmetry, at the height to which it was pressed, and friction drags the wall along.
"""

from copy import copy
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.events import DETAIL, OBJECT_EDGE
from pneutouch.mechanics.harmonic.friction import SurfaceFriction, SurfacePoints, tangents
from pneutouch.mechanics.harmonic.friction_settling import SurfaceFrictionSolver
from pneutouch.mechanics.harmonic.object_contact import HarmonicContact, X, Y, Z, upward
from pneutouch.mechanics.harmonic.surface import Surface, SurfaceHeight
from pneutouch.mechanics.solid.continuation import PlateState, descend
from pneutouch.mechanics.solid.friction import FrictionPoints
from pneutouch.mechanics.solid.friction_linear import PointTractions
from pneutouch.mechanics.solid.friction_path import FrictionFollower, approach
from pneutouch.mechanics.solid.newton import NewtonFailure

MOST_FAILED = 600
"""Number of Newton steps in a path's failed solves, together, after which it is given up: those of 25 solves, each of
which may cost more than the whole path; paths of random scenes that succeeded needed up to 288."""


@dataclass(frozen=True)
class SlidObject(Surface):
    """The object ``body`` displaced by ``travel`` along x (``sense`` 1) or -x (-1), at constant height; in R0.

    Its `height` is the travel, because `PathFollower` uses the height as path parameter.
    """

    body: Surface
    sense: float
    travel: float = 0.0

    @property
    def along(self) -> float:
        """Displacement in x, with its sign."""
        return self.sense * self.travel

    @property
    def height(self) -> float:
        """The travel, in place of the height."""
        return self.travel

    @property
    def span(self) -> tuple[float, float]:
        """Radii between which the underside belongs to the body itself, see `RigidObject.span`."""
        return self.body.span

    def at(self, height: float) -> "SlidObject":
        """The object after the travel ``height``."""
        return replace(self, travel=height)

    def distance(self, x: Array, y: Array) -> Array:
        """Distance of points from the axis of the displaced body."""
        return self.body.distance(x - self.along, y)

    def over(self, x: Array, y: Array) -> SurfaceHeight:
        """Underside of the displaced body at points x, y, arrays of one shape."""
        return self.body.over(x - self.along, y)


class SurfaceFrictionFollower(FrictionFollower):
    """A `FrictionFollower` for a wall with harmonics; ``height`` is the height of the object, or its travel."""

    _plate: Surface
    #: Newton steps of the path's failed solves.
    _failed = 0

    @property
    def plate(self) -> Surface:
        """The object at the beginning of the path."""
        return self._plate

    @property
    def _contact(self) -> HarmonicContact:
        contact = self._solid.contact
        assert isinstance(contact, HarmonicContact)
        return contact

    @property
    def _drift(self) -> Array:
        """Derivative (3,) of the object's position by the path parameter."""
        return np.array([self._plate.sense, 0.0, 0.0] if isinstance(self._plate, SlidObject) else [0.0, 0.0, 1.0])

    def slid(self, sense: float) -> Self:
        """Follower of the object's sideways motion from the last state on, towards +x, or -x if ``sense`` is -1; the
        path parameter is the travel, and all points stick at first."""
        other, here = copy(self), self.here
        other._plate, other.down, other._failed = SlidObject(self._plate.at(here.height), sense), -1.0, 0
        other.path = [replace(here, height=0.0)]
        other.path = [other._stuck()]
        return other

    @property
    def given_up(self) -> str | None:
        """Reason why no more solves are tried after a failure; None: they are tried."""
        if self._failed < MOST_FAILED:
            return None
        return f"solves failed again and again, in {self._failed} Newton steps together"

    def solve(self, height: float) -> PlateState | NewtonFailure:
        """State at a path parameter, or the failure, whose Newton steps are counted; the path is not changed."""
        solved = super().solve(height)
        if isinstance(solved, NewtonFailure):
            self._failed += solved.iterations
        return solved

    def _solver(self, height: float, rest: Array) -> SurfaceFrictionSolver:
        plate = self._plate.at(height)
        along = plate.along if isinstance(plate, SlidObject) else 0.0
        step = SurfaceFriction(
            self._contact, plate, self._coefficient, rest, self._stiffness, along=along, drift=self._drift
        )
        return SurfaceFrictionSolver(replace(self._bare, plate=plate), step, self._sides)

    def _towards(self, height: float) -> SurfaceFrictionSolver:
        """Solver of the step to a path parameter; with harmonics it begins with tractions predicted by the path."""
        solver = super()._towards(height)
        assert isinstance(solver, SurfaceFrictionSolver)
        if self.here.state.x.shape[1] > 2:
            solver.foreseen = self._foreseen(height)
        return solver

    def _foreseen(self, height: float) -> PointTractions | None:
        """Tractions predicted at a path parameter with the last state's rates; None without rates or contact there."""
        here = self.here
        touch = here.state.touch
        assert touch is not None and here.friction is not None
        points, touching = here.friction.points, touch.traction > 0.0
        begun = len(self.path) > 1 or isinstance(self._plate, SlidObject)
        if not begun or not touching.any():
            return None
        gone = (self._contact.points(here.by_height) - self._drift) * (height - here.height)
        opening = -np.einsum("...i,...i->...", upward(touch.slope), gone)
        along = np.einsum("...ij,...j->...i", tangents(touch.slope), gone)
        normal = -self._contact.stiffness * (touch.gap + opening)
        trial = points.traction + here.friction.stiffness * along
        return PointTractions(normal, np.where(touching[..., None], trial, 0.0))

    def _places(self, x: Array) -> Array:
        """Wall points (x, y) at ``x`` relative to the object's last place, (n_edges, n_points, n_angles, 2)."""
        along = self._plate.at(self.here.height).along if isinstance(self._plate, SlidObject) else 0.0
        return self._contact.points(x)[..., :Z] - [along, 0.0]

    def _signs(self) -> None:
        """No signs of slip: a point that comes into contact does not take over the direction of a neighbour's slip."""
        return

    def _ahead(self, height: float) -> Array:
        """Predicted places (x, y) relative to the object of wall points at a path parameter, or where they touch
        before, as in `FrictionFollower`."""
        here, travel = self.here, height - self.here.height
        place = self._places(here.state.x)
        touch = here.state.touch
        if len(self.path) < 2 or touch is None:
            return place
        gone = self._contact.points(here.by_height) - self._drift
        closing = -np.einsum("...i,...i->...", upward(touch.slope), gone) * travel
        return np.asarray(place + approach(touch.gap, closing)[..., None] * gone[..., :Z] * travel)


def held_back(state: PlateState) -> Array | float:
    """Friction tractions (x, y, z) at a state, (n_edges, n_points, n_angles, 3); 0 without friction."""
    if state.friction is None:
        return 0.0
    points = state.friction.points
    assert isinstance(points, SurfacePoints)
    return points.load


STEPS = 10
"""Number of equal steps of the travel at which states are returned."""

ENDED_BEFORE = "the press ended before its depth"


@dataclass(frozen=True)
class ShearState:
    """One equilibrium; mm, N, MPa.

    travel: of the object along x.  force, sideways, moment: as in `press.OffAxisState`.  rise: pressure above the
    driving pressure.  sliding: share of the vertical tractions at points that slid in the step to this state; for the
    first state, in the last step of the press.  positions: coefficients, see `fields.Harmonics`.
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
    """States at equal steps of the travel, from the end of the press on; none after an incomplete press.

    stiffness: initial slope, N/mm, of the sideways force over the travel, with all points sticking; None without
    states. slips_from: travel of the first solved state at which all points slide; None: some stick. ended: reason why
    the path ended early; None if it did not."""

    states: list[ShearState]
    stiffness: float | None
    slips_from: float | None
    ended: str | None

    @property
    def peak(self) -> float | None:
        """Greatest sideways force against the travel, N, with its sign; None with fewer than two states."""
        if len(self.states) < 2:
            return None
        sense = np.sign(self.states[-1].travel)
        return float(min(sense * s.sideways for s in self.states)) * float(sense)

    def column(self, name: str) -> Array:
        """The field ``name`` of every state, (n_states,)."""
        return np.array([getattr(s, name) for s in self.states])


def not_sheared() -> ShearPath:
    """A path without states, after a press that ended before its depth."""
    return ShearPath([], None, None, ENDED_BEFORE)


def shear(pressed: SurfaceFrictionFollower, travel: float, driving_pressure: float) -> ShearPath:
    """Path from the last state of a press while the object moves by ``travel`` along x (mm, not 0); pressure in MPa."""
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
    """Share of ``load`` (n_edges, n_points, n_angles) carried by sliding points, exactly 1 if none sticks."""
    if not points.sticking.any():
        return 1.0
    return float(load[points.sliding].sum()) / float(load.sum())


class _ShearRecorder:
    """Converts the solver's states to mm, N and MPa."""

    def __init__(self, follower: SurfaceFrictionFollower, driving_pressure: float) -> None:
        self._solid, self._driving = follower.here.scene.solid, driving_pressure
        plate = follower.plate
        assert isinstance(plate, SlidObject)
        self._object = plate

    def travel(self, state: PlateState) -> float:
        """Travel of the object along x at a state, mm."""
        return self._object.at(state.height).along * self._solid.length

    def state(self, state: PlateState) -> ShearState:
        """A converged state of the solver in mm, N and MPa."""
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
        """True if the contact has reached the edge of the object."""
        contact, touch = self._solid.contact, state.state.touch
        assert touch is not None and isinstance(contact, HarmonicContact)
        place = contact.points(state.state.x)[touch.traction > 0.0]
        far = self._object.at(state.height).distance(place[:, X], place[:, Y]).max(initial=0.0)
        return bool(far > self._object.span[1])
