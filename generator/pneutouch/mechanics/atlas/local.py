"""Tables of the solid's states for the neighbourhood of one design of any shape.

The parameters are the wall and the shape's own sizes, over R0. The solid is surveyed for the design and for designs one
step away in each parameter and in each pair of them; in between, every coefficient is a full quadratic in the
logarithms of the parameters. Volume, plate height and gas are treated as in the atlas, by the same code.
"""

import json
from collections.abc import Callable
from copy import copy
from dataclasses import asdict, dataclass, fields, replace
from itertools import combinations

import numpy as np

from pneutouch.arrays import Array, Index
from pneutouch.mechanics.atlas.recipe import FIELDS, RECIPE, STORED, AtlasRecipe, StoredRecipe, axes, parts
from pneutouch.mechanics.atlas.surveyed import Survey, SurveyedDome, SurveyPlan, fit_apex, fit_sheet, grown
from pneutouch.mechanics.atlas.table import Atlas, AtlasSlices
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.solid.mesh import cell_counts

STEP = 0.06
"""Step in the logarithm of each parameter between the surveyed designs."""
REACH = 1.25
"""Distance in steps from the middle of a table to which it is used."""
_MORE_DEPTH = 1.08
"""Depth of the table over the design's."""
_GASES = (0.25, 0.6, 1.4, 3.5)
"""Ambient pressures of the surveyed presses, over the design's."""
_UNKNOWN = 0.1
"""Depth beyond the surveyed one, in units of height, to which a press that did not end there counts as good."""
_STRETCH = 100.0
"""Stretch of the volume axis: nearly equal cells."""

Progress = Callable[[int, int], None]
"""Told how many of all points are done."""


@dataclass(frozen=True)
class LocalRecipe(StoredRecipe):
    """Contents of a local table, in units of R0 and mu.

    shape: name of the shape. fixed: its sizes that the table does not vary, as JSON. names, centre: the parameters, the
    wall first, and their values over R0 in the middle of the table. base: sizes of the rigid base. ambient, dead:
    the design's gas. pressure: greatest driving pressure of the design. depth: greatest depth of the table.
    fingerprint: that of the program's solid. step: see `STEP`. starts, depths: numbers of volumes and depths surveyed.
    """

    shape: str
    fixed: str
    names: tuple[str, ...]
    centre: tuple[float, ...]
    poisson_ratio: float
    base: tuple[float, ...]
    ambient: float
    dead: float
    pressure: float
    depth: float
    fingerprint: str = ""
    step: float = STEP
    starts: int = 9
    depths: int = 14
    volume_cells: int = 14
    depth_cells: int = 11


def varied(sensor: Sensor) -> tuple[str, ...]:
    """Names of the sizes that a table of the sensor's shape varies: the wall, and every own size that is a length."""
    shape = sensor.dome.shape
    own = [field.name for field in fields(shape)[2:]]
    lengths = (name for name in own if isinstance(getattr(shape, name), float) and getattr(shape, name))
    return ("wall_thickness", *lengths)


def fixed_sizes(sensor: Sensor) -> str:
    """The other own sizes of the sensor's shape as JSON; lengths over R0, to nine digits."""
    shape, names = sensor.dome.shape, varied(sensor)
    others = {field.name: getattr(shape, field.name) for field in fields(shape)[2:] if field.name not in names}

    def scaled(size: object) -> object:
        if isinstance(size, tuple):
            return [scaled(part) for part in size]
        return rounded(size / shape.inner_radius) if isinstance(size, float) else size

    return json.dumps({name: scaled(size) for name, size in others.items()}, sort_keys=True)


def ratios(sensor: Sensor, names: tuple[str, ...]) -> Array:
    """Sizes of the sensor's shape over R0, (names,)."""
    shape = sensor.dome.shape
    return np.array([getattr(shape, name) for name in names]) / shape.inner_radius


def offsets(count: int) -> Array:
    """Surveyed points in steps from the middle, (1 + 2 count + pairs, count)."""
    unit = np.eye(count)
    pairs = [unit[i] + unit[j] for i, j in combinations(range(count), 2)]
    return np.array([np.zeros(count), *unit, *-unit, *pairs])


