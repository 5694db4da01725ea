"""Stretch and stress on the two faces of the wall, where bending makes them largest, and limits that they reach."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.laws.hyperelastic import same_invariant
from pneutouch.mechanics.laws.strain import BY_A, BY_H, BY_J, Strain
from pneutouch.mechanics.solid.elements import HOOP, IN_PLANE, area_ratio, positions, strain_operator
from pneutouch.mechanics.solid.inflate import Inflation, between, pressure_between
from pneutouch.mechanics.solid.model import SolidModel

#: Distance from a clamped node, in wall thicknesses, within which the singular elastic stress is left out.
CLAMP_REACH = 0.5
_TURNED_OVER = 1.0e-4
_SEARCH = 41


@dataclass(frozen=True)
class WallExtremes:
    """Extremes over both faces of the wall away from the clamp.

    stretch, von_mises (Cauchy, MPa): the largest values.  fold: largest stretch across a face over the least along it.
    """

    stretch: float
    von_mises: float
    fold: float


class StrainProbe:
    """Strains on the faces eta = +-1 of every cell: at Gauss stations along the arc that are farther than `CLAMP_REACH`
    from the clamp, and exactly at that distance, so that the extremes change continuously with the wall.

    operator (n_cells, 5 n_stations, 2 n_nodes): strains at the stations; ``far`` selects those far enough. places
    (n, 2), outer (n,): all that the extremes are taken from, at rest, and whether on the outer face of its cell.
    edge_operator (n_edges, 5, 2 n_nodes): strains at the limit distance, in the cells ``edge_cells``.
    """

    def __init__(self, solid: SolidModel) -> None:
        self.solid = solid
        rest, cells = solid.rest, solid.mesh.cells
        stations = np.polynomial.legendre.leggauss(3)[0]
        points = np.stack([np.tile(stations, 2), np.repeat([-1.0, 1.0], 3)], axis=1)
        b, _, position = strain_operator(rest, cells, points)
        flat = position.reshape(-1, 2)
        self.far = self._distance(flat) > CLAMP_REACH * solid.wall
        self.operator = b.reshape(b.shape[0], -1, b.shape[-1])
        edges = self._edges()
        self.edge_cells = np.array([cell for cell, _ in edges], dtype=np.intp)
        extra = [strain_operator(rest, cells[[cell]], point[None, :]) for cell, point in edges]
        self.edge_operator = np.array([operator[0, 0] for operator, _, _ in extra]).reshape(len(edges), 5, b.shape[-1])
        self.places = np.concatenate([flat[self.far], *(place[0] for _, _, place in extra)])
        sides = np.tile(points[:, 1] > 0.0, b.shape[0])[self.far]
        self.outer = np.concatenate([sides, [point[1] > 0.0 for _, point in edges]])
        self._relative = solid.grade(self.places[:, 0], self.places[:, 1])
        self._centre = strain_operator(rest, cells, np.zeros((1, 2)))[0][:, 0]

    def _distance(self, points: Array) -> Array:
        """Distances (n,) of points (n, 2) at rest from the nearest clamped node; inf without one."""
        held = self.solid.rest[self.solid.mesh.clamped]
        if held.size == 0:
            return np.full(points.shape[0], np.inf)
        return np.asarray(np.hypot(*(points[:, None, :] - held[None, :, :]).T).min(axis=0))

    def _edges(self) -> list[tuple[int, Array]]:
        """Pairs of a cell and a local point (2,) on its face whose distance from the clamp is the limit."""
        along = np.linspace(-1.0, 1.0, _SEARCH)
        reach = CLAMP_REACH * self.solid.wall
        edges = []
        for face in (-1.0, 1.0):
            local = np.stack([along, np.full_like(along, face)], axis=1)
            place = positions(self.solid.rest, self.solid.mesh.cells, local)
            beyond = self._distance(place.reshape(-1, 2)).reshape(place.shape[:2]) - reach
            for cell, k in zip(*np.nonzero(beyond[:, :-1] * beyond[:, 1:] < 0.0), strict=True):
                share = beyond[cell, k] / (beyond[cell, k] - beyond[cell, k + 1])
                edges.append((int(cell), np.array([along[k] + share * (along[1] - along[0]), face])))
        return edges

    def _strains(self, x: Array) -> tuple[Array, Array, Array, Array]:
        """Invariants a, j, h of `laws.strain` (n_points,) and principal stretches (3, n_points) at positions x."""
        nodes = x[self.solid.mesh.cells].reshape(self.solid.mesh.cells.shape[0], -1, 1)
        f = np.matmul(self.operator, nodes).reshape(-1, 5)[self.far]
        f = np.concatenate([f, np.matmul(self.edge_operator, nodes[self.edge_cells])[..., 0]])
        # At a crease's tip a face can turn over between sound integration points: this gives a very large fold.
        j = np.maximum(area_ratio(f), _TURNED_OVER)
        a, h = np.maximum((f[:, IN_PLANE] ** 2).sum(axis=1), 2.0 * j), np.maximum(f[:, HOOP], _TURNED_OVER)
        plus, minus = np.sqrt(a + 2.0 * j), np.sqrt(np.maximum(a - 2.0 * j, 0.0))
        return a, j, h, np.stack([0.5 * (plus + minus), 0.5 * (plus - minus), h])

    def greatest_stretch(self, x: Array) -> float:
        """Greatest principal stretch over both faces for nondimensional positions x (n_nodes, 2)."""
        return float(self._strains(x)[3].max())

    def greatest_tension(self, x: Array) -> float:
        """Uniaxial stretch with the greatest first invariant of both faces, at nondimensional positions x."""
        _, j, h, stretch = self._strains(x)
        return float(same_invariant(((stretch**2).sum(axis=0) * (j * h) ** (-2.0 / 3.0)).max()))

    def principal(self, x: Array) -> tuple[Array, Array]:
        """Principal stretches and deviatoric Cauchy stresses lambda dW/dlambda / J (MPa), (3, n_points) each."""
        a, j, h, stretch = self._strains(x)
        jet = self.solid.material.energy(Strain(a, j, h)).data
        common = jet[BY_J] * j
        stress = np.stack(
            [2.0 * jet[BY_A] * stretch[0] ** 2 + common, 2.0 * jet[BY_A] * stretch[1] ** 2 + common, h * jet[BY_H]]
        )
        return stretch, self._relative * stress / (j * h)

    def cell_stretch(self, x: Array) -> Array:
        """Greatest principal stretch at the centre of every cell (n_cells,) for nondimensional positions x."""
        cells = self.solid.mesh.cells
        f = np.matmul(self._centre, x[cells].reshape(cells.shape[0], -1, 1))[..., 0]
        j = area_ratio(f)
        a = (f[:, IN_PLANE] ** 2).sum(axis=1)
        in_plane = 0.5 * (np.sqrt(a + 2.0 * j) + np.sqrt(np.maximum(a - 2.0 * j, 0.0)))
        return np.asarray(np.maximum(in_plane, f[:, HOOP]))

    def outlines(self, positions: Array) -> Array:
        """Outlines of the cells (n_cells, 4 or 8, 2) in the unit of the given positions (n_nodes, 2)."""
        cells = self.solid.mesh.cells
        # Each corner and the middle of the side after it.
        around = np.arange(8).reshape(2, 4).T.ravel() if cells.shape[1] > 4 else np.arange(4)
        return np.asarray(positions[cells[:, around]])

    def peak(self, x: Array) -> WallExtremes:
        """Extremes over both faces for nondimensional positions x (n_nodes, 2)."""
        stretch, stress = self.principal(x)
        apart = stress - np.roll(stress, 1, axis=0)
        mises = np.sqrt(0.5 * (apart**2).sum(axis=0))
        fold = stretch[0] / np.minimum(stretch[1], stretch[2])
        return WallExtremes(float(stretch.max()), float(mises.max()), float(fold.max()))


def burst(probe: StrainProbe, inflation: Inflation, break_strain: float) -> tuple[float, float] | None:
    """Pressure (MPa) and outer apex height (mm) where free inflation reaches a break strain (stretch - 1), or None."""
    return met(probe, inflation, lambda x: probe.greatest_stretch(x) - 1.0, break_strain)


def met(
    probe: StrainProbe, inflation: Inflation, measure: Callable[[Array], float], level: float
) -> tuple[float, float] | None:
    """Pressure (MPa) and outer apex height (mm) at which inflation first brings ``measure``, a function of the
    positions (n_nodes, 2), to ``level``; None: never. Bisected on the Hermite cubic between states.
    """
    solid = probe.solid
    for a, b in zip(inflation.states, inflation.states[1:], strict=False):
        if measure(b.unit.x) < level:
            continue
        low, high = a.unit.volume, b.unit.volume
        for _ in range(40):
            middle = 0.5 * (low + high)
            over = measure(between(a, b, middle)) >= level
            low, high = (low, middle) if over else (middle, high)
        x = between(a, b, high)
        share = (high - a.unit.volume) / (b.unit.volume - a.unit.volume)
        return pressure_between(a, b, share), float(x[solid.mesh.outer_apex, 1]) * solid.length
    return None
