"""Newton steps with friction and harmonics: touching, sticking and sliding are settled in a linear model as in `solid`.

A sliding point keeps the direction in which it was found to slide; across it, a share of its spring stiffness is left.
The directions turn from one Newton step to the next.

Tractions of contact and friction are carried from step to step as in `model`: tractions of a guess that overshoots
would give the tangent negative modes and let points slide that stick.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.mechanics.harmonic.friction import (
    SurfaceFriction,
    SurfacePoints,
    clipped,
    directions,
    in_space,
    lengths,
    secants,
)
from pneutouch.mechanics.harmonic.object_contact import Z, upward
from pneutouch.mechanics.solid.friction_linear import LinearContact, PointStatus, PointTractions
from pneutouch.mechanics.solid.friction_newton import SETTLING, FrictionSolver, HeldState
from pneutouch.mechanics.solid.friction_system import ContactSystem
from pneutouch.mechanics.solid.object_contact import ContactEvaluation


@dataclass(frozen=True)
class SurfaceStatus(PointStatus):
    """Status of points in space: ``sign`` is the direction of sliding, (..., 2), zero for a point that does not slide;
    ``turn`` is the share of its spring stiffness left across that direction."""

    turn: Array

    @property
    def sliding(self) -> Flags:
        """Mask of the points that slide."""
        return np.asarray(self.sign.any(axis=-1))

    @property
    def sticking(self) -> Flags:
        """Mask of the points that stick."""
        return np.asarray(self.bearing & ~self.sliding)

    def _reversed(self, other: "SurfaceStatus") -> Flags:
        return np.asarray(np.einsum("...i,...i->...", self.sign, other.sign) < 0.0)

    def then(self, new: PointStatus) -> "SurfaceStatus":
        """Status to try next if solving with this one gave ``new``: directions are kept; reversed points stick."""
        assert isinstance(new, SurfaceStatus)
        both, back = self.sliding & new.sliding, self._reversed(new)
        sign = np.where(both[..., None], self.sign, new.sign) * ~back[..., None]
        return replace(new, sign=sign, turn=np.where(both, self.turn, new.turn) * ~back)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, SurfaceStatus):
            return NotImplemented
        same = (self.touching == other.touching) & (self.sliding == other.sliding)
        return bool((same & ~self._reversed(other)).all())


@dataclass(frozen=True)
class SurfaceLinearContact(LinearContact):
    """Contact and friction, linear in a displacement of the coefficients; tractions along the surface (..., 2).

    foreseen: tractions that act on the curvature of the object, tried first for their status; None: the present ones.
    """

    step: SurfaceFriction
    points: SurfacePoints
    foreseen: PointTractions | None = None
    unsettled: bool = False
    #: False, because the direction of a sliding point in space may turn.
    IN_PIECES: ClassVar[bool] = False

    def at(self, move: Array) -> PointTractions:
        """Tractions after a displacement of the coefficients (n_nodes, columns)."""
        contact, touch = self.step.contact, self.touch
        return PointTractions(
            -contact.stiffness * contact.opening(touch, move, touch.gap),
            self.step.stiffness * (self.points.slip + self.step.change(move, touch.slope)),
        )

    @cached_property
    def _bent(self) -> ContactEvaluation:
        """The contact with the foreseen tractions, which act on the curvature of the object."""
        return self.touch if self.foreseen is None else replace(self.touch, traction=self._seen.normal)

    @cached_property
    def _seen(self) -> PointTractions:
        """Foreseen tractions, limited by contact and friction."""
        assert self.foreseen is not None
        normal = np.maximum(self.foreseen.normal, 0.0)
        return PointTractions(normal, clipped(self.foreseen.trial, self._grip * normal))

    def begins(self, still: PointTractions) -> SurfaceStatus:
        """Status to try first: by the foreseen tractions, else (or with held limits) by those before the step."""
        return self.status(still if self.foreseen is None or self.held else self.foreseen)

    def status(self, at: PointTractions) -> SurfaceStatus:
        """Status of the points at given tractions: touching, sticking or sliding, and the directions of sliding."""
        touching, cap, size = at.normal > 0.0, self._cap(at.normal), lengths(at.trial)
        bearing = cap > 0.0 if self.held else touching
        sliding = bearing & (size > cap)
        turn = np.divide(cap, size, out=np.zeros_like(size), where=sliding)
        return SurfaceStatus(touching, bearing, np.where(sliding[..., None], directions(at.trial), 0.0), turn)

    def under(self, status: PointStatus, at: PointTractions) -> PointTractions:
        """Tractions ``at`` as they are with a fixed status: 0 without contact, limited for sliding points."""
        assert isinstance(status, SurfaceStatus)
        normal = np.where(status.touching, at.normal, 0.0)
        cap = self.points.cap if self.held else self._grip * normal
        along = np.einsum("...i,...i->...", status.sign, at.trial)
        slides = (cap - status.turn * along)[..., None] * status.sign + status.turn[..., None] * at.trial
        return PointTractions(normal, np.where(status.sticking[..., None], at.trial, slides))

    def force(self, tractions: PointTractions) -> Array:
        """Gradient (size,) of the energy for given tractions."""
        slope = self.touch.slope
        load = tractions.normal[..., None] * upward(slope) + in_space(tractions.trial, slope)
        return self.solid.faces.push(self.step.contact.load_forces(load))

    def blocks(self, status: PointStatus, begun: PointTractions) -> tuple[Array, Array | None]:
        """Symmetric and unsymmetric stiffness under a fixed status; ``begun`` are the tractions before a move."""
        assert isinstance(status, SurfaceStatus)
        contact, touch = self.step.contact, self._bent
        held = self.step.spring_form(touch.slope, status.sticking, status.sign, status.turn)
        both = contact.hessian(touch, status.touching) + contact.form_blocks(held)
        if self.held:
            return both, None
        turns = begun.trial if self.foreseen is None else self._seen.trial
        follows = self.step.sliding_form(in_space(turns, touch.slope), touch, status.sign)
        return both, None if follows is None else contact.form_blocks(follows)

    def work(self, tractions: PointTractions, begun: PointTractions, ended: PointTractions) -> float:
        """Work of ``tractions`` over the displacement that changes the unlimited ones from ``begun`` to ``ended``."""
        across, along = self._travel(begun, ended)
        return float(np.vdot(tractions.normal, across) + np.vdot(tractions.trial, along))

    def works(self, begun: PointTractions, ended: PointTractions, shares: Array) -> Array:
        """Work (n,) over the displacement from ``begun`` to ``ended`` of the limited tractions at shares (n,) of it."""
        across, along = self._travel(begun, ended)
        change = begun.towards(ended, shares)
        normal = np.maximum(change.normal, 0.0)
        trial = clipped(change.trial, np.broadcast_to(self._cap(normal), normal.shape))
        n = shares.size
        return np.asarray(normal.reshape(n, -1) @ across.ravel() + trial.reshape(n, -1) @ along.ravel())

    def _travel(self, begun: PointTractions, ended: PointTractions) -> tuple[Array, Array]:
        """Displacements, normal and tangential, between two tractions, times the areas of the points."""
        weight = self.step.contact.weight
        across = weight * (ended.normal - begun.normal) / self.step.contact.stiffness
        return across, weight[..., None] * (ended.trial - begun.trial) / self.step.stiffness


class SurfaceFrictionSolver(FrictionSolver):
    """Solver of one step with friction for a wall with harmonics."""

    step: SurfaceFriction
    #: Tractions of the last linear model, or those predicted along the path; see `model`.
    foreseen: PointTractions | None = None

    def direction(self, here: HeldState, kept: Array | None = None) -> Array:
        """Newton step (size,) as in `FrictionSolver`, from the foreseen tractions."""
        # Without harmonics the steps are the solid's, and with them the last digits of its figures.
        if here.state.x.shape[1] == 2:
            return super().direction(here, kept)
        step = super().direction(here, kept)
        self._led = self._linear(here, False).at(self.solid.expand(step))
        return step

    def _search(self, here: HeldState, step: Array, slope: float) -> HeldState | None:
        """Line search as in `FrictionSolver`; the foreseen tractions advance towards those of the model by the same
        share as the positions."""
        moved = super()._search(here, step, slope)
        if moved is not None and here.state.x.shape[1] > 2:
            move, gone = self.solid.expand(step), moved.state.x - here.state.x
            share = min(1.0, float(np.vdot(move, gone)) / float(np.vdot(move, move)))
            before = self.foreseen or PointTractions(here.touch.traction, here.points.traction)
            self.foreseen = before.towards(self._led, share)
        return moved

    def _linear(self, here: HeldState, held: bool) -> SurfaceLinearContact:
        assert isinstance(here.points, SurfacePoints)
        carried = here.state.x.shape[1] > 2
        return SurfaceLinearContact(
            self.solid, self.step, here.touch, here.points, held, foreseen=self.foreseen, unsettled=carried
        )

    def by_height(self, held: HeldState, system: ContactSystem, down: float) -> tuple[Array, float, float]:
        """Rate of the unknowns (size,), force on the object against its path, and its rate, by the path parameter.

        Points that slid in the step keep sliding if that lengthens their slip path; else they stick.
        """
        step, touch, points = self.step, held.touch, held.points
        assert isinstance(points, SurfacePoints)
        contact, slope, drift, touching = step.contact, touch.slope, step.drift, touch.traction > 0.0
        normal, slid, turn, load = upward(slope), points.direction, step.turn(points), points.load
        pressed = contact.form(touch, touching)
        on = points.sliding
        for _ in range(SETTLING):
            sign = np.where(on[..., None], slid, 0.0)
            springs = step.spring_form(slope, touching & ~on, sign, np.where(on, turn, 0.0))
            follows = step.sliding_form(load, touch, sign)
            form = pressed + springs if follows is None else pressed + springs + follows
            blocks = contact.form_blocks(springs if follows is None else springs + follows)
            push = self.solid.faces.push(contact.load_forces(-(form @ drift)))
            move = system.whole(system.solve(push, blocks))
            gone = contact.points(self.solid.expand(move)) - drift
            pressing = np.where(touching, contact.stiffness * np.einsum("...i,...i->...", normal, gone), 0.0)
            steeper = np.einsum("...i,...ij,...j->...", slope, touch.curve, gone[..., :Z]) / secants(slope)
            bears = step.coefficient * (secants(slope) * pressing + touch.traction * steeper)
            slips = np.einsum("...i,...i->...", in_space(slid, slope), gone)
            goes = np.where(on, down * slips < 0.0, down * (bears - step.stiffness * slips) > 0.0) & points.sliding
            if (goes == on).all():
                break
            on = goes
        total = contact.weight[..., None] * (touch.traction[..., None] * normal + load)
        rate = contact.weight[..., None] * np.einsum("...ij,...j->...i", form, gone)
        return move, float((total @ drift).sum()), float((rate @ drift).sum())
