"""Least limits of free inflation over the wall ratio: limit point and break strain of many domes at once."""

from functools import cache

import numpy as np

from pneutouch.arrays import Array, distinct
from pneutouch.mechanics.atlas.table import shipped

_RATIOS, _VOLUMES = 60, 91
"""Wall ratios 3 % apart: between them limit pressures are straight to 0.02 %."""


def least_limit(wall_ratio: Array, break_stretch: Array) -> Array:
    """Driving pressure over the shear modulus at which an inflated dome meets its first limit, (n,).

    That is the limit point, or the break stretch (n,) where the wall reaches it before. Wall ratios (n,) outside the
    atlas have the limit of its edge.
    """
    ratios, limit, stretch, pressure = _inflations()
    least = np.interp(wall_ratio, ratios, limit)
    for value in distinct(break_stretch[break_stretch < stretch.max()]):
        rows = break_stretch == value
        ruptured = np.interp(wall_ratio[rows], ratios, _ruptured(float(value), stretch, pressure))
        least[rows] = np.fmin(least[rows], ruptured)
    return np.asarray(least)


def _ruptured(break_stretch: float, stretch: Array, pressure: Array) -> Array:
    """Pressure at a break stretch for each wall ratio; NaN if the limit point comes before."""
    reached = stretch >= break_stretch
    after = np.maximum(reached.argmax(axis=1), 1)
    rows = np.arange(after.size)
    low, high = stretch[rows, after - 1], stretch[rows, after]
    share = np.clip((break_stretch - low) / (high - low), 0.0, 1.0)
    between = pressure[rows, after - 1] + share * (pressure[rows, after] - pressure[rows, after - 1])
    return np.where(reached.any(axis=1), between, np.nan)


@cache
def _inflations() -> tuple[Array, Array, Array, Array]:
    """Wall ratios (k,), limit pressures (k,), stretches and pressures up to the limit point (k, volumes), over mu."""
    recipe = shipped().recipe
    ratios = np.linspace(recipe.thinnest, recipe.thickest, _RATIOS)
    slices = shipped().slices(ratios, ("stretch",))
    k = np.repeat(np.arange(_RATIOS), _VOLUMES)
    nu = np.tile(np.linspace(0.0, 1.0, _VOLUMES), _RATIOS)
    apex = slices.free_apex(k, nu)[:, 0]
    shape = (_RATIOS, _VOLUMES)
    stretch, pressure = slices.field("stretch", k, nu, apex), slices.point(k, nu, apex).pressure
    return ratios, slices.limit_pressure, stretch.reshape(shape), pressure.reshape(shape)
