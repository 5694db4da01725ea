"""The second variation of the total energy of an axisymmetric state, for displacements with n waves around the axis.

A displacement is u_r = a cos(n t), u_z = b cos(n t), u_theta = c sin(n t), with t the angle around the axis and nodal
a, b, c on the mesh of the meridian. Integrals over the angle have half their value for n = 0, where the second
variation equals that of the axisymmetric solid. It is a polynomial K0 + n K1 + n^2 K2. The wall contributes with the
law's second derivatives by the shears that vanish in an axisymmetric deformation, and gas, contact, friction and base
contribute on its faces.
"""

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array, Flags, Index
from pneutouch.mechanics.laws.hyperelastic import Hyperelastic
from pneutouch.mechanics.laws.strain import BY_A, BY_AH, BY_HH, BY_J, BY_JH, Strain
from pneutouch.mechanics.solid.banded import AssemblyPattern, is_definite
from pneutouch.mechanics.solid.elements import (
    AXIAL,
    F_RR,
    F_RZ,
    F_ZR,
    F_ZZ,
    HOOP,
    IN_PLANE,
    RADIAL,
    area_ratio,
    line_shapes,
)
from pneutouch.mechanics.solid.mesh import SolidMesh
from pneutouch.mechanics.solid.model import PointFields, SolidModel
from pneutouch.mechanics.solid.newton import SolverState

IN_R, IN_Z, AROUND = range(3)
"""Displacements of a node: radial a and axial b in the meridian, c around the axis."""


@dataclass(frozen=True)
class HarmonicBlocks:
    """Coefficients of 1, n and n^2 of a family of blocks, (n_blocks, 3 n_nodes, 3 n_nodes) each: a, b, c by node."""

    constant: Array
    linear: Array
    square: Array


def empty_blocks(blocks: int, nodes: int) -> Array:
    """Zero array indexed by block, node, displacement, node, displacement."""
    return np.zeros((blocks, nodes, 3, nodes, 3))


def block_family(parts: tuple[Array, Array, Array]) -> HarmonicBlocks:
    """Block family from the coefficients of 1, n and n^2, each indexed as in `empty_blocks`."""
    size = 3 * parts[0].shape[1]
    return HarmonicBlocks(*(part.reshape(-1, size, size) for part in parts))


def with_around(meridian: Array, around: Array | None = None) -> Array:
    """Blocks as in `empty_blocks` from those of the axisymmetric solid (n_blocks, 2 n, 2 n) and of displacements around
    the axis (n_blocks, n, n), None: zeros; n nodes a block."""
    nodes = meridian.shape[1] // 2
    out = empty_blocks(meridian.shape[0], nodes)
    out[:, :, :AROUND, :, :AROUND] = meridian.reshape(-1, nodes, 2, nodes, 2)
    if around is not None:
        out[:, :, AROUND, :, AROUND] = around
    return out


def face_blocks(solid: SolidModel, state: SolverState) -> list[HarmonicBlocks]:
    """Block families of the edges of the inner wall, of the outer wall and, if the wall can meet a flange, of outer
    edges with the flange's top; the last without the work of sliding around the axis."""
    inner, outer = _gas(solid, state), _contact(solid, state)
    if solid.base is not None:
        inner, outer = (
            face if base is None else _with(face, *base)
            for face, base in zip((inner, outer), solid.base.waves(state.x), strict=True)
        )
    for term in state.terms[len(solid.supports) :]:
        if term.blocks is not None:
            outer = _with(outer, term.blocks, term.around)
    if not solid.meeting.size:
        return [inner, outer]
    fold, empty = state.terms[1].fold_blocks, empty_blocks(*solid.meeting.shape)
    return [inner, outer, block_family((empty if fold is None else with_around(fold), empty, empty.copy()))]


def _with(face: HarmonicBlocks, meridian: Array, around: Array | None) -> HarmonicBlocks:
    more = with_around(meridian, around)
    return HarmonicBlocks(face.constant + more.reshape(face.constant.shape), face.linear, face.square)


