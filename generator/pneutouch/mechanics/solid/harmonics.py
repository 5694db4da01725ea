"""The second variation of the total energy around the axis, for displacements of n waves on an axisymmetric state.

A displacement is u_r = a cos(n t), u_z = b cos(n t), u_theta = c sin(n t) of the angle t around the axis, with nodal
a, b, c on the mesh of the meridian. Integrals over the angle are taken over half their value for n = 0, where the
second variation is then that of the axisymmetric solid. It is a polynomial K0 + n K1 + n^2 K2.
"""

from __future__ import annotations

import numpy as np

from pneutouch.arrays import Array, Index
from pneutouch.mechanics.laws.strain import BY_AH, BY_HH, BY_JH
from pneutouch.mechanics.solid.banded import AssemblyPattern
from pneutouch.mechanics.solid.elements import gauss_square, pressure_modes, strain_operator
from pneutouch.mechanics.solid.harmonic_faces import (
    AROUND,
    IN_R,
    IN_Z,
    HarmonicBlocks,
    block_family,
    empty_blocks,
    face_blocks,
    with_around,
)
from pneutouch.mechanics.solid.kinematics import F_RR, F_RZ, F_ZR, F_ZZ, HOOP, IN_PLANE, RADIAL, area_ratio
from pneutouch.mechanics.solid.mesh import SolidMesh
from pneutouch.mechanics.solid.model import PointFields, SolidModel
from pneutouch.mechanics.solid.newton import SolverState
from pneutouch.mechanics.solid.out_of_plane import R_T, T_R, T_Z, Z_T, shear_moduli

#: Gradients of a scalar: by R, by Z, over R.
_BY_R, _BY_Z, _OVER_R = range(3)


