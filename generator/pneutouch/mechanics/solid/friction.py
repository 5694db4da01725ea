"""Coulomb friction between outer wall and pressing object, by return mapping at the quadrature points of the contact.

A stiff spring along the object's surface holds a touching point at its place of rest, where it first touched. The
spring's traction is at most the coefficient times the normal traction: at this limit the place of rest slides along.
Tractions are per area at rest, in mu; lengths in R0; n is the number of nodes of an edge.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.mechanics.solid.elements import AXIAL, RADIAL, TermState
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.object_contact import Contact, ContactEvaluation, Indenter

#: Stiffness of the friction springs over that of the normal contact.
TANGENTIAL = 0.1


@dataclass(frozen=True)
class FrictionPoints:
    """Friction at the quadrature points of the outer wall in one position of the wall, (n_edges, n_points) each.

    traction: along the object's surface, per area at rest, in mu; positive where it pulls the wall towards the axis.
    cap: greatest magnitude of the traction, 0 without contact. slope: dz/dr of the object's surface. slip: distance
    along the surface from the place of rest, in R0. sticking, sliding: masks of touching points that stick, or slide.
    """

    traction: Array
    cap: Array
    slope: Array
    slip: Array
    sticking: Flags
    sliding: Flags

    @property
    def secant(self) -> Array:
        """Ratio of length along the surface to length along the radius."""
        return np.hypot(1.0, self.slope)

    @property
    def pull(self) -> Array:
        """Magnitude of the traction."""
        return np.abs(self.traction)

    @property
    def travel(self) -> Array:
        """Length of the slip."""
        return np.abs(self.slip)

    def path(self, past: FrictionPoints) -> Array:
        """Slip, positive in the direction of the traction in ``past``."""
        return np.asarray(np.sign(past.traction) * self.slip)


@dataclass(frozen=True)
class FrictionStep:
    """Friction for one position of the object, ``plate``: ``rest`` (n_edges, n_points) are the radii at which the
    points of the wall rest or will first touch; ``stiffness`` of the springs in mu/R0."""

    contact: Contact
    plate: Indenter
    coefficient: float
    rest: Array
    stiffness: float

    def slip(self, x: Array, slope: Array) -> Array:
        """Displacement (n_edges, n_points) from the places of rest to positions x, along tangents of ``slope``."""
        r, z = self.contact.positions(x)
        height = self.plate.underside(self.rest)[0]
        return np.asarray((r - self.rest + slope * (z - height)) / np.hypot(1.0, slope))

    def change(self, move: Array, slope: Array) -> Array:
        """Change of `slip` by a nodal displacement ``move`` (n_nodes, 2)."""
        r, z = self.contact.positions(move)
        return np.asarray((r + slope * z) / np.hypot(1.0, slope))

    def cap(self, traction: Array, slope: Array) -> Array:
        """Largest tangential traction at given vertical tractions (n_edges, n_points) and slopes; 0 if not positive."""
        out = np.zeros_like(traction)
        np.multiply(self.coefficient, traction * np.hypot(1.0, slope), out=out, where=traction > 0.0)
        return out

    def rate(self, sign: Array, slope: Array) -> Array:
        """Ratio of tangential to vertical traction of sliding points; ``sign``: direction of sliding, else 0."""
        out = np.zeros_like(sign)
        np.multiply(self.coefficient, sign * np.hypot(1.0, slope), out=out, where=sign != 0.0)
        return out

    def at(self, x: Array, touch: ContactEvaluation) -> FrictionPoints:
        """Friction at positions x (n_nodes, 2) by return mapping; ``touch`` is the contact there."""
        cap, slip = self.cap(touch.traction, touch.slope), self.slip(x, touch.slope)
        trial = self.stiffness * slip
        touching = touch.traction > 0.0
        sliding = touching & (np.abs(trial) > cap)
        return FrictionPoints(np.clip(trial, -cap, cap), cap, touch.slope, slip, touching & ~sliding, sliding)

    def force(self, traction: Array, slope: Array) -> Array:
        """Gradient of the energy by outer edges (n_edges, 2 n) for given tractions along the surface."""
        load = self.contact.weight * traction / np.hypot(1.0, slope)
        out = np.empty((load.shape[0], 2 * self.contact.shape.shape[1]))
        out[:, RADIAL] = load @ self.contact.shape
        out[:, AXIAL] = (load * slope) @ self.contact.shape
        return out

    def stick(self, sticking: Flags, slope: Array) -> Array:
        """Stiffness of the sticking points as blocks of the outer edges (n_edges, 2 n, 2 n), symmetric."""
        share = np.where(sticking, self.stiffness, 0.0)
        if not slope.any():
            return self.contact.blocks([(RADIAL, RADIAL, share)])
        share = share / (1.0 + slope**2)
        across = share * slope
        return self.contact.blocks(
            [(RADIAL, RADIAL, share), (RADIAL, AXIAL, across), (AXIAL, RADIAL, across), (AXIAL, AXIAL, across * slope)]
        )

    def around(self, sticking: Flags) -> Array:
        """Stiffness of the sticking points around the axis, by edges (n_edges, n, n): the springs act in all directions
        of the surface. Sliding points are taken as free around the axis."""
        share = np.where(sticking, self.stiffness, 0.0)
        return self.contact.blocks([(RADIAL, RADIAL, share)])[:, RADIAL, RADIAL]

    def slide(self, traction: Array, touch: ContactEvaluation, sign: Array) -> Array | None:
        """Unsymmetric part of the stiffness, (n_edges, 2 n, 2 n): the traction of sliding points (nonzero ``sign``)
        follows the normal traction, and its direction follows the surface. None if no point slides on a flat one."""
        slope = touch.slope
        if not slope.any():
            by_z = self.rate(sign, slope) * self.contact.stiffness
            return self.contact.blocks([(RADIAL, AXIAL, by_z)]) if sign.any() else None
        secant = np.hypot(1.0, slope)
        rate = self.rate(sign, slope) / secant
        by_z = rate * self.contact.stiffness
        by_r = -by_z * slope + rate * touch.traction * slope * touch.curve / secant**2
        turn = traction * touch.curve / secant**3
        return self.contact.blocks(
            [
                (RADIAL, RADIAL, by_r - turn * slope),
                (RADIAL, AXIAL, by_z),
                (AXIAL, RADIAL, by_r * slope + turn),
                (AXIAL, AXIAL, by_z * slope),
            ]
        )

    def stored(self, points: FrictionPoints) -> float:
        """Energy stored in the springs, mu R0^3."""
        return float(np.vdot(self.contact.weight, points.pull**2)) / (2.0 * self.stiffness)

    def held(self, solid: SolidModel, points: FrictionPoints) -> FrictionTerm:
        """Friction as an energy term, with the traction limits and slopes held at those of ``points``."""
        return FrictionTerm(solid, self, points)

    def moved(self, x: Array, points: FrictionPoints) -> Array:
        """Radii (n_edges, n_points) at which the points rest after a step to positions x; NaN without contact."""
        r, _ = self.contact.positions(x)
        slid = r - points.traction / self.stiffness / points.secant
        return np.where(points.sliding, slid, np.where(points.sticking, self.rest, np.nan))


class FrictionTerm:
    """Friction with the traction limits (``cap``) and the slopes held: the pseudo-potential of a step, convex in the
    slip; an `EnergyTerm`. At the positions of the held values its gradient is the force of friction."""

    def __init__(self, solid: SolidModel, step: FrictionStep, held: FrictionPoints) -> None:
        self.solid, self.step, self.held = solid, step, held
        # Rounding of the slip leaves less force than that of the gap, as the springs are softer.
        self.noise = solid.contact.noise * step.stiffness / solid.contact.stiffness

    def energy(self, x: Array) -> float:
        """Energy stored in the springs, plus the traction limit times the slip beyond the limit, mu R0^3."""
        trial = self.step.stiffness * self.step.slip(x, self.held.slope)
        bears = np.clip(trial, -self.held.cap, self.held.cap)
        return float(np.vdot(self.solid.contact.weight, bears * (trial - 0.5 * bears))) / self.step.stiffness

    def at(self, x: Array) -> TermState:
        """Energy and its derivatives at positions x (n_nodes, 2)."""
        cap, slope = self.held.cap, self.held.slope
        trial = self.step.stiffness * self.step.slip(x, slope)
        force = self.step.force(np.clip(trial, -cap, cap), slope)
        sticking = (cap > 0.0) & (np.abs(trial) <= cap)
        stick, around = self.step.stick(sticking, slope), self.step.around(sticking)
        return TermState(self.energy(x), self.solid.faces.push(force), stick, around=around)


@dataclass(frozen=True)
class FrictionState:
    """Friction at an accepted state: its points, the radii (n_edges, n_points) at which they rest (NaN without
    contact), spring stiffness in mu/R0, and the energy stored and dissipated in the step that led here, in mu R0^3."""

    points: FrictionPoints
    rest: Array
    stiffness: float
    stored: float
    dissipated: float

    @classmethod
    def after(cls, before: FrictionState | None, step: FrictionStep, x: Array, points: FrictionPoints) -> FrictionState:
        """Friction at the end x (n_nodes, 2) of a step that began at ``before``; None: the step to first contact."""
        return cls(
            points, step.moved(x, points), step.stiffness, step.stored(points), _dissipated(before, step, points)
        )


def _dissipated(before: FrictionState | None, step: FrictionStep, points: FrictionPoints) -> float:
    """Work (mu R0^3) of the tractions over the sliding of a step, by the trapezium rule; ``before`` None: first step.

    Sliding begins at the last traction, or at the lesser of last and present limit if that is more, and ends at the
    present limit. A point that slid and is released is taken to leave in the middle of the step. A point that stuck and
    is released loses half its traction times its path from its rest, as when a crack opens by that point (Rybicki &
    Kanninen 1977, Eng. Fract. Mech. 9, 931, doi:10.1016/0013-7944(77)90013-3), with the energy of its spring included.
    """
    weight = step.contact.weight
    slid = points.sliding
    beyond = points.travel[slid] - points.pull[slid] / step.stiffness
    if before is None:
        return float(np.vdot(weight[slid], points.cap[slid] * beyond))
    past, touching = before.points, points.sticking | points.sliding
    begun = np.maximum(past.pull, np.minimum(past.cap, points.cap))[slid]
    work = float(np.vdot(weight[slid], 0.5 * (begun + points.cap[slid]) * beyond))
    path = points.path(past)
    stuck, let_go = past.sticking & ~touching, past.sliding & ~touching
    spring = past.pull / step.stiffness
    work += 0.5 * float(np.vdot(weight[stuck], (past.pull * np.maximum(path, spring))[stuck]))
    work += 0.5 * float(np.vdot(weight[let_go], (past.pull * spring)[let_go]))
    return work + 0.25 * float(np.vdot(weight[let_go], past.cap[let_go] * points.travel[let_go]))