def _contact(solid: SolidModel, state: SolverState) -> HarmonicBlocks:
    """Second variation of the contact energy by outer edges: a point moved around the axis also moves outwards."""
    contact, touch = solid.contact, state.touch
    empty = empty_blocks(*solid.mesh.outer.shape)
    if touch is None:
        return block_family((empty, empty.copy(), empty.copy()))
    around = None
    if touch.slope.any():
        radius = np.maximum(contact.positions(state.x)[0], 1.0e-300)
        around = contact.across(-touch.traction * touch.slope / radius)
    constant = with_around(contact.hessian(touch, touch.traction > 0.0), around)
    return block_family((constant, empty, empty.copy()))


def _gas(solid: SolidModel, state: SolverState) -> HarmonicBlocks:
    """Second variation of the gas potential, minus pressure times volume, by edges of the inner wall.

    V = (1/2) integral of z_s [h, h_t] - z_t [h, h_s] over meridian s and angle t, h the horizontal position, [,] the
    determinant: to second order pi integral of z'(a^2 + 2 n a c + c^2) + r b'(2 a + n c) + n b (r c' - r' c) ds.
    """
    edges, pressure = solid.mesh.inner, state.filling.pressure
    n = edges.shape[1]
    point, weight = np.polynomial.legendre.leggauss(n)
    value, slope = line_shapes(point, n)
    line = state.x[edges]
    r, by_r, by_z = line[..., 0] @ value.T, line[..., 0] @ slope.T, line[..., 1] @ slope.T

    def form(load: Array, left: Array, right: Array) -> Array:
        return np.asarray(-np.pi * pressure * np.einsum("eq,qi,qk->eik", weight * load, left, right))

    rising = 2.0 * form(by_z, value, value)
    cross = form(r, slope, value) + form(r, value, slope) - form(by_r, value, value)
    constant = with_around(-pressure * solid.cavity.hessian(state.x), rising)
    linear = empty_blocks(edges.shape[0], n)
    for field, block in ((IN_R, rising), (IN_Z, cross)):
        linear[:, :, field, :, AROUND] = block
        linear[:, :, AROUND, :, field] = np.swapaxes(block, 1, 2)
    return block_family((constant, linear, np.zeros_like(linear)))


R_T, Z_T, T_R, T_Z = range(4)
"""Shear components of a point: F_(r theta), F_(z theta), F_(theta R) and F_(theta Z)."""


def shear_moduli(law: Hyperelastic, strains: Array, pressure: Array) -> Array:
    """Hessian (n_points, 4, 4) by the shears, in MPa, of the law's energy plus ``pressure`` (n_points; MPa) times J.

    ``strains`` (n_points, 5) as in `elements`. The deformation gradient is block diagonal, so two of its principal axes
    are in the plane and the third is the hoop. A shear between one of the first two and the hoop leaves the other
    alone: the energy then is that of a plane deformation, a function of a = |F|^2 and j = det F of this pair, with 2
    W_a on the diagonal of the Hessian and -W_j off it. It is smooth where stretches coincide.
    """
    e, d = 0.5 * (strains[:, F_RR] + strains[:, F_ZZ]), 0.5 * (strains[:, F_RR] - strains[:, F_ZZ])
    k, g = 0.5 * (strains[:, F_ZR] - strains[:, F_RZ]), 0.5 * (strains[:, F_ZR] + strains[:, F_RZ])
    # F = rotation(left) diag(stretches) rotation(right); left + right has the direction (e, k), left - right (d, g).
    mean, half = np.hypot(e, k), np.hypot(d, g)
    stretch, hoop = np.stack([mean + half, mean - half]), strains[:, HOOP]
    other = stretch[::-1]
    jet = law.energy(Strain((stretch**2 + hoop**2).ravel(), (stretch * hoop).ravel(), other.ravel())).data
    alone = 2.0 * jet[BY_A].reshape(2, -1)
    both = -(jet[BY_J].reshape(2, -1) + pressure * other)
    safe = np.where(half > 0.0, half, 1.0)
    cos_sum, sin_sum, cos_gap, sin_gap = e / mean, k / mean, d / safe, g / safe
    even, odd = 0.5 * (alone[0] + alone[1]), 0.5 * (alone[0] - alone[1])
    out = np.empty((strains.shape[0], 4, 4))
    twice_left = odd * (cos_sum * cos_gap - sin_sum * sin_gap), odd * (sin_sum * cos_gap + cos_sum * sin_gap)
    twice_right = odd * (cos_sum * cos_gap + sin_sum * sin_gap), odd * (sin_sum * cos_gap - cos_sum * sin_gap)
    out[:, R_T, R_T], out[:, Z_T, Z_T] = even + twice_left[0], even - twice_left[0]
    out[:, R_T, Z_T] = out[:, Z_T, R_T] = twice_left[1]
    out[:, T_R, T_R], out[:, T_Z, T_Z] = even + twice_right[0], even - twice_right[0]
    out[:, T_R, T_Z] = out[:, T_Z, T_R] = -twice_right[1]
    even, odd = 0.5 * (both[0] + both[1]), 0.5 * (both[0] - both[1])
    out[:, R_T, T_R] = out[:, T_R, R_T] = even * cos_sum + odd * cos_gap
    out[:, R_T, T_Z] = out[:, T_Z, R_T] = odd * sin_gap - even * sin_sum
    out[:, Z_T, T_R] = out[:, T_R, Z_T] = odd * sin_gap + even * sin_sum
    out[:, Z_T, T_Z] = out[:, T_Z, Z_T] = even * cos_sum - odd * cos_gap
    return out


