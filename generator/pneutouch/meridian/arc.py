"""Place of a point of the wall on the arc of the dome."""

import numpy as np

from pneutouch.arrays import Array


def arc_share(radius: Array, height: Array) -> Array:
    """Arc position of points (r, z), arrays of one shape: 0 at the pole, 1 at the rim and in the flange below it."""
    return np.asarray(np.clip(np.arctan2(radius, np.maximum(height, 0.0)) / (0.5 * np.pi), 0.0, 1.0))
