"""The exact neo-Hookean membrane, tabulated: the reference for the error of the cap model in state I.

The membrane equations solved by shooting, without assuming constant curvature or equibiaxial stretch. The
tests solve them again with an independent program and compare every row.
"""

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.inflation import LIMIT_HEIGHT, LIMIT_PRESSURE, relative_height

_PRESSURE = (0.0, 0.487184, 0.816153, 1.204673, 1.398748, 1.497427, 1.546655, 1.568785, 1.57537)
_HEIGHT = (1.0, 1.066291, 1.134059, 1.255874, 1.360730, 1.452773, 1.535446, 1.611202, 1.69000)

RISING_BRANCH = np.column_stack([_PRESSURE, _HEIGHT])
"""p R0/(mu t0) and h/R0 from no pressure to the limit point."""


def limit_point_errors() -> tuple[float, float]:
    """Relative errors of the cap's limit pressure and of its apex height there."""
    pressure, height = RISING_BRANCH[-1]
    return float(LIMIT_PRESSURE / pressure - 1), float(LIMIT_HEIGHT / height - 1)


def height_errors(relative_pressures: Array) -> Array:
    """Relative errors of the cap's apex height at p R0/(mu t0) from 0 to the cap's limit.

    Interpolated between the table's rows, where the errors change slowly.
    """
    known = RISING_BRANCH[RISING_BRANCH[:, 0] <= LIMIT_PRESSURE]
    errors = relative_height(known[:, 0], 1.0, 1.0, 1.0) / known[:, 1] - 1
    return np.asarray(np.interp(relative_pressures, known[:, 0], errors))
