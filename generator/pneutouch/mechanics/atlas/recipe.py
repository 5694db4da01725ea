"""Recipe of the atlas: the presses for which the solid is solved, and the form in which its results are stored.

The tables hold coefficients of uniform B-splines: few numbers, smooth derivatives, quick to evaluate. The recipe is
stored as JSON in the file of the shipped table.
"""

import json
from dataclasses import asdict, dataclass
from functools import cached_property, lru_cache
from typing import Any, NamedTuple, Self

import numpy as np

from pneutouch.arrays import Array, Index


@lru_cache
def pieces(degree: int) -> Array:
    """Coefficients (degree + 1, degree + 1) of the B-splines nonzero in a cell, as polynomials of the position u.

    Row k holds the factors of u^k, each column one spline. By the recursion of de Boor (1972) on uniform knots.
    """
    rows = np.ones((1, 1))
    for d in range(1, degree + 1):
        more = np.zeros((d + 1, d + 1))
        for j in range(d + 1):
            # N_j^d = ((u + d - j) N_{j-1}^{d-1} + (1 + j - u) N_j^{d-1}) / d in the cell's own numbering.
            if j > 0:
                more[:-1, j] += (d - j) * rows[:, j - 1]
                more[1:, j] += rows[:, j - 1]
            if j < d:
                more[:-1, j] += (1 + j) * rows[:, j]
                more[1:, j] -= rows[:, j]
        rows = more / d
    return rows


@dataclass(frozen=True)
class SplineAxis:
    """An interval from ``low`` to ``high`` in ``cells`` cells, with cells + degree spline coefficients.

    The cells are equal in z = sqrt(x - low + stretch^2), finest at the low end, or in x where ``stretch`` is None.
    """

    low: float
    high: float
    cells: int
    degree: int
    stretch: float | None = None

    @property
    def size(self) -> int:
        """Number of spline coefficients."""
        return self.cells + self.degree

    @cached_property
    def _spacing(self) -> float:
        """Length of a cell in z."""
        ends = self._stretched(np.array([self.low, self.high]))
        return float(ends[1] - ends[0]) / self.cells

    def _stretched(self, x: Array) -> Array:
        if self.stretch is None:
            return x - self.low
        return np.sqrt(np.maximum(x - self.low, 0.0) + self.stretch**2) - self.stretch

    def even(self, count: int) -> Array:
        """Points equally spaced in z from end to end, (count,)."""
        z = np.linspace(0.0, self._spacing * self.cells, count)
        return self.low + (z if self.stretch is None else z * (z + 2 * self.stretch))

    @cached_property
    def _derivatives(self) -> Array:
        """Coefficients of value and first two derivatives by z, side by side; (degree + 1, 3 (degree + 1))."""
        value = pieces(self.degree)
        n = self.degree + 1
        power = np.arange(1.0, n)
        first, second = np.zeros_like(value), np.zeros_like(value)
        first[:-1] = power[:, None] * value[1:]
        second[:-1] = power[:, None] * first[1:]
        return np.concatenate([value, first / self._spacing, second / self._spacing**2], axis=1)

    def basis(self, x: Array) -> tuple[Index, Array]:
        """Index of the first coefficient (n,) for each x, and weights (n, 3, degree + 1) of value, slope and curvature.

        Beyond the ends the polynomial of the last cell is extrapolated.
        """
        z, cell, powers = self._powers(x)
        weight = (powers @ self._derivatives).reshape(cell.size, 3, self.degree + 1)
        if self.stretch is not None:
            rate = (0.5 / (z + self.stretch))[:, None]
            weight[:, 2] = rate**2 * (weight[:, 2] - 2.0 * rate * weight[:, 1])
            weight[:, 1] *= rate
        return cell, weight

    def values(self, x: Array) -> tuple[Index, Array]:
        """Index of the first coefficient (n,) for each x, and weights (n, degree + 1) of the value only."""
        _, cell, powers = self._powers(x)
        return cell, powers @ pieces(self.degree)

    def _powers(self, x: Array) -> tuple[Array, Index, Array]:
        """Coordinate z (n,), its cell (n,) and powers of the local coordinate in the cell, (n, degree + 1)."""
        z = self._stretched(x)
        u = z / self._spacing
        cell = np.minimum(np.maximum(np.floor(u), 0), self.cells - 1).astype(np.intp)
        u = u - cell
        powers = np.empty((u.size, self.degree + 1))
        powers[:, 0] = 1.0
        for k in range(1, self.degree + 1):
            np.multiply(powers[:, k - 1], u, out=powers[:, k])
        return z, cell, powers

    def rows(self, x: Array, order: int = 0) -> Array:
        """Weights (n, size) of all coefficients for the derivative of ``order`` 0 (value), 1 or 2."""
        cell, weight = self.basis(x)
        out = np.zeros((x.size, self.size))
        np.put_along_axis(out, cell[:, None] + np.arange(self.degree + 1), weight[:, order], axis=1)
        return out


