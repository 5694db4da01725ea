"""Joins the sheets of all walls into the atlas's coefficients, over wall, volume and depth."""

from __future__ import annotations

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.atlas.recipe import STORED, AtlasRecipe, axes
from pneutouch.mechanics.atlas.surveyed import NormalEquations, WallCoefficients, roughness

_SETTLING = 200
_TYPES = {"inner_apex": np.float32}
"""Half precision is enough for the other fields: a step of it moves a stretch by less than a thousandth."""


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
