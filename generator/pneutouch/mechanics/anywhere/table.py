"""Table of contact anywhere on the dome: the presses from which it is made, and interpolation in it.

The shipped table is read once.
"""

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

    The dome before contact is stated by its wall ratio, its share of the limit pressure and its gas stiffness. An
    object of radius a has the curvature R0/a; a plate has 0. Its ``lean`` is the sine of the angle between the axis and
    the normal at first contact on the unloaded dome: the sine of a plate's tilt, or e/(Ro + a) for a ball at offset e,
    with the outer radius Ro. A reading is stated by its ``level``: the travel, in R0, of the central plate that gives
    it.

    Central presses by the solid: every combination of walls, shares, gases and curvatures, default mesh. Presses with a
    lean, by the solid with harmonics to ``order`` on ``cells`` cells along the arc: every combination of leaning_walls,
    leaning_shares, leaning_curvatures and leans, at ``leaning_gas``; the table holds their difference from the central
    press on the same mesh.
    Presses by the edge of a bar, with the curvature of its round nose and the lean of a ball, at ``leaning_gas`` on
    ``cells`` cells, with harmonics to ``edge_order``. Across the pole, with even harmonics: every combination of
    leaning_walls, leaning_shares and edge_curvatures. The table holds their logarithm as a share of the logarithm for
    the central ball of half the curvature (the same mean curvature), and their highest level as a difference from the
    level of the ball of the same curvature. With a lean: every combination of edge_walls, edge_shares, edge_curvatures
    and leans; the table holds the change by the lean less the change under a plate.
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
    """An axis of the table with its nodes (m,), ascending.

    SciPy's `CubicHermiteSpline` would give the same values. It is not used because every datasheet reads the table, and
    importing it takes 0.8 times as much processor time as importing NumPy and `scipy.linalg`.
    """

    nodes: Array

    def weights(self, at: Array) -> Array:
        """Weights (n, m) of the nodes for values at (n,): cubic between two nodes, with the slopes of the parabola
        through each node and its neighbours; linear if there are only two nodes. Constant beyond the ends."""
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
        """Weights (n, m) for linear interpolation between the nodes; constant beyond the ends."""
        return np.asarray(np.stack([np.interp(at, self.nodes, row) for row in np.eye(self.nodes.size)], axis=-1))


RECIPE = PlaceTableRecipe()


SHIPPED = Path(__file__).with_name("contact.npz")

NodeWeights = Callable[[NodeAxis, Array], Array]

_PLATE_FIRST = ((0, 0), (1, 0), (0, 0))
"""Padding that puts the plate (curvature 0) before the curvatures of a table (n, curvatures, k)."""


class DomeConditions(NamedTuple):
    """Domes before contact, (n,) each: wall ratio t0/R0, driving pressure over limit pressure, and gas stiffness in
    mu/R0^3, the absolute gas pressure over the gas volume at first contact."""

    wall_ratio: Array
    share: Array
    gas: Array


class ContactPlaces(NamedTuple):
    """m objects in their places on n domes, (n, m) each: curvature R0/a and lean, as in `PlaceTableRecipe`. The objects
    are balls and plates; if ``lying``, edges of bars that lie across the plane of the lean."""

    curvature: Array
    lean: Array
    lying: bool = False


