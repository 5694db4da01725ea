"""Contact of the outer wall with a rigid surface at equally spaced angles: the solid's penalty at points in space.

The outer wall of a solved state: forces of contact gathered at its nodes, and the object over it.
"""

from __future__ import annotations

import numpy as np

from pneutouch.arrays import Array, Flags, Index
from pneutouch.mechanics.harmonic.fields import FieldGroup, FieldOperator, Harmonics
from pneutouch.mechanics.harmonic.surface import ProfiledObject, Surface, object_lines
from pneutouch.mechanics.pressed_face import PressedFace
from pneutouch.mechanics.solid.elements import line_shapes
from pneutouch.mechanics.solid.indenter import Indenter
from pneutouch.mechanics.solid.mesh import END, START
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.object_contact import Contact, ContactEvaluation

X, Y, Z = range(3)
"""Cartesian fields of a point of a face."""


def face_operator(edges: Index, points: int, harmonics: Harmonics, signs: Array) -> FieldOperator:
    """Positions (x, y, z) at the Gauss points of edges and at the angles."""
    shape, _ = line_shapes(np.polynomial.legendre.leggauss(points)[0], edges.shape[1])
    return FieldOperator([FieldGroup(shape, harmonics.cartesian(harmonics.contact_angles))], edges, signs)


class HarmonicContact(Contact):
    """The solid's contact with every quadrature point of the outer wall taken at each angle: arrays of points are
    (n_edges, n_points, n_angles), slopes have one axis more and curvatures two, by x and y."""

    def __init__(self, solid: SolidModel, harmonics: Harmonics, signs: Array) -> None:
        super().__init__(solid.mesh, solid.mesh.nodes / solid.length, solid.contact.stiffness)
        self._operator = face_operator(self.edges, self.shape.shape[0], harmonics, signs)
        angles, self._symmetric = harmonics.contact_angles.size, harmonics.stride > 1
        self.weight = np.repeat(self.weight[..., None], angles, axis=2) / angles
        self.noise = float(np.finfo(np.float64).eps * self.stiffness * np.linalg.norm(self.weight))

    def points(self, nodes: Array) -> Array:
        """Positions (x, y, z) of the points, (n_edges, n_points, n_angles, 3)."""
        return self._operator.fields(nodes)

    def touch(self, nodes: Array, plate: Indenter) -> ContactEvaluation:
        """Energy and tractions against a surface for coefficients (n_nodes, columns)."""
        place = self.points(nodes)
        assert isinstance(plate, Surface)
        under = plate.over(place[..., X], place[..., Y])
        gap = under.height - place[..., Z]
        traction = np.maximum(-self.stiffness * gap, 0.0)
        energy = float(np.vdot(self.weight, traction**2)) / (2.0 * self.stiffness)
        return ContactEvaluation(energy, traction, gap, under.slope, under.curve)

    def opening(self, touch: ContactEvaluation, move: Array, lift: float | Array) -> Array:
        """Gaps after a displacement of the nodes, taken as linear in it, where the surface was ``lift`` above."""
        place = self.points(move)
        along = touch.slope[..., 0] * place[..., X] + touch.slope[..., 1] * place[..., Y]
        return np.asarray(lift + along - place[..., Z])

    def force(self, traction: Array, slope: Array) -> Array:
        """Derivative of the energy by edge coefficients under given tractions, (n_edges, n columns)."""
        return self.load_forces(traction[..., None] * upward(slope))

    def hessian(self, touch: ContactEvaluation, active: Flags) -> Array:
        """Second derivative with `active` points in contact, (n_edges, n columns, n columns)."""
        return self.form_blocks(self.form(touch, active))

    def form(self, touch: ContactEvaluation, active: Flags) -> Array:
        """Derivative of the tractions in space by the positions of the points, (n_edges, n_points, n_angles, 3, 3)."""
        normal = upward(touch.slope)
        form = (np.where(active, self.stiffness, 0.0)[..., None] * normal)[..., :, None] * normal[..., None, :]
        form[..., :Z, :Z] -= touch.traction[..., None, None] * touch.curve
        return form

    def form_blocks(self, form: Array) -> Array:
        """A derivative by the positions as one by the coefficients of the edges, (n_edges, n columns, n columns)."""
        return self._operator.stiffness(self.weight[..., None, None] * form)

    def load_forces(self, load: Array) -> Array:
        """Derivative of the energy by edge coefficients (n_edges, n columns) of tractions in space, (..., 3)."""
        return self._operator.forces(self.weight[..., None] * load)

    def resultant(self, nodes: Array, touch: ContactEvaluation, held: Array | float = 0.0) -> Array:
        """Force (x, y, z) on the object and its moment (x, y, z) about the origin; nondimensional, (2, 3).

        held: tractions of friction in space, (n_edges, n_points, n_angles, 3).

        Each angle stands for its mirror images too, so the force in y and the moments about x and z are zero; with two
        planes of symmetry the force is upright and has no moment.
        """
        place = self.points(nodes)
        load = self.weight[..., None] * (touch.traction[..., None] * upward(touch.slope) + held)
        out = np.stack([load.sum(axis=(0, 1, 2)), np.cross(place, load).sum(axis=(0, 1, 2))])
        along = 0.0 if self._symmetric else 1.0
        return np.asarray(out * [[along, 0.0, 1.0], [0.0, along, 0.0]])

    def middle(self, nodes: Array, touch: ContactEvaluation) -> float:
        """Middle of the normal tractions along x; 0 without any."""
        load = self.weight * touch.traction
        if self._symmetric or not load.any():
            return 0.0
        return float(np.vdot(load, self.points(nodes)[..., X])) / float(load.sum())


