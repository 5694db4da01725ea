"""All presses of the recipe, and the tables that they make."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.anywhere.table import ContactPlaces, DomeConditions, PlaceTable, PlaceTableRecipe
from release.tables.contact.press import DomeState, at_equal_reading, pressed

Tables = dict[str, Array]
Solved = dict[tuple[str, DomeState], tuple[Array, Array]]

_NEAR = 0.05
"""A level this near to the highest one of a press, R0, may lie beyond the end of its curve."""


def central(recipe: PlaceTableRecipe, state: DomeState) -> tuple[Array, Array]:
    """Of the central presses of a dome: logarithms (curvatures, levels) and highest levels (curvatures,)."""
    plate = pressed(recipe, state, 0.0, 0.0)
    rows = [at_equal_reading(recipe, plate, pressed(recipe, state, bend, 0.0)) for bend in recipe.curvatures]
    return np.array([logs for logs, _ in rows]), np.array([reach for _, reach in rows])


def leaning(recipe: PlaceTableRecipe, state: DomeState) -> tuple[Array, Array]:
    """Changes by a lean: logarithms (curvatures, leans, levels) and highest levels (curvatures, leans)."""
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


def edges(recipe: PlaceTableRecipe, state: DomeState, leans: Sequence[float]) -> tuple[Array, Array]:
    """Presses by edges: logarithms (curvatures, leans, levels) and highest levels (curvatures, leans)."""
    plate = pressed(recipe, state, 0.0, 0.0, cells=recipe.cells)
    rows = [
        [at_equal_reading(recipe, plate, pressed(recipe, state, bend, lean, lying=True)) for lean in leans]
        for bend in recipe.edge_curvatures
    ]
    return np.array([[logs for logs, _ in row] for row in rows]), np.array(
        [[reach for _, reach in row] for row in rows]
    )


def jobs(recipe: PlaceTableRecipe) -> Iterator[tuple[str, DomeState]]:
    """The kind and the dome of every job, each independent of the others."""
    for kind in ("edge_leaning", "leaning", "edge", "central"):
        for state in product(*axes(recipe, kind)):
            yield kind, DomeState(*state)


def axes(recipe: PlaceTableRecipe, kind: str) -> tuple[Sequence[float], ...]:
    """Walls, shares and gases of the domes of a kind of job."""
    if kind == "central":
        return recipe.walls, recipe.shares, recipe.gases
    if kind == "edge_leaning":
        return recipe.edge_walls, recipe.edge_shares, (recipe.leaning_gas,)
    return recipe.leaning_walls, recipe.leaning_shares, (recipe.leaning_gas,)


def solve(recipe: PlaceTableRecipe, kind: str, state: DomeState) -> tuple[Array, Array]:
    """One job's logarithms and highest levels."""
    if kind in ("edge", "edge_leaning"):
        return edges(recipe, state, (0.0,) if kind == "edge" else recipe.leans)
    return leaning(recipe, state) if kind == "leaning" else central(recipe, state)


def joined(recipe: PlaceTableRecipe, solved: Solved) -> Tables:
    """The tables: ``central``, ``leaning``, ``edge``, ``edge_leaning`` and, with ``_reach``, their highest levels."""
    tables: Tables = {}
    for kind in ("central", "leaning"):
        tables[kind], tables[f"{kind}_reach"] = _gathered(recipe, solved, kind)
    tables["leaning"], tables["leaning_reach"] = tables["leaning"][:, :, 0], tables["leaning_reach"][:, :, 0]
    _hold(recipe, tables)
    across, leaning = ([part[:, :, 0] for part in _gathered(recipe, solved, k)] for k in ("edge", "edge_leaning"))
    tables["edge"], tables["edge_reach"] = _of_balls(recipe, tables, across[0][..., 0, :], across[1][..., 0])
    chosen = np.ix_(
        [recipe.leaning_walls.index(wall) for wall in recipe.edge_walls],
        [recipe.leaning_shares.index(share) for share in recipe.edge_shares],
    )
    for edge, plate, place in (("edge_leaning", "leaning", 0), ("edge_leaning_reach", "leaning_reach", 1)):
        changed = leaning[place] - across[place][chosen]
        if edge == "edge_leaning":
            _keep(changed, leaning[1], np.array(recipe.levels))
        tables[edge] = changed - tables[plate][chosen][:, :, :1]
    return tables


def _gathered(recipe: PlaceTableRecipe, solved: Solved, kind: str) -> tuple[Array, Array]:
    """Logarithms and highest levels of all jobs of a kind over their axes."""
    nodes = axes(recipe, kind)
    rows = [solved[kind, DomeState(*state)] for state in product(*nodes)]
    shape = tuple(len(axis) for axis in nodes)
    logs, reach = (np.float32(np.array([row[part] for row in rows])) for part in (0, 1))
    return logs.reshape(*shape, *logs.shape[1:]), reach.reshape(*shape, *reach.shape[1:])


def _of_balls(recipe: PlaceTableRecipe, tables: Tables, logs: Array, reach: Array) -> tuple[Array, Array]:
    """Logarithms of edges across the pole (walls, shares, curvatures, levels) as shares of those of central balls of
    half the curvature, and their highest levels less those of balls of the same.

    A share is between that of a plate, 0, and 1: outside are the quotients of two numbers near zero.
    """
    table = PlaceTable(tables, recipe)
    shares, more = np.zeros_like(logs), np.zeros_like(reach)
    bends = np.array([recipe.edge_curvatures])
    for (w, wall), (s, share) in product(enumerate(recipe.leaning_walls), enumerate(recipe.leaning_shares)):
        domes = DomeConditions(*(np.array([value]) for value in (wall, share, recipe.leaning_gas)))
        balls = table.logs(domes, ContactPlaces(0.5 * bends, np.zeros_like(bends)))[0]
        shares[w, s] = np.clip(logs[w, s] / balls, 0.0, 1.0)
        more[w, s] = reach[w, s] - table.reach(domes, ContactPlaces(bends, np.zeros_like(bends)))[0]
    _keep(shares, reach, np.array(recipe.levels))
    return shares, more


def _hold(recipe: PlaceTableRecipe, tables: Tables) -> None:
    """Keep what a lean changes of plates and balls beyond the highest level of its own press as it is there: the curves
    end near it."""
    table, reach = PlaceTable(tables, recipe), np.zeros_like(tables["leaning_reach"])
    for (w, wall), (s, share) in product(enumerate(recipe.leaning_walls), enumerate(recipe.leaning_shares)):
        domes = DomeConditions(*(np.array([value]) for value in (wall, share, recipe.leaning_gas)))
        for (c, bend), (e, lean) in product(enumerate(recipe.leaning_curvatures), enumerate(recipe.leans)):
            reach[w, s, c, e] = table.reach(domes, ContactPlaces(np.array([[bend]]), np.array([[lean]])))[0, 0]
    _keep(tables["leaning"], reach, np.array(recipe.levels))


def _keep(logs: Array, reach: Array, levels: Array) -> None:
    """Keep values (..., levels) beyond the highest levels (...) as they are there."""
    for place in np.ndindex(reach.shape):
        last = max(int((levels <= reach[place] - _NEAR).sum()), 1)
        logs[(*place, slice(last, None))] = logs[(*place, last - 1)]