class HarmonicSolid:
    """The operators of a solid that do not depend on its state, and the second variation at a state."""

    def __init__(self, solid: SolidModel) -> None:
        self.solid = solid
        mesh = solid.mesh
        points, weights = gauss_square(solid.scheme.gauss)
        b, measure, position = strain_operator(solid.rest, mesh.cells, points)
        self._weight = measure * weights
        relative = solid.grade(position[..., 0], position[..., 1])
        self._relative = (relative * self._weight).ravel()
        mean = (relative * self._weight).sum(axis=1) / self._weight.sum(axis=1)
        self._kappa = (solid.material.bulk_ratio * mean)[:, None, None]
        self._tested = pressure_modes(points, self._weight, solid.scheme.pressure) * self._weight[:, None, :]
        n_cells, n_points = self._weight.shape
        gradients = [b[:, :, row, RADIAL] for row in (F_RR, F_RZ, HOOP)]
        self._gradient = np.stack(gradients, axis=2)
        self._tall = self._gradient.reshape(n_cells, 3 * n_points, -1)
        self._wide = np.ascontiguousarray(np.swapaxes(self._tall, 1, 2))
        self._over = np.ascontiguousarray(self._gradient[:, :, _OVER_R])
        self._over_wide = np.ascontiguousarray(np.swapaxes(self._over, 1, 2))
        families = [mesh.cells, mesh.inner, mesh.outer, *([] if solid.meeting.size == 0 else [solid.meeting])]
        self.unknowns = _number(solid)
        tables = [self.unknowns[x].reshape(x.shape[0], -1) for x in families]
        self._pattern = AssemblyPattern(tables, int(self.unknowns.max()) + 1)
        signs = np.ones((mesh.nodes.shape[0], 3))
        signs[mesh.axis, AROUND] = -1.0
        by_block = [signs[x].reshape(x.shape[0], -1) for x in families]
        self._turned = [np.flatnonzero((sign < 0.0).any(axis=1)) for sign in by_block]
        pairs = zip(by_block, self._turned, strict=True)
        self._signs = [sign[at, :, None] * sign[at, None, :] for sign, at in pairs]
        self._on_axis = self.unknowns[mesh.axis, IN_R]

    def expand(self, n: int, vector: Array) -> Array:
        """Nodal displacements a, b, c (n_nodes, 3) of the unknowns of n waves."""
        out = np.where(self.unknowns >= 0, vector[self.unknowns], 0.0)
        out[self.solid.mesh.axis, AROUND] *= -1.0
        if n > 1:
            out[self.solid.mesh.axis] = 0.0
        return np.asarray(out)

    def bands(self, state: SolverState, numbers: tuple[int, ...]) -> dict[int, Array]:
        """Lower bands of the second variation for numbers of waves of at least one, by number.

        On the axis b is zero; c is -a for one wave, a displacement across the axis, and for more waves all are zero:
        their rows and columns hold a large diagonal alone. The trapped gas adds nothing: such displacements keep the
        volume to first order.
        """
        families, constant = self.blocks(state), None
        out = {}
        for n in numbers:
            if len(numbers) == 1:
                out[n] = self._assembled([family.at(n) for family in families])
            else:
                if constant is None:
                    names = ("constant", "linear", "square")
                    constant, linear, square = (self._assembled([getattr(f, p) for f in families]) for p in names)
                out[n] = constant + n * linear + n * n * square
            if n > 1:
                _fix(out[n], self._on_axis)
        return out

    def _assembled(self, blocks: list[Array]) -> Array:
        """Band of a sum of blocks, whose signs of c on the axis are turned in place."""
        for block, turned, sign in zip(blocks, self._turned, self._signs, strict=True):
            block[turned] *= sign
        return self._pattern.matrix(blocks)

    def blocks(self, state: SolverState) -> list[HarmonicBlocks]:
        """The second variation by cells, by edges of the inner and of the outer wall, and where the wall can meet a
        flange by those edges with its top: there without the work of sliding around the axis."""
        return [self.wall(state.local), *face_blocks(self.solid, state)]

    def wall(self, local: PointFields) -> HarmonicBlocks:
        """Second variation of the stored energy by cells."""
        d, n_cells = self._shears(local), self._weight.shape[0]
        constant = with_around(self.solid.stiffness(local))
        nodes = constant.shape[1]
        linear, square = empty_blocks(n_cells, nodes), empty_blocks(n_cells, nodes)
        constant[:, :, AROUND, :, AROUND] = self._product(_around(d))
        for field, block in zip((IN_R, IN_Z), self._mixed(local, d), strict=True):
            linear[:, :, field, :, AROUND] = block
            linear[:, :, AROUND, :, field] = np.swapaxes(block, 1, 2)
        hoop = local.jets[BY_HH]
        for i, k, values in (
            (IN_R, IN_R, d[:, R_T, R_T]),
            (IN_Z, IN_Z, d[:, Z_T, Z_T]),
            (IN_R, IN_Z, d[:, R_T, Z_T]),
            (AROUND, AROUND, hoop),
        ):
            block = np.matmul(self._over_wide, values.reshape(n_cells, -1, 1) * self._over)
            square[:, :, i, :, k] = block
            square[:, :, k, :, i] = block
        self._add_swelling(local, linear, square)
        return block_family((constant, linear, square))

    def _product(self, form: Array) -> Array:
        """Blocks (n_cells, n, n) of a form of the gradients of two displacements, (n_points, 3, 3)."""
        n_cells, n_points = self._weight.shape
        moved = np.matmul(form.reshape(n_cells, n_points, 3, 3), self._gradient)
        return np.asarray(np.matmul(self._wide, moved.reshape(n_cells, 3 * n_points, -1)))

    def _shears(self, local: PointFields) -> Array:
        """Weighted Hessian by the shears, nondimensional, with the averaged pressure; (n_points, 4, 4)."""
        n_cells, n_points = self._weight.shape
        change = (area_ratio(local.strains) * local.strains[:, HOOP] - 1.0).reshape(n_cells, n_points, 1)
        content = np.matmul(self._tested, change)
        pressure = (self._kappa * np.matmul(np.swapaxes(self._tested, 1, 2), content)).ravel()
        scale = self._relative / self.solid.mu
        moduli = shear_moduli(self.solid.material, local.strains, pressure / scale)
        return np.asarray(moduli * scale[:, None, None])

    def _mixed(self, local: PointFields, d: Array) -> tuple[Array, Array]:
        """Blocks between a and c, and between b and c: the part in n."""
        by_hoop = local.jets[BY_AH][:, None] * local.basis[:, 0, IN_PLANE]
        by_hoop += local.jets[BY_JH][:, None] * local.basis[:, 1, IN_PLANE]
        forms = []
        for columns, shear in (((F_RR, F_RZ), R_T), ((F_ZR, F_ZZ), Z_T)):
            form = np.zeros((d.shape[0], 3, 3))
            form[:, _BY_R, _OVER_R], form[:, _BY_Z, _OVER_R] = by_hoop[:, columns[0]], by_hoop[:, columns[1]]
            form[:, _OVER_R, _OVER_R] = d[:, shear, R_T]
            form[:, _OVER_R, _BY_R], form[:, _OVER_R, _BY_Z] = -d[:, shear, T_R], -d[:, shear, T_Z]
            forms.append(form)
        forms[0][:, _OVER_R, _OVER_R] += local.jets[BY_HH]
        return self._product(forms[0]), self._product(forms[1])

    def _add_swelling(self, local: PointFields, linear: Array, square: Array) -> None:
        """Add the contribution of the averaged volume's stiffness with c, in place."""
        n_cells, n_points = self._weight.shape
        nodes = linear.shape[1]
        area = area_ratio(local.strains)
        in_plane = local.basis[:, 1, IN_PLANE] * local.strains[:, HOOP:]
        by_a = np.stack([in_plane[:, F_RR], in_plane[:, F_RZ], area], axis=1)
        by_b = np.stack([in_plane[:, F_ZR], in_plane[:, F_ZZ]], axis=1)
        tested = self._tested[..., None]
        swell_a, swell_b, swell_c = (
            np.matmul(
                (tested * values.reshape(n_cells, 1, n_points, -1)).reshape(n_cells, tested.shape[1], -1),
                self._gradient[:, :, rows].reshape(n_cells, -1, nodes),
            )
            for values, rows in (
                (by_a, slice(None)),
                (by_b, slice(_BY_R, _OVER_R)),
                (area[:, None], slice(_OVER_R, None)),
            )
        )
        stiff = self._kappa * swell_c
        for field, swell in ((IN_R, swell_a), (IN_Z, swell_b)):
            block = np.matmul(np.swapaxes(swell, 1, 2), stiff)
            linear[:, :, field, :, AROUND] += block
            linear[:, :, AROUND, :, field] += np.swapaxes(block, 1, 2)
        square[:, :, AROUND, :, AROUND] += np.matmul(np.swapaxes(swell_c, 1, 2), stiff)


