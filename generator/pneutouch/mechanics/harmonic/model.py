"""The finite elements of a wall with harmonics, without rotational symmetry, and its Newton steps under an object.

The set of touching points is carried from step to step, and tractions are unknowns of their own, as in primal-dual
methods (Hintermüller, Ito and Kunisch 2002, SIAM J. Optim. 13(3), doi:10.1137/S1052623401383558). The curvature of the
object acts on the tractions of the last quadratic model, since under a round object a step overshoots by far more than
the penetration in equilibrium. A point that comes or goes is a rank-one change of the tangent, which is factored for
one set of points and solved for others by Woodbury's identity; the inertia of the small matrix shows whether the
changed tangent is positive definite (Haynsworth 1968, Linear Algebra Appl. 1(1), doi:10.1016/0024-3795(68)90050-5).
"""

from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array, Flags, Index
from pneutouch.mechanics.harmonic.fields import AXIAL, FieldGroup, Harmonics
from pneutouch.mechanics.harmonic.material import GradientLaw, HarmonicCavity, LawFields, NodePairOperator
from pneutouch.mechanics.harmonic.object_contact import HarmonicContact, X, Y, Z, face_operator, space_form, upward
from pneutouch.mechanics.harmonic.surface import revolved
from pneutouch.mechanics.sensor import RigidBase
from pneutouch.mechanics.solid.banded import lapack
from pneutouch.mechanics.solid.base_contact import BaseContact, BaseFace, BaseMeeting
from pneutouch.mechanics.solid.elements import F_RR, F_RZ, HOOP, RADIAL
from pneutouch.mechanics.solid.model import PointFields, SolidModel
from pneutouch.mechanics.solid.newton import NewtonDirection, SolidScene, SolverState, downhill, tangent, with_contact
from pneutouch.mechanics.solid.object_contact import ContactEvaluation
from pneutouch.mechanics.solid.second_variation import ranked_numbers


class HarmonicFace(BaseFace):
    """One face of the wall at the contact angles; arrays of points are (n_edges, n_points, n_angles), slopes of the
    base have one more axis and second derivatives two more, by x and y."""

    def __init__(self, face: BaseFace, harmonics: Harmonics, signs: Array) -> None:
        self._face, self.high, self.stiffness = face, face.high, face.stiffness
        self._operator = face_operator(face.edges, face.shape.shape[0], harmonics, signs)
        angles = harmonics.contact_angles.size
        self.weight = np.repeat(face.weight[..., None], angles, axis=2) / angles

    def meet(self, nodes: Array) -> BaseMeeting | None:
        """Contact for coefficients (n_nodes, columns); None if no point is below the surface of the base."""
        place = self._operator.fields(nodes)
        if place[..., Z].min() >= self.high:
            return None
        under = revolved(self._face.surface, place[..., X], place[..., Y])
        traction = np.maximum(self.stiffness * (under.height - place[..., Z]), 0.0)
        radius = np.hypot(place[..., X], place[..., Y])
        return BaseMeeting(radius, traction, under.slope, under.curve) if traction.any() else None

    def lift(self, meeting: BaseMeeting) -> Array:
        """Derivative of the energy by edge coefficients, (n_edges, n * columns) for n nodes of an edge."""
        return self._operator.forces(-(self.weight * meeting.traction)[..., None] * upward(meeting.slope))

    def hessian(self, meeting: BaseMeeting) -> Array:
        """Second derivative of the energy by edge coefficients, (n_edges, n * columns, n * columns)."""
        stiff = np.where(meeting.traction > 0.0, self.stiffness, 0.0) * self.weight
        load = self.weight * meeting.traction
        return self._operator.stiffness(space_form(stiff, meeting.slope, load, meeting.curve))


@dataclass(frozen=True)
class HarmonicFields(PointFields):
    """Fields at the integration points and angles, n in all: ``strains`` (n, 3, 3) are the transposed deformation
    gradients F, by R, by Z and around the axis; ``jets`` (n,) their determinants, ``basis`` (n, 3, 3) their cofactors,
    ``by_cell`` as ``strains``.

    pressure: derivative of the averaged volume's energy by det F, (n,), weighted.
    """

    law: LawFields
    pressure: Array


