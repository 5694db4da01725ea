"""Contact and friction, linear in a displacement: the model in which a Newton step is settled.

It gives the status of the wall's points (touching, sticking, sliding) in the linear model of a step, and their
tractions. `PiecewiseLine` finds the status one point after another.

The tractions are continuous and piecewise linear. From the start the residual of the model shrinks linearly along a
straight line in every piece; where the line leaves a piece, one point touches, leaves, sticks or slides, and the
stiffness has a rank-one change (Katzenelson 1965, Bell Syst. Tech. J. 44, 1605,
doi:10.1002/j.1538-7305.1965.tb04195.x). Only the points are stored: the response of their tractions to loads on them.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

import numpy as np

from pneutouch.arrays import Array, Flags, Index
from pneutouch.mechanics.solid.elements import AXIAL, RADIAL
from pneutouch.mechanics.solid.friction import FrictionPoints, FrictionStep
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.object_contact import ContactEvaluation


@dataclass(frozen=True)
class PointStatus:
    """Status of points: touching; bearing (friction can hold them); sign (of the slip of sliding points, else 0)."""

    touching: Flags
    bearing: Flags
    sign: Array

    @property
    def sticking(self) -> Flags:
        """Mask of the points that stick."""
        return np.asarray(self.bearing & (self.sign == 0.0))

    @property
    def edges(self) -> Index:
        """Numbers of the outer wall's edges with points in contact."""
        return np.flatnonzero(self.touching.any(axis=tuple(range(1, self.touching.ndim))))

    def then(self, new: "PointStatus") -> "PointStatus":
        """Status to try next if solving with this one gave the status ``new``.

        A point that would reverse its sliding sticks first: otherwise it could alternate between both signs for ever.
        """
        return replace(new, sign=np.where(new.sign == -self.sign, 0.0, new.sign))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, PointStatus):
            return NotImplemented
        return bool((self.touching == other.touching).all() and (self.sign == other.sign).all())


@dataclass(frozen=True)
class PointTractions:
    """Tractions of the linear model before they are limited: normal, and along the surface; (n_edges, n_points)."""

    normal: Array
    trial: Array

    def towards(self, other: "PointTractions", share: float | Array) -> "PointTractions":
        """Tractions at a share of the way to ``other``, or at shares (n,), which become the first axis."""
        return PointTractions(_between(self.normal, other.normal, share), _between(self.trial, other.trial, share))


def _between(here: Array, there: Array, share: float | Array) -> Array:
    shares = np.asarray(share)
    return np.asarray(here + shares.reshape(*shares.shape, *(1,) * here.ndim) * (there - here))


def touched(tractions: PointTractions, before: int | None = None) -> Index:
    """Numbers of the outer wall's edges with points in contact, of those before the edge ``before`` (None: all)."""
    normal = tractions.normal[:before]
    return np.flatnonzero((normal > 0.0).any(axis=tuple(range(1, normal.ndim))))


#: Average number of changes per point beyond which the search is given up.
_MOST = 3
#: A change that leaves less than this share of the stiffness turns the line back.
_FLAT = 1.0e-9


