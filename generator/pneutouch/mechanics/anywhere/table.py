"""The table of contact anywhere, read once, and values looked up in it.

The presses that the table of contact anywhere is made from.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.atlas.recipe import StoredRecipe


@dataclass(frozen=True)
class PlaceTableRecipe(StoredRecipe):
    """Nodes of the table, in units of R0 and mu.

    An object of curvature ``R0/a`` (a: its radius; 0: a plate) first touches the unloaded dome where the normal leans
    by an angle whose sine is its ``lean``: that of the tilt of a plate, or for a ball e/(Ro + a) by its offset e and
    the outer radius Ro. A wall ratio, a share of the limit pressure and a gas stiffness state the dome before contact.
    A reading is stated by the travel of the central plate that gives it, over R0: its ``level``.

    Central presses by the solid: every combination of walls, shares, gases and curvatures, default mesh. Presses with a
    lean, by the solid with harmonics to ``order`` on ``cells`` cells along the arc: every combination of leaning_walls,
    leaning_shares, leaning_curvatures and leans, at ``leaning_gas``; of these the table has the difference from the
    central press on the same mesh.

    Presses by the edge of a bar, whose curvature is that of its round nose and whose lean is a ball's, at
    ``leaning_gas`` on ``cells`` cells, with harmonics to ``edge_order``. Across the pole, with even harmonics: every
    combination of leaning_walls, leaning_shares and edge_curvatures; of these the table has the logarithm as a share of
    that of the central ball of half the curvature, which has the same mean curvature, and the highest level as a
    difference from that of the ball of the same. With a lean: every combination of edge_walls, edge_shares,
    edge_curvatures and leans; of these it has what the lean changes, less what it changes under a plate.
    """

    poisson_ratio: float = 0.49
    walls: tuple[float, ...] = (0.06, 0.11, 0.2, 0.35)
    shares: tuple[float, ...] = (0.0, 0.1, 0.25, 0.5, 0.9)
    gases: tuple[float, ...] = (0.01, 0.1, 0.6)
    curvatures: tuple[float, ...] = (0.5, 1.0, 2.0, 10.0 / 3.0)
    levels: tuple[float, ...] = (0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7)
    leaning_walls: tuple[float, ...] = (0.06, 0.15, 0.35)
    leaning_shares: tuple[float, ...] = (0.0, 0.25, 0.9)
    leaning_curvatures: tuple[float, ...] = (0.0, 1.0, 10.0 / 3.0)
    leans: tuple[float, ...] = (0.44,)
    leaning_gas: float = 0.1
    order: int = 6
    edge_walls: tuple[float, ...] = (0.06, 0.35)
    edge_shares: tuple[float, ...] = (0.0, 0.9)
    edge_curvatures: tuple[float, ...] = (1.0, 10.0 / 3.0)
    edge_order: int = 8
    cells: int = 16
    depth: float = 0.75
    steps: int = 15


class NodeAxis(NamedTuple):
    """A direction of the table with its nodes (m,), ascending.

    SciPy's `CubicHermiteSpline` would give the same values. It is not used because every datasheet reads the table, and
    importing it takes 0.8 times as much processor time as importing NumPy and `scipy.linalg`.
    """

    nodes: Array

    def weights(self, at: Array) -> Array:
        """Weights (n, m) of the nodes for values at (n,): a cubic between two nodes through both, with the slopes that
        a parabola through each node and its neighbours has; a parabola with three nodes. The ends hold beyond."""
        x, size = self.nodes, self.nodes.size
        if size == 1:
            return np.ones((at.size, 1))
        at = np.clip(at, x[0], x[-1])
        slopes = np.gradient(np.eye(size), x, axis=0, edge_order=1 if size == 2 else 2)
        k = np.clip(np.searchsorted(x, at, side="right") - 1, 0, size - 2)
        span = x[k + 1] - x[k]
        t = (at - x[k]) / span
        one = np.eye(size)
        left, right = (t * (1 - t) ** 2 * span)[:, None], (t**2 * (t - 1) * span)[:, None]
        rise = (t**2 * (3 - 2 * t))[:, None]
        return np.asarray((1 - rise) * one[k] + rise * one[k + 1] + left * slopes[k] + right * slopes[k + 1])

    def straight(self, at: Array) -> Array:
        """Weights (n, m) of straight lines between the nodes; the ends hold beyond."""
        return np.asarray(np.stack([np.interp(at, self.nodes, row) for row in np.eye(self.nodes.size)], axis=-1))


RECIPE = PlaceTableRecipe()


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