class HarmonicModel(SolidModel):
    """A solid whose nodes have harmonics around the axis to an order. Positions are coefficients (n_nodes, columns) in
    units of the solid's ``length``, see `fields.Harmonics`; with order 0 positions and results equal the solid's.
    ``stride`` 2 is for scenes that are symmetric about two planes. Raises ValueError if the wall can meet its flange.

    The volume is averaged in the meridian as in the solid, and around the axis over the harmonics to the same order.
    """

    def __init__(self, solid: SolidModel, order: int, stride: int = 1) -> None:
        if solid.faces.fold is not None:
            raise ValueError("a wall that can lie down on its own flange has no harmonics yet")
        self.harmonics, self._solid = Harmonics(order, stride), solid
        super().__init__(solid.mesh, solid.material, solid.scheme, solid.grade)

    def _assemble(self, base: RigidBase | None) -> None:
        """Number the unknowns and build contact, cavity and base at the angles; ``base`` is ignored for the solid's."""
        solid, harmonics = self._solid, self.harmonics
        self.rest, self.meeting = harmonics.lifted(solid.rest), solid.meeting
        self.dofs, signs = _number(solid, harmonics)
        self._sign = signs
        self.size = int(self.dofs.max()) + 1
        self._operators(signs)
        self._patterns(forms={0: self._field.entries(self.dofs)})
        self.cavity = HarmonicCavity(self.mesh.inner, solid.cavity.below, harmonics, signs)
        self.contact = HarmonicContact(solid, harmonics, signs)
        self.base = None
        if solid.base is not None:
            outer, inner = (HarmonicFace(face, harmonics, signs) for face in (solid.base.outer, solid.base.inner))
            self.base = BaseContact(outer, inner, self.faces)
        self.supports = () if self.base is None else (self.base,)

    def lowest(self, x: Array, edges: Index, above: float = -np.inf) -> float:
        """Least height (R0), over the angles, of those nodes of ``edges`` that are higher than ``above`` at rest."""
        nodes = np.unique(edges)
        nodes = nodes[self.rest[nodes, 1] > above]
        heights = self.harmonics.values(self.harmonics.angles)[:, AXIAL] @ x[nodes].T
        return float(heights.min())

    def _operators(self, signs: Array) -> None:
        """Constant operators: deformation gradients, weights and weighted modes of the averaged volume."""
        by_r, by_z, over = (self.b[:, :, row, RADIAL] for row in (F_RR, F_RZ, HOOP))
        angles = self.harmonics.angles
        values, turned = self.harmonics.values(angles), self.harmonics.turned(angles)
        groups = [FieldGroup(by_r, values), FieldGroup(by_z, values), FieldGroup(over, turned)]
        self._field = NodePairOperator(groups, self.mesh.cells, signs, self.harmonics)
        self._share = (self.stiff_weight[:, None] / angles.size / self.mu).repeat(angles.size, axis=1).ravel()
        self._law = GradientLaw(self.material)
        self._cosines = self.harmonics.cosines(angles)
        n_cells, n_points = self.weight.shape
        shape = np.stack([by_r, by_z, over], axis=2).reshape(n_cells, 1, n_points, 3, -1)
        tested = self.tested[:, :, :, None, None] * shape
        self._tested_shape = np.ascontiguousarray(
            np.moveaxis(tested, 4, 2).reshape(n_cells, tested.shape[1] * shape.shape[-1], -1)
        )
        waves = [self._cosines[:, :, None, None] * rows for rows in (values, values, turned)]
        self._waves = [np.ascontiguousarray(w.transpose(1, 2, 0, 3).reshape(3 * angles.size, -1)) for w in waves]

    def expand(self, step: Array) -> Array:
        """Displacement of the coefficients (n_nodes, columns) from the free unknowns (size,); 0 where fixed."""
        return np.asarray(np.where(self.dofs >= 0, step[self.dofs], 0.0) * self._sign)

    def local(self, x: Array) -> PointFields:
        """Deformation gradients, energy, derivatives at the integration points; energy inf if a point is inverted."""
        f = self._field.fields(x)
        gradient = f.reshape(-1, 3, 3)
        # Cofactors: the derivative of the determinant.
        cofactor = np.stack([np.cross(gradient[:, (k + 1) % 3], gradient[:, (k + 2) % 3]) for k in range(3)], axis=1)
        volume = np.einsum("ni,ni->n", gradient[:, 0], cofactor[:, 0])
        if not volume.min() > 0.0:
            return PointFields(np.inf, f, f, f, f, f)
        n_cells, n_points = self.weight.shape
        change = (volume - 1.0).reshape(n_cells, n_points, -1)
        content = np.matmul(np.matmul(self.tested, change), self._cosines.T)
        stored = 0.5 * float(np.vdot(self.kappa * content, content))
        pressure = self.averaged_pressure(content)
        law = self._law.at(gradient, cofactor, volume, self._share)
        return HarmonicFields(law.energy + stored, gradient, volume, cofactor, content, f, law, pressure)

    def averaged_pressure(self, content: Array) -> Array:
        """Averaged pressure (n,), weighted, of a ``content`` (n_cells, n_modes, waves + 1)."""
        by_content = np.matmul(np.swapaxes(self.tested, 1, 2), self.kappa * content)
        return np.asarray(np.matmul(by_content, self._cosines)).ravel()

    def mixed(self, before: PointFields, here: PointFields, move: Array) -> PointFields:
        """Fields ``here`` at the averaged pressure that the last Newton step expected, as in the solid."""
        assert isinstance(here, HarmonicFields)
        swelling = self._swelling(before)
        grown = np.matmul(swelling, move[self.mesh.cells].reshape(len(swelling), -1, 1))
        expected = before.content + grown.reshape(before.content.shape)
        return replace(here, pressure=here.pressure + self.averaged_pressure(expected - here.content))

    def forces(self, local: PointFields) -> Array:
        """Derivative of the stored energy by the coefficients of the cells, (n_cells, n_coefficients)."""
        assert isinstance(local, HarmonicFields)
        by_gradient = local.law.stress() + local.pressure[:, None, None] * local.basis
        return self._field.forces(by_gradient.reshape(*self.weight.shape, -1, 9))

    def stiffness(self, local: PointFields) -> Array:
        """Second derivative of the energy by the coefficients of the cells, by node pairs: see `NodePairOperator`."""
        assert isinstance(local, HarmonicFields)
        form = local.law.moduli(local.pressure)
        blocks = self._field.stiffness(form.reshape(*self.weight.shape, -1, 9, 9))
        swelling = self._swelling(local)
        blocks += self._field.picked(np.matmul(np.swapaxes(self.kappa * swelling, 1, 2), swelling))
        return blocks

    def _swelling(self, local: PointFields) -> Array:
        """Derivative of the averaged volume's modes and harmonics, (n_cells, n_modes * (waves + 1), n_coefficients)."""
        n_cells, n_points = self.weight.shape
        cofactor = local.basis.reshape(n_cells * n_points, -1, 3, 3)
        along = [cofactor[:, :, k].reshape(n_cells * n_points, -1) @ waves for k, waves in enumerate(self._waves)]
        stacked = np.stack(along, axis=1).reshape(n_cells, 3 * n_points, -1)
        modes, waves = self.tested.shape[1], self.harmonics.waves + 1
        out = np.matmul(self._tested_shape, stacked).reshape(n_cells, modes, -1, waves, self.harmonics.columns)
        swelling = np.swapaxes(out, 2, 3).reshape(n_cells, modes * waves, -1)
        sign = self._sign[self.mesh.cells].reshape(n_cells, 1, -1)
        return np.asarray(swelling * sign)