class PlaceTable:
    """Tables of the logarithm of the force under an object over that under the central plate at the same reading."""

    def __init__(self, tables: Mapping[str, Array], recipe: PlaceTableRecipe) -> None:
        self.recipe, self._tables = recipe, {name: np.asarray(table, dtype=float) for name, table in tables.items()}

    def logs(self, domes: DomeConditions, places: ContactPlaces) -> Array:
        """Logarithms (n, m, levels) at every level of the recipe; constant beyond the outermost nodes."""
        r = self.recipe
        central = np.pad(self._of_central(domes, "central"), _PLATE_FIRST)
        if not places.lying:
            middle = _at((0.0, *r.curvatures), places.curvature) @ central
        else:
            # A slight curvature acts only by its mean around the axis: its deviation from a body of revolution has no
            # effect to first order. The share of the ball of this mean curvature begins at 1.
            shares = np.pad(self._of_leaning(domes, "edge"), _PLATE_FIRST, constant_values=1.0)
            nodes = tuple(float(_narrow(bend)) for bend in (0.0, *r.edge_curvatures))
            middle = _at((0.0, *r.curvatures), 0.5 * places.curvature) @ central
            middle = middle * (_at(nodes, _narrow(places.curvature)) @ shares)
        return np.asarray(middle + self._off_axis(domes, places, ("leaning", "edge_leaning"), NodeAxis.weights))

    def reach(self, domes: DomeConditions, places: ContactPlaces) -> Array:
        """Highest level (n, m) that the object reaches within the recipe's depth."""
        r, straight = self.recipe, NodeAxis.straight
        central = np.pad(self._of_central(domes, "central_reach")[..., None], _PLATE_FIRST, constant_values=r.depth)
        values = _at((0.0, *r.curvatures), places.curvature, straight) @ central
        if places.lying:
            more = np.pad(self._of_leaning(domes, "edge_reach")[..., None], _PLATE_FIRST)
            values = values + _at((0.0, *r.edge_curvatures), places.curvature, straight) @ more
        values = values + self._off_axis(domes, places, ("leaning_reach", "edge_leaning_reach"), straight)
        return np.asarray(np.minimum(values[..., 0], r.depth))

    def _of_central(self, domes: DomeConditions, name: str) -> Array:
        """Table ``name`` of central presses by plates and balls, interpolated at domes, (n, curvatures, ...)."""
        r = self.recipe
        walls, shares = _dome_weights(r.walls, r.shares, domes)
        gases = NodeAxis(np.log(r.gases)).weights(np.log(domes.gas))
        table = self._tables[name]
        return np.asarray(np.einsum("nw,ns,ng,wsg...->n...", walls, shares, gases, table, optimize=True))

    def _of_leaning(self, domes: DomeConditions, name: str) -> Array:
        """Table ``name`` over leaning_walls and leaning_shares, interpolated at domes, (n, ...)."""
        return self._over(self.recipe.leaning_walls, self.recipe.leaning_shares, domes, name)

    def _over(self, walls: Sequence[float], shares: Sequence[float], domes: DomeConditions, name: str) -> Array:
        """Table ``name`` over walls and shares, interpolated at domes, (n, ...)."""
        by_wall, by_share = _dome_weights(walls, shares, domes)
        return np.asarray(np.einsum("nw,ns,ws...->n...", by_wall, by_share, self._tables[name], optimize=True))

    def _off_axis(
        self, domes: DomeConditions, places: ContactPlaces, names: tuple[str, str], weights: NodeWeights
    ) -> Array:
        """Changes by the lean, (n, m, levels), from the tables of balls and of edges; (n, m, 1) for the highest levels.

        A negative lean gives the mirror image: the lean enters by its square. The highest level under an edge is mostly
        where the wall comes to the end of the nose, on the side of the offset: there the lean enters by its size.
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
    """Weights (n, walls) of wall ratios and (n, shares) of shares of the limit pressure for n domes."""
    return (
        NodeAxis(np.log(walls)).weights(np.log(domes.wall_ratio)),
        NodeAxis(np.sqrt(shares)).weights(np.sqrt(domes.share)),
    )


def _at(nodes: Sequence[float], at: Array, weights: NodeWeights = NodeAxis.weights) -> Array:
    """Weights (..., nodes) of the nodes of an axis for values ``at`` (...)."""
    return weights(NodeAxis(np.array(nodes)), at.ravel()).reshape(*at.shape, -1)


def _narrow(curvature: float | Array) -> Array:
    """R0/(R0 + a) of an object of a curvature R0/a: 0 for a plate, 1 for a sharp edge."""
    return np.asarray(curvature / (1.0 + np.asarray(curvature)))


def digest(tables: Mapping[str, Array]) -> str:
    """First 16 hexadecimal digits of the SHA-256 of the tables' numbers."""
    content = b"".join(name.encode() + np.ascontiguousarray(tables[name], "<f4").tobytes() for name in sorted(tables))
    return sha256(content).hexdigest()[:16]


@cache
def shipped() -> PlaceTable:
    """The table that comes with the package."""
    with np.load(SHIPPED) as file:
        recipe = PlaceTableRecipe.from_text(str(file["recipe"]))
        tables = {name: file[name] for name in file.files if name not in ("recipe", "model", "digest")}
    return PlaceTable(tables, recipe)
