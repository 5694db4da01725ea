"""Contact of the outer wall with a rigid surface at equally spaced angles, and records of pressed walls for drawing.

Contact is the solid's penalty at points in space; a pressed wall has positions, contact forces and pressures at nodes.
"""

from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array, Flags, Index
from pneutouch.mechanics.harmonic.fields import FieldGroup, FieldOperator, Harmonics
from pneutouch.mechanics.harmonic.surface import ProfiledObject, Surface, object_lines
from pneutouch.mechanics.solid.elements import line_shapes
from pneutouch.mechanics.solid.mesh import END, START
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.object_contact import Contact, ContactEvaluation, Indenter

_ROWS = 96
"""Number of rows at which a wall is drawn, apart from rows added at the edge of contact."""


@dataclass(frozen=True, slots=True)
class PressedFace:
    """A pressed outer wall, symmetric about the plane of angle 0 (mm, N); its nodes run from the base to the pole.
    Forces are collected only at the ends of edges: with mid-edge nodes included, the values would alternate.

    Attributes:
        indentation: Indentation by the object.
        travel: Distance that the object then moved sideways.
        harmonics: The Fourier sums of the positions.
        coefficients: Positions of the nodes, (n_nodes, columns), see `harmonic.fields.Harmonics`.
        forces: Contact forces of the wall on the object, normal to it, (n_ends, n_angles, 3), at the contact angles of
            `harmonics`; each also stands for its mirror images, with components of opposite sign.
        areas: Areas of the deformed wall that belong to the forces, (n_ends, n_angles), with their mirror images.
        touching: Part of these areas that touches the object, (n_ends, n_angles).
        lines: Lines that outline the object, (k, 3) each.
    """

    indentation: float
    travel: float
    harmonics: Harmonics
    coefficients: Array
    forces: Array
    areas: Array
    touching: Array
    lines: tuple[Array, ...] = ()

    @property
    def edges(self) -> int:
        """Number of edges of the wall's outer face."""
        return len(self.areas) - 1

    def scaled(self, force: float) -> "PressedFace":
        """The face with all forces multiplied by ``force``."""
        return self if force == 1.0 else replace(self, forces=force * self.forces)

    def rows(self) -> Array:
        """Places (n_rows,) along the wall to draw it at, in edges from the base; closer at the edge of contact."""
        share = self.touching / self.areas
        low, high = np.minimum(share[:-1], share[1:]), np.maximum(share[:-1], share[1:])
        partly = ((high > 0.0) & (low < 1.0)).any(axis=1) | (np.ptp(share, axis=1)[1:] > 0.0)
        finest, stride = max(1, min(3, _ROWS // self.edges)), max(1, -(-self.edges // _ROWS))
        places = [np.arange(k, k + 1, 1.0 / (finest if partly[k] else 1)) for k in range(self.edges)]
        every = np.append(np.concatenate(places), float(self.edges))
        return np.asarray(every[::-stride][::-1])

    def positions(self, rows: Array, angles: Array) -> Array:
        """Positions (x, y, z), (n_rows, n_angles, 3), mm, at places along the wall as of `rows` and at angles (rad)."""
        step = (len(self.coefficients) - 1) // self.edges
        edge = np.minimum(rows.astype(np.intp), self.edges - 1)
        nodes = step * edge[:, None] + [0, step, 1][: step + 1]
        along = np.stack([line_shapes(np.array([x]), step + 1)[0][0] for x in 2.0 * (rows - edge) - 1.0])
        place = np.einsum("nk,nkc,aic->nai", along, self.coefficients[nodes], self.harmonics.cartesian(angles))
        return np.asarray(place)

    def pressure(self, rows: Array, angles: Array) -> Array:
        """Contact pressure for rows along the wall and angles, (n_rows, n_angles), MPa: force over touching area.

        Without harmonics, force and area are linear between the ends of edges. With harmonics, because contact angles
        are few, both are averaged with a Gaussian, one edge wide along the wall and half the distance of contact points
        wide across it. The contact ends where half of the area touches; around there the pressure falls to 0. For a
        contact smaller than these distances the share of touching area is taken relative to its maximum, and the
        pressure is multiplied by that.
        """
        force, harmonics = np.linalg.norm(self.forces, axis=2), self.harmonics
        if harmonics.order == 0:
            ends = np.arange(self.edges + 1)
            parts = [np.interp(rows, ends, part[:, 0])[:, None] for part in (force, self.touching, self.areas)]
            return np.repeat(_pressure(np.stack(parts)), angles.size, axis=1)
        half = harmonics.contact_angles
        turns = np.pi * np.arange(harmonics.stride)
        around = np.concatenate([turn + sign * half for turn in turns for sign in (1.0, -1.0)])
        place = self.positions(np.arange(self.edges + 1.0), around)
        loads = np.stack(
            [np.tile(part, 2 * harmonics.stride).ravel() for part in (force, self.touching, self.areas)], axis=1
        )
        along = np.linalg.norm(np.diff(place, axis=0), axis=2).mean(axis=1)
        out = []
        for row, at in zip(rows, self.positions(rows, angles), strict=True):
            apart = sum((at[:, None, k] - place[..., k].ravel()) ** 2 for k in range(3))
            edge = along[min(int(row), self.edges - 1)]
            straight = np.repeat((edge * (row - np.arange(self.edges + 1.0))) ** 2, around.size)
            width = 0.5 * np.maximum(edge, np.hypot(at[:, 0], at[:, 1]) * np.pi / (harmonics.stride * half.size))
            across = np.maximum(apart - straight, 0.0) / width[:, None] ** 2
            out.append((np.exp(-0.5 * (across + straight / edge**2)) @ loads).T)
        return _pressure(np.stack(out, axis=1))


def _pressure(parts: Array) -> Array:
    """Force over touching area, from forces, touching areas and areas (3, ...); falls to 0 where too little touches."""
    force, touching, areas = parts
    share = touching / areas
    greatest = float(share.max())
    if greatest == 0.0:
        return np.zeros_like(share)
    inside = np.clip(2.0 * share / greatest - 0.5, 0.0, 1.0)
    return np.asarray(np.where(inside > 0.0, greatest * inside * force / np.maximum(touching, 1e-300), 0.0))


X, Y, Z = range(3)
"""Cartesian components of a point of a face."""


def face_operator(edges: Index, points: int, harmonics: Harmonics, signs: Array) -> FieldOperator:
    """Operator for positions (x, y, z) at ``points`` Gauss points of each edge and at the contact angles."""
    shape, _ = line_shapes(np.polynomial.legendre.leggauss(points)[0], edges.shape[1])
    return FieldOperator([FieldGroup(shape, harmonics.cartesian(harmonics.contact_angles))], edges, signs)


class HarmonicContact(Contact):
    """The solid's contact with every quadrature point of the outer wall evaluated at each angle: arrays of points are
    (n_edges, n_points, n_angles), slopes have one more axis and curvatures two, by x and y; n nodes an edge."""

    def __init__(self, solid: SolidModel, harmonics: Harmonics, signs: Array) -> None:
        super().__init__(solid.mesh, solid.mesh.nodes / solid.length, solid.contact.stiffness)
        self._operator = face_operator(self.edges, self.shape.shape[0], harmonics, signs)
        angles, self._symmetric = harmonics.contact_angles.size, harmonics.stride > 1
        self.weight = np.repeat(self.weight[..., None], angles, axis=2) / angles
        self.noise = float(np.finfo(np.float64).eps * self.stiffness * np.linalg.norm(self.weight))

    def points(self, nodes: Array) -> Array:
        """Positions (x, y, z) of the points for coefficients, (n_edges, n_points, n_angles, 3)."""
        return self._operator.fields(nodes)

    def touch(self, nodes: Array, plate: Indenter) -> ContactEvaluation:
        """Contact with a surface for coefficients (n_nodes, columns)."""
        place = self.points(nodes)
        assert isinstance(plate, Surface)
        under = plate.over(place[..., X], place[..., Y])
        gap = under.height - place[..., Z]
        traction = np.maximum(-self.stiffness * gap, 0.0)
        return ContactEvaluation(self.energy(traction), traction, gap, under.slope, under.curve)

    def opening(self, touch: ContactEvaluation, move: Array, lift: float | Array) -> Array:
        """Gaps after a displacement of the coefficients, linearised; ``lift`` is the gap before it."""
        place = self.points(move)
        along = touch.slope[..., 0] * place[..., X] + touch.slope[..., 1] * place[..., Y]
        return np.asarray(lift + along - place[..., Z])

    def force(self, traction: Array, slope: Array) -> Array:
        """Derivative of the energy by edge coefficients for given tractions and slopes, (n_edges, n * columns)."""
        return self.load_forces(traction[..., None] * upward(slope))

    def hessian(self, touch: ContactEvaluation, active: Flags) -> Array:
        """Second derivative of the energy, (n_edges, n * columns, n * columns), if the `active` points touch."""
        return self.form_blocks(self.form(touch, active))

    def form(self, touch: ContactEvaluation, active: Flags) -> Array:
        """Derivative of the tractions in space by the positions of the points, (n_edges, n_points, n_angles, 3, 3)."""
        return space_form(np.where(active, self.stiffness, 0.0), touch.slope, -touch.traction, touch.curve)

    def form_blocks(self, form: Array) -> Array:
        """Derivative by the edges' coefficients, (n_edges, n * columns, n * columns), from ``form`` by positions."""
        return self._operator.stiffness(self.weight[..., None, None] * form)

    def load_forces(self, load: Array) -> Array:
        """Derivative of the energy by edge coefficients (n_edges, n * columns), from tractions (x, y, z), (..., 3)."""
        return self._operator.forces(self.weight[..., None] * load)

    def resultant(self, nodes: Array, touch: ContactEvaluation, held: Array | float = 0.0) -> Array:
        """Force (x, y, z) on the object and its moment (x, y, z) about the origin; nondimensional, (2, 3).

        held: friction tractions (x, y, z), (n_edges, n_points, n_angles, 3), 0 without friction.

        Each angle also stands for its mirror images, so the force in y and the moments about x and z are zero; with two
        planes of symmetry the force is vertical and has no moment.
        """
        place = self.points(nodes)
        load = self.weight[..., None] * (touch.traction[..., None] * upward(touch.slope) + held)
        out = np.stack([load.sum(axis=(0, 1, 2)), np.cross(place, load).sum(axis=(0, 1, 2))])
        along = 0.0 if self._symmetric else 1.0
        return np.asarray(out * [[along, 0.0, 1.0], [0.0, along, 0.0]])

    def middle(self, nodes: Array, touch: ContactEvaluation) -> float:
        """Coordinate x (R0) of the centre of the normal tractions; 0 without contact or with two symmetry planes."""
        load = self.weight * touch.traction
        if self._symmetric or not load.any():
            return 0.0
        return float(np.vdot(load, self.points(nodes)[..., X])) / float(load.sum())


def upward(slope: Array) -> Array:
    """Upward normals (..., 3) of a surface with slopes (..., 2) by x and y, with vertical component 1."""
    return np.concatenate([-slope, np.ones((*slope.shape[:-1], 1))], axis=-1)


def space_form(stiff: Array, slope: Array, load: Array, curve: Array) -> Array:
    """Derivative (..., 3, 3) of tractions in space by positions: ``stiff`` (...) by gap; ``load`` (...), down on a
    surface with ``slope`` (..., 2) and second derivatives ``curve`` (..., 2, 2)."""
    normal = upward(slope)
    form = (stiff[..., None] * normal)[..., :, None] * normal[..., None, :]
    form[..., :Z, :Z] += load[..., None, None] * curve
    return np.asarray(form)


_DRAWN = 1.3
"""Distance, over the outer radius of the dome, to which an unbounded object is drawn."""


def pressed_face(
    solid: SolidModel,
    harmonics: Harmonics,
    positions: Array,
    body: ProfiledObject,
    indentation: float,
    travel: float = 0.0,
) -> PressedFace:
    """Pressed outer wall at positions (n_nodes, columns) in mm, under an object (in R0) at its final place.

    Friction tractions are left out: the pressure is the one normal to the object.
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
    """Areas (R0^2) of the deformed outer wall at the points of contact, (n_edges, n_points, n_angles), for coefficients
    x (n_nodes, columns): products of the tangents along the meridian and around the axis."""
    edges, angles = solid.mesh.outer, harmonics.contact_angles
    place, weight = np.polynomial.legendre.leggauss(solid.contact.shape.shape[0])
    value, slope = line_shapes(place, edges.shape[1])
    along = np.einsum("pn,enc,akc->epak", slope, x[edges], harmonics.values(angles), optimize=True)
    around = np.einsum("pn,enc,akc->epak", value, x[edges], harmonics.turned(angles), optimize=True)
    areas = np.linalg.norm(np.cross(along, around), axis=-1)
    return np.asarray(areas * weight[:, None] * (2.0 * np.pi / angles.size))


def _gathered(solid: SolidModel, load: Array) -> Array:
    """Loads (n_mesh_nodes, n_angles, k) at the ends of edges from those at contact points (n_edges, n_points, n_angles,
    k), distributed linearly by distance. All shares are non-negative, so no node is pulled."""
    ends = solid.mesh.outer[:, [START, END]]
    place, _ = np.polynomial.legendre.leggauss(solid.contact.shape.shape[0])
    shares = 0.5 + 0.5 * place[:, None] * np.array([-1.0, 1.0])
    out = np.zeros((solid.mesh.nodes.shape[0], *load.shape[2:]))
    np.add.at(out, ends, np.einsum("pn,epak->enak", shares, load))
    return out


def _along(solid: SolidModel) -> list[int]:
    """Node numbers of the outer wall from the base to the pole."""
    edges = solid.mesh.outer
    order = [START, 2] if edges.shape[1] == 3 else [START]
    return [*edges[:, order].ravel().tolist(), solid.mesh.outer_apex]