def weights(place: Array) -> Array:
    """Weights (n, points) of the points of `offsets` in the quadratic through them, at places in steps (n, count)."""
    count = place.shape[1]
    up, down = 0.5 * place * (place + 1.0), 0.5 * place * (place - 1.0)
    middle, cross = 1.0 - (place**2).sum(axis=1), []
    for i, j in combinations(range(count), 2):
        product = place[:, i] * place[:, j]
        cross.append(product)
        up[:, i] -= product
        up[:, j] -= product
        middle = middle + product
    return np.column_stack([middle, up, down, *cross])


class LocalAtlas(Atlas):
    """Tables around one design. ``sizes`` are the parameters of one sensor in mm, the wall first: its batches have
    these sizes, but for the wall, at radii of their own."""

    def __init__(self, tables: dict[str, Array], local: LocalRecipe, sizes: Array) -> None:
        super().__init__(tables, _box(local, *tables["ends"].tolist()))
        self.local, self.sizes = local, sizes

    def of(self, sensor: Sensor) -> "LocalAtlas":
        """The same tables for a sensor's sizes."""
        own = copy(self)
        own.sizes = ratios(sensor, self.local.names) * sensor.dome.inner_radius
        return own

    def place(self, sensor: Sensor) -> Array:
        """Distance of a sensor's sizes from the middle of the table in steps, (parameters,)."""
        return np.asarray(np.log(ratios(sensor, self.local.names) / self.local.centre) / self.local.step)

    def slices_of(self, wall: Array, radius: Array, names: tuple[str, ...] = FIELDS) -> tuple[AtlasSlices, Index]:
        """Tables for walls and inner radii (n,), mm, each pair once, and the number (n,) of each pair's table."""
        pairs, k = np.unique(np.stack([wall, radius], axis=1), axis=0, return_inverse=True)
        sizes = np.broadcast_to(self.sizes, (len(pairs), self.sizes.size)).copy()
        sizes[:, 0] = pairs[:, 0]
        place = np.log(sizes / pairs[:, 1:] / self.local.centre) / self.local.step
        slices = self._at(np.clip(place, -2.0 * REACH, 2.0 * REACH), names)
        near = np.abs(place).max(axis=1) <= REACH
        return replace(slices, support=slices.support & near[:, None, None]), k.ravel()

    def _at(self, place: Array, names: tuple[str, ...]) -> AtlasSlices:
        weight, count, tables = weights(place), len(place), self.tables

        def cut(name: str) -> Array:
            return np.asarray(np.tensordot(weight, tables[name], axes=1))

        ends = np.cumsum([len(parts(name)) for name in names])
        return AtlasSlices(
            grid=axes(self.recipe),
            limit_volume=cut("top_volume"),
            limit_pressure=cut("top_pressure"),
            apex=cut("apex"),
            potential=cut("potential"),
            support=np.broadcast_to(tables["support"].astype(bool), (count, *tables["support"].shape)),
            rest_apex=cut("rest_apex"),
            rest_volume=cut("rest_volume"),
            unit=cut("unit"),
            fold_from=np.full(count, np.inf),
            fold_volume=np.zeros((count, 2)),
            fold_depths=np.array([0.0, 1.0]),
            fields=np.asarray(np.tensordot(weight, self._together(names), axes=1)),
            columns={name: slice(end - len(parts(name)), end) for name, end in zip(names, ends, strict=True)},
        )

    def inflation(self, sensor: Sensor) -> Array:
        """Free inflation of a sensor: volume, heights of the inner and the outer apex, greatest stretch and pressure at
        `INFLATED` + 1 volumes up to the limit point and some beyond, (5, n)."""
        return np.asarray(np.tensordot(weights(self.place(sensor)[None]), self.tables["inflation"], axes=1)[0])

    def top_pressure(self, sensor: Sensor) -> float:
        """Driving pressure over mu at the end of a sensor's table."""
        return float((weights(self.place(sensor)[None]) @ self.tables["top_pressure"])[0])

    def last_travel(self, sensor: Sensor, nu: Array) -> Array:
        """Travel (R0) at which a sensor's wall buckles in a press from inflated volumes nu (n,), or the table ends."""
        weight, local = weights(self.place(sensor)[None]), self.local
        lasts = np.tensordot(weight, self.tables["lasts"], axes=1)[0]
        gas = np.log(sensor.gas.ambient_pressure / sensor.wall.shear_modulus / local.ambient)
        starts = np.linspace(0.0, 1.0, local.starts)
        by_gas = np.array([np.interp(nu, starts, column) for column in lasts.T])
        unit = float((weight @ self.tables["unit"])[0])
        return unit * np.array([np.interp(gas, np.log(_GASES), column) for column in by_gas.T])

    @property
    def softest(self) -> float:
        """Least ambient pressure over mu inside the box."""
        return self.local.ambient * _GASES[0]

    @property
    def has_limit(self) -> bool:
        """True if free inflation has a limit point in the whole neighbourhood."""
        return bool(self.tables["limited"].all())