@dataclass(frozen=True)
class StoredRecipe:
    """Recipe of a stored table; its fields are numbers and tuples of numbers."""

    def text(self) -> str:
        """The recipe as JSON."""
        return json.dumps(asdict(self), sort_keys=True)

    @classmethod
    def from_text(cls, text: str) -> Self:
        """Recipe from its JSON text."""
        content: dict[str, Any] = json.loads(text)
        fields: dict[str, Any] = {k: tuple(v) if isinstance(v, list) else v for k, v in content.items()}
        return cls(**fields)


@dataclass(frozen=True)
class AtlasRecipe(StoredRecipe):
    """Box (limits of the inputs) and resolution of the atlas, in units of R0 and mu.

    Coordinates: t0/R0; ``nu``, the cavity volume above the unloaded one, as a share of its value at the limit point;
    ``w``, the distance of the plate below the free apex at that volume. A press with trapped gas reaches nu < 0 where
    the cavity is squeezed below its unloaded volume. ambients, first_pressures: ambient pressures (in mu; 0: vented)
    and shares of the limit pressure of the presses with trapped gas that line the edge at zero pressure. stiffest_gas:
    greatest ambient pressure over mu that is solved; stiffest: the greatest inside the box. furthest: greatest wall
    ratio that is solved, for a search whose designs the solid confirms. deepest: greatest plate
    travel inside the box; states are solved to ``beyond``, so that the edge of the box is not the edge of the data.
    """

    poisson_ratio: float = 0.49
    thinnest: float = 0.06
    thickest: float = 0.35
    furthest: float = 0.535
    walls: int = 32
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
        """Solved t0/R0, (walls,), equally spaced in the logarithm from slightly below the box to ``furthest``."""
        return np.geomspace(self.thinnest / self.margin, self.furthest, self.walls)

    @property
    def fold_depths(self) -> Array:
        """Depths (R0) below the unloaded apex at which the edge of buckling is stored, (folds,)."""
        return np.linspace(0.35, self.beyond, self.folds)


class AtlasAxes(NamedTuple):
    """The three axes of the tables: wall ratio (its logarithm), volume nu, depth w, as in `AtlasRecipe`."""

    wall: SplineAxis
    volume: SplineAxis
    depth: SplineAxis


def axes(recipe: AtlasRecipe) -> AtlasAxes:
    """Axes of a recipe; the walls are cubic in their logarithm, with knots at the solved wall ratios."""
    walls = recipe.wall_ratios
    return AtlasAxes(
        SplineAxis(float(np.log(walls[0])), float(np.log(walls[-1])), walls.size - 1, 3),
        SplineAxis(
            recipe.lowest_volume, recipe.highest_volume, recipe.volume_cells, recipe.degree, recipe.volume_stretch
        ),
        SplineAxis(0.0, recipe.beyond, recipe.depth_cells, recipe.degree, recipe.depth_stretch),
    )


RECIPE = AtlasRecipe()

FIELDS = ("contact_radius", "stretch", "von_mises", "fold", "inner_apex")
"""Fields that can be read in addition to the potential, see `indent.PressState`; lengths in R0, stresses in mu."""

STRETCHES = tuple(f"stretch_{face}_{part}" for face in ("inner", "outer") for part in ("low", "middle", "high"))
"""Greatest stretch on each face and third of the arc: each is smooth, while the greatest of all has kinks."""

STORED = (*STRETCHES, "contact_radius", "von_mises", "fold", "inner_apex")
"""Quantities that are tabulated."""


def parts(name: str) -> tuple[str, ...]:
    """Names of the tables whose greatest value is the field ``name`` of `FIELDS`."""
    return STRETCHES if name == "stretch" else (name,)


_SATURATING = ("stretch", *STRETCHES, "von_mises", "fold")
_HALF = 2.0
_MOST = 0.9


def flattened(name: str, values: Array) -> Array:
    """A field as it is tabulated; strains and stresses saturate, being huge and meaningless at the tip of a crease."""
    return values / (values + _HALF) if name in _SATURATING else values


def unflattened(name: str, values: Array) -> Array:
    """Inverse of `flattened`; the result of a saturating field is at most 18."""
    if name not in _SATURATING:
        return values
    share = np.clip(values, 0.0, _MOST)
    return np.asarray(_HALF * share / (1.0 - share))
