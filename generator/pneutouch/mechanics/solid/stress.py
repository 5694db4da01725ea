"""Stretch and stress on the two faces of the wall, where bending puts the largest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneutouch.mechanics.laws.strain import Strain
from pneutouch.mechanics.solid.elements import strain_operator
from pneutouch.mechanics.solid.inflate import Inflation, between, pressure_between
from pneutouch.mechanics.solid.model import Solid

Array = NDArray[np.float64]

#: Within this many wall thicknesses of a clamped node the elastic stress is singular and says nothing; left out.
CLAMP_REACH = 0.5
_TURNED_OVER = 1.0e-4


@dataclass(frozen=True)
class Peak:
    """Extremes over both faces of the wall away from the clamp.

    stretch, von_mises (Cauchy, MPa): the largest.  fold: largest ratio of the stretch across a face to the least
    along it.
    """

    stretch: float
    von_mises: float
    fold: float


class Probe:
    """Evaluates strains on the faces eta = +-1 at Gauss stations along the arc, of every cell."""

    def __init__(self, solid: Solid) -> None:
        self._solid = solid
        stations = np.polynomial.legendre.leggauss(3)[0]
        points = np.stack([np.tile(stations, 2), np.repeat([-1.0, 1.0], 3)], axis=1)
        b, _, position = strain_operator(solid.rest, solid.mesh.cells, points)
        held = solid.rest[solid.mesh.clamped]
        flat = position.reshape(-1, 2)
        far = np.ones(flat.shape[0], dtype=bool)
        if held.size:
            far = np.hypot(*(flat[:, None, :] - held[None, :, :]).T).min(axis=0) > CLAMP_REACH * solid.wall
        self._b = b.reshape(b.shape[0], -1, b.shape[-1])
        self._far = far
        self._centre = strain_operator(solid.rest, solid.mesh.cells, np.zeros((1, 2)))[0][:, 0]

    def principal(self, x: Array) -> tuple[Array, Array]:
        """Principal stretches and deviator-carrying stresses lambda dW/dlambda / J (MPa), (3, n_points) each."""
        cells = self._solid.mesh.cells
        f = np.matmul(self._b, x[cells].reshape(cells.shape[0], -1, 1)).reshape(-1, 5)[self._far]
        # At the tip of a crease a face can turn over between sound integration points: shown as an immense fold.
        j = np.maximum(f[:, 0] * f[:, 3] - f[:, 1] * f[:, 2], _TURNED_OVER)
        a, h = np.maximum((f[:, :4] ** 2).sum(axis=1), 2.0 * j), np.maximum(f[:, 4], _TURNED_OVER)
        plus, minus = np.sqrt(a + 2.0 * j), np.sqrt(np.maximum(a - 2.0 * j, 0.0))
        stretch = np.stack([0.5 * (plus + minus), 0.5 * (plus - minus), h])
        jet = self._solid.material.energy(Strain(a, j, h)).data
        common = jet[2] * j
        stress = np.stack(
            [2.0 * jet[1] * stretch[0] ** 2 + common, 2.0 * jet[1] * stretch[1] ** 2 + common, h * jet[3]]
        )
        return stretch, stress / (j * h)

    def cell_stretch(self, x: Array) -> Array:
        """Greatest principal stretch at the centre of every cell (n_cells,) for nondimensional positions x."""
        cells = self._solid.mesh.cells
        f = np.matmul(self._centre, x[cells].reshape(cells.shape[0], -1, 1))[..., 0]
        j = f[:, 0] * f[:, 3] - f[:, 1] * f[:, 2]
        a = (f[:, :4] ** 2).sum(axis=1)
        in_plane = 0.5 * (np.sqrt(a + 2.0 * j) + np.sqrt(np.maximum(a - 2.0 * j, 0.0)))
        return np.asarray(np.maximum(in_plane, f[:, 4]))

    def outlines(self, positions: Array) -> Array:
        """Outlines of the cells (n_cells, 4 or 8, 2), in the unit of the positions (n_nodes, 2)."""
        cells = self._solid.mesh.cells
        around = [0, 4, 1, 5, 2, 6, 3, 7] if cells.shape[1] > 4 else [0, 1, 2, 3]
        return np.asarray(positions[cells[:, around]])

    def peak(self, x: Array) -> Peak:
        """Largest values for nondimensional positions x (n_nodes, 2)."""
        stretch, stress = self.principal(x)
        apart = stress - np.roll(stress, 1, axis=0)
        mises = np.sqrt(0.5 * (apart**2).sum(axis=0))
        fold = stretch[0] / np.minimum(stretch[1], stretch[2])
        return Peak(float(stretch.max()), float(mises.max()), float(fold.max()))


def burst(solid: Solid, inflation: Inflation, break_strain: float) -> tuple[float, float] | None:
    """Pressure (MPa) and outer apex height (mm) at which free inflation reaches a break strain (stretch - 1), or None.

    Bisected on the Hermite cubic between neighbouring states.
    """
    probe = Probe(solid)
    for a, b in zip(inflation.states, inflation.states[1:], strict=False):
        if probe.peak(b.unit.x).stretch - 1.0 < break_strain:
            continue
        low, high = a.unit.volume, b.unit.volume
        for _ in range(40):
            middle = 0.5 * (low + high)
            over = probe.peak(between(a, b, middle)).stretch - 1.0 >= break_strain
            low, high = (low, middle) if over else (middle, high)
        x = between(a, b, high)
        share = (high - a.unit.volume) / (b.unit.volume - a.unit.volume)
        return pressure_between(a, b, share), float(x[solid.mesh.outer[-1, 1], 1]) * solid.length
    return None
