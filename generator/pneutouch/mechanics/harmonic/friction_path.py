"""Follows a branch of equilibria under an object in space that holds the wall by friction: down, then sideways."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.harmonic.contact import HarmonicContact, Z, upward
from pneutouch.mechanics.harmonic.friction import SurfaceFriction, SurfacePoints, tangents
from pneutouch.mechanics.harmonic.friction_settling import SurfaceFrictionSolver
from pneutouch.mechanics.harmonic.surface import Surface, SurfaceHeight
from pneutouch.mechanics.solid.continuation import PlateState
from pneutouch.mechanics.solid.friction_path import FrictionFollower, approach
from pneutouch.mechanics.solid.friction_status import PointTractions
from pneutouch.mechanics.solid.newton import NewtonFailure

MOST_FAILED = 600
"""Newton steps of failed solves after which a path is not continued past another one: 25 solves without an end, each of
which may cost more than the whole path; sound paths of random scenes needed up to 288."""


@dataclass(frozen=True)
class SlidObject(Surface):
    """A surface that has moved by ``travel`` along x, backwards where ``sense`` is -1, at its height.

    Its `height` is the travel: what `PathFollower` follows a path by.
    """

    body: Surface
    sense: float
    travel: float = 0.0

    @property
    def along(self) -> float:
        """Distance that it has moved in x."""
        return self.sense * self.travel

    @property
    def height(self) -> float:
        """The travel."""
        return self.travel

    @property
    def span(self) -> tuple[float, float]:
        """Radii between which the underside is the body's own, see `RigidObject.span`."""
        return self.body.span

    def at(self, height: float) -> SlidObject:
        """This body after another travel."""
        return replace(self, travel=height)

    def distance(self, x: Array, y: Array) -> Array:
        """Distance from the axis of the body."""
        return self.body.distance(x - self.along, y)

    def over(self, x: Array, y: Array) -> SurfaceHeight:
        """The body's underside at points of any one shape."""
        return self.body.over(x - self.along, y)


class SurfaceFrictionFollower(FrictionFollower):
    """A `FrictionFollower` of a wall with harmonics."""

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
        """Velocity of the object along its path."""
        return np.array([self._plate.sense, 0.0, 0.0] if isinstance(self._plate, SlidObject) else [0.0, 0.0, 1.0])

    def slid(self, sense: float) -> Self:
        """A follower of the object that moves sideways from the newest state on, towards x or, where ``sense`` is -1,
        away from it; the path is by the travel, and all points stick at first."""
        other, here = copy(self), self.here
        other._plate, other.down, other._failed = SlidObject(self._plate.at(here.height), sense), -1.0, 0
        other.path = [replace(here, height=0.0)]
        other.path = [other._stuck()]
        return other

    @property
    def given_up(self) -> str | None:
        """Reason why no further solves are tried after a failure, or None."""
        if self._failed < MOST_FAILED:
            return None
        return f"solves failed again and again, in {self._failed} Newton steps together"

    def solve(self, height: float) -> PlateState | NewtonFailure:
        """State at a place of the path ahead; not kept."""
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
        """The solver of the step to a place of the path, with the tractions that the path leads to."""
        solver = super()._towards(height)
        assert isinstance(solver, SurfaceFrictionSolver)
        if self.here.state.x.shape[1] > 2:
            solver.foreseen = self._foreseen(height)
        return solver

    def _foreseen(self, height: float) -> PointTractions | None:
        """Tractions at a place of the path ahead, at the rates of the newest state; None from first contact on."""
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
        """Positions of the points of the wall now, (x, y) from the object, (n_edges, n_points, n_angles, 2)."""
        along = self._plate.at(self.here.height).along if isinstance(self._plate, SlidObject) else 0.0
        return self._contact.points(x)[..., :Z] - [along, 0.0]

    def _signs(self) -> None:
        """Forget the directions of slip: a point that comes to touch does not take its neighbour's."""
        return

    def _ahead(self, height: float) -> Array:
        """Positions at a place of the path ahead, or those at which points will touch before it, as in the solid."""
        here, travel = self.here, height - self.here.height
        place = self._places(here.state.x)
        touch = here.state.touch
        if len(self.path) < 2 or touch is None:
            return place
        gone = self._contact.points(here.by_height) - self._drift
        closing = -np.einsum("...i,...i->...", upward(touch.slope), gone) * travel
        return np.asarray(place + approach(touch.gap, closing)[..., None] * gone[..., :Z] * travel)


def held_back(state: PlateState) -> Array | float:
    """Tractions of friction in space at a state, (n_edges, n_points, n_angles, 3); 0 without friction."""
    if state.friction is None:
        return 0.0
    points = state.friction.points
    assert isinstance(points, SurfacePoints)
    return points.load