def _box(local: LocalRecipe, lowest: float, beyond: float) -> AtlasRecipe:
    """Axes and box of a local table in the terms of the atlas; volumes from ``lowest``, depths w to ``beyond``."""
    wall, spread = local.centre[0], float(np.exp(REACH * local.step))
    return replace(
        RECIPE,
        poisson_ratio=local.poisson_ratio,
        thinnest=wall / spread,
        thickest=wall * spread,
        lowest_volume=lowest,
        highest_volume=1.0,
        deepest=local.depth,
        beyond=beyond,
        stiffest=local.ambient * _GASES[-1],
        volume_cells=local.volume_cells,
        volume_stretch=_STRETCH,
        depth_cells=local.depth_cells,
    )


def recipe_of(sensor: Sensor, greatest_pressure: float, fingerprint: str = "", step: float = STEP) -> LocalRecipe:
    """Recipe of a table around a sensor that is driven up to a pressure, MPa; ``step`` as in `STEP`."""
    names, size, mu = varied(sensor), sensor.dome.inner_radius, sensor.wall.shear_modulus
    return LocalRecipe(
        shape=sensor.dome.shape.key,
        fixed=fixed_sizes(sensor),
        names=names,
        centre=tuple(map(rounded, _middle(sensor, names, step))),
        poisson_ratio=sensor.wall.poisson_ratio,
        base=base_sizes(sensor),
        ambient=rounded(sensor.gas.ambient_pressure / mu),
        dead=rounded(sensor.gas.dead_volume / size**3),
        pressure=rounded(greatest_pressure / mu),
        depth=rounded(_MORE_DEPTH * sensor.protocol.depth / size),
        fingerprint=fingerprint,
        step=step,
    )


def rounded(value: float) -> float:
    """A number to nine digits, so that a recipe does not depend on rounding."""
    return float(f"{value:.9g}")


def base_sizes(sensor: Sensor) -> tuple[float, ...]:
    """Sizes of the sensor's rigid base over R0; none without a base."""
    base = sensor.dome.base
    return () if base is None else tuple(rounded(x / sensor.dome.inner_radius) for x in asdict(base).values())


def _middle(sensor: Sensor, names: tuple[str, ...], step: float) -> list[float]:
    """Sizes (R0) in the middle of a table: the sensor's, or a step away from a size beyond which the shape is none."""
    sizes = ratios(sensor, names) * sensor.dome.inner_radius
    for number in range(len(names)):
        for sign in (1.0, -1.0):
            other = sizes.copy()
            other[number] *= np.exp(sign * step)
            if sensor.replace(**dict(zip(names, other.tolist(), strict=True))).dome.shape.fault is not None:
                sizes[number] *= np.exp(-sign * step)
    return [float(x) for x in sizes / sensor.dome.inner_radius]


