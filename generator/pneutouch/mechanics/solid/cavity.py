"""The exact volume a meridian line encloses, as a cubic polynomial of its nodal positions.

Supplies that fill the cavity, as a potential of its volume: p = -potential', stiffness c = potential'' (a rank-one
term).

All three are nondimensional: volumes in R0^3, pressures in mu.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import log1p
from typing import NamedTuple, Protocol

import numpy as np

from pneutouch.arrays import Array, Index
from pneutouch.mechanics.solid.elements import AXIAL, RADIAL, line_shapes


class Cavity:
    """V = pi int r^2 dz along the wetted wall from base to apex; r^2 z' is integrated exactly.

    It is the volume above the plane through the line's first point; a flat floor below adds a constant only.
    """

    def __init__(self, edges: Index) -> None:
        self.edges = edges
        x, w = np.polynomial.legendre.leggauss(edges.shape[1])
        value, slope = line_shapes(x, edges.shape[1])
        n = edges.shape[1]
        self._n = n
        self._form = np.pi * np.einsum("q,qi,qj,qk->ijk", w, value, value, slope).reshape(n * n, n)

    def _parts(self, nodes: Array) -> tuple[Array, Array, Array, Array]:
        """r, z of the edges and the form contracted with z: (n_edges, n), (n_edges, n), (n_edges, n, n)."""
        line = nodes[self.edges]
        r, z = line[..., 0], line[..., 1]
        by_z = (z @ self._form.T).reshape(-1, self._n, self._n)
        return r, z, by_z, np.matmul(by_z, r[..., None])[..., 0]

    def volume(self, nodes: Array) -> float:
        """Enclosed volume; nodes (n_nodes, 2)."""
        r, _, _, half = self._parts(nodes)
        return float(np.vdot(r, half))

    def gradient(self, nodes: Array) -> tuple[float, Array]:
        """Volume and its derivative by edge positions, (n_edges, 2 n), interleaved r, z."""
        r, _, _, half = self._parts(nodes)
        out = np.empty((r.shape[0], 2 * self._n))
        out[:, RADIAL] = 2.0 * half
        out[:, AXIAL] = (r[:, :, None] * r[:, None, :]).reshape(r.shape[0], -1) @ self._form
        return float(np.vdot(r, half)), out

    def hessian(self, nodes: Array) -> Array:
        """Second derivative by edge positions, symmetric; (n_edges, 2 n, 2 n)."""
        r, _, by_z, _ = self._parts(nodes)
        out = np.zeros((r.shape[0], 2 * self._n, 2 * self._n))
        mixed = 2.0 * (r @ self._form.reshape(self._n, -1)).reshape(-1, self._n, self._n)
        out[:, RADIAL, RADIAL] = 2.0 * by_z
        out[:, RADIAL, AXIAL] = mixed
        out[:, AXIAL, RADIAL] = np.swapaxes(mixed, 1, 2)
        return out


class FillingState(NamedTuple):
    """Potential, gauge pressure and -dp/dV at one volume."""

    energy: float
    pressure: float
    rate: float


class Supply(Protocol):
    """Anything with a potential of the cavity volume."""

    def at(self, volume: float) -> FillingState | None:
        """Potential, pressure and rate, or None if the volume is impossible."""
        ...


@dataclass(frozen=True)
class Regulator:
    """A constant gauge pressure."""

    pressure: float

    def at(self, volume: float) -> FillingState:
        """Potential -p V."""
        return FillingState(-self.pressure * volume, self.pressure, 0.0)


@dataclass(frozen=True)
class Liquid:
    """A nearly incompressible filling of rest volume `target`: volume control as an energy.

    The pressure is what it takes, `stiffness` only sets how far V may fall short of the target; every (p, V) it
    yields is an exact point of the pressure-volume curve.
    """

    target: float
    stiffness: float

    def at(self, volume: float) -> FillingState:
        """Potential stiffness/2 (V - target)^2."""
        deficit = self.target - volume
        return FillingState(0.5 * self.stiffness * deficit * deficit, self.stiffness * deficit, self.stiffness)


@dataclass(frozen=True)
class Gas:
    """Trapped isothermal gas: absolute pressure times (V + dead) stays `content`; shut in at the volume `start`."""

    content: float
    ambient: float
    dead: float
    start: float

    @classmethod
    def filled(cls, pressure: float, volume: float, ambient: float, dead: float) -> Gas:
        """The gas shut in at a gauge pressure and cavity volume."""
        return cls((pressure + ambient) * (volume + dead), ambient, dead, volume)

    def at(self, volume: float) -> FillingState | None:
        """Potential -[C ln((V + dead)/(start + dead)) - ambient (V - start)].

        Counted from the shut-in state: with a large dead volume the rounding of the full potential would hide the work.
        """
        total = volume + self.dead
        if total <= 0.0:
            return None
        swell = volume - self.start
        absolute = self.content / total
        energy = self.ambient * swell - self.content * log1p(swell / (self.start + self.dead))
        return FillingState(energy, absolute - self.ambient, absolute / total)
