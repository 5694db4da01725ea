"""Independent reference: the exact neo-Hookean membrane by shooting, no constant curvature assumed.

Three first-order equations along the reference arc of a hemisphere of unit radius (Yang & Feng 1970 form),
unit mu t0. Written for the tests alone; the package does not import it.
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, minimize_scalar


def _tension(s: float, t: float) -> tuple[float, float, float, float]:
    """Meridional and hoop tension, and the derivatives of the first by both stretches."""
    ts = (s - 1 / (s**3 * t**2)) / t
    tt = (t - 1 / (t**3 * s**2)) / s
    return ts, tt, (1 + 3 / (s**4 * t**2)) / t, -s / t**2 + 3 / (s**3 * t**4)


def shape(pole_stretch: float, pressure: float) -> tuple[float, float]:
    """Base radius and apex height of the membrane that starts at the pole with a stretch under a pressure."""
    start = 1e-6
    tension = _tension(pole_stretch, pole_stretch)[0]

    def slope(arc: float, y: np.ndarray) -> list[float]:
        s, t, turn, _ = y
        radius = np.sin(arc)
        r = t * radius
        ts, tt, by_s, by_t = _tension(s, t)
        dt = (s * np.cos(turn) - t * np.cos(arc)) / radius
        ds = ((tt - ts) * s * np.cos(turn) / r - by_t * dt) / by_s
        return [ds, dt, s / ts * (pressure - tt * np.sin(turn) / r), -s * np.sin(turn)]

    first = [pole_stretch, pole_stretch, pressure * pole_stretch / (2 * tension) * start, 0.0]
    end = solve_ivp(slope, (start, np.pi / 2), first, method="DOP853", rtol=1e-10, atol=1e-12).y[:, -1]
    return end[1], -end[3]


def inflated(pole_stretch: float) -> tuple[float, float]:
    """Pressure p R0/(mu t0) and height h/R0 of the membrane clamped at its base, for stretches up to 3."""
    guess = 2 * (pole_stretch**-1 - pole_stretch**-7)
    most = 1.6 + 0.55 * max(0.0, pole_stretch - 1.8)
    pressure = brentq(lambda p: shape(pole_stretch, p)[0] - 1.0, 0.5 * guess, most * guess, xtol=1e-13)
    return pressure, shape(pole_stretch, pressure)[1]


def limit_point() -> tuple[float, float]:
    """Greatest pressure and the height there."""
    best = minimize_scalar(lambda s: -inflated(s)[0], bounds=(1.5, 2.0), method="bounded", options={"xatol": 1e-6})
    return inflated(best.x)