def upward(slope: Array) -> Array:
    """Direction upwards on a surface of a slope, of height 1: (-d/dx, -d/dy, 1)."""
    return np.concatenate([-slope, np.ones((*slope.shape[:-1], 1))], axis=-1)


_DRAWN = 1.3
"""Distance over the outer radius of the dome to which an endless object is drawn."""


def pressed_face(
    solid: SolidModel,
    harmonics: Harmonics,
    positions: Array,
    body: ProfiledObject,
    indentation: float,
    travel: float = 0.0,
) -> PressedFace:
    """The outer wall at positions (n_nodes, columns) in mm under an object in R0 that stands in its place.

    With friction its tractions are left out: the pressure is that normal to the object.
    """
    contact = HarmonicContact(solid, harmonics, np.ones(positions.shape))
    x, length = positions / solid.length, solid.length
    touch = contact.touch(x, body)
    load = (contact.weight * touch.traction)[..., None] * upward(touch.slope)
    areas = face_areas(solid, x, harmonics)
    both = _gathered(solid, np.stack([areas, np.where(touch.traction > 0.0, areas, 0.0)], axis=3)) * length**2
    ends = [*solid.mesh.outer[:, START], solid.mesh.outer_apex]
    reach = _DRAWN * float(solid.mesh.nodes[:, 0].max())
    return PressedFace(
        indentation=indentation,
        travel=travel,
        harmonics=harmonics,
        coefficients=positions[_along(solid)],
        forces=_gathered(solid, load)[ends] * solid.mu * length**2,
        areas=both[ends, :, 0],
        touching=both[ends, :, 1],
        lines=tuple(line * length for line in object_lines(body, reach / length)),
    )


def face_areas(solid: SolidModel, x: Array, harmonics: Harmonics) -> Array:
    """Areas of the deformed outer wall at the points of contact (n_edges, n_points, n_angles) in R0 squared: the
    product of the tangents along the meridian and around the axis, of coefficients x (n_nodes, columns)."""
    edges, angles = solid.mesh.outer, harmonics.contact_angles
    place, weight = np.polynomial.legendre.leggauss(solid.contact.shape.shape[0])
    value, slope = line_shapes(place, edges.shape[1])
    along = np.einsum("pn,enc,akc->epak", slope, x[edges], harmonics.values(angles), optimize=True)
    around = np.einsum("pn,enc,akc->epak", value, x[edges], harmonics.turned(angles), optimize=True)
    areas = np.linalg.norm(np.cross(along, around), axis=-1)
    return np.asarray(areas * weight[:, None] * (2.0 * np.pi / angles.size))


def _gathered(solid: SolidModel, load: Array) -> Array:
    """Loads at the points of contact (n_edges, n_points, n_angles, k) at the ends of their edges, in shares by the
    distance from them, (n_mesh_nodes, n_angles, k). No share is negative: no node is pulled."""
    ends = solid.mesh.outer[:, [START, END]]
    place, _ = np.polynomial.legendre.leggauss(solid.contact.shape.shape[0])
    shares = 0.5 + 0.5 * place[:, None] * np.array([-1.0, 1.0])
    out = np.zeros((solid.mesh.nodes.shape[0], *load.shape[2:]))
    np.add.at(out, ends, np.einsum("pn,epak->enak", shares, load))
    return out


def _along(solid: SolidModel) -> list[int]:
    """Nodes of the outer wall from the base to the pole."""
    edges = solid.mesh.outer
    order = [START, 2] if edges.shape[1] == 3 else [START]
    return [*edges[:, order].ravel().tolist(), solid.mesh.outer_apex]
