"""Tables of the atlas, read once, and the states interpolated in them; nu as in `recipe.AtlasRecipe`."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from pneutouch.arrays import Array, Flags, Index
from pneutouch.mechanics.atlas.recipe import FIELDS, AtlasAxes, AtlasRecipe, axes, parts, unflattened

SHIPPED = Path(__file__).with_name("atlas.npz")

#: Cavity volume of the unloaded hemisphere in R0^3.
REST_VOLUME = 2.0 / 3.0 * np.pi


_ORDERS = np.arange(3.0)[:, None]
"""Orders of the derivatives that a basis has."""


class AtlasPoint(NamedTuple):
    """Interpolated states, nondimensional; arrays of one length.

    by_volume, by_height: derivatives of the pressure by volume and plate height; force_by_height: derivative of the
    force. supported: the solid was solved near the state. folded: the wall has buckled before the state.
    """

    pressure: Array
    force: Array
    by_volume: Array
    by_height: Array
    force_by_height: Array
    supported: Flags
    folded: Flags

    def each(self, change: Callable[[Any], Any]) -> "AtlasPoint":
        """Point with the function ``change`` applied to every array."""
        return AtlasPoint(*map(change, self))


@dataclass(frozen=True)
class AtlasSlices:
    """Tables at some wall ratios, numbered k: limit_volume, limit_pressure (walls,), apex (walls, volume), potential
    (walls, volume, depth), support (walls, volume cells, depth cells). rest_apex, rest_volume (walls,): outer apex
    height and cavity of the unloaded dome. unit (walls,): unit of all depths, R0 in the shipped atlas. fold_from
    (walls,), fold_volume (walls, folds): edge of buckling, the least volume of an unbuckled wall at fold_depths, from
    depth fold_from on. fields: (walls, volume, depth, parts of all fields), with the ``columns`` of each field by its
    name."""

    grid: AtlasAxes
    limit_volume: Array
    limit_pressure: Array
    apex: Array
    potential: Array
    support: Flags
    rest_apex: Array
    rest_volume: Array
    unit: Array
    fold_from: Array
    fold_volume: Array
    fold_depths: Array
    fields: Array
    columns: dict[str, slice]

    def reach(self, k: Index) -> Array:
        """Volume (R0^3) between rest and limit point for walls k, (n,)."""
        return np.asarray(self.limit_volume[k] - self.rest_volume[k])

    def free_apex(self, k: Index, nu: Array) -> Array:
        """Outer apex height of the free dome and its first two derivatives by nu, (n, 3)."""
        cell, weight = self.grid.volume.basis(nu)
        return self._apex(k, cell, weight)

    def _apex(self, k: Index, cell: Index, weight: Array) -> Array:
        return np.asarray(np.matmul(weight, self._apex_windows[k, cell][..., None])[..., 0])

    @cached_property
    def _apex_windows(self) -> Array:
        """Spline coefficients of the apex height in each cell, (walls, volume cells, coefficients)."""
        return np.lib.stride_tricks.sliding_window_view(self.apex, self.grid.volume.degree + 1, axis=1)

    def point(self, k: Index, nu: Array, height: Array, *, with_folded: bool = True) -> AtlasPoint:
        """Pressure, force and their slopes at volumes nu and plate heights, (n,) each.

        ``with_folded`` False leaves ``folded`` at False: an iteration needs it only at its end.
        """
        cell, by_nu = self.grid.volume.basis(nu)
        apex = self._apex(k, cell, by_nu)
        unit = self.unit[k]
        depth, by_w = self.grid.depth.basis((apex[:, 0] - height) / unit)
        by_w /= unit[:, None, None] ** _ORDERS
        jet = np.matmul(np.matmul(by_nu, self._windows[k, cell, depth]), by_w.swapaxes(1, 2))
        rise, bend, reach = apex[:, 1], apex[:, 2], self.reach(k)
        force = jet[:, 0, 1]
        mixed = (jet[:, 1, 1] + jet[:, 0, 2] * rise) / reach
        along = jet[:, 2, 0] + 2 * jet[:, 1, 1] * rise + jet[:, 0, 2] * rise**2 + force * bend
        folded = self.folded(k, nu, height) if with_folded else np.zeros(nu.size, dtype=bool)
        return AtlasPoint(
            (jet[:, 1, 0] + force * rise) / reach,
            force,
            along / reach**2,
            -mixed,
            -jet[:, 0, 2],
            self.support[k, cell, depth],
            folded,
        )

    @cached_property
    def _windows(self) -> Array:
        """Spline coefficients of the potential in each cell, (walls, volume cells, depth cells, coefficients twice)."""
        size = self.grid.volume.degree + 1, self.grid.depth.degree + 1
        return np.lib.stride_tricks.sliding_window_view(self.potential, size, axis=(1, 2))

    def folded(self, k: Index, nu: Array, height: Array) -> Flags:
        """Mask (n,) of the states, at volumes nu and plate heights (n,), before which the wall has buckled."""
        depth = (self.rest_apex[k] - height) / self.unit[k]
        deep = depth > self.fold_from[k]
        if not deep.any():
            return deep
        grid = self.fold_depths
        share = (depth - grid[0]) / (grid[1] - grid[0])
        j = np.clip(share.astype(np.intp), 0, grid.size - 2)
        share = share - j
        least = (1 - share) * self.fold_volume[k, j] + share * self.fold_volume[k, j + 1]
        return np.asarray(deep & (self.rest_volume[k] + nu * self.reach(k) < least))

    def field(self, name: str, k: Index, nu: Array, height: Array) -> Array:
        """A tabulated field (see `recipe.FIELDS`) at volumes nu and plate heights, (n,)."""
        return self.several((name,), k, nu, height)[0]

    def several(self, names: Sequence[str], k: Index, nu: Array, height: Array) -> list[Array]:
        """Tabulated fields at volumes nu and plate heights, (n,) each."""
        cell, by_nu = self.grid.volume.values(nu)
        apex = np.matmul(by_nu[:, None], self._apex_windows[k, cell][..., None])[:, 0, 0]
        depth, by_w = self.grid.depth.values((apex - height) / self.unit[k])
        across = np.matmul(by_nu[:, None], self._field_windows[k, cell, depth]).reshape(*by_w.shape, -1)
        found = np.matmul(by_w[:, None], across)[:, 0]
        # Saturation is monotone, so the maximum over the parts of a field is taken before the saturation is undone.
        return [unflattened(name, found[:, self.columns[name]].max(axis=1)) for name in names]

    @cached_property
    def _field_windows(self) -> Array:
        """Spline coefficients of the fields in each cell, (walls, volume cells, depth cells, coefficients, coefficients
        of all fields)."""
        walls, rows, columns, held = self.fields.shape
        size = self.grid.volume.degree + 1, (self.grid.depth.degree + 1) * held
        flat = self.fields.reshape(walls, rows, columns * held)
        return np.lib.stride_tricks.sliding_window_view(flat, size, axis=(1, 2))[:, :, ::held]


class Atlas:
    """Tables over all wall ratios, with the recipe by which they were made."""

    def __init__(self, tables: dict[str, Array], recipe: AtlasRecipe) -> None:
        self.recipe = recipe
        self.tables = tables
        self._grid = axes(recipe)
        self._stacked: dict[tuple[str, ...], Array] = {}

    def boxed(self, recipe: AtlasRecipe) -> "Atlas":
        """An atlas with the same tables and another recipe, which may differ only in the box (limits of inputs)."""
        return Atlas(self.tables, recipe)

    def _together(self, names: tuple[str, ...]) -> Array:
        """Tables of all parts of fields, (walls, volume, depth, parts)."""
        if names not in self._stacked:
            every = [self.tables[part] for name in names for part in parts(name)] or [self.tables["potential"]]
            self._stacked[names] = np.stack(every, axis=-1)
        return self._stacked[names]

    def slices_of(self, wall: Array, radius: Array, names: tuple[str, ...]) -> tuple[AtlasSlices, Index]:
        """`slices` for walls and inner radii (n,) of one unit, each ratio once; with each sensor's number k."""
        walls, k = np.unique(wall / radius, return_inverse=True)
        return self.slices(walls, names), k

    def slices(self, wall_ratio: Array, names: tuple[str, ...] = FIELDS) -> AtlasSlices:
        """Tables interpolated at wall ratios (walls,) inside the box, with the fields ``names``."""
        grid = self._grid.wall
        cell, weight = grid.basis(np.log(wall_ratio))
        starts = np.flatnonzero(np.diff(cell, prepend=-1))
        together = list(zip(starts, [*starts[1:], cell.size], strict=True)) if cell.size else []

        def cut(table: Array) -> Array:
            # All ratios of one cell at once. BLAS would start threads, which take twice the time beside other work.
            flat = table.reshape(table.shape[0], -1)
            values = np.empty((cell.size, flat.shape[1]))
            for first, end in together:
                four = flat[cell[first] : cell[first] + grid.degree + 1]
                np.einsum("nk,km->nm", weight[first:end, 0], four, out=values[first:end])
            return values.reshape(cell.size, *table.shape[1:])

        nodes = np.log(self.recipe.wall_ratios)
        ends = np.cumsum([len(parts(name)) for name in names])
        below = np.clip(np.searchsorted(nodes, np.log(wall_ratio), side="right") - 1, 0, nodes.size - 2)
        support: Flags = self.tables["support"].astype(bool)
        share = ((np.log(wall_ratio) - nodes[below]) / (nodes[below + 1] - nodes[below]))[:, None]

        def between(name: str) -> Array:
            table = self.tables[name].reshape(nodes.size, -1)
            values: Array = (1 - share) * table[below] + share * table[below + 1]
            return values

        return AtlasSlices(
            grid=self._grid,
            limit_volume=cut(self.tables["limit_volume"]),
            limit_pressure=cut(self.tables["limit_pressure"]),
            apex=cut(self.tables["apex"]),
            potential=cut(self.tables["potential"]),
            support=support[below] & support[below + 1],
            rest_apex=1.0 + wall_ratio,
            rest_volume=np.full_like(wall_ratio, REST_VOLUME),
            unit=np.ones_like(wall_ratio),
            fold_from=between("fold_from")[:, 0],
            fold_volume=between("fold_volume"),
            fold_depths=self.recipe.fold_depths,
            fields=cut(self._together(names)),
            columns={name: slice(end - len(parts(name)), end) for name, end in zip(names, ends, strict=True)},
        )


@cache
def shipped() -> Atlas:
    """The atlas that comes with the package."""
    with np.load(SHIPPED) as file:
        recipe = AtlasRecipe.from_text(str(file["recipe"]))
        numbers = {name: file[name] for name in file.files if name not in ("recipe", "solid")}
    # In double precision at once: products with half precision are slow.
    return Atlas({name: table.astype(np.float64) for name, table in numbers.items()}, recipe)
