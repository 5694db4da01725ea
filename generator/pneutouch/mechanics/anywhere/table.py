"""The table of contact anywhere, read once, and values looked up in it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.anywhere.recipe import NodeAxis, PlaceTableRecipe

SHIPPED = Path(__file__).with_name("contact.npz")

NodeWeights = Callable[[NodeAxis, Array], Array]

_PLATE_FIRST = ((0, 0), (1, 0), (0, 0))
"""Puts the plate before the curvatures of a table (n, curvatures, k)."""


class DomeConditions(NamedTuple):
    """Domes before contact, (n,) each: wall ratio t0/R0, share of the limit pressure, and stiffness of the gas in
    mu/R0^3: its absolute pressure over its volume at first contact."""

    wall_ratio: Array
    share: Array
    gas: Array


class ContactPlaces(NamedTuple):
    """Objects and where they touch n domes, (n, m) each: curvature R0/a and lean, see `recipe.PlaceTableRecipe`.

    They are balls and plates, or edges of bars that lie across the plane of their lean."""

    curvature: Array
    lean: Array
    lying: bool = False


class PlaceTable:
    """The logarithm of the force under an object over the central plate's at equal reading."""

    def __init__(self, tables: Mapping[str, Array], recipe: PlaceTableRecipe) -> None:
        self.recipe, self._tables = recipe, {name: np.asarray(table, dtype=float) for name, table in tables.items()}

    def logs(self, domes: DomeConditions, places: ContactPlaces) -> Array:
        """Logarithms at every level of the recipe, (n, m, levels); beyond the nodes as at the last ones."""
        r = self.recipe
        central = np.pad(self._of_central(domes, "central"), _PLATE_FIRST)
        if not places.lying:
            middle = _at((0.0, *r.curvatures), places.curvature) @ central
        else:
            # A slight curvature acts by its mean around the axis alone: its deviation from that of a body of
            # revolution has no effect to first order. The share of the ball of this mean curvature begins at 1.
            shares = np.pad(self._of_leaning(domes, "edge"), _PLATE_FIRST, constant_values=1.0)
            nodes = tuple(float(_narrow(bend)) for bend in (0.0, *r.edge_curvatures))
            middle = _at((0.0, *r.curvatures), 0.5 * places.curvature) @ central
            middle = middle * (_at(nodes, _narrow(places.curvature)) @ shares)
        return np.asarray(middle + self._off_axis(domes, places, ("leaning", "edge_leaning"), NodeAxis.weights))

    def reach(self, domes: DomeConditions, places: ContactPlaces) -> Array:
        """Highest level that the object reaches within the recipe's depth, (n, m)."""
        r, straight = self.recipe, NodeAxis.straight
        central = np.pad(self._of_central(domes, "central_reach")[..., None], _PLATE_FIRST, constant_values=r.depth)
        values = _at((0.0, *r.curvatures), places.curvature, straight) @ central
        if places.lying:
            more = np.pad(self._of_leaning(domes, "edge_reach")[..., None], _PLATE_FIRST)
            values = values + _at((0.0, *r.edge_curvatures), places.curvature, straight) @ more
        values = values + self._off_axis(domes, places, ("leaning_reach", "edge_leaning_reach"), straight)
        return np.asarray(np.minimum(values[..., 0], r.depth))

    def _of_central(self, domes: DomeConditions, name: str) -> Array:
        """A table of central presses by plates and balls at domes, (n, curvatures, ...)."""
        r = self.recipe
        walls, shares = _dome_weights(r.walls, r.shares, domes)
        gases = NodeAxis(np.log(r.gases)).weights(np.log(domes.gas))
        table = self._tables[name]
        return np.asarray(np.einsum("nw,ns,ng,wsg...->n...", walls, shares, gases, table, optimize=True))

    def _of_leaning(self, domes: DomeConditions, name: str) -> Array:
        """A table over leaning walls and shares at domes, (n, ...)."""
        return self._over(self.recipe.leaning_walls, self.recipe.leaning_shares, domes, name)

    def _over(self, walls: Sequence[float], shares: Sequence[float], domes: DomeConditions, name: str) -> Array:
        """A table over walls and shares at domes, (n, ...)."""
        by_wall, by_share = _dome_weights(walls, shares, domes)
        return np.asarray(np.einsum("nw,ns,ws...->n...", by_wall, by_share, self._tables[name], optimize=True))

    def _off_axis(
        self, domes: DomeConditions, places: ContactPlaces, names: tuple[str, str], weights: NodeWeights
    ) -> Array:
        """Changes by a lean, (n, m, levels), from the tables of balls and of edges; (n, m, 1) for the highest levels.

        The scene with a negative lean is the mirrored one: the lean enters by its square. A range by an edge mostly
        ends where the wall has come to the end of its nose, on the side of the offset: there it enters by its size.
        """
        r, balls = self.recipe, self._of_leaning(domes, names[0])
        table, nodes = balls, r.leaning_curvatures
        if places.lying:
            # The first of the balls is the tilted plate, which is an edge without curvature, too.
            plate = balls[:, :1]
            more = self._over(r.edge_walls, r.edge_shares, domes, names[1])
            table, nodes = np.hstack([plate, plate + more]), (0.0, *r.edge_curvatures)
        bends = _at(nodes, places.curvature, weights)
        power = 1 if places.lying and names[1].endswith("_reach") else 2
        leans = _at([0.0, *(lean**power for lean in r.leans)], np.abs(places.lean) ** power, weights)[..., 1:]
        pairs = (bends[..., None] * leans[..., None, :]).reshape(*places.lean.shape, -1)
        return np.asarray(pairs @ table.reshape(len(table), pairs.shape[-1], -1))


def _dome_weights(walls: Sequence[float], shares: Sequence[float], domes: DomeConditions) -> tuple[Array, Array]:
    """Weights of wall ratios and of shares of the limit pressure for n domes."""
    return (
        NodeAxis(np.log(walls)).weights(np.log(domes.wall_ratio)),
        NodeAxis(np.sqrt(shares)).weights(np.sqrt(domes.share)),
    )


def _at(nodes: Sequence[float], at: Array, weights: NodeWeights = NodeAxis.weights) -> Array:
    """Weights of nodes for values of any one shape, (..., nodes)."""
    return weights(NodeAxis(np.array(nodes)), at.ravel()).reshape(*at.shape, -1)


def _narrow(curvature: float | Array) -> Array:
    """R0/(R0 + a) of an object of a curvature R0/a: 0 for a plate, 1 for a sharp edge."""
    return np.asarray(curvature / (1.0 + np.asarray(curvature)))


def digest(tables: Mapping[str, Array]) -> str:
    """SHA-256 of the tables' numbers, the first 16 digits."""
    content = b"".join(name.encode() + np.ascontiguousarray(tables[name], "<f4").tobytes() for name in sorted(tables))
    return sha256(content).hexdigest()[:16]


@cache
def shipped() -> PlaceTable:
    """The table that comes with the package."""
    with np.load(SHIPPED) as file:
        recipe = PlaceTableRecipe.from_text(str(file["recipe"]))
        tables = {name: file[name] for name in file.files if name not in ("recipe", "model", "digest")}
    return PlaceTable(tables, recipe)
