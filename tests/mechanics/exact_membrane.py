"""Independent reference: the exact neo-Hookean membrane by shooting, no constant curvature assumed.

Three first-order equations along the reference arc of a hemisphere of unit radius (Yang & Feng 1970 form), or along the
radius of a flat membrane (Adkins & Rivlin 1952), unit mu t0. Written for tests and benchmarks; the package does not
import it.
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


def _slopes(radius: float, lean: float, pressure: float, y: np.ndarray) -> list[float]:
    """Slopes, along the arc at rest, of both stretches, the angle to the base plane and the height; ``lean`` is the
    cosine of that angle at rest."""
    s, t, turn, _ = y
    r = t * radius
    ts, tt, by_s, by_t = _tension(s, t)
    dt = (s * np.cos(turn) - t * lean) / radius
    ds = ((tt - ts) * s * np.cos(turn) / r - by_t * dt) / by_s
    return [ds, dt, s / ts * (pressure - tt * np.sin(turn) / r), -s * np.sin(turn)]


_START = 1e-6


def _first(pole_stretch: float, pressure: float) -> list[float]:
    return [pole_stretch, pole_stretch, pressure * pole_stretch / (2 * _tension(*[pole_stretch] * 2)[0]) * _START, 0.0]


def shape(pole_stretch: float, pressure: float) -> tuple[float, float]:
    """Base radius and apex height of the membrane that starts at the pole with a stretch under a pressure."""

    def slope(arc: float, y: np.ndarray) -> list[float]:
        return _slopes(np.sin(arc), np.cos(arc), pressure, y)

    first = _first(pole_stretch, pressure)
    end = solve_ivp(slope, (_START, np.pi / 2), first, method="DOP853", rtol=1e-10, atol=1e-12).y[:, -1]
    return end[1], -end[3]


def flat(pole_stretch: float) -> tuple[float, float]:
    """Pressure p a/(mu t0) and height h/a of a flat membrane clamped at the radius a.

    A membrane has no length of its own: shot from the pole under unit pressure, it is clamped where it comes back to
    its radius at rest.
    """

    def clamped(radius: float, y: np.ndarray) -> float:
        return y[1] - 1.0

    clamped.terminal = True  # type: ignore[attr-defined]
    found = solve_ivp(
        lambda radius, y: _slopes(radius, 1.0, 1.0, y),
        (_START, 10.0),
        _first(pole_stretch, 1.0),
        method="DOP853",
        events=clamped,
        rtol=1e-11,
        atol=1e-13,
    )
    rim = float(found.t[-1])
    return rim, -float(found.y[3, -1]) / rim


def flat_at(height: float) -> float:
    """Pressure p a/(mu t0) of the flat membrane at a height h/a from 0.06 to 2."""
    return flat(brentq(lambda stretch: flat(stretch)[1] - height, 1.002, 5.0))[0]


def flat_limit() -> tuple[float, float]:
    """Greatest pressure of the flat membrane, and the height there."""
    best = minimize_scalar(lambda s: -flat(s)[0], bounds=(1.5, 3.0), method="bounded", options={"xatol": 1e-7})
    return flat(best.x)


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