def build(sensor: Sensor, recipe: LocalRecipe, progress: Progress = lambda done, total: None) -> LocalAtlas:
    """Survey the points around a sensor and fit the tables; ``progress``: done points, and all.

    Raises ComputationError where the solid fails.
    """
    cells, _ = cell_counts(sensor.dome.shape, None, None)
    surveys: list[Survey] = []
    inflations, limited, units, lasts = [], [], [], []
    swell: float | None = None
    deepest = 0.0
    plan = SurveyPlan(recipe.starts, recipe.depths, tuple(gas * recipe.ambient for gas in _GASES), recipe.dead)
    places = offsets(len(recipe.names))
    for number, place in enumerate(places):
        sizes = np.array(recipe.centre) * np.exp(recipe.step * place) * sensor.dome.inner_radius
        point = SurveyedDome(sensor.replace(**dict(zip(recipe.names, sizes.tolist(), strict=True))), cells, plan)
        if number == 0:
            swell, deepest = point.swelling(recipe.pressure), recipe.depth * np.exp(recipe.step) / point.unit
        surveys.append(point.survey(swell, deepest * point.unit))
        inflations.append(point.inflation())
        limited.append(point.run.limit is not None)
        units.append(point.unit)
        lasts.append(point.lasts)
        progress(number + 1, len(places))
    tables = _fitted(surveys, np.array(units), recipe)
    shape = len(places), recipe.starts, len(_GASES)
    tables |= {"lasts": np.minimum(np.array(lasts), deepest + _UNKNOWN).reshape(shape)}
    tables |= {"inflation": np.array(inflations), "limited": np.array(limited)}
    return LocalAtlas(tables, recipe, np.array(recipe.centre) * sensor.dome.inner_radius)


def _fitted(surveys: list[Survey], units: Array, recipe: LocalRecipe) -> dict[str, Array]:
    """Tables of all points (points, ...) on common axes, and the cells in which every point has states."""
    rests = [(float(one.free_volume[0]), float(one.limit_volume - one.free_volume[0])) for one in surveys]
    places = [(one.volume - rest) / reach for one, (rest, reach) in zip(surveys, rests, strict=True)]
    lowest = min(float(nu.min()) for nu in places) - 1e-6
    volume = axes(_box(recipe, lowest, 1.0)).volume
    apexes = [fit_apex(one, volume, *rest) for one, rest in zip(surveys, rests, strict=True)]
    depths = [volume.rows(nu) @ apex - one.height for one, nu, apex in zip(surveys, places, apexes, strict=True)]
    ends = lowest, max(float(w.max()) for w in depths) + 1e-6
    box = _box(recipe, *ends)
    grid = axes(box)
    sheets = [fit_sheet(one, box) for one in surveys]
    shape = grid.volume.size, grid.depth.size
    support = np.ones((grid.volume.cells, grid.depth.cells), bool)
    for nu, w in zip(places, depths, strict=True):
        seen = np.zeros_like(support)
        seen[grid.volume.basis(nu)[0], grid.depth.basis(w)[0]] = True
        support &= grown(seen) > 0
    unit = np.array([one.limit_pressure for one in surveys])
    # Where a point has no states, its coefficients are those of the first: a quadratic needs all to agree.
    middle = sheets[0].potential.solve(), sheets[0].fields.solve()
    potential = np.array([sheet.potential.solve(middle[0])[:, 0] for sheet in sheets]) * unit[:, None]
    stored = np.array([sheet.fields.solve(middle[1]) for sheet in sheets])
    return {
        "ends": np.array(ends),
        "top_volume": np.array([one.limit_volume for one in surveys]),
        "top_pressure": unit,
        "rest_volume": np.array([one.free_volume[0] for one in surveys]),
        "rest_apex": np.array([one.free_apex[0] for one in surveys]) * units,
        "apex": np.array([sheet.apex for sheet in sheets]) * units[:, None],
        "unit": units,
        "potential": potential.reshape(-1, *shape),
        "support": support,
        **{name: stored[..., k].reshape(-1, *shape) for k, name in enumerate(STORED)},
    }
