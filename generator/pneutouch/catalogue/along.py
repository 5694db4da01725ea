"""A quantity along the arc of the dome: values at knots, monotone cubic between them."""

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array


@dataclass(frozen=True, slots=True)
class ArcProfile:
    """Values (n,) at knots (n,) that rise from 0 at the pole to 1 at the rim; n = 1 is a constant.

    Between knots a cubic that has no extremum of its own: slopes by Fritsch and Butland (SIAM J. Sci. Stat. Comput. 5,
    300-304, 1984, DOI 10.1137/0905021), one-sided at the ends.
    """

    knots: tuple[float, ...]
    values: tuple[float, ...]

    def __call__(self, arc: Array) -> Array:
        """The quantity at arc positions of any shape; beyond the ends that of the end."""
        if len(self.knots) == 1:
            return np.full(np.shape(arc), self.values[0])
        x, y = np.array(self.knots), np.array(self.values)
        slope = _slopes(x, y)
        at = np.clip(arc, x[0], x[-1])
        k = np.clip(np.searchsorted(x, at, side="right") - 1, 0, x.size - 2)
        step = x[k + 1] - x[k]
        t = (at - x[k]) / step
        return np.asarray(
            (1 + 2 * t) * (1 - t) ** 2 * y[k]
            + t * (1 - t) ** 2 * step * slope[k]
            + t**2 * (3 - 2 * t) * y[k + 1]
            - t**2 * (1 - t) * step * slope[k + 1]
        )


def _slopes(x: Array, y: Array) -> Array:
    step, rise = np.diff(x), np.diff(y) / np.diff(x)
    if rise.size == 1:
        return np.repeat(rise, 2)
    inner = np.zeros(rise.size - 1)
    same = rise[:-1] * rise[1:] > 0
    w1, w2 = 2 * step[1:] + step[:-1], step[1:] + 2 * step[:-1]
    inner[same] = (w1 + w2)[same] / (w1[same] / rise[:-1][same] + w2[same] / rise[1:][same])
    return np.concatenate([[_end(step[:2], rise[:2])], inner, [_end(step[:-3:-1], rise[:-3:-1])]])


def _end(step: Array, rise: Array) -> float:
    """One-sided slope at an end, three points, kept monotone."""
    slope = float(((2 * step[0] + step[1]) * rise[0] - step[0] * rise[1]) / (step[0] + step[1]))
    if slope * rise[0] <= 0:
        return 0.0
    if rise[0] * rise[1] <= 0 and abs(slope) > 3 * abs(rise[0]):
        return float(3 * rise[0])
    return slope
