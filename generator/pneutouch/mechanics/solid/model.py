"""The finite elements of a wall: energy, forces and stiffness, with lengths in R0 and stresses in mu."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from pneutouch.arrays import Array, Index
from pneutouch.mechanics.laws.hyperelastic import Hyperelastic
from pneutouch.mechanics.laws.strain import BY_A, BY_H, BY_J, BY_JH, GRADIENT, HESSIAN, VALUE, Strain
from pneutouch.mechanics.sensor import RigidBase
from pneutouch.mechanics.solid.banded import AssemblyPattern, BlockEntries, FaceSums
from pneutouch.mechanics.solid.base_contact import BaseContact, BaseFace, BaseLoad
from pneutouch.mechanics.solid.elements import (
    AXIAL,
    DEFAULT_SCHEME,
    F_RR,
    F_RZ,
    F_ZR,
    F_ZZ,
    HOOP,
    IN_PLANE,
    RADIAL,
    Cavity,
    IntegrationScheme,
    gauss_square,
    pressure_modes,
    strain_operator,
)
from pneutouch.mechanics.solid.mesh import SolidMesh
from pneutouch.mechanics.solid.object_contact import Contact

if TYPE_CHECKING:
    from pneutouch.mechanics.solid.flange import FlangeContact

ModulusField = Callable[[Array, Array], Array]

#: Invariants (a, j, h) in the basis of the strains.
_A, _J, _H = range(3)

#: Contact stiffness in mu/t0: a traction of mu leaves a penetration of 3e-5 of the wall.
CONTACT_STIFFNESS = 3.0e4


@dataclass(frozen=True)
class PointFields:
    """Fields at the integration points for one set of nodal positions.

    energy:   stored energy / (mu R0^3); inf if a point is inverted, and then no other field holds.
    strains:  (n_points, 5), see `elements`.
    jets:     (10, n_points) weighted energy derivatives, see `Jet`; the averaged pressure is included.
    basis:    (n_points, 3, 5) derivatives of (a, j, h) by the strains.
    content:  (n_cells, n_modes, 1) change of the averaged volume.
    by_cell:  (n_cells, 3 n_points of a cell + n_modes, 2 n_nodes) derivatives by cell positions of (a, j, h) at the
      cell's points, and of ``content``.
    """

    energy: float
    strains: Array
    jets: Array
    basis: Array
    content: Array
    by_cell: Array


class SolidModel:
    """A wall on one mesh with one law, whose modulus may vary along the arc. Positions are arrays (n_nodes, 2) in units
    of the mesh's ``length``, n_nodes of the mesh; in the shapes of blocks of cells it is the nodes of a cell.

    ``grade`` returns the modulus over that of the material at rest points (r, z), in the same unit, arrays of one
    shape; None: 1. ``base`` supports both faces of the wall, in mm; None: they pass through.
    """

    def __init__(
        self,
        mesh: SolidMesh,
        material: Hyperelastic,
        scheme: IntegrationScheme | None = None,
        grade: ModulusField | None = None,
        base: RigidBase | None = None,
    ) -> None:
        self.mesh, self.material, self.grade = mesh, material, grade or _even
        self.scheme = scheme or DEFAULT_SCHEME[mesh.cells.shape[1]]
        self.length, self.mu = mesh.length, material.mu
        self.wall = mesh.wall / mesh.length
        self.rest = mesh.nodes / mesh.length
        self.bottom = min(float(self.rest[:, 1].min()), mesh.floor / mesh.length)
        self._integration()
        self._assemble(base)
        # Rounding leaves this much force in the exact unloaded state; no residual can fall below it.
        idle, edges = self.forces(self.local(self.rest)), self.dofs[mesh.inner]
        self.noise = float(np.linalg.norm(self.pattern.vector([idle, np.zeros((len(edges), edges[0].size))])))

    def _assemble(self, base: RigidBase | None) -> None:
        """Number the unknowns, and build contact, cavity and supports on the faces."""
        mesh = self.mesh
        meeting = np.zeros((0, 0), np.intp)
        if base is not None and mesh.flange.size:
            from pneutouch.mechanics.solid.flange import meeting_nodes

            meeting = meeting_nodes(mesh)
        self.meeting = meeting
        self.dofs = _number_dofs(mesh, meeting)
        flat = self.dofs.ravel()
        self.size = int((flat >= 0).sum())
        self._order = np.empty(self.size, dtype=np.intp)
        self._order[flat[flat >= 0]] = np.flatnonzero(flat >= 0)
        folding = self.dofs[meeting].reshape(meeting.shape[0], 2 * meeting.shape[1])
        self._patterns(_half_width(folding), folding)
        self.cavity = Cavity(mesh.inner, mesh.pocket / self.length**3)
        self.contact = Contact(mesh, self.rest, float(self.relative.max()) * CONTACT_STIFFNESS / self.wall)
        self.base = None if base is None else BaseContact(*self._base_faces(base), self.faces)
        self.supports: tuple[BaseContact | FlangeContact, ...] = () if self.base is None else (self.base,)
        if folding.size:
            from pneutouch.mechanics.solid.flange import FlangeContact

            self.supports += (FlangeContact(meeting, self.rest, self.contact, self.faces),)

    def _patterns(
        self, width: int = 0, folding: Index | None = None, forms: Mapping[int, BlockEntries] = MappingProxyType({})
    ) -> None:
        """Assembly patterns of the cells with the edges of the inner wall, and of the faces; ``folding``: table of the
        unknowns coupled by the contact with a flange; ``forms`` as in `AssemblyPattern`."""
        mesh = self.mesh
        tables = [self.dofs[x].reshape(x.shape[0], -1) for x in (mesh.cells, mesh.inner, mesh.outer)]
        self.pattern = AssemblyPattern(tables[:2], self.size, width, forms)
        inner, outer = (AssemblyPattern([table], self.size, self.pattern.width) for table in tables[1:])
        fold = None
        if folding is not None and folding.size:
            fold = AssemblyPattern([folding], self.size, self.pattern.width)
        self.faces = FaceSums(inner, outer, fold)

    def _base_faces(self, base: RigidBase) -> tuple[BaseFace, BaseFace]:
        """Contact of the outer face and of the inner face with a base (mm)."""
        flange, opening, *ring = (x / self.length for x in (base.flange, base.opening, base.ring, base.ring_height))
        outer = BaseFace(self.mesh.outer, self.rest, self.contact, flange, (ring[0], ring[1]))
        return outer, BaseFace(self.mesh.inner, self.rest, self.contact, opening, low=self.mesh.floor / self.length)

    def base_load(self, x: Array) -> BaseLoad:
        """Load of the outer wall on its base and on its own flange at positions x (n_nodes, 2)."""
        return sum((part.load(x) for part in self.supports), BaseLoad())

    def _integration(self) -> None:
        """Constant operators: strains (``b``, also as `_tall`), slopes of shapes, and weighted volume modes."""
        points, weights = gauss_square(self.scheme.gauss)
        b, measure, position = strain_operator(self.rest, self.mesh.cells, points)
        self.weight = measure * weights
        self.relative = self.grade(position[..., 0], position[..., 1])
        n_cells, n_points = self.weight.shape
        self.b = np.ascontiguousarray(b)
        self._tall = self.b.reshape(n_cells, n_points * 5, -1)
        slopes = self.b[:, :, F_RR : F_RZ + 1, RADIAL].reshape(n_cells, 2 * n_points, -1)
        self._slopes = np.ascontiguousarray(np.swapaxes(slopes, 1, 2))
        # The second derivatives of a / 2 and of j by cell positions are those of radial by radial, and by axial ones.
        self._bent = np.zeros((n_cells, n_points, 2, 2 * slopes.shape[2]))
        self._bent[..., RADIAL] = slopes.reshape(n_cells, n_points, 2, -1)
        self._bent[:, :, 0, AXIAL] = self._bent[:, :, 1, RADIAL]
        self._bent[:, :, 1, AXIAL] = -self._bent[:, :, 0, RADIAL]
        modes = pressure_modes(points, self.weight, self.scheme.pressure)
        self.tested = np.ascontiguousarray(modes * self.weight[:, None, :])
        self.stiff_weight = (self.relative * self.weight).ravel()
        # The averaged volume belongs to a whole cell, and so does its bulk modulus.
        mean = (self.relative * self.weight).sum(axis=1) / self.weight.sum(axis=1)
        self.kappa = (self.material.bulk_ratio * mean)[:, None, None]

    def expand(self, step: Array) -> Array:
        """Nodal displacement (n_nodes, 2) from the free unknowns (size,); 0 where fixed."""
        out = np.zeros(self.rest.size)
        out[self._order] = step
        return out.reshape(-1, 2)

    def local(self, x: Array) -> PointFields:
        """Strains, energy and energy derivatives at the integration points for positions x (n_nodes, 2)."""
        n_cells, n_points = self.weight.shape
        gathered = x[self.mesh.cells].reshape(n_cells, -1, 1)
        f = np.matmul(self._tall, gathered).reshape(-1, 5)
        rr, rz, zr, zz, h = np.ascontiguousarray(f.T)
        j = rr * zz - rz * zr
        if not (j.min() > 0.0 and h.min() > 0.0):
            return PointFields(np.inf, f, f, f, f, f)
        a = rr * rr + rz * rz + zr * zr + zz * zz
        jets = self.material.energy(Strain(a, j, h)).data * (self.stiff_weight / self.mu)
        content = np.matmul(self.tested, (j * h - 1.0).reshape(n_cells, n_points, 1))
        pressure = self.averaged_pressure(content)
        energy = float(jets[VALUE].sum()) + 0.5 * float(np.vdot(self.kappa * content, content))
        jets[BY_J] += pressure * h
        jets[BY_H] += pressure * j
        jets[BY_JH] += pressure
        basis = np.zeros((j.size, 3, 5))
        basis[:, _A, IN_PLANE] = 2.0 * f[:, IN_PLANE]
        basis[:, _J, F_RR], basis[:, _J, F_RZ], basis[:, _J, F_ZR], basis[:, _J, F_ZZ] = zz, -zr, -rz, rr
        basis[:, _H, HOOP] = 1.0
        by_cell = np.empty((n_cells, 3 * n_points + content.shape[1], self.b.shape[-1]))
        by_point, swelling = np.split(by_cell, [3 * n_points], axis=1)
        np.matmul(basis.reshape(n_cells, n_points, 3, 5), self.b, out=by_point.reshape(n_cells, n_points, 3, -1))
        tested = np.zeros((*self.tested.shape, 3))
        tested[..., _J], tested[..., _H] = (self.tested * x.reshape(n_cells, 1, n_points) for x in (h, j))
        np.matmul(tested.reshape(n_cells, -1, 3 * n_points), by_point, out=swelling)
        return PointFields(energy, f, jets, basis, content, by_cell)

    def averaged_pressure(self, content: Array) -> Array:
        """Averaged pressure (n_points,), weighted, of a ``content`` (n_cells, n_modes, 1)."""
        return np.asarray((self.kappa * np.matmul(np.swapaxes(self.tested, 1, 2), content)).ravel())

    def mixed(self, before: PointFields, here: PointFields, move: Array) -> PointFields:
        """Fields ``here`` at the averaged pressure that the last Newton step, a ``move`` (n_nodes, 2) from the fields
        ``before``, expected: Newton's method for displacements and averaged pressure. The pressure of the positions is
        far off after a long step, and costs up to a fifth more steps."""
        swelling = before.by_cell[:, -before.content.shape[1] :]
        expected = before.content + np.matmul(swelling, move[self.mesh.cells].reshape(len(swelling), -1, 1))
        pressure, jets = self.averaged_pressure(expected - here.content), here.jets.copy()
        jets[BY_J] += pressure * here.strains[:, HOOP]
        jets[BY_JH] += pressure
        return replace(here, jets=jets)

    def forces(self, local: PointFields) -> Array:
        """Derivative of the stored energy by cell positions, (n_cells, 2 n_nodes)."""
        gradient = np.ascontiguousarray(local.jets[GRADIENT].T).reshape(self.weight.shape[0], 1, -1)
        return np.asarray(np.matmul(gradient, local.by_cell[:, : gradient.shape[2]])[:, 0])

    def stiffness(self, local: PointFields) -> Array:
        """Second derivative of the stored energy by cell positions, (n_cells, 2 n_nodes, 2 n_nodes)."""
        n_cells, n_points = self.weight.shape
        jets, by_cell, last = local.jets, local.by_cell, 3 * n_points
        # Small products are twice as fast if their factors are contiguous.
        hessian = np.ascontiguousarray(jets[np.ravel(HESSIAN)].T).reshape(n_cells, n_points, 3, 3)
        forms = np.empty_like(by_cell)
        cells = n_cells, n_points, 3, by_cell.shape[2]
        np.matmul(hessian, by_cell[:, :last].reshape(cells), out=forms[:, :last].reshape(cells))
        np.multiply(self.kappa, by_cell[:, last:], out=forms[:, last:])
        out = np.matmul(np.swapaxes(by_cell, 1, 2), forms)
        weight = np.stack([2.0 * jets[BY_A], jets[BY_J]], axis=1).reshape(n_cells, n_points, 1, 1, 2)
        bent = (self._bent.reshape(n_cells, n_points, 2, -1, 2) * weight).reshape(n_cells, 2 * n_points, -1)
        curved = np.matmul(self._slopes, bent)
        out[:, RADIAL] += curved
        out[:, AXIAL, AXIAL] += curved[..., RADIAL]
        out[:, AXIAL, RADIAL] += np.swapaxes(curved[..., AXIAL], 1, 2)
        return np.asarray(out)


def _even(radius: Array, height: Array) -> Array:
    del height
    return np.ones_like(radius)


def _half_width(table: Index) -> int:
    """Greatest difference between two unknowns' numbers in one row of a table; -1 (fixed) does not count."""
    if not table.size:
        return 0
    return int((table.max(axis=1) - np.where(table < 0, table.max(), table).min(axis=1)).max())


