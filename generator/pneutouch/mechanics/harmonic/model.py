"""The discrete body with harmonics: energy, forces and stiffness of a wall that is no body of revolution."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array, Index
from pneutouch.mechanics.harmonic.fields import AXIAL, FieldGroup, Harmonics
from pneutouch.mechanics.harmonic.material import GradientLaw, HarmonicCavity, LawFields, NodePairOperator
from pneutouch.mechanics.harmonic.object_contact import HarmonicContact, X, Y, Z, face_operator, upward
from pneutouch.mechanics.harmonic.surface import revolved
from pneutouch.mechanics.solid.base_contact import BaseContact, BaseFace, BaseMeeting
from pneutouch.mechanics.solid.elements import F_RR, F_RZ, HOOP, RADIAL, gauss_square, strain_operator
from pneutouch.mechanics.solid.indenter import RigidBase
from pneutouch.mechanics.solid.model import PointFields, SolidModel


class HarmonicFace(BaseFace):
    """One face of the wall at the angles; arrays of points are (n_edges, n_points, n_angles), slopes of the base have
    one axis more and curvatures two, by x and y."""

    def __init__(self, face: BaseFace, harmonics: Harmonics, signs: Array) -> None:
        self._face, self.high, self.stiffness = face, face.high, face.stiffness
        self._operator = face_operator(face.edges, face.shape.shape[0], harmonics, signs)
        angles = harmonics.contact_angles.size
        self.weight = np.repeat(face.weight[..., None], angles, axis=2) / angles

    def meet(self, nodes: Array) -> BaseMeeting | None:
        """Points below the surface of the base for coefficients (n_nodes, columns); None if there are none."""
        place = self._operator.fields(nodes)
        if place[..., Z].min() >= self.high:
            return None
        under = revolved(self._face.surface, place[..., X], place[..., Y])
        traction = np.maximum(self.stiffness * (under.height - place[..., Z]), 0.0)
        radius = np.hypot(place[..., X], place[..., Y])
        return BaseMeeting(radius, traction, under.slope, under.curve) if traction.any() else None

    def force(self, meeting: BaseMeeting) -> Array:
        """Derivative of the energy by edge coefficients, (n_edges, n columns)."""
        return self._operator.forces(-(self.weight * meeting.traction)[..., None] * upward(meeting.slope))

    def hessian(self, meeting: BaseMeeting) -> Array:
        """Second derivative by edge coefficients, (n_edges, n columns, n columns)."""
        normal = upward(meeting.slope)
        stiff = np.where(meeting.traction > 0.0, self.stiffness, 0.0) * self.weight
        form = (stiff[..., None] * normal)[..., :, None] * normal[..., None, :]
        form[..., :Z, :Z] += (self.weight * meeting.traction)[..., None, None] * meeting.curve
        return self._operator.stiffness(form)


@dataclass(frozen=True)
class HarmonicFields(PointFields):
    """Fields at the integration points and angles: ``strains`` (n_points n_angles, 9) are the deformation gradient
    transposed, by R, by Z and around; ``jets`` its determinant and ``basis`` its cofactors.

    pressure: derivative of the averaged volume's energy by det F, (n_points n_angles,), weighted.
    """

    law: LawFields
    pressure: Array


class HarmonicModel(SolidModel):
    """A solid whose nodes carry harmonics around the axis to an order. Positions are coefficients (n_nodes, columns) in
    units of the solid's ``length``, see `fields.Harmonics`; with order 0 they and all results are the solid's.
    ``stride`` 2 is for scenes that are symmetric about two planes.

    The volume is averaged in the meridian as in the solid, and around the axis over the harmonics to the same order.
    """

    def __init__(self, solid: SolidModel, order: int, stride: int = 1) -> None:
        if solid.faces.fold is not None:
            raise ValueError("a wall that can lie down on its own flange has no harmonics yet")
        self.harmonics, self._solid = Harmonics(order, stride), solid
        super().__init__(solid.mesh, solid.material, solid.scheme, solid.grade)

    def _assemble(self, base: RigidBase | None) -> None:
        """Number the unknowns, and build what acts on the faces at the angles; the base is the solid's."""
        solid, harmonics = self._solid, self.harmonics
        self.rest, self.meeting = harmonics.lifted(solid.rest), solid.meeting
        self.dofs, signs = _number(solid, harmonics)
        self._sign = signs
        self.size = int(self.dofs.max()) + 1
        self._operators(signs)
        self._patterns(forms={0: self._field.entries(self.dofs)})
        self.cavity = HarmonicCavity(self.mesh.inner, harmonics, signs)
        self.contact = HarmonicContact(solid, harmonics, signs)
        self.base = None
        if solid.base is not None:
            outer, inner = (HarmonicFace(face, harmonics, signs) for face in (solid.base.outer, solid.base.inner))
            self.base = BaseContact(outer, inner, self.faces)
        self.supports = () if self.base is None else (self.base,)

    def lowest(self, x: Array, edges: Index, above: float = -np.inf) -> float:
        """Least height at the angles of the nodes of a face that are higher than ``above`` at rest, in R0."""
        nodes = np.unique(edges)
        nodes = nodes[self.rest[nodes, 1] > above]
        heights = self.harmonics.values(self.harmonics.angles)[:, AXIAL] @ x[nodes].T
        return float(heights.min())

    def _operators(self, signs: Array) -> None:
        """Constant operators: deformation gradients, weights and the tested modes of the averaged volume."""
        points, _ = gauss_square(self.scheme.gauss)
        b, _, _ = strain_operator(self.mesh.nodes / self.length, self.mesh.cells, points)
        by_r, by_z, over = (b[:, :, row, RADIAL] for row in (F_RR, F_RZ, HOOP))
        angles = self.harmonics.angles
        values, turned = self.harmonics.values(angles), self.harmonics.turned(angles)
        groups = [FieldGroup(by_r, values), FieldGroup(by_z, values), FieldGroup(over, turned)]
        self._field = NodePairOperator(groups, self.mesh.cells, signs, self.harmonics)
        self._share = (self._stiff_weight[:, None] / angles.size / self.mu).repeat(angles.size, axis=1).ravel()
        self._law = GradientLaw(self.material)
        self._cosines = self.harmonics.cosines(angles)
        n_cells, n_points = self._weight.shape
        shape = np.stack([by_r, by_z, over], axis=2).reshape(n_cells, 1, n_points, 3, -1)
        tested = self._tested[:, :, :, None, None] * shape
        self._tested_shape = np.ascontiguousarray(
            np.moveaxis(tested, 4, 2).reshape(n_cells, tested.shape[1] * shape.shape[-1], -1)
        )
        waves = [self._cosines[:, :, None, None] * rows for rows in (values, values, turned)]
        self._waves = [np.ascontiguousarray(w.transpose(1, 2, 0, 3).reshape(3 * angles.size, -1)) for w in waves]

    def expand(self, step: Array) -> Array:
        """Displacement of the coefficients (n_nodes, columns) of a vector of free unknowns (size,)."""
        return np.asarray(np.where(self.dofs >= 0, step[self.dofs], 0.0) * self._sign)

    def local(self, x: Array) -> PointFields:
        """Deformation gradients, energy and its derivatives at the integration points for coefficients x."""
        f = self._field.fields(x)
        gradient = f.reshape(-1, 3, 3)
        cofactor = _cofactors(gradient)
        volume = np.einsum("ni,ni->n", gradient[:, 0], cofactor[:, 0])
        if not volume.min() > 0.0:
            return PointFields(np.inf, f, f, f)
        n_cells, n_points = self._weight.shape
        change = (volume - 1.0).reshape(n_cells, n_points, -1)
        content = np.matmul(np.matmul(self._tested, change), self._cosines.T)
        stored = 0.5 * float(np.vdot(self._kappa * content, content))
        by_content = np.matmul(np.swapaxes(self._tested, 1, 2), self._kappa * content)
        pressure = np.matmul(by_content, self._cosines).ravel()
        law = self._law.at(gradient, cofactor, volume, self._share)
        return HarmonicFields(law.energy + stored, gradient, volume, cofactor, law, pressure)

    def forces(self, local: PointFields) -> Array:
        """Derivative of the stored energy by the coefficients of the cells, (n_cells, n)."""
        assert isinstance(local, HarmonicFields)
        by_gradient = local.law.stress() + local.pressure[:, None, None] * local.basis
        return self._field.forces(by_gradient.reshape(*self._weight.shape, -1, 9))

    def stiffness(self, local: PointFields) -> Array:
        """Second derivative of the stored energy by the coefficients of the cells, see `NodePairOperator`."""
        assert isinstance(local, HarmonicFields)
        form = local.law.moduli(local.pressure)
        blocks = self._field.stiffness(form.reshape(*self._weight.shape, -1, 9, 9))
        swelling = self._swelling(local)
        blocks += self._field.picked(np.matmul(np.swapaxes(self._kappa * swelling, 1, 2), swelling))
        return blocks

    def _swelling(self, local: PointFields) -> Array:
        """Derivative of the averaged volume's modes and harmonics, (n_cells, n_modes (waves + 1), n)."""
        n_cells, n_points = self._weight.shape
        cofactor = local.basis.reshape(n_cells * n_points, -1, 3, 3)
        along = [cofactor[:, :, k].reshape(n_cells * n_points, -1) @ waves for k, waves in enumerate(self._waves)]
        stacked = np.stack(along, axis=1).reshape(n_cells, 3 * n_points, -1)
        modes, waves = self._tested.shape[1], self.harmonics.waves + 1
        out = np.matmul(self._tested_shape, stacked).reshape(n_cells, modes, -1, waves, self.harmonics.columns)
        swelling = np.swapaxes(out, 2, 3).reshape(n_cells, modes * waves, -1)
        sign = self._sign[self.mesh.cells].reshape(n_cells, 1, -1)
        return np.asarray(swelling * sign)


def _cofactors(f: Array) -> Array:
    """Derivative of the determinant of matrices (n, 3, 3)."""
    return np.stack([np.cross(f[:, (k + 1) % 3], f[:, (k + 2) % 3]) for k in range(3)], axis=1)


def _number(solid: SolidModel, harmonics: Harmonics) -> tuple[Index, Array]:
    """Unknown of each node and coefficient (n_nodes, columns), -1 where fixed, node by node in the solid's order; and
    its sign.

    On the axis only z_0 moves, and across it r_1 = -s_1: one unknown; zero where there are two planes of
    symmetry.
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
    order = np.argsort(solid.dofs.max(axis=1), kind="stable")
    numbers = np.empty(free.shape, dtype=np.intp)
    ranked = free[order]
    numbers[order] = np.where(ranked, np.cumsum(ranked).reshape(ranked.shape) - 1, -1)
    signs = np.ones(free.shape)
    if across:
        numbers[mesh.axis, 4], signs[mesh.axis, 4] = numbers[mesh.axis, 2], -1.0
    return numbers, signs