def _around(d: Array) -> Array:
    """The form of c with itself: its strains are -c/R in r theta, and its gradients in theta R and theta Z."""
    form = np.empty((d.shape[0], 3, 3))
    places = ((_BY_R, T_R, 1.0), (_BY_Z, T_Z, 1.0), (_OVER_R, R_T, -1.0))
    for i, row, sign in places:
        for k, column, other in places:
            form[:, i, k] = sign * other * d[:, row, column]
    return form


def _number(solid: SolidModel) -> Index:
    """Unknowns (n_nodes, 3) in the order of the axisymmetric solid's, -1 where fixed; on the axis a and c are one."""
    mesh: SolidMesh = solid.mesh
    free = np.ones((mesh.nodes.shape[0], 3), dtype=bool)
    free[mesh.axis] = True, False, False
    free[mesh.sliding, IN_Z] = False
    free[mesh.clamped] = False
    order = np.argsort(solid.dofs.max(axis=1), kind="stable")
    numbers = np.empty(free.shape, dtype=np.intp)
    ranked = free[order]
    numbers[order] = np.where(ranked, np.cumsum(ranked).reshape(ranked.shape) - 1, -1)
    numbers[mesh.axis, AROUND] = numbers[mesh.axis, IN_R]
    return numbers


def _fix(band: Array, unknowns: Index) -> None:
    """Uncouple unknowns of a lower band, in place: their diagonal becomes the largest of all."""
    width, largest = band.shape[0] - 1, float(np.abs(band[0]).max())
    for unknown in unknowns[unknowns >= 0]:
        back = np.arange(1, min(width, int(unknown)) + 1)
        band[back, unknown - back] = 0.0
        band[:, unknown] = 0.0
        band[0, unknown] = largest
