"""Turns surveys into the atlas's coefficients: one potential over wall, volume and depth, and further fields."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_triangular

from pneutouch.arrays import Array
from pneutouch.mechanics.atlas.recipe import STORED, AtlasAxes, AtlasRecipe, SplineAxis, axes, flattened
from release.tables.atlas.survey import Survey

_SMOOTH = 1.0e-5
"""Weight of the coefficients' roughness: decides only where no state supports them."""
_ALIKE = 1.0e-5
"""Weight of a coefficient's distance from the mean of its neighbours over the wall ratio, likewise."""
_SETTLING = 200
_FLOOR = 0.15
"""Pressures and forces below this share of the limit pressure are fitted to absolute, above it to relative error."""

_TYPES = {"inner_apex": np.float32}
"""Half precision is enough for the other fields: a step of it moves a stretch by less than a thousandth."""
_AT_CONTACT = 4.0
"""Weight of the free dome: its fields give the limits of driving, and no force is the force at first contact."""


def roughness(size: int, order: int) -> Array:
    """Differences of an order of neighbouring coefficients, (size - order, size)."""
    return np.diff(np.eye(size), n=order, axis=0)


@dataclass(frozen=True)
class NormalEquations:
    """Least squares by its triangular factor R'R and right side, (n, n) and (n, several)."""

    factor: Array
    right: Array

    def solve(self, near: Array | None = None) -> Array:
        """The coefficients, drawn to those of `near` where nothing else decides; (n, several)."""
        right = self.right if near is None else self.right + _ALIKE**2 * near
        solution: Array = solve_triangular(self.factor, solve_triangular(self.factor, right, trans="T"))
        return solution


@dataclass(frozen=True)
class WallCoefficients:
    """One wall ratio's coefficients: apex (volume,), and the systems for the potential in units of the limit pressure
    and for the fields, over (volume, depth) flat.

    support: cells with states in or next to them (volume cells, depth cells). fold_from, fold_volume: see `Survey`.
    """

    limit_volume: float
    limit_pressure: float
    apex: Array
    potential: NormalEquations
    fields: NormalEquations
    support: Array
    fold_from: float
    fold_volume: Array


def fit_sheet(survey: Survey, recipe: AtlasRecipe) -> WallCoefficients:
    """Least squares over all states of one survey; energy, pressure and force are met by one and the same potential."""
    grid = axes(recipe)
    rest, reach = survey.free_volume[0], survey.limit_volume - survey.free_volume[0]
    apex = _fit_apex(survey, grid.volume, rest, reach)
    nu = (survey.volume - rest) / reach
    rise, slope = grid.volume.rows(nu) @ apex, grid.volume.rows(nu, 1) @ apex
    w = np.maximum(rise - survey.height, 0.0)

    def products(by_volume: int, by_depth: int) -> Array:
        a, b = grid.volume.rows(nu, by_volume), grid.depth.rows(w, by_depth)
        return (a[:, :, None] * b[:, None, :]).reshape(nu.size, -1)

    force = products(0, 1)
    pressure = (products(1, 0) + slope[:, None] * force) / reach
    value = products(0, 0)
    unit = survey.limit_pressure
    solution = [
        (value, survey.energy, 0.1 * _FLOOR),
        (pressure, survey.pressure, _FLOOR),
        (force, survey.force, _FLOOR),
    ]
    scales = [1.0 / (floor * unit + np.abs(target)) for _, target, floor in solution]
    scales[2] = scales[2] * np.where(w > 0.0, 1.0, _AT_CONTACT)
    smooth = _smoothness(grid)
    potential = _system(
        [rows * (unit * scale)[:, None] for (rows, _, _), scale in zip(solution, scales, strict=True)],
        [(target * scale)[:, None] for (_, target, _), scale in zip(solution, scales, strict=True)],
        smooth / _FLOOR,
    )
    weight = np.where(w > 0.0, 1.0, _AT_CONTACT)[:, None]
    target = np.stack([flattened(name, field) for name, field in zip(STORED, survey.fields, strict=True)], axis=1)
    support = np.zeros((grid.volume.cells, grid.depth.cells))
    support[grid.volume.basis(nu)[0], grid.depth.basis(w)[0]] = 1.0
    return WallCoefficients(
        survey.limit_volume,
        unit,
        apex,
        potential,
        _system([value * weight], [target * weight], smooth),
        _grown(support),
        survey.fold_from,
        survey.fold_volume,
    )


