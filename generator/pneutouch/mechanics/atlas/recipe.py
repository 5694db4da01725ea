"""Recipe of the atlas: the presses for which the solid is solved, and the form in which its answers are stored."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.atlas.spline import SplineAxis
from pneutouch.mechanics.stored_recipe import StoredRecipe


@dataclass(frozen=True)
class AtlasRecipe(StoredRecipe):
    """The box and the resolution of the atlas, in units of R0 and mu.

    Coordinates: t0/R0; ``nu``, the cavity volume above the unloaded one as a share of that at the limit point; ``w``,
    how far the plate is below the free apex at that volume. A press with trapped gas leaves nu = 0 downwards where the
    cavity is squeezed below its unloaded volume. ambients, first_pressures: presses with trapped
    gas from these ambient pressures (in mu; 0: vented) and shares of the limit pressure, which line the edge at zero
    pressure. stiffest_gas: greatest ambient pressure over mu that is solved; stiffest: that is inside the box.
    deepest: greatest plate travel;
    states are solved to ``beyond``, so that the edge of the box is not the edge of the data.
    """

    poisson_ratio: float = 0.49
    thinnest: float = 0.06
    thickest: float = 0.35
    walls: int = 27
    margin: float = 1.07
    lowest_volume: float = -0.34
    highest_volume: float = 1.06
    deepest: float = 0.75
    stiffest_gas: float = 3.0
    stiffest: float = 1.0
    beyond: float = 0.80
    volumes: int = 68
    depths: int = 60
    ambients: tuple[float, ...] = (0.0, 0.004, 0.01, 0.02, 0.04, 0.07, 0.1, 0.15, 0.2, 0.3, 0.45, 0.7, 1.2)
    first_pressures: tuple[float, ...] = (0.0, 0.05)
    folds: int = 46
    degree: int = 4
    volume_cells: int = 46
    volume_stretch: float = 0.5
    depth_cells: int = 30
    depth_stretch: float = 0.1

    @property
    def wall_ratios(self) -> Array:
        """Surveyed t0/R0, (walls,): even in the logarithm, from a little below the box to a little above it."""
        return np.geomspace(self.thinnest / self.margin, self.thickest * self.margin, self.walls)

    @property
    def fold_depths(self) -> Array:
        """Depths below the unloaded apex at which the buckling edge is kept, (folds,)."""
        return np.linspace(0.35, self.beyond, self.folds)


class AtlasAxes(NamedTuple):
    """The three directions of the tables."""

    wall: SplineAxis
    volume: SplineAxis
    depth: SplineAxis


def axes(recipe: AtlasRecipe) -> AtlasAxes:
    """The directions of a recipe; walls in their logarithm, cubic, knots on the surveys."""
    walls = recipe.wall_ratios
    return AtlasAxes(
        SplineAxis(float(np.log(walls[0])), float(np.log(walls[-1])), recipe.walls - 1, 3),
        SplineAxis(
            recipe.lowest_volume, recipe.highest_volume, recipe.volume_cells, recipe.degree, recipe.volume_stretch
        ),
        SplineAxis(0.0, recipe.beyond, recipe.depth_cells, recipe.degree, recipe.depth_stretch),
    )


RECIPE = AtlasRecipe()

FIELDS = ("contact_radius", "stretch", "von_mises", "fold", "inner_apex")
"""Fields that can be read in addition to the potential: see `solid.PressState`; lengths in R0, stresses in mu."""

STRETCHES = tuple(f"stretch_{face}_{part}" for face in ("inner", "outer") for part in ("low", "middle", "high"))
"""The greatest stretch by face and third of the arc, each smooth where the greatest of all has kinks."""

STORED = (*STRETCHES, "contact_radius", "von_mises", "fold", "inner_apex")
"""Quantities that are tabulated."""


def parts(name: str) -> tuple[str, ...]:
    """The tables a field is the greatest of."""
    return STRETCHES if name == "stretch" else (name,)


_SATURATING = ("stretch", *STRETCHES, "von_mises", "fold")
_HALF = 2.0
_MOST = 0.9


def flattened(name: str, values: Array) -> Array:
    """A field as it is tabulated: where a face turns over at a crease's tip, strains are immense and mean nothing."""
    return values / (values + _HALF) if name in _SATURATING else values


def unflattened(name: str, values: Array) -> Array:
    """A field from its table; immense values are cut at eighteen."""
    if name not in _SATURATING:
        return values
    share = np.clip(values, 0.0, _MOST)
    return np.asarray(_HALF * share / (1.0 - share))
