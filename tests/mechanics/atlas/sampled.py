"""Batches for the tests of the atlas, and its energy read without its own look-up."""

from __future__ import annotations

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.atlas.table import AtlasSlices, shipped


def batch(**values: float | list[float]) -> SensorBatch:
    """Sensors with R0 = mu = 1, a wall of 0.16 R0, no pressure and no dead volume, unless said otherwise."""
    plain = {
        "inner_radius": 1.0,
        "wall_thickness": 0.16,
        "shear_modulus": 1.0,
        "ambient_pressure": 0.6,
        "dead_volume": 0.0,
        "driving_pressure": 0.0,
        "depth": 0.5,
        "plate_radius": np.inf,
        "gauge_limit": np.inf,
        "break_stretch": np.inf,
    }
    return SensorBatch(*(part.copy() for part in np.broadcast_arrays(*map(np.atleast_1d, (plain | values).values()))))


def random_batch(count: int, seed: int, deepest: float = 0.7) -> SensorBatch:
    """Sensors all over the box, in mm and MPa."""
    rng = np.random.default_rng(seed)
    radius, mu = rng.uniform(4.0, 30.0, count), np.exp(rng.uniform(np.log(0.05), np.log(5.0), count))
    wall = np.exp(rng.uniform(np.log(0.0601), np.log(0.3499), count))
    limit = shipped().slices(wall).limit_pressure * mu
    share = np.where(rng.random(count) < 0.3, 0.0, rng.uniform(0.0, 0.95, count))
    dead = np.where(rng.random(count) < 0.3, 0.0, rng.exponential(1.5, count))
    return SensorBatch(
        radius,
        wall * radius,
        mu,
        mu * np.exp(rng.uniform(np.log(0.01), np.log(0.99), count)),
        dead * radius**3,
        share * limit,
        rng.uniform(0.2, deepest, count) * radius,
        np.full(count, np.inf),
        np.full(count, np.inf),
        np.full(count, np.inf),
    )


def energy(slices: AtlasSlices, nu: Array, height: Array, k: int = 0) -> Array:
    """Energy of the wall in mu R0^3 at volumes nu and plate heights of one slice, by full rows of the basis."""
    grid = slices.grid
    by_volume = grid.volume.rows(nu)
    by_depth = grid.depth.rows(by_volume @ slices.apex[k] - height)
    found: Array = np.einsum("ni,ij,nj->n", by_volume, slices.potential[k], by_depth)
    return found
