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


class DomeConditions(NamedTuple):
    """Domes before contact, (n,) each: wall ratio t0/R0, share of the limit pressure, and stiffness of the gas in
    mu/R0^3: its absolute pressure over its volume at first contact."""

    wall_ratio: Array
    share: Array
    gas: Array


class ContactPlaces(NamedTuple):
    """Objects and where they touch n domes, (n, m) each: curvature R0/a and lean, see `recipe.PlaceTableRecipe`."""

    curvature: Array
    lean: Array


class PlaceTable:
    """The logarithm of the force under an object over the central plate's at equal reading."""

    def __init__(self, tables: Mapping[str, Array], recipe: PlaceTableRecipe) -> None:
        self.recipe, self._tables = recipe, {name: np.asarray(table, dtype=float) for name, table in tables.items()}

    def logs(self, domes: DomeConditions, places: ContactPlaces) -> Array:
        """At every level of the recipe, (n, m, levels); beyond the nodes as at the last ones."""
        central, leaning = self._of_domes(domes, "central", "leaning")
        return self._at(places, np.pad(central, ((0, 0), (1, 0), (0, 0))), leaning, NodeAxis.weights)

    def reach(self, domes: DomeConditions, places: ContactPlaces) -> Array:
        """Highest level that the object reaches within the recipe's depth, (n, m)."""
        central, leaning = self._of_domes(domes, "central_reach", "leaning_reach")
        plate = np.full((len(central), 1), self.recipe.depth)
        values = self._at(places, np.hstack([plate, central])[..., None], leaning[..., None], NodeAxis.straight)
        return np.asarray(np.minimum(values[..., 0], self.recipe.depth))

    def _of_domes(self, domes: DomeConditions, central: str, leaning: str) -> tuple[Array, Array]:
        """Both tables at domes: (n, curvatures, ...) and (n, leaning_curvatures, leans, ...)."""
        r, wall, share = self.recipe, np.log(domes.wall_ratio), np.sqrt(domes.share)
        walls = [NodeAxis(np.log(nodes)).weights(wall) for nodes in (r.walls, r.leaning_walls)]
        shares = [NodeAxis(np.sqrt(nodes)).weights(share) for nodes in (r.shares, r.leaning_shares)]
        gases = NodeAxis(np.log(r.gases)).weights(np.log(domes.gas))
        first, second = self._tables[central], self._tables[leaning]
        return (
            np.einsum("nw,ns,ng,wsg...->n...", walls[0], shares[0], gases, first, optimize=True),
            np.einsum("nw,ns,ws...->n...", walls[1], shares[1], second, optimize=True),
        )

    def _at(
        self, places: ContactPlaces, central: Array, leaning: Array, weights: Callable[[NodeAxis, Array], Array]
    ) -> Array:
        """Tables of domes (n, 1 + curvatures, k) and (n, leaning_curvatures, leans, k) at places, (n, m, k).

        The scene with a negative lean is the mirrored one: the lean enters by its square.
        """
        r = self.recipe

        def along(nodes: Sequence[float], at: Array) -> Array:
            return weights(NodeAxis(np.array(nodes)), at.ravel()).reshape(*at.shape, -1)

        bends = along((0.0, *r.curvatures), places.curvature)
        bends_leaning = along(r.leaning_curvatures, places.curvature)
        leans = along([0.0, *(lean**2 for lean in r.leans)], places.lean**2)[..., 1:]
        pairs = (bends_leaning[..., None] * leans[..., None, :]).reshape(*places.lean.shape, -1)
        return bends @ central + pairs @ leaning.reshape(len(leaning), pairs.shape[-1], -1)


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
