"""The second variation around the axis of what acts on the faces of the wall: gas, contact, friction and base."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.solid.elements import line_shapes
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import SolverState

IN_R, IN_Z, AROUND = range(3)
"""Displacements of a node: a and b in the meridian, c around the axis."""


@dataclass(frozen=True)
class HarmonicBlocks:
    """Coefficients of 1, n and n^2 of one family of blocks, each (n_blocks, 3 n, 3 n): a, b, c node by node."""

    constant: Array
    linear: Array
    square: Array

    def at(self, n: int) -> Array:
        """The blocks for n waves."""
        return np.asarray(self.constant + n * self.linear + n * n * self.square)


def empty_blocks(blocks: int, nodes: int) -> Array:
    """Zeros, indexed by block, node, displacement, node, displacement."""
    return np.zeros((blocks, nodes, 3, nodes, 3))


def block_family(parts: tuple[Array, Array, Array]) -> HarmonicBlocks:
    """Coefficients indexed as those of `empty_blocks`."""
    size = 3 * parts[0].shape[1]
    return HarmonicBlocks(*(part.reshape(-1, size, size) for part in parts))


def with_around(meridian: Array, around: Array | None = None) -> Array:
    """Blocks of the axisymmetric solid (n_blocks, 2 n, 2 n) with those of displacements around the axis, (n_blocks, n,
    n), or with space for them."""
    nodes = meridian.shape[1] // 2
    out = empty_blocks(meridian.shape[0], nodes)
    out[:, :, :AROUND, :, :AROUND] = meridian.reshape(-1, nodes, 2, nodes, 2)
    if around is not None:
        out[:, :, AROUND, :, AROUND] = around
    return out


def face_blocks(solid: SolidModel, state: SolverState) -> list[HarmonicBlocks]:
    """Families of the edges of the inner and of the outer wall, and where the wall can meet a flange of those edges
    with its top: there without the work of sliding around the axis."""
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
    """Second variation of the contact's energy: a point that moves around the axis moves outwards, too."""
    contact, touch = solid.contact, state.touch
    empty = empty_blocks(*solid.mesh.outer.shape)
    if touch is None:
        return block_family((empty, empty.copy(), empty.copy()))
    around = None
    if touch.slope.any():
        radius = np.maximum(contact.positions(state.x)[0], 1.0e-300)
        load = -contact.weight * touch.traction * touch.slope / radius
        around = np.einsum("eq,qi,qk->eik", load, contact.shape, contact.shape)
    constant = with_around(contact.hessian(touch, touch.traction > 0.0), around)
    return block_family((constant, empty, empty.copy()))


def _gas(solid: SolidModel, state: SolverState) -> HarmonicBlocks:
    """Second variation of the cavity volume by edges of the inner wall, times the pressure.

    V = (1/2) integral of z_s [h, h_t] - z_t [h, h_s] over the surface, h the horizontal position: to second order
    pi integral of z'(a^2 + 2 n a c + c^2) + r b'(2 a + n c) + n b (r c' - r' c) along the meridian.
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