def _number(solid: SolidModel, harmonics: Harmonics) -> tuple[Index, Array]:
    """Numbers of the unknowns by node and coefficient (n_nodes, columns), -1 if fixed, node by node in the solid's
    order; and the sign of each coefficient.

    On the axis only z_0 is free, and as one unknown the motion across the axis, r_1 = -s_1, which is zero with two
    planes of symmetry.
    """
    mesh, columns = solid.mesh, harmonics.columns
    free = np.ones((mesh.nodes.shape[0], columns), dtype=bool)
    axial = [1, *(3 * k for k in range(1, harmonics.waves + 1))]
    free[mesh.axis] = False
    free[mesh.axis, 1] = True
    across = harmonics.order > 0 and harmonics.stride == 1
    free[mesh.axis, 2:3] = across
    for column in axial:
        free[mesh.sliding, column] = False
    free[mesh.clamped] = False
    numbers = ranked_numbers(free, solid)
    signs = np.ones(free.shape)
    if across:
        numbers[mesh.axis, 4], signs[mesh.axis, 4] = numbers[mesh.axis, 2], -1.0
    return numbers, signs


_MOST = 24
"""Most points in which a set may differ from the factored set: solving for as many costs two factorisations."""


class PointSets:
    """Newton steps at one state for different sets of touching points, given as masks of the contact's points.

    ``held`` has the tractions that act on the curvature of the object, ``start`` the state's, negative for open gaps.
    """

    def __init__(self, scene: SolidScene, state: SolverState, held: ContactEvaluation, start: Array, band: Array):
        self._scene, self._state, self._held, self._start, self._band = scene, state, held, start, band
        contact = scene.solid.contact
        self._soft = (contact.weight / contact.stiffness).ravel()
        self._factor: Array | None = None

    def load(self, active: Flags) -> Array:
        """Gradient (size,) of the energy with the tractions of a set of points only."""
        return self._state.inner + self._force(np.where(active, self._start, 0.0))

    def at(self, active: Flags) -> NewtonDirection:
        """Newton step to the minimum of the quadratic model for a set of touching points."""
        changed = None if self._factor is None else np.flatnonzero(active != self._base)
        if changed is None or changed.size > _MOST:
            changed = self._factored(active)
        newton = None if changed is None else self._changed(active, changed)
        if newton is not None:
            return newton
        newton = downhill(self._state, with_contact(self._scene, self._band, self._held, active), self.load(active))
        if newton.lift:
            # The lift that made this tangent definite is kept for the other sets: fewer failed factorisations.
            self._band = self._band.copy(order="F")
            self._band[0] += newton.lift
            self._factor = None
        return newton

    def _factored(self, active: Flags) -> Index | None:
        """Factor the tangent for a set; returns an empty array of changed points, None if not positive definite."""
        factor, info = lapack.dpbtrf(with_contact(self._scene, self._band, self._held, active), lower=1)
        self._factor = None
        if info:
            return None
        self._factor, self._base = factor, active
        rhs = np.stack([-self.load(active), self._state.by_volume], axis=1)
        self._solution = lapack.dpbtrs(factor, rhs, lower=1)[0]
        self._number: dict[int, int] = {}
        self._pushes, self._moves = np.empty((rhs.shape[0], 0)), np.empty((rhs.shape[0], 0))
        return np.empty(0, np.intp)

    def _changed(self, active: Flags, changed: Index) -> NewtonDirection | None:
        """Newton step for a set that differs in points ``changed`` from the factored one; None if not definite."""
        solution = self._solution
        if changed.size:
            columns = self._known(changed)
            push, move = self._pushes[:, columns], self._moves[:, columns]
            sign = np.where(active.ravel()[changed], 1.0, -1.0)
            solution = solution.copy()
            solution[:, 0] -= move @ (sign * self._start.ravel()[changed])
            small = np.diag(sign * self._soft[changed]) + push.T @ move
            small = 0.5 * (small + small.T)
            if int((np.linalg.eigvalsh(small) > 0.0).sum()) != int((sign > 0.0).sum()):
                return None
            solution -= move @ np.linalg.solve(small, push.T @ solution)
        plain, soft = solution.T
        rate, by_volume = self._state.filling.rate, self._state.by_volume
        denominator = 1.0 + rate * float(by_volume @ soft)
        step = plain - soft * (rate * float(by_volume @ plain) / denominator)
        return NewtonDirection(step, soft, denominator, True, True) if denominator > 0.0 else None

    def _known(self, points: Index) -> list[int]:
        """Columns, for points (flat indices), of their unit loads and solutions, which are computed at first use."""
        new = [int(p) for p in points if int(p) not in self._number]
        if new:
            loads = np.stack([self._unit(p) for p in new], axis=1)
            self._number.update({p: len(self._number) + k for k, p in enumerate(new)})
            self._pushes = np.concatenate([self._pushes, loads], axis=1)
            self._moves = np.concatenate([self._moves, lapack.dpbtrs(self._factor, loads, lower=1)[0]], axis=1)
        return [self._number[int(p)] for p in points]

    def _unit(self, point: int) -> Array:
        traction = np.zeros(self._start.size)
        traction[point] = 1.0
        return self._force(traction.reshape(self._start.shape))

    def _force(self, traction: Array) -> Array:
        solid = self._scene.solid
        return solid.faces.push(solid.contact.force(traction, self._held.slope))


