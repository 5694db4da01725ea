"""A selection problem in numbers: resins, bounds and target, in mm, N, MPa; sensitivities in kPa/N.

Also the first limit of free inflation over the wall ratio, limit point or break strain, for many domes at once.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple, Self

import numpy as np

from pneutouch.arrays import Array, distinct
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.atlas.recipe import AtlasRecipe
from pneutouch.mechanics.atlas.table import Atlas, shipped
from pneutouch.mechanics.corrected.designs import ContactFactors
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.spec.grade import Grade
from pneutouch.spec.material import Material

_SMALLEST, _LARGEST = 2.0, 60.0
"""Inner radii that are searched where none is given, mm."""
_HALVINGS = 14
"""Number of halvings in the search of a radius of at most 60 mm, to within 4 um."""
_ROUNDED = 0.01
"""Largest change of a wall by rounding, mm."""


@dataclass(frozen=True)
class CandidateResin:
    """A resin as the atlas needs it: modulus in MPa, stretch at break (inf: unknown); ``grade`` if it is a mix."""

    name: str
    material: Material
    shear_modulus: float
    break_stretch: float
    grade: Grade | None = None

    @classmethod
    def of(cls, name: str, material: Material, grade: Grade | None = None) -> Self:
        """Resin with the modulus and the stretch at break that a prediction takes of its material."""
        wall = material_sensor(material).wall
        return cls(name, material, wall.shear_modulus, wall.break_stretch or np.inf, grade)


class ConnectorFit(NamedTuple):
    """Connectors around domes, (n,) each: relative margin of the space for their parts, and the whole diameter, mm."""

    margin: Array
    diameter: Array


LimitUncertainty = Callable[[CandidateResin, SensorBatch], Array]
"""Function that gives the relative standard uncertainty (n,) of the limit pressure of sensors of one resin."""


@dataclass(frozen=True)
class SelectionProblem:
    """Requirements on a sensor and the settled parameters; None for a free one. depth_share: plate travel over R0.

    plate_share: the plate's radius over R0 if that gives more than ``plate_radius``. dead_volume: mm3 for domes of
    inner radius (n,). connector: its fit to domes of inner radius and wall (n,), mm; None if no connector matters.
    limit_spread: uncertainty of the limits; None allows driving pressures above the rated one. factors: factors on the
    atlas's figures, for a contact or a law that it does not cover. anywhere: True if the ranking counts an unknown
    object and place. stiffness_depth: depth of the required stiffness, mm; None: the mean over the range.
    """

    resins: tuple[CandidateResin, ...]
    sensitivity: float | None
    tolerance: float
    driving_pressure: float | None
    force_range: float | None
    stiffness: tuple[float | None, float | None]
    max_diameter: float | None
    inner_radius: float | None
    wall_thickness: float | None
    least_wall: float
    ambient_pressure: float
    dead_volume: Callable[[Array], Array]
    plate_radius: float
    gauge_limit: float
    depth_share: float
    steps: int
    atlas: Atlas
    plate_share: float = 0.0
    max_footprint: float | None = None
    connector: Callable[[Array, Array], ConnectorFit] | None = None
    limit_spread: LimitUncertainty | None = None
    factors: ContactFactors | None = None
    anywhere: bool = False
    stiffness_depth: float | None = None

    @property
    def recipe(self) -> AtlasRecipe:
        """Recipe of the atlas, with the box of the search."""
        return self.atlas.recipe

    def plate(self, radius: Array) -> Array:
        """Radius of the plate for domes of inner radius (n,), mm."""
        return np.maximum(self.plate_radius, self.plate_share * radius)

    def batch(self, resin: Array, radius: Array, wall: Array, pressure: Array) -> SensorBatch:
        """Candidates as sensors; resin (n,) numbers in ``resins``, radius and wall (n,) mm, pressure (n,) MPa."""
        index = resin.astype(np.intp)
        ones = np.ones(radius.size)
        return SensorBatch(
            inner_radius=radius,
            wall_thickness=wall,
            shear_modulus=np.array([r.shear_modulus for r in self.resins])[index],
            ambient_pressure=ones * self.ambient_pressure,
            dead_volume=self.dead_volume(radius),
            driving_pressure=pressure,
            depth=radius * self.depth_share,
            plate_radius=self.plate(radius),
            gauge_limit=ones * self.gauge_limit,
            break_stretch=np.array([r.break_stretch for r in self.resins])[index],
        )

    def radii(self, ratio: Array) -> tuple[Array, Array]:
        """Least and greatest inner radius (n,), mm, for wall ratios (n,): by least wall, size limit and footprint."""
        if self.inner_radius is not None:
            fixed = np.full_like(ratio, self.inner_radius)
            return fixed, fixed
        low = np.maximum(self.least_wall / ratio, _SMALLEST)
        largest = _LARGEST if self.max_diameter is None else 0.5 * self.max_diameter
        high = np.minimum(largest / (1.0 + ratio), _LARGEST)
        return low, high if self.max_footprint is None else self._within_footprint(ratio, low, high)

    def _within_footprint(self, ratio: Array, low: Array, high: Array) -> Array:
        """Greatest radii up to ``high`` whose connector keeps the footprint, in whole hundredths; bisected, for the
        diameter grows with the dome."""
        assert self.connector is not None and self.max_footprint is not None
        kept = self.connector(high, ratio * high).diameter <= self.max_footprint
        least, most = np.zeros_like(high), high
        for _ in range(_HALVINGS):
            middle = 0.5 * (least + most)
            inside = self.connector(middle, ratio * middle).diameter <= self.max_footprint
            least, most = np.where(inside, middle, least), np.where(inside, most, middle)
        return np.where(kept, high, least - _ROUNDED)


_RATIOS, _VOLUMES = 75, 91
"""Numbers of wall ratios and volumes. The ratios are 3 % apart: limit pressures are linear between them to 0.02 %."""


def least_limit(wall_ratio: Array, break_stretch: Array) -> Array:
    """Driving pressures over the shear modulus at which inflated domes meet their first limit, (n,).

    The limit is the limit point, or the break stretch (n,) if the wall reaches it earlier. A wall ratio (n,) outside
    the tables counts as the nearest one inside.
    """
    ratios, limit, stretch, pressure = _inflations()
    least = np.interp(wall_ratio, ratios, limit)
    for value in distinct(break_stretch[break_stretch < stretch.max()]):
        rows = break_stretch == value
        ruptured = np.interp(wall_ratio[rows], ratios, _ruptured(float(value), stretch, pressure))
        least[rows] = np.fmin(least[rows], ruptured)
    return np.asarray(least)


def _ruptured(break_stretch: float, stretch: Array, pressure: Array) -> Array:
    """Pressure (mu) at which each wall ratio reaches the break stretch, (k,); NaN if the limit point comes first."""
    reached = stretch >= break_stretch
    after = np.maximum(reached.argmax(axis=1), 1)
    rows = np.arange(after.size)
    low, high = stretch[rows, after - 1], stretch[rows, after]
    share = np.clip((break_stretch - low) / (high - low), 0.0, 1.0)
    between = pressure[rows, after - 1] + share * (pressure[rows, after] - pressure[rows, after - 1])
    return np.where(reached.any(axis=1), between, np.nan)


@cache
def _inflations() -> tuple[Array, Array, Array, Array]:
    """Wall ratios (k,), limit pressures (k,), stretches and pressures over mu up to the limit (k, volumes)."""
    walls = shipped().recipe.wall_ratios
    # Powers are rounded: the ends stay inside the tables.
    ratios = np.clip(np.geomspace(walls[0], walls[-1], _RATIOS), walls[0], walls[-1])
    slices = shipped().slices(ratios, ("stretch",))
    k = np.repeat(np.arange(_RATIOS), _VOLUMES)
    nu = np.tile(np.linspace(0.0, 1.0, _VOLUMES), _RATIOS)
    apex = slices.free_apex(k, nu)[:, 0]
    shape = (_RATIOS, _VOLUMES)
    stretch, pressure = slices.field("stretch", k, nu, apex), slices.point(k, nu, apex).pressure
    return ratios, slices.limit_pressure, stretch.reshape(shape), pressure.reshape(shape)