#: Gradient components of a scalar: by R, by Z, and the scalar over R.
_BY_R, _BY_Z, _OVER_R = range(3)


class HarmonicSolid:
    """The second variation of a solid at its states, from operators that do not depend on the state."""

    def __init__(self, solid: SolidModel) -> None:
        self.solid = solid
        mesh = solid.mesh
        n_cells, n_points = solid.weight.shape
        gradients = [solid.b[:, :, row, RADIAL] for row in (F_RR, F_RZ, HOOP)]
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
        """Nodal displacements a, b, c (n_nodes, 3) from the unknowns for n waves."""
        out = np.where(self.unknowns >= 0, vector[self.unknowns], 0.0)
        out[self.solid.mesh.axis, AROUND] *= -1.0
        if n > 1:
            out[self.solid.mesh.axis] = 0.0
        return np.asarray(out)

    def bands(self, state: SolverState, numbers: tuple[int, ...]) -> dict[int, Array]:
        """Lower bands of the second variation at a state, by number of waves, for the ``numbers`` (1 or more).

        On the axis b is zero; c is -a for one wave, a displacement across the axis; for more waves all three are zero,
        and their rows and columns have only a large diagonal. The trapped gas adds nothing: such displacements keep the
        volume to first order.
        """
        families, parts = self.blocks(state), ("constant", "linear", "square")
        constant, linear, square = (self._assembled([getattr(f, part) for f in families]) for part in parts)
        out = {}
        for n in numbers:
            out[n] = n * square
            out[n] += linear
            out[n] *= n
            out[n] += constant
            if n > 1:
                _fix(out[n], self._on_axis)
        return out

    def _assembled(self, blocks: list[Array]) -> Array:
        """Lower band of the sum of all families' blocks, whose signs for c on the axis are reversed in place."""
        for block, turned, sign in zip(blocks, self._turned, self._signs, strict=True):
            block[turned] *= sign
        return self._pattern.matrix(blocks)

    def blocks(self, state: SolverState) -> list[HarmonicBlocks]:
        """Second variation at a state: families of the cells, then those of `face_blocks`."""
        return [self.wall(state.local), *face_blocks(self.solid, state)]

    def wall(self, local: PointFields) -> HarmonicBlocks:
        """Second variation of the wall's stored energy by cells."""
        d, n_cells = self._shears(local), self.solid.weight.shape[0]
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
        """Blocks (n_cells, n, n) from a bilinear form of the gradients of two displacements, (n_points, 3, 3)."""
        n_cells, n_points = self.solid.weight.shape
        moved = np.matmul(form.reshape(n_cells, n_points, 3, 3), self._gradient)
        return np.asarray(np.matmul(self._wide, moved.reshape(n_cells, 3 * n_points, -1)))

    def _shears(self, local: PointFields) -> Array:
        """Weighted Hessian by the shears, nondimensional, with the averaged pressure; (n_points, 4, 4)."""
        pressure = self.solid.averaged_pressure(local.content)
        scale = self.solid.stiff_weight / self.solid.mu
        moduli = shear_moduli(self.solid.material, local.strains, pressure / scale)
        return np.asarray(moduli * scale[:, None, None])

    def _mixed(self, local: PointFields, d: Array) -> tuple[Array, Array]:
        """Coefficients of n in the blocks between a and c, and between b and c, (n_cells, n, n) each."""
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
        """Add, in place, the part of the averaged volume's stiffness that involves c."""
        solid, swelling = self.solid, local.by_cell[:, -local.content.shape[1] :]
        area = area_ratio(local.strains).reshape(solid.weight.shape[0], 1, -1)
        swell_c = np.matmul(solid.tested * area, self._over)
        stiff = solid.kappa * swell_c
        for field, swell in ((IN_R, swelling[..., RADIAL]), (IN_Z, swelling[..., AXIAL])):
            block = np.matmul(np.swapaxes(swell, 1, 2), stiff)
            linear[:, :, field, :, AROUND] += block
            linear[:, :, AROUND, :, field] += np.swapaxes(block, 1, 2)
        square[:, :, AROUND, :, AROUND] += np.matmul(np.swapaxes(swell_c, 1, 2), stiff)


