"""Figures of a gain over frequency: first resonance, bandwidth, and the band within a tolerance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.mechanics.line.dynamics import SensorDynamics, on_axis

HALF_POWER = 0.5**0.5
"""The gain at -3 dB; its inverse is that at +3 dB."""

TOLERANCE = 0.05
"""Deviation of the gain from that of a slow change that limits the narrower band."""

LINE, GAS, WALL = "line", "heat exchange of the gas", "relaxation of the wall"
"""Effects that can end the narrower band."""

_SLOWEST = 1.0e-4
"""Hz: a change over some hours."""

_BEYOND = 4.0
"""The highest frequency looked at, in half-wave resonances of the ducts, which bound the first resonance."""

_NO_DUCT = 1.0e4
"""Frequency in Hz up to which a line without any duct is looked at."""

_POINTS_A_DECADE = 60
_ROUNDING = 1e-10
"""Relative steps of the gain below this are rounding."""

_CLOSE = 1e-7
"""Relative width to which a frequency is found."""


@dataclass(frozen=True, slots=True)
class BandFigures:
    """Frequencies in Hz; None if there is none up to ``highest``.

    Attributes:
        resonance: The first maximum of the gain at the gauge, a wall as stiff as it is at once.
        resonance_gain: The gain there, over that of the same wall when slow.
        bandwidth: Up to where that gain is within 3 dB of the slow one: down in a damped line, up before a resonance.
        within_tolerance: Up to where the gain, relaxation of the wall included, is within `TOLERANCE` of the slow one.
        limited_by: Effect that ends that band: `LINE`, `GAS` or `WALL`.
        highest: Up to where was looked.
    """

    resonance: float | None
    resonance_gain: float | None
    bandwidth: float | None
    within_tolerance: float | None
    limited_by: str | None
    highest: float


def band_figures(dynamics: SensorDynamics) -> BandFigures:
    """The figures of a state."""
    fast, top = dynamics.at_once(), highest_frequency(dynamics)
    grid = np.geomspace(_SLOWEST, top, int(_POINTS_A_DECADE * np.log10(top / _SLOWEST)))
    gain = gain_at(fast, grid)
    peak = _first_peak(fast, grid, gain)
    height = None if peak is None else _one(fast, peak)
    # A sharp peak may reach out of the band between two points of the grid.
    with_peak = grid if peak is None else np.sort(np.append(grid, peak))
    bandwidth = _leaves(fast, with_peak, lambda gain: np.abs(np.log(gain)) + np.log(HALF_POWER))
    within = _leaves(dynamics, with_peak, lambda gain: np.abs(gain - 1.0) - TOLERANCE)
    return BandFigures(peak, height, bandwidth, within, None if within is None else _limit(dynamics, within), top)


def highest_frequency(dynamics: SensorDynamics) -> float:
    """Up to where the figures look, Hz."""
    length = dynamics.line.length
    return _BEYOND * dynamics.line.air.sound_speed / (2.0 * length) if length > 0.0 else _NO_DUCT


def gain_at(dynamics: SensorDynamics, frequency: Array) -> Array:
    """The gain at frequencies in Hz, (n,)."""
    return np.abs(dynamics.gain(on_axis(frequency)))


def _one(dynamics: SensorDynamics, frequency: float) -> float:
    return float(gain_at(dynamics, np.array([frequency]))[0])


def _first(where: Flags) -> int | None:
    """The first index that holds; None if none does."""
    return int(np.argmax(where)) if where.any() else None


def _first_peak(dynamics: SensorDynamics, grid: Array, gain: Array) -> float | None:
    """The first maximum inside the grid, by ever closer points; they hold it however sharp it is."""
    # Where the gain is 1 its rounding has maxima of its own.
    at = _first((gain[1:-1] > (1.0 + _ROUNDING) * gain[:-2]) & (gain[1:-1] > gain[2:]))
    if at is None:
        return None
    low, high = grid[at], grid[at + 2]
    while high - low > _CLOSE * high:
        near = np.linspace(low, high, 33)
        k = int(np.clip(np.argmax(gain_at(dynamics, near)), 1, near.size - 2))
        low, high = near[k - 1], near[k + 1]
    return float(0.5 * (low + high))


def _leaves(dynamics: SensorDynamics, grid: Array, excess: Callable[[Array], Array]) -> float | None:
    """The lowest frequency at which an excess of the gain turns positive, by halving; None if none does."""
    at = _first(excess(gain_at(dynamics, grid)) > 0.0)
    if at is None:
        return None
    low, high = grid[max(at - 1, 0)], grid[at]
    while high - low > _CLOSE * high:
        near = np.linspace(low, high, 33)
        k = max(int(np.argmax(excess(gain_at(dynamics, near)) > 0.0)), 1)
        low, high = near[k - 1], near[k]
    return float(0.5 * (low + high))


def _limit(dynamics: SensorDynamics, frequency: float) -> str:
    """Name of the effect that by itself moves the gain most at a frequency."""
    elastic = replace(dynamics, excess=(), times=())
    alone = {
        LINE: replace(elastic, isothermal=True),
        GAS: replace(elastic, lumped=True),
        WALL: replace(dynamics, isothermal=True, lumped=True),
    }
    return max(alone, key=lambda name: abs(_one(alone[name], frequency) - 1.0))
