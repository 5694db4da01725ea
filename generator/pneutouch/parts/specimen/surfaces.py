"""Minimal surfaces as sheets or networks: level sets of a sum of waves, marched on a grid that ends with the box."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from pneutouch.arrays import Array
from pneutouch.parts.specimen.marching import MarchingGrid, between, level_set
from pneutouch.parts.specimen.mesh import Box, Mesh

PeriodicFunction = Callable[[Array, Array, Array], Array]
Form = Literal["sheet", "network"]


def _gyroid(x: Array, y: Array, z: Array) -> Array:
    level: Array = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
    return level


def _schwarz_p(x: Array, y: Array, z: Array) -> Array:
    level: Array = np.cos(x) + np.cos(y) + np.cos(z)
    return level


def _diamond(x: Array, y: Array, z: Array) -> Array:
    level: Array = np.cos(x) * np.cos(y) * np.cos(z) - np.sin(x) * np.sin(y) * np.sin(z)
    return level


SURFACES: dict[str, PeriodicFunction] = {"gyroid": _gyroid, "schwarz-p": _schwarz_p, "diamond": _diamond}
"""First nodal approximations; x, y and z in radians, one cell being 2 pi (von Schnering and Nesper 1991)."""

PINCHED: dict[str, float] = {"gyroid": math.sqrt(2.0), "schwarz-p": 1.0, "diamond": math.sqrt(0.5)}
"""Levels at which a neck closes: the saddle of the wave. Beyond it the body falls apart."""

RADIUS: dict[str, float] = {"gyroid": 0.13, "schwarz-p": 0.16, "diamond": 0.066}
"""Radius of curvature in cells by which the grid is stepped; the deviation that follows is tested."""

_SAMPLES = 48
"""Samples along each axis of a cell, at their middles, for the level of a given fraction."""

_CLOSE = 2e-3
"""Relative error of the fraction at which the search for a level stops."""

_TRIES = 5


@dataclass(frozen=True)
class PeriodicSurface:
    """A family with its cell in mm, its form, and the chord tolerance of its mesh in mm."""

    kind: str
    cell: float
    form: Form
    tolerance: float

    @property
    def step(self) -> float:
        """Step of the grid in mm that keeps the tolerance, from the wave's least radius of curvature."""
        return math.sqrt(8 * self.tolerance * RADIUS[self.kind] * self.cell)

    def grid(self, box: Box) -> MarchingGrid:
        """A grid over a box, its steps as equal as the box allows."""
        step = self.step
        a, b, c = (max(2, math.ceil((high - low) / step)) for low, high in zip(box.low, box.high, strict=True))
        return MarchingGrid(box, (a, b, c))

    def values(self, grid: MarchingGrid) -> Array:
        """The wave at the grid's nodes; cells start at the box's least corner."""
        x, y, z = (2 * np.pi * (line - line[0]) / self.cell for line in grid.lines())
        return self._wave(x[:, None, None], y[None, :, None], z[None, None, :])

    def at(self, box: Box) -> Callable[[Array], Array]:
        """The wave at points (n, 3) in mm."""
        low = np.array(box.low)

        def wave(points: Array) -> Array:
            x, y, z = 2 * np.pi * (points - low).T / self.cell
            return self._wave(x, y, z)

        return wave

    def levels(self, level: float) -> tuple[float | None, float]:
        """The levels between which the body lies."""
        return (-level, level) if self.form == "sheet" else (None, level)

    def limits(self) -> tuple[float, float]:
        """Least and greatest volume fraction of one cell at which the body hangs together."""
        pinched, wave = PINCHED[self.kind], self._samples()
        if self.form == "sheet":
            return 0.0, float((np.abs(wave) < pinched).mean())
        return float((wave < -pinched).mean()), float((wave < pinched).mean())

    def level(self, fraction: float) -> float:
        """The level that gives one cell a volume fraction, by its share of evenly spread samples."""
        wave = self._samples()
        return float(np.quantile(np.abs(wave) if self.form == "sheet" else wave, fraction))

    def _samples(self) -> Array:
        middle = 2 * np.pi * (np.arange(_SAMPLES) + 0.5) / _SAMPLES
        return self._wave(middle[:, None, None], middle[None, :, None], middle[None, None, :]).reshape(-1)

    def _wave(self, x: Array, y: Array, z: Array) -> Array:
        level: Array = np.asarray(SURFACES[self.kind](x, y, z))
        return level


def fill(surface: PeriodicSurface, box: Box, fraction: float) -> Mesh:
    """The body in a box, closed, at a volume fraction of the box, met within 0.2 % as measured on the mesh."""
    grid = surface.grid(box)
    values, wave = surface.values(grid), surface.at(box)
    level = surface.level(fraction)
    slope = (surface.level(1.02 * fraction) - surface.level(0.98 * fraction)) / (0.04 * fraction)
    mesh = between(grid, wave, values, *surface.levels(level))
    for _ in range(_TRIES):
        missing = fraction - mesh.volume / box.volume
        if abs(missing) <= _CLOSE * fraction:
            break
        level += missing * slope
        mesh = between(grid, wave, values, *surface.levels(level))
    return mesh


def fraction_of(surface: PeriodicSurface, box: Box, thickness: float) -> float:
    """The volume fraction of a sheet whose volume is ``thickness`` mm times the area of its middle surface."""
    grid = surface.grid(box)
    middle = level_set(grid, surface.at(box), surface.values(grid), 0.0)
    a, b, c = np.moveaxis(middle.vertices[middle.triangles], 1, 0)
    area = 0.5 * float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())
    return thickness * area / box.volume