_FREE = 5
"""Rounds that take the set of touching points directly from the previous solution."""

_ROUNDS = 12
"""Total rounds of one quadratic model; the later ones use a line search."""


@dataclass(frozen=True)
class Foreseen:
    """Masks of the points that are expected to touch, and tractions that act on the curvature of the object there, both
    of the shape of the contact's points."""

    touching: Flags
    traction: Array


class ContactNewton:
    """Newton steps to one state, for `newton.minimise`, from a guess of the contact at that state."""

    def __init__(self, foreseen: Foreseen | None = None) -> None:
        self._foreseen = foreseen

    def __call__(self, scene: SolidScene, state: SolverState) -> NewtonDirection:
        """The Newton step at a state; its tractions are the guess for the next one."""
        assert state.touch is not None
        newton, traction = _ContactModel(scene, state, state.touch, self._foreseen).least()
        self._foreseen = Foreseen(traction > 0.0, np.maximum(traction, 0.0))
        return newton


class _ContactModel:
    """Model of wall, filling and contact at a state: convex, piecewise quadratic, with a kink in the gradient where a
    point comes or goes. Tractions are negative for open gaps."""

    def __init__(self, scene: SolidScene, state: SolverState, touch: ContactEvaluation, foreseen: Foreseen | None):
        self._scene, self._state, self._touch = scene, state, touch
        self._contact, self._push = scene.solid.contact, scene.solid.faces.push
        self._here = self._contact.linear(touch, np.zeros_like(state.x))
        self._foreseen = foreseen or Foreseen(self._here > 0.0, np.zeros_like(self._here))
        held = replace(touch, traction=self._foreseen.traction)
        self._sets = PointSets(scene, state, held, self._here, tangent(scene, state))

    def least(self) -> tuple[NewtonDirection, Array]:
        """Step to the minimum of the model, or to a lower point of it, and the tractions there.

        The touching points of each solution are the next set. If a set recurs, the remaining rounds search on the line
        from the last point to the next solution for the minimum of the model.
        """
        here, active = self._here, self._foreseen.touching
        step, pull, searching, seen = np.zeros_like(self._state.residual), self._state.inner, False, set[bytes]()
        for number in range(_ROUNDS):
            newton = self._sets.at(active)
            if newton.lift:
                pull = pull + newton.lift * step
            ahead = self._contact.linear(self._touch, self._scene.solid.expand(newton.step))
            following = ahead > 0.0
            if (following == active).all():
                return newton, ahead
            seen.add(active.tobytes())
            if number + 1 < _FREE and following.tobytes() not in seen:
                active = following
                continue
            pull_ahead = self._pull(active, ahead)
            if not searching and self._lower(newton.step, ahead, pull_ahead):
                share = 1.0
            else:
                move = newton.step - step
                share = self._contact.least_share(here, ahead, float(move @ pull), float(move @ pull_ahead))
            searching = True
            step, pull = step + share * (newton.step - step), pull + share * (pull_ahead - pull)
            here = here + share * (ahead - here)
            active = here > 0.0
        return replace(newton, step=step), here

    def _pull(self, active: Flags, traction: Array) -> Array:
        """Gradient (size,) of wall and filling that balances the tractions of a set of points."""
        return np.asarray(-self._push(self._contact.force(np.where(active, traction, 0.0), self._touch.slope)))

    def _lower(self, step: Array, ahead: Array, pull: Array) -> bool:
        """True if the model is lower at the end of a step than at the state itself."""
        contact = self._contact
        pressed = np.maximum(ahead, 0.0) ** 2 - np.maximum(self._here, 0.0) ** 2
        change = 0.5 * float(step @ (self._state.inner + pull))
        return change + float(np.vdot(contact.weight, pressed)) / (2.0 * contact.stiffness) < 0.0
