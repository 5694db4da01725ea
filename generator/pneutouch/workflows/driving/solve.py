"""Driving pressures at which a figure has a required value, and the band in which the sensor in hand may have it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics import SensorState
from pneutouch.workflows.driving.reach import ReachCurves, figure_of

_EXACT = 1e-6
"""Relative distance to the required value at which a solution is taken."""

_TRIES = 40

_JUMPED = 1e-3
"""Relative distance above which a bracketed crossing is a jump of the figure, not a solution."""


@dataclass(frozen=True)
class PressureBand:
    """Driving pressures (MPa) at which the k = 2 interval of the figure holds the required value.

    ``open_low``, ``open_high``: the band reaches the vented sensor, the top of what was computed: it may go on.
    """

    low: float
    high: float
    open_low: bool
    open_high: bool


@dataclass(frozen=True)
class DrivingSolution:
    """A state whose figure has the required value; ``band`` is None if the uncertainty is not known."""

    state: SensorState
    band: PressureBand | None


def solutions(curves: ReachCurves, figure: str, value: float) -> list[DrivingSolution]:
    """Every driving pressure at which a figure has a value, rising. Every bracket of the computed states is solved."""
    pressures, values = curves.pressures, curves.values(figure)
    roots: list[float] = []
    for k in range(len(pressures)):
        if abs(values[k] - value) <= _EXACT * value:
            roots.append(float(pressures[k]))
        elif k + 1 < len(pressures) and (values[k] - value) * (values[k + 1] - value) < 0:
            if abs(values[k + 1] - value) <= _EXACT * value:
                continue
            root = _root(curves, figure, value, (float(pressures[k]), float(pressures[k + 1])))
            roots += [] if root is None else [root]
    states = [curves.add(pressure) for pressure in roots]
    return [DrivingSolution(state, band(curves, figure, value, state.driving_pressure)) for state in states]


def _root(curves: ReachCurves, figure: str, value: float, ends: tuple[float, float]) -> float | None:
    """The pressure in a bracket at which the model itself gives the value (Illinois); None if the figure jumps."""
    low, high = ends
    off_low, off_high = (figure_of(curves.add(end), figure) / value - 1.0 for end in ends)
    middle = off = np.nan
    for _ in range(_TRIES):
        middle = high - off_high * (high - low) / (off_high - off_low)
        off = figure_of(curves.predicted([middle]).states[0], figure) / value - 1.0
        if np.isnan(off) or abs(off) <= _EXACT or abs(high - low) <= _EXACT * high:
            break
        if off * off_high < 0:
            low, off_low = high, off_high
        else:
            off_low *= 0.5
        high, off_high = middle, off
    return float(middle) if abs(off) <= _JUMPED else None


def band(curves: ReachCurves, figure: str, value: float, near: float) -> PressureBand | None:
    """The band about a driving pressure (MPa), or None if the uncertainty of the figure is not known.

    With f the predicted figure and w the expanded uncertainty of its logarithm it holds where \\|ln(f/value)\\| <= w.
    """
    pressures, excess = curves.pressures, _excess(curves, figure, value)
    at = int(np.argmin(np.abs(pressures - near)))
    if not excess[at] <= 0.0:
        return None
    low = high = at
    while low > 0 and excess[low - 1] <= 0.0:
        low -= 1
    while high + 1 < len(pressures) and excess[high + 1] <= 0.0:
        high += 1
    ends = (_crossing(pressures, excess, low, low - 1), _crossing(pressures, excess, high, high + 1))
    return PressureBand(ends[0], ends[1], open_low=low == 0, open_high=high == len(pressures) - 1)


def possible(curves: ReachCurves, figure: str, value: float) -> PressureBand | None:
    """The first band in which the sensor in hand may have the value, although the prediction has it nowhere."""
    inside = np.flatnonzero(_excess(curves, figure, value) <= 0.0)
    return None if inside.size == 0 else band(curves, figure, value, float(curves.pressures[inside[0]]))


def _excess(curves: ReachCurves, figure: str, value: float) -> Array:
    """Distance by which the value lies outside the interval, in ln (n,); NaN if one of them is not known."""
    return np.asarray(np.abs(np.log(curves.values(figure) / value)) - curves.widths(figure))


def _crossing(pressures: Array, excess: Array, inside: int, outside: int) -> float:
    """Pressure at which the excess is zero between two states; the state inside if the other is none or has no
    figure."""
    if not 0 <= outside < len(pressures) or np.isnan(excess[outside]):
        return float(pressures[inside])
    share = excess[inside] / (excess[inside] - excess[outside])
    return float(pressures[inside] + share * (pressures[outside] - pressures[inside]))
