"""The volume inside a wall that is no body of revolution."""

from __future__ import annotations

import numpy as np

from pneutouch.arrays import Array, Index
from pneutouch.mechanics.harmonic.fields import AROUND, AXIAL, RADIAL, Harmonics
from pneutouch.mechanics.harmonic.operators import FieldGroup, FieldOperator
from pneutouch.mechanics.solid.cavity import Cavity
from pneutouch.mechanics.solid.elements import line_shapes

_R, _S, _TURN_R, _TURN_S, _TURN_Z, _ALONG_R, _ALONG_Z, _ALONG_S = range(8)
"""Fields of the surface: position outwards and around, and its derivatives by the angle and along the meridian."""

_PRODUCTS = (
    (0.5, _R, _TURN_S, _ALONG_Z),
    (-0.5, _R, _TURN_Z, _ALONG_S),
    (0.5, _S, _TURN_Z, _ALONG_R),
    (-0.5, _S, _TURN_R, _ALONG_Z),
)
"""Half the horizontal position times the normal of the surface: its flux is the volume above the first point's plane
(divergence theorem). On a surface of revolution it is r^2 z'/2."""


class HarmonicCavity(Cavity):
    """The volume as a cubic polynomial of the coefficients, integrated exactly along the meridian and the angle."""

    def __init__(self, edges: Index, harmonics: Harmonics, signs: Array) -> None:
        super().__init__(edges)
        x, w = np.polynomial.legendre.leggauss(edges.shape[1])
        value, slope = line_shapes(x, edges.shape[1])
        angles = harmonics.angles
        values, turned = harmonics.values(angles), harmonics.turned(angles)
        rows = np.concatenate([values[:, [RADIAL, AROUND]], turned[:, [RADIAL, AROUND, AXIAL]]], axis=1)
        groups = [FieldGroup(value, rows), FieldGroup(slope, values)]
        self._operator = FieldOperator(groups, edges, signs)
        self._measure = (2.0 * np.pi / angles.size) * w[:, None]

    def volume(self, nodes: Array) -> float:
        """Enclosed volume of coefficients (n_nodes, columns)."""
        return self._volume(self._operator.fields(nodes))

    def gradient(self, nodes: Array) -> tuple[float, Array]:
        """Volume and its derivative by edge coefficients, (n_edges, n columns)."""
        fields = self._operator.fields(nodes)
        by_field = np.zeros_like(fields)
        for factor, *three in _PRODUCTS:
            for i, k, m in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
                by_field[..., three[i]] += factor * self._measure * fields[..., three[k]] * fields[..., three[m]]
        return self._volume(fields), self._operator.forces(by_field)

    def hessian(self, nodes: Array) -> Array:
        """Second derivative by edge coefficients, (n_edges, n columns, n columns)."""
        fields = self._operator.fields(nodes)
        by_fields = np.zeros((*fields.shape, fields.shape[3]))
        for factor, *three in _PRODUCTS:
            for i, k, m in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
                value = factor * self._measure * fields[..., three[m]]
                by_fields[..., three[i], three[k]] += value
                by_fields[..., three[k], three[i]] += value
        return self._operator.stiffness(by_fields)

    def _volume(self, fields: Array) -> float:
        parts = (factor * fields[..., i] * fields[..., k] * fields[..., m] for factor, i, k, m in _PRODUCTS)
        return float(np.vdot(np.broadcast_to(self._measure, fields.shape[:3]), sum(parts)))