def _grown(support: Array) -> Array:
    """Cells with states and their neighbours: the states' spacing is no boundary, stability is."""
    wide = np.pad(support, 1)
    rows, columns = support.shape
    return np.asarray(np.maximum.reduce([wide[i : i + rows, k : k + columns] for i in range(3) for k in range(3)]))


def _fit_apex(survey: Survey, axis: SplineAxis, rest: float, reach: float) -> Array:
    """The free apex over nu; below nu = 0, where it only gives w its meaning, as straight as smoothness allows."""
    nu = (survey.free_volume - rest) / reach
    stiff = roughness(axis.size, 2)
    stiff[axis.basis(np.zeros(1))[0][0] :] = 0.0
    left = np.concatenate([axis.rows(nu), 1e-3 * stiff, 1e-6 * roughness(axis.size, 4)])
    right = np.concatenate([survey.free_apex, np.zeros(left.shape[0] - nu.size)])
    solution: Array = np.linalg.lstsq(left, right, rcond=None)[0]
    return solution


def _smoothness(grid: AtlasAxes) -> Array:
    volume, depth = grid.volume.size, grid.depth.size
    rough = np.concatenate([np.kron(roughness(volume, 4), np.eye(depth)), np.kron(np.eye(volume), roughness(depth, 4))])
    return np.concatenate([_SMOOTH * rough, _ALIKE * np.eye(volume * depth)])


def _system(rows: list[Array], values: list[Array], smooth: Array) -> NormalEquations:
    left = np.concatenate(rows)
    factor = np.linalg.qr(np.concatenate([left, smooth]), mode="r")
    return NormalEquations(np.asarray(factor), left.T @ np.concatenate(values))


def join(sheets: list[WallCoefficients], recipe: AtlasRecipe) -> dict[str, Array]:
    """The tables of the atlas: splines over the logarithm of the wall ratio through every sheet's coefficients."""
    wall, shape = axes(recipe).wall, (-1, axes(recipe).volume.size, axes(recipe).depth.size)
    # Not-a-knot: no jump of the third derivative at the first and the last inner knot.
    square = np.concatenate([wall.rows(np.log(recipe.wall_ratios)), roughness(wall.size, 4)[[0, -1]]])
    through = np.linalg.inv(square)[:, : recipe.walls]
    unit = np.array([sheet.limit_pressure for sheet in sheets])
    potential = unit[:, None] * _settled([sheet.potential for sheet in sheets])[..., 0]
    fields = _settled([sheet.fields for sheet in sheets])

    def along(stack: Array) -> Array:
        return np.tensordot(through, stack, axes=1)

    def stacked(name: str) -> Array:
        return np.stack([np.asarray(getattr(sheet, name)) for sheet in sheets])

    return {
        **{name: along(stacked(name)) for name in ("limit_volume", "limit_pressure", "apex")},
        "potential": along(potential).reshape(shape).astype(np.float32),
        **{
            name: along(fields[..., k]).reshape(shape).astype(_TYPES.get(name, np.float16))
            for k, name in enumerate(STORED)
        },
        **{name: stacked(name) for name in ("fold_from", "fold_volume")},
        "support": stacked("support").astype(bool),
    }


def _settled(systems: list[NormalEquations]) -> Array:
    """Coefficients of all walls, (walls, n, several), where each leans on its neighbours beyond its own states.

    States end at another volume for every wall; a spline over the walls needs what lies beyond to agree.
    """
    solution = np.stack([system.solve() for system in systems])
    last = len(systems) - 1
    for _ in range(_SETTLING):
        for i, system in enumerate(systems):
            solution[i] = system.solve(0.5 * (solution[max(i - 1, 0)] + solution[min(i + 1, last)]))
    return solution
