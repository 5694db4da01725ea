"""Air pushed in with a syringe: the expected pressure in the closed line alone and in the sensor."""

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.prediction import InflationCurve

_GRID = 4000


def line_pressure(pushed: Array, dead_volume: float, ambient: float) -> Array:
    """Gauge pressure (MPa) after ``pushed`` mm3 of room air into a closed line of ``dead_volume`` mm3 (Boyle)."""
    return np.asarray(ambient * pushed / dead_volume)


def sensor_pressure(pushed: Array, inflation: InflationCurve, dead_volume: float, ambient: float) -> Array:
    """Gauge pressure (MPa) after ``pushed`` mm3 of room air into the closed, unpressed sensor; NaN past the limit
    point.

    Boyle with a cavity that swells: (p + pa)(V(p) + Vd) = pa (V0 + Vd + pushed), with V(p) of the free inflation.
    """
    from scipy.interpolate import CubicSpline

    top = int(np.argmax(inflation.pressure))
    volume, start = np.linspace(inflation.volume[0], inflation.volume[top], _GRID), inflation.volume[0]
    _, first = np.unique(inflation.volume[: top + 1], return_index=True)
    pressure = CubicSpline(inflation.volume[first], inflation.pressure[first])(volume)
    pressure = pressure - pressure[0]
    taken = (pressure + ambient) * (volume + dead_volume) / ambient - (start + dead_volume)
    return np.asarray(np.interp(pushed, taken, pressure, right=np.nan))
