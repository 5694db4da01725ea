"""The straight line through a loading curve."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Line:
    """Ordinary least squares y = intercept + slope x, with R^2."""

    slope: float
    intercept: float
    r_squared: float


def fit_sensitivity(force: Array, rise: Array) -> Line:
    """Pressure rise (MPa) over force (N) with intercept; slope in MPa/N.  Both (n,), n >= 2."""
    x, y = force - force.mean(), rise - rise.mean()
    slope = float(x @ y / (x @ x))
    rest = y - slope * x
    return Line(slope, float(rise.mean() - slope * force.mean()), 1.0 - float(rest @ rest) / float(y @ y))
