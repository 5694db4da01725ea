"""Coulomb friction of a wall without rotational symmetry: the solid's law with two directions along the surface.

A spring holds each point in the tangent plane of the object; its traction is limited to the coefficient times the
normal traction. Tractions and slips have two components along `tangents`; n is the number of nodes of an edge.
"""

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.mechanics.harmonic.object_contact import HarmonicContact, X, Y, Z, upward
from pneutouch.mechanics.harmonic.surface import Surface
from pneutouch.mechanics.solid.elements import TermState
from pneutouch.mechanics.solid.friction import FrictionPoints, FrictionStep, FrictionTerm
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.object_contact import ContactEvaluation


def tangents(slope: Array) -> Array:
    """Two perpendicular unit tangents (..., 2, 3) of a surface with slopes (..., 2) by x and y, the first in the plane
    of x and z."""
    by_x, by_y = slope[..., X], slope[..., Y]
    first, secant, none = np.hypot(1.0, by_x), secants(slope), np.zeros_like(by_x)
    along = np.stack([1.0 / first, none, by_x / first], axis=-1)
    across = np.stack([-by_x * by_y / first, first, by_y / first], axis=-1) / secant[..., None]
    return np.stack([along, across], axis=-2)


def secants(slope: Array) -> Array:
    """Ratio of surface area to projected area for slopes (..., 2)."""
    return np.asarray(np.sqrt(1.0 + np.einsum("...i,...i->...", slope, slope)))


def lengths(vectors: Array) -> Array:
    """Lengths (...) of vectors (..., 2)."""
    return np.hypot(vectors[..., 0], vectors[..., 1])


def directions(vectors: Array) -> Array:
    """Unit vectors along vectors (..., 2); zero for zero vectors."""
    size = lengths(vectors)[..., None]
    return np.divide(vectors, size, out=np.zeros_like(vectors), where=size > 0.0)


def clipped(trial: Array, cap: Array) -> Array:
    """Tractions ``trial`` (..., 2), shortened to the length ``cap`` (...) where they are longer."""
    size = lengths(trial)
    share = np.divide(cap, size, out=np.ones_like(size), where=size > cap)
    return np.asarray(trial * share[..., None])


def springs(sticking: Flags, direction: Array, turn: Array) -> Array:
    """Derivative of the traction by the slip, over the spring's stiffness, (..., 2, 2), symmetric.

    direction: (..., 2), direction of the traction of sliding points, else zero. turn: (...), limit of a sliding point's
    traction over the traction without limit: the share of the spring's stiffness left across the direction.
    """
    kept = np.where(sticking, 1.0, np.where(direction.any(axis=-1), turn, 0.0))
    across = np.where(sticking, 0.0, turn)[..., None, None] * direction[..., :, None] * direction[..., None, :]
    return kept[..., None, None] * np.eye(2) - across


@dataclass(frozen=True)
class SurfacePoints(FrictionPoints):
    """Friction at points and angles of the outer wall: ``traction`` and ``slip`` (n_edges, n_points, n_angles, 2) along
    `tangents`; ``slope`` of the same shape, by x and y; the other fields of `FrictionPoints` without the last axis. A
    traction is positive along its tangent where the spring pulls the wall back."""

    @property
    def secant(self) -> Array:
        """Ratio of surface area to projected area."""
        return secants(self.slope)

    @property
    def pull(self) -> Array:
        """Magnitude of the traction."""
        return lengths(self.traction)

    @property
    def travel(self) -> Array:
        """Length of the slip."""
        return lengths(self.slip)

    def path(self, past: FrictionPoints) -> Array:
        """Part of the slip in the direction of the traction in ``past``."""
        return np.asarray(np.einsum("...i,...i->...", directions(past.traction), self.slip))

    @property
    def direction(self) -> Array:
        """Traction direction of sliding points; zero for other points."""
        return np.where(self.sliding[..., None], directions(self.slip), 0.0)

    @property
    def load(self) -> Array:
        """Tractions as vectors (x, y, z), (..., 3)."""
        return in_space(self.traction, self.slope)


def in_space(vectors: Array, slope: Array) -> Array:
    """Vectors (x, y, z), (..., 3), from components (..., 2) along the `tangents` of slopes."""
    return np.asarray(np.einsum("...i,...ij->...j", vectors, tangents(slope)))


