"""The rated pressure of candidates: that which `check` and the datasheet state of the design."""

import numpy as np

from pneutouch.arrays import Array, distinct
from pneutouch.mechanics.atlas.inflated import least_limit
from pneutouch.mechanics.rating import rated_pressure
from pneutouch.selection.problem import SelectionProblem


def rated(problem: SelectionProblem, resin: Array, radius: Array, wall: Array) -> Array:
    """Rated pressures of candidates, (n,), MPa; resin (n,) numbers, radius and wall (n,) mm.

    Without a known spread the limits count as designed.
    """
    batch = problem.batch(resin, radius, wall, np.zeros_like(radius))
    limit = batch.shear_modulus * least_limit(batch.wall_ratio, batch.break_stretch)
    spread = np.zeros_like(limit)
    if problem.limit_spread is not None:
        for number in distinct(resin):
            rows = resin == number
            spread[rows] = problem.limit_spread(problem.resins[int(number)], batch.take(rows))
    return rated_pressure(limit, spread, batch.gauge_limit)
