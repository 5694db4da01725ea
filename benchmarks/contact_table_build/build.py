"""All presses of the recipe, and the tables that they make."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

import numpy as np

from benchmarks.contact_table_build.press import DomeState, at_equal_reading, pressed
from pneutouch.arrays import Array
from pneutouch.mechanics.anywhere.recipe import PlaceTableRecipe
from pneutouch.mechanics.anywhere.table import ContactPlaces, DomeConditions, PlaceTable

Tables = dict[str, Array]

_NEAR = 0.05
"""A level this near to the highest one of a press, R0, may lie beyond the end of its curve."""


def central(recipe: PlaceTableRecipe, state: DomeState) -> tuple[Array, Array]:
    """Of the central presses of a dome: logarithms (curvatures, levels) and highest levels (curvatures,)."""
    plate = pressed(recipe, state, 0.0, 0.0)
    rows = [at_equal_reading(recipe, plate, pressed(recipe, state, bend, 0.0)) for bend in recipe.curvatures]
    return np.array([logs for logs, _ in rows]), np.array([reach for _, reach in rows])


def leaning(recipe: PlaceTableRecipe, state: DomeState) -> tuple[Array, Array]:
    """What a lean changes of a dome's: logarithms (curvatures, leans, levels) and highest levels (curvatures, leans)."""
    plate = pressed(recipe, state, 0.0, 0.0, cells=recipe.cells)
    logs = np.zeros((len(recipe.leaning_curvatures), len(recipe.leans), len(recipe.levels)))
    reach = np.zeros(logs.shape[:2])
    for i, bend in enumerate(recipe.leaning_curvatures):
        upright = pressed(recipe, state, bend, 0.0, cells=recipe.cells)
        middle = at_equal_reading(recipe, plate, upright)
        for k, lean in enumerate(recipe.leans):
            there = at_equal_reading(recipe, plate, pressed(recipe, state, bend, lean))
            logs[i, k], reach[i, k] = there[0] - middle[0], there[1] - middle[1]
    return logs, reach


def jobs(recipe: PlaceTableRecipe) -> Iterator[tuple[str, DomeState]]:
    """The kind and the dome of every job, each independent of the others."""
    for state in product(recipe.leaning_walls, recipe.leaning_shares, (recipe.leaning_gas,)):
        yield "leaning", DomeState(*state)
    for state in product(recipe.walls, recipe.shares, recipe.gases):
        yield "central", DomeState(*state)


def solve(recipe: PlaceTableRecipe, kind: str, state: DomeState) -> tuple[Array, Array]:
    """One job's logarithms and highest levels."""
    return leaning(recipe, state) if kind == "leaning" else central(recipe, state)


def joined(recipe: PlaceTableRecipe, solved: dict[tuple[str, DomeState], tuple[Array, Array]]) -> Tables:
    """The tables: ``central``, ``leaning`` and the highest levels ``central_reach``, ``leaning_reach``."""
    tables = {}
    for kind, axes in (
        ("central", (recipe.walls, recipe.shares, recipe.gases)),
        ("leaning", (recipe.leaning_walls, recipe.leaning_shares, (recipe.leaning_gas,))),
    ):
        rows = [solved[kind, DomeState(*state)] for state in product(*axes)]
        shape = tuple(len(axis) for axis in axes)
        for name, part in ((kind, 0), (f"{kind}_reach", 1)):
            values = np.array([row[part] for row in rows])
            tables[name] = np.float32(values.reshape(*shape, *values.shape[1:]))
    tables["leaning"], tables["leaning_reach"] = tables["leaning"][:, :, 0], tables["leaning_reach"][:, :, 0]
    _hold(recipe, tables)
    return tables


def _hold(recipe: PlaceTableRecipe, tables: Tables) -> None:
    """Keep what a lean changes beyond the highest level of its own press as it is there: the curves end near it."""
    table, levels = PlaceTable(tables, recipe), np.array(recipe.levels)
    for (w, wall), (s, share) in product(enumerate(recipe.leaning_walls), enumerate(recipe.leaning_shares)):
        domes = DomeConditions(*(np.array([value]) for value in (wall, share, recipe.leaning_gas)))
        for (c, bend), (e, lean) in product(enumerate(recipe.leaning_curvatures), enumerate(recipe.leans)):
            places = ContactPlaces(np.array([[bend]]), np.array([[lean]]))
            last = max(int((levels <= float(table.reach(domes, places)[0, 0]) - _NEAR).sum()), 1)
            tables["leaning"][w, s, c, e, last:] = tables["leaning"][w, s, c, e, last - 1]