@dataclass(frozen=True)
class SurfaceFriction(FrictionStep):
    """Friction for one position of the object, displaced by ``along`` in x: ``rest`` (n_edges, n_points, n_angles, 2)
    are the places (x, y) relative to the object at which the points rest or will first touch.

    drift: (3,), derivative of the object's position by the path parameter.
    """

    contact: HarmonicContact
    plate: Surface
    along: float
    drift: Array

    def slip(self, x: Array, slope: Array) -> Array:
        """Displacement of the points at coefficients x from their places of rest, along `tangents` of ``slope``."""
        at = self.rest + np.array([self.along, 0.0])
        height = self.plate.over(at[..., X], at[..., Y]).height
        gone = self.contact.points(x) - np.concatenate([at, height[..., None]], axis=-1)
        return np.asarray(np.einsum("...ij,...j->...i", tangents(slope), gone))

    def change(self, move: Array, slope: Array) -> Array:
        """Change of `slip` by a displacement of the coefficients (n_nodes, columns)."""
        return np.asarray(np.einsum("...ij,...j->...i", tangents(slope), self.contact.points(move)))

    def cap(self, traction: Array, slope: Array) -> Array:
        """Largest tangential traction for given vertical tractions per area at rest; 0 without contact."""
        return self.coefficient * np.maximum(traction, 0.0) * secants(slope)

    def at(self, x: Array, touch: ContactEvaluation) -> SurfacePoints:
        """Friction at coefficients x (n_nodes, columns) by return mapping; ``touch`` is the contact there."""
        cap, slip = self.cap(touch.traction, touch.slope), self.slip(x, touch.slope)
        trial = self.stiffness * slip
        touching = touch.traction > 0.0
        sliding = touching & (lengths(trial) > cap)
        return SurfacePoints(clipped(trial, cap), cap, touch.slope, slip, touching & ~sliding, sliding)

    def turn(self, points: FrictionPoints) -> Array:
        """Share of the spring's stiffness that a sliding point keeps across its slip; 0 for other points."""
        trial = self.stiffness * points.travel
        return np.divide(points.cap, trial, out=np.zeros_like(trial), where=points.sliding)

    def force(self, traction: Array, slope: Array) -> Array:
        """Gradient of the energy by outer edges (n_edges, n * columns) for tractions along the surface."""
        return self.contact.load_forces(in_space(traction, slope))

    def spring_form(self, slope: Array, sticking: Flags, direction: Array, turn: Array) -> Array:
        """Symmetric derivative of the tractions in space by the positions, (..., 3, 3), see `springs`."""
        frame = tangents(slope)
        held = self.stiffness * springs(sticking, direction, turn)
        return np.asarray(np.matmul(np.swapaxes(frame, -1, -2), np.matmul(held, frame)))

    def sliding_form(self, load: Array, touch: ContactEvaluation, direction: Array) -> Array | None:
        """Unsymmetric part of the derivative, (..., 3, 3): the traction of sliding points (nonzero ``direction``, (...,
        2)) follows the normal traction, and the friction traction ``load`` (..., 3) of all points turns with the
        surface. None if no point slides and the surface is flat."""
        touching = touch.traction > 0.0
        bent = bool((touch.curve.any(axis=(-1, -2)) & touching).any())
        if not (direction.any() or bent):
            return None
        normal, secant = upward(touch.slope), secants(touch.slope)[..., None]
        by_place = secant * self.contact.stiffness * normal
        steeper = np.einsum("...i,...ij->...j", touch.slope, touch.curve)
        by_place[..., :Z] += touch.traction[..., None] * steeper / secant
        form = self.coefficient * in_space(direction, touch.slope)[..., :, None] * by_place[..., None, :]
        if bent:
            turned = np.einsum("...i,...ij->...j", load[..., :Z], touch.curve) / secant**2
            form[..., :Z] += normal[..., :, None] * turned[..., None, :]
        return form

    def held(self, solid: SolidModel, points: FrictionPoints) -> FrictionTerm:
        """Friction as an energy term, with the traction limits and slopes held at those of ``points``."""
        return SurfaceFrictionTerm(solid, self, points)

    def moved(self, x: Array, points: FrictionPoints) -> Array:
        """Places (x, y), relative to the object, at which the points rest after the step; NaN without contact."""
        assert isinstance(points, SurfacePoints)
        place = self.contact.points(x)[..., :Z] - points.load[..., :Z] / self.stiffness - [self.along, 0.0]
        sliding, sticking = points.sliding[..., None], points.sticking[..., None]
        return np.where(sliding, place, np.where(sticking, self.rest, np.nan))


class SurfaceFrictionTerm(FrictionTerm):
    """Friction with the traction limits and the slopes held: the pseudo-potential of a step, as in `FrictionTerm`."""

    step: SurfaceFriction

    def energy(self, x: Array) -> float:
        """Energy stored in the springs, plus the traction limit times the slip beyond the limit, mu R0^3."""
        trial = self.step.stiffness * self.step.slip(x, self.held.slope)
        bears = clipped(trial, self.held.cap)
        work = np.einsum("...i,...i->...", bears, trial - 0.5 * bears)
        return float(np.vdot(self.step.contact.weight, work)) / self.step.stiffness

    def at(self, x: Array) -> TermState:
        """Energy and its derivatives at coefficients x (n_nodes, columns)."""
        cap, slope = self.held.cap, self.held.slope
        trial = self.step.stiffness * self.step.slip(x, slope)
        size = lengths(trial)
        sliding = (cap > 0.0) & (size > cap)
        turn = np.divide(cap, size, out=np.zeros_like(cap), where=sliding)
        direction = np.where(sliding[..., None], directions(trial), 0.0)
        form = self.step.spring_form(slope, (cap > 0.0) & ~sliding, direction, turn)
        force = self.step.force(clipped(trial, cap), slope)
        return TermState(self.energy(x), self.solid.faces.push(force), self.step.contact.form_blocks(form))
