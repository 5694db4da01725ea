"""A predicted curve read at the depths of a measurement: a sensitivity belongs to the range it is fitted over."""

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.response import Figures, figures

_ROUNDING, _LEAST_POINTS = 1e-9, 3


def figures_at(
    indentation: Array, force: Array, rise_kPa: Array, range_end: float, depths: Array
) -> tuple[Figures | None, float]:
    """Figures of a curve (mm, N, kPa; one length) at ``depths``, mm, as far as its range goes; the depth reached."""
    from scipy.interpolate import PchipInterpolator

    kept = indentation <= range_end * (1 + _ROUNDING)
    travel, first = np.unique(indentation[kept], return_index=True)
    at = depths[depths <= range_end * (1 + _ROUNDING)]
    if travel.size < _LEAST_POINTS or not at.size:
        return None, 0.0
    curves = np.stack([force[kept][first], rise_kPa[kept][first]], axis=1)
    at = np.minimum(at, travel[-1])
    read = PchipInterpolator(travel, curves)(at)
    return figures(at, read[:, 0], read[:, 1]), float(at[-1])
