"""Presses that the table was not made from, compared with it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.anywhere.table import ContactPlaces, DomeConditions, PlaceTable, PlaceTableRecipe
from release.tables.contact.press import DomeState, at_equal_reading, pressed


class HeldOutPress(NamedTuple):
    """A dome and a contact, an edge where it is ``lying``; the logarithm of the force at the recipe's levels by the
    model and by the table, (levels,) each, NaN beyond the highest level that the object reaches; and that level by
    both."""

    state: DomeState
    curvature: float
    lean: float
    lying: bool
    model: Array
    table: Array
    reach: tuple[float, float]


def drawn(recipe: PlaceTableRecipe, seed: int, *, leaning: bool, lying: bool = False) -> tuple[DomeState, float, float]:
    """A random dome inside the table, and the curvature and lean of a contact."""
    draw = np.random.default_rng([seed, int(leaning), *([1] if lying else [])])
    wall = float(np.exp(draw.uniform(*np.log([recipe.walls[0], recipe.walls[-1]]))))
    share = float(draw.uniform(*np.sqrt([recipe.shares[0], recipe.shares[-1]])) ** 2)
    gas = float(np.exp(draw.uniform(*np.log([0.03, recipe.gases[-1]]))))
    curvature = float(draw.uniform(0.0 if leaning else 0.2, recipe.curvatures[-1]))
    lean = float(draw.uniform(0.1, recipe.leans[-1])) if leaning else 0.0
    return DomeState(wall, share, gas), curvature, lean


def compared(
    table: PlaceTable, state: DomeState, curvature: float, lean: float, *, lying: bool = False, order: int | None = None
) -> HeldOutPress:
    """One press by model and table; ``order`` of the harmonics in place of the recipe's."""
    recipe = table.recipe
    cells = recipe.cells if lean or lying else None
    plate = pressed(recipe, state, 0.0, 0.0, cells=cells)
    under = pressed(recipe, state, curvature, lean, lying=lying, order=order, cells=cells)
    logs, reach = at_equal_reading(recipe, plate, under)
    domes = DomeConditions(*(np.array([value]) for value in state))
    places = ContactPlaces(np.array([[curvature]]), np.array([[lean]]), lying)
    looked_up, reached = table.logs(domes, places)[0, 0], float(table.reach(domes, places)[0, 0])
    within = np.array(recipe.levels) <= min(reach, reached)
    model, tabulated = (np.where(within, values, np.nan) for values in (logs, looked_up))
    return HeldOutPress(state, curvature, lean, lying, model, tabulated, (reach, reached))