class PiecewiseLine:
    """The line from the tractions ``begun`` to ``ended``, to which the linear model of ``status`` leads; n points each.

    response: (2 n, 2 n) change of the tractions, normal first, by loads of unit tractions under that status; it is
    overwritten.  areas: (2, n) area of a point over the stiffness of its springs, normal and along the surface. grip:
    (n,) limit of the traction along the surface over the normal traction, or the limit itself if ``held``.
    """

    def __init__(
        self,
        status: PointStatus,
        begun: PointTractions,
        ended: PointTractions,
        response: Array,
        areas: Array,
        grip: Array,
        held: bool,
    ) -> None:
        self._response, self._areas, self._grip, self._held = response, areas, grip, held
        self._at, self._move = (np.concatenate([one.normal, one.trial]) for one in (begun, ended))
        self._move -= self._at
        n = grip.size
        self._touching, self._bearing, self._sign = status.touching.copy(), status.bearing.copy(), status.sign.copy()
        # Three margins for each point, given by coefficients of the normal and the trial traction and a constant: the
        # piece ends where a margin falls to zero.
        self._by_normal, self._by_trial, self._free = np.zeros((3, n)), np.zeros((3, n)), np.full((3, n), np.inf)
        for j in range(n):
            self._bound(j)

    def status(self) -> PointStatus | None:
        """Status at the end of the line, piece after piece; None if it turns back or passes too many pieces."""
        n = self._grip.size
        for _ in range(_MOST * n):
            margin = self._by_normal * self._at[:n] + self._by_trial * self._at[n:] + self._free
            rate = self._by_normal * self._move[:n] + self._by_trial * self._move[n:]
            share = np.full(margin.shape, np.inf)
            np.divide(np.maximum(margin, 0.0), -rate, out=share, where=rate < 0.0)
            k = int(share.argmin())
            first = float(share.flat[k])
            if first >= 1.0:
                return PointStatus(self._touching, self._bearing, self._sign)
            self._at += first * self._move
            self._move *= 1.0 - first
            if not self._cross(k // n, k % n):
                return None
        return None

    def _cross(self, side: int, j: int) -> bool:
        """Enter the piece beyond margin ``side`` (0 contact; 1, 2 sliding) of point j; False if the line turns back."""
        n = self._grip.size
        trial, grip, held = float(self._at[n + j]), float(self._grip[j]), self._held
        across, along = self._areas[:, j]
        if side == 0:
            on = -1.0 if self._touching[j] else 1.0
            self._touching[j] = on > 0.0
            if held:
                push, gap = (on * across, 0.0), (1.0, 0.0)
            else:
                self._bearing[j] = self._touching[j]
                sign = self._sign[j] if on < 0.0 else (1.0 if trial >= 0.0 else -1.0)
                self._sign[j] = sign if on > 0.0 else 0.0
                push, gap = (on * across, on * along * sign * grip), (1.0, 0.0)
        else:
            slides = self._sign[j] == 0.0
            sign = (1.0 if side == 1 else -1.0) if slides else float(self._sign[j])
            self._sign[j] = sign if slides else 0.0
            on = -1.0 if slides else 1.0
            push, gap = (0.0, along), (0.0 if held else -on * sign * grip, on)
        self._bound(j)
        return self._change(j, push, gap)

    def _change(self, j: int, push: tuple[float, float], gap: tuple[float, float]) -> bool:
        """Add to the stiffness a load on point j times a combination of its tractions; False if it becomes too flat."""
        n, response = self._grip.size, self._response
        column = push[0] * response[:, j] + push[1] * response[:, n + j]
        row = gap[0] * response[j] + gap[1] * response[n + j]
        left = 1.0 + gap[0] * float(column[j]) + gap[1] * float(column[n + j])
        if not left > _FLAT:
            return False
        column /= left
        self._move -= column * (gap[0] * float(self._move[j]) + gap[1] * float(self._move[n + j]))
        response -= np.multiply.outer(column, row)
        return True

    def _bound(self, j: int) -> None:
        """Set the margins of point j in its present piece."""
        grip, held, sign = float(self._grip[j]), self._held, float(self._sign[j])
        touching, bearing = bool(self._touching[j]), bool(self._bearing[j])
        sticks = bearing and sign == 0.0
        by_cap, cap = (0.0, grip) if held else (grip, 0.0)
        none = (0.0, 0.0, np.inf)
        # A point that sticks slides before it leaves, unless its largest traction is held.
        first = (1.0 if touching else -1.0, 0.0, 0.0) if held or not sticks else none
        second, third = none, none
        if sticks:
            second, third = (by_cap, -1.0, cap), (by_cap, 1.0, cap)
        elif sign:
            second = (-by_cap, sign, -cap)
        for k, margin in enumerate((first, second, third)):
            self._by_normal[k, j], self._by_trial[k, j], self._free[k, j] = margin


@dataclass(frozen=True)
class LinearContact:
    """Contact and friction, linear in a displacement from one set of positions.

    held: the limits of the tractions along the surface stay at their present values; the model then has an energy.
    kept: signs of slip (n_edges, n_points), 0 for sticking points, that all points keep at any traction. unsettled: a
    step with unsettled points is accepted, because the next step starts from the tractions it leads to.
    """

    solid: SolidModel
    step: FrictionStep
    touch: ContactEvaluation
    points: FrictionPoints
    held: bool = False
    kept: Array | None = None
    unsettled: bool = False
    #: True if the tractions are piecewise linear in the displacement.
    IN_PIECES: ClassVar[bool] = True

    @cached_property
    def _grip(self) -> Array:
        """Limit of the traction along the surface over the normal traction, (n_edges, n_points)."""
        return self.step.coefficient * self.points.secant

    def at(self, move: Array) -> PointTractions:
        """Tractions after a nodal displacement (n_nodes, 2)."""
        r, z = self.solid.contact.positions(move)
        slope, points = self.touch.slope, self.points
        return PointTractions(
            -self.solid.contact.stiffness * (self.touch.gap + slope * r - z),
            self.step.stiffness * (points.slip + (r + slope * z) / points.secant),
        )

    def rows(self, begin: int) -> Array:
        """Derivatives of the tractions at the n points of the edges from ``begin`` on, normal first, by the unknowns of
        each edge: (2 n, n_edges, 2 n_nodes); 0 but for a point's own edge."""
        contact, slope, secant = self.solid.contact, self.touch.slope[begin:], self.points.secant[begin:]
        n_edges, n_points = slope.shape
        out = np.zeros((2, n_edges, n_points, n_edges, 2 * contact.shape.shape[1]))
        edge = np.arange(n_edges)
        for k, (by_r, by_z) in enumerate(
            [
                (-contact.stiffness * slope, np.full(slope.shape, contact.stiffness)),
                (self.step.stiffness / secant, self.step.stiffness * slope / secant),
            ]
        ):
            out[k, edge, :, edge, RADIAL] = by_r[..., None] * contact.shape
            out[k, edge, :, edge, AXIAL] = by_z[..., None] * contact.shape
        return out.reshape(2 * slope.size, n_edges, -1)

    def line(
        self, status: PointStatus, begun: PointTractions, ended: PointTractions, response: Array, edge: int
    ) -> PiecewiseLine:
        """Line from tractions ``begun`` towards the tractions ``ended`` that a status leads to, for the points of the
        edges from ``edge`` on; response: (2 n, 2 n) of their tractions to loads of `rows`, with that status."""
        local = PointStatus(status.touching[edge:].ravel(), status.bearing[edge:].ravel(), status.sign[edge:].ravel())
        first, last = (PointTractions(at.normal[edge:].ravel(), at.trial[edge:].ravel()) for at in (begun, ended))
        areas = self._weight[edge:].ravel() / np.array([[self.solid.contact.stiffness], [self.step.stiffness]])
        grip = (self.points.cap if self.held else self._grip)[edge:].ravel()
        return PiecewiseLine(local, first, last, response, areas, grip, self.held)

    def _cap(self, normal: Array) -> Array:
        return self.points.cap if self.held else self._grip * np.maximum(normal, 0.0)

    def begins(self, still: PointTractions) -> PointStatus:
        """Status to try first in a step that begins with tractions ``still``."""
        return self.status(still)

    def status(self, at: PointTractions) -> PointStatus:
        """Status of the points at given tractions: touching, sticking or sliding."""
        touching = at.normal > 0.0
        if self.kept is not None:
            return PointStatus(touching, touching, np.where(touching, self.kept, 0.0))
        cap = self._cap(at.normal)
        bearing = cap > 0.0 if self.held else touching
        return PointStatus(touching, bearing, np.where(bearing & (np.abs(at.trial) > cap), np.sign(at.trial), 0.0))

    def under(self, status: PointStatus, at: PointTractions) -> PointTractions:
        """Tractions ``at`` as they are with a fixed status: 0 without contact, at the limit for sliding points."""
        normal = np.where(status.touching, at.normal, 0.0)
        slides = status.sign * (self.points.cap if self.held else self._grip * normal)
        return PointTractions(normal, np.where(status.sticking, at.trial, slides))

    def force(self, tractions: PointTractions) -> Array:
        """Gradient (size,) of the energy for given tractions."""
        slope = self.touch.slope
        across, along = self.solid.contact.force(tractions.normal, slope), self.step.force(tractions.trial, slope)
        return self.solid.faces.push(across + along)

    def blocks(self, status: PointStatus, begun: PointTractions) -> tuple[Array, Array | None]:
        """Symmetric and unsymmetric stiffness under a fixed status; ``begun`` are the tractions before a move."""
        slope = self.touch.slope
        both = self.solid.contact.hessian(self.touch, status.touching) + self.step.stick(status.sticking, slope)
        return both, None if self.held else self.step.slide(begun.trial, self.touch, status.sign)

    def work(self, tractions: PointTractions, begun: PointTractions, ended: PointTractions) -> float:
        """Work of ``tractions`` over the displacement that changes the unlimited ones from ``begun`` to ``ended``."""
        normal = np.vdot(self._weight * tractions.normal, ended.normal - begun.normal) / self.solid.contact.stiffness
        return float(normal + np.vdot(self._weight * tractions.trial, ended.trial - begun.trial) / self.step.stiffness)

    def works(self, begun: PointTractions, ended: PointTractions, shares: Array) -> Array:
        """Work (n,) over the displacement from ``begun`` to ``ended`` of the limited tractions at shares (n,) of it."""
        change = begun.towards(ended, shares)
        normal = np.maximum(change.normal, 0.0)
        cap = self._cap(normal)
        trial = np.minimum(np.maximum(change.trial, -cap), cap)
        across = self._weight * (ended.normal - begun.normal) / self.solid.contact.stiffness
        along = self._weight * (ended.trial - begun.trial) / self.step.stiffness
        n = shares.size
        return np.asarray(normal.reshape(n, -1) @ across.ravel() + trial.reshape(n, -1) @ along.ravel())

    @property
    def _weight(self) -> Array:
        return self.solid.contact.weight