def _number_dofs(mesh: SolidMesh, meeting: Index) -> Index:
    """Numbers (n_nodes, 2) of the unknowns by node and direction, -1 if fixed; reordered if that narrows the band."""
    n = mesh.nodes.shape[0]
    native = np.arange(n)
    # Two columns of nodes span a cell of a dome numbered down each column: no order is narrower.
    span = int(np.ptp(mesh.cells, axis=1).max())
    rank = native if span <= 2 * mesh.axis.size + 2 else _narrower([mesh.cells, meeting], n)
    fixed = np.zeros((n, 2), dtype=bool)
    fixed[mesh.clamped] = True
    fixed[mesh.axis, 0] = True
    fixed[mesh.sliding, 1] = True
    by_rank = np.empty(n, dtype=np.intp)
    by_rank[rank] = native
    free = ~fixed[by_rank].ravel()
    numbers = np.where(free, np.cumsum(free) - 1, -1).reshape(n, 2)
    return numbers[rank].astype(np.intp)


def _narrower(groups: list[Index], n: int) -> Index:
    """Ranks of n nodes by reverse Cuthill-McKee if that narrows the span of node ``groups``, else their own order."""
    # Only a flange needs these, which take a tenth of SciPy's import.
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import reverse_cuthill_mckee

    groups = [rows for rows in groups if rows.size]
    i = np.concatenate([np.repeat(rows, rows.shape[1], axis=1).ravel() for rows in groups])
    k = np.concatenate([np.tile(rows, (1, rows.shape[1])).ravel() for rows in groups])
    graph = csr_array((np.ones(i.size), (i, k)), shape=(n, n))
    order = np.empty(n, dtype=np.intp)
    order[reverse_cuthill_mckee(graph, symmetric_mode=True)] = np.arange(n)
    spans = [max(int(np.ptp(rank[rows], axis=1).max()) for rows in groups) for rank in (order, np.arange(n))]
    return order if spans[0] < spans[1] else np.arange(n)