def _around(d: Array) -> Array:
    """Bilinear form (n_points, 3, 3) of c with itself: its shear R_T is -c/R, and its gradients are T_R and T_Z."""
    form = np.empty((d.shape[0], 3, 3))
    places = ((_BY_R, T_R, 1.0), (_BY_Z, T_Z, 1.0), (_OVER_R, R_T, -1.0))
    for i, row, sign in places:
        for k, column, other in places:
            form[:, i, k] = sign * other * d[:, row, column]
    return form


def _number(solid: SolidModel) -> Index:
    """Numbers (n_nodes, 3) of the unknowns in the axisymmetric solid's order, -1: fixed; a and c on the axis share."""
    mesh: SolidMesh = solid.mesh
    free = np.ones((mesh.nodes.shape[0], 3), dtype=bool)
    free[mesh.axis] = True, False, False
    free[mesh.sliding, IN_Z] = False
    free[mesh.clamped] = False
    numbers = ranked_numbers(free, solid)
    numbers[mesh.axis, AROUND] = numbers[mesh.axis, IN_R]
    return numbers


def ranked_numbers(free: Flags, solid: SolidModel) -> Index:
    """Numbers (n_nodes, k) of the ``free`` unknowns, -1 for others, node by node in the solid's order."""
    order = np.argsort(solid.dofs.max(axis=1), kind="stable")
    numbers, ranked = np.empty(free.shape, dtype=np.intp), free[order]
    numbers[order] = np.where(ranked, np.cumsum(ranked).reshape(ranked.shape) - 1, -1)
    return numbers


def _fix(band: Array, unknowns: Index) -> None:
    """Uncouple unknowns of a lower band, in place, and set their diagonal to the largest absolute diagonal entry."""
    width, largest = band.shape[0] - 1, float(np.abs(band[0]).max())
    for unknown in unknowns[unknowns >= 0]:
        back = np.arange(1, min(width, int(unknown)) + 1)
        band[back, unknown - back] = 0.0
        band[:, unknown] = 0.0
        band[0, unknown] = largest


def unstable_waves(harmonic: HarmonicSolid, state: SolverState, numbers: tuple[int, ...]) -> tuple[int, ...]:
    """Numbers of waves, among those given, for which the second variation at a state is not positive definite."""
    return tuple(n for n, band in harmonic.bands(state, numbers).items() if not is_definite(band))
