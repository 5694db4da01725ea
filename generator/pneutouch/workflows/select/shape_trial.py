"""A design of another shape that was pressed by the solid, and the size of the wall or radius to try next."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from pneutouch.mechanics.prediction import SensorState
from pneutouch.mechanics.response import Figures
from pneutouch.mechanics.sensor import Sensor
from pneutouch.selection import CandidateResin


@dataclass(frozen=True)
class ShapeTrial:
    """A design that was pressed by the solid: its changes to the base, by ``table.key``, sensor and state; and slope
    of its ln sensitivity by ln wall, NaN from a single solve."""

    shape: str
    resin: CandidateResin
    changes: Mapping[str, Any]
    sensor: Sensor
    state: SensorState
    footprint: float
    slope: float = float("nan")

    @property
    def figures(self) -> Figures[float]:
        """Figures of its press."""
        assert self.state.figures is not None
        return self.state.figures


def slope_of(known: Mapping[float, float]) -> float:
    """Slope of ln sensitivity by ln size between the two solves nearest to the target; NaN with one."""
    if len(known) < 2:
        return float("nan")
    (a, low), (b, high) = sorted(known.items(), key=lambda one: abs(one[1]))[:2]
    return (high - low) / float(np.log(b / a))


def next_size(known: Mapping[float, float], low: float, high: float, *, falls: bool) -> float:
    """Size to try next, by a secant in logarithms within the bracket of what is known; ``falls``: as of a wall."""
    low = max(low, *(size if (gap > 0) == falls else low for size, gap in known.items()))
    high = min(high, *(size if (gap > 0) != falls else high for size, gap in known.items()))
    (a, first), (b, second) = [*known.items()][-2:] if len(known) > 1 else ((1.0, 0.0), *known.items())
    # Of membranes the sensitivity falls about as the first power of the wall.
    slope = (second - first) / float(np.log(b / a)) if len(known) > 1 else (-1.0 if falls else 1.0)
    at = b * float(np.exp(np.clip(-second / slope, -0.7, 0.7))) if slope else 0.0
    return at if low < at < high else float(np.sqrt(low * high))
