"""The outer wall under the object that presses it: positions, contact forces and pressures at its nodes."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.harmonic.fields import Harmonics
from pneutouch.mechanics.solid.elements import line_shapes

_ROWS = 96
"""Rows at which a wall is drawn, but for those added where the contact ends."""


@dataclass(frozen=True, slots=True)
class PressedFace:
    """A pressed outer wall, symmetric about the plane of angle 0 (mm, N); its nodes run from the base to the pole.

    Forces are gathered at the ends of its edges: those in the middle of edges would alternate with them.

    Attributes:
        indentation: Of the object.
        travel: Distance that the object then moved sideways.
        harmonics: The Fourier sums of the positions.
        coefficients: Positions of the nodes, (n_nodes, columns), see `harmonic.fields.Harmonics`.
        forces: Contact forces of the wall on the object, normal to it, (n_ends, M + 1, 3), at the contact angles of the
            half circle; each stands for its mirror image too, whose component in y is opposite.
        areas: Areas of the deformed wall that belong to them, (n_ends, M + 1); of both images.
        touching: Part of these areas that touches the object, (n_ends, M + 1).
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
        """Number of edges."""
        return len(self.areas) - 1

    def scaled(self, force: float) -> PressedFace:
        """The face with all forces times a factor."""
        return self if force == 1.0 else replace(self, forces=force * self.forces)

    def rows(self) -> Array:
        """Places along the wall at which it is drawn, in edges from the base: closer where the contact ends."""
        share = self.touching / self.areas
        low, high = np.minimum(share[:-1], share[1:]), np.maximum(share[:-1], share[1:])
        partly = ((high > 0.0) & (low < 1.0)).any(axis=1) | (np.ptp(share, axis=1)[1:] > 0.0)
        finest, stride = max(1, min(3, _ROWS // self.edges)), max(1, -(-self.edges // _ROWS))
        places = [np.arange(k, k + 1, 1.0 / (finest if partly[k] else 1)) for k in range(self.edges)]
        every = np.append(np.concatenate(places), float(self.edges))
        return np.asarray(every[::-stride][::-1])

    def positions(self, rows: Array, angles: Array) -> Array:
        """Positions (x, y, z) at places along the wall and angles, (n_rows, n_angles, 3), mm."""
        step = (len(self.coefficients) - 1) // self.edges
        edge = np.minimum(rows.astype(np.intp), self.edges - 1)
        nodes = step * edge[:, None] + [0, step, 1][: step + 1]
        along = np.stack([line_shapes(np.array([x]), step + 1)[0][0] for x in 2.0 * (rows - edge) - 1.0])
        place = np.einsum("nk,nkc,aic->nai", along, self.coefficients[nodes], self.harmonics.cartesian(angles))
        return np.asarray(place)

    def pressure(self, rows: Array, angles: Array) -> Array:
        """Contact pressure at places along the wall and angles, (n_rows, n_angles), MPa: force over touching area.

        Without harmonics both are linear between the ends of edges. With them, between few contact angles, both are
        means of the neighbourhood by a Gauss function, one edge wide along the wall and across it half as wide as
        contact points are apart. The contact ends where half of the area touches; around that the pressure falls to 0.
        Of a contact smaller than these distances the share of the area is taken over its greatest, and the pressure
        times that.
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
    """Force over touching area of forces, touching areas and areas (3, ...), to zero where too little touches."""
    force, touching, areas = parts
    share = touching / areas
    greatest = float(share.max())
    if greatest == 0.0:
        return np.zeros_like(share)
    inside = np.clip(2.0 * share / greatest - 0.5, 0.0, 1.0)
    return np.asarray(np.where(inside > 0.0, greatest * inside * force / np.maximum(touching, 1e-300), 0.0))
