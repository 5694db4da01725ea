"""State I of the paper's membrane theory in closed form: a cap of constant curvature (eq. 4 to 9).

With x = h/R0 the thickness stretch is 2/(1 + x^2), and stationary energy gives, for the neo-Hookean law
with C1 = mu/2,

    p R0/(C1 t0) = 8 x/(1 + x^2) - 64 x/(1 + x^2)^4 .

Its maximum is the limit point: beyond it the dome goes on growing at falling pressure.

The exact neo-Hookean membrane, tabulated: the reference for the error of the cap model in state I.

The membrane equations solved by shooting, without assuming constant curvature or equibiaxial stretch. The
tests solve them again with an independent program and compare every row.

Roots of many equations at once by bisection: no derivative, no failure inside a bracket.

SciPy's `elementwise.find_root` takes 9 ms for 100 roots where this takes 1.1 ms, and 0.5 s to import.
"""

import math
from collections.abc import Callable

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import BeyondLimitError, ComputationError

_HALVINGS = 60
"""2**-60 of the bracket: below the rounding of any root of its size."""


def bisect(function: Callable[[Array], Array], low: Array, high: Array) -> Array:
    """Return where ``function`` turns from negative to positive between ``low`` and ``high``, elementwise.

    Where it is positive already at ``low`` the answer is ``low``; where it is still negative at ``high``,
    ``high``. All arrays have the same shape.
    """
    a, b = np.array(low, float), np.array(high, float)
    for _ in range(_HALVINGS):
        middle = 0.5 * (a + b)
        below = function(middle) < 0
        a, b = np.where(below, middle, a), np.where(below, b, middle)
    root: Array = 0.5 * (a + b)
    return root


_HIGHEST = 1e6
"""Largest x searched on the falling branch; p R0/(mu t0) is 4e-6 there."""


def relative_pressure(x: Array) -> Array:
    """P R0/(mu t0) at relative height x = h/R0."""
    square = 1 + x**2
    return 4 * x / square - 32 * x / square**4


def thickness_stretch(x: Array) -> Array:
    """Wall now over wall before (eq. 5)."""
    return 2 / (1 + x**2)


def membrane_stretch(x: Array) -> Array:
    """In-plane stretch, the same in all directions (eq. 3)."""
    return thickness_stretch(x) ** -0.5


def _limit_height() -> float:
    """X of the limit point, where (1 - x^2)(1 + x^2)^3 = 8 (1 - 7 x^2)."""

    def slope(x: Array) -> Array:
        square = x**2
        return 8 * (1 - 7 * square) - (1 - square) * (1 + square) ** 3

    # The slope is negative below the limit point and positive above it on this bracket.
    return float(bisect(slope, np.array(1.2), np.array(3.0)))


LIMIT_HEIGHT = _limit_height()
"""h/R0 at the limit point: 1.80524, for every stiffness, size and wall."""

LIMIT_PRESSURE = float(relative_pressure(np.array(LIMIT_HEIGHT)))
"""p R0/(mu t0) at the limit point: 1.51991."""


def pressure(x: Array, inner_radius: float, wall: float, shear_modulus: float) -> Array:
    """Driving pressure in MPa that holds the dome at relative height x (eq. 9)."""
    return shear_modulus * wall / inner_radius * relative_pressure(x)


def relative_height(
    p: Array, inner_radius: float, wall: float, shear_modulus: float, *, falling: bool = False
) -> Array:
    """h/R0 at driving pressures ``p`` (MPa, from 0 to the limit), on the rising or the falling branch."""
    target = np.asarray(p, float) * inner_radius / (shear_modulus * wall)
    if np.any(target > LIMIT_PRESSURE * (1 + 1e-12)):
        scale = shear_modulus * wall / inner_radius
        text = (
            f"no equilibrium of the membrane at p R0/(mu t0) = {float(np.max(target)):.4g}: the limit point is "
            f"{LIMIT_PRESSURE:.4g}; lower the driving pressure"
        )
        raise BeyondLimitError(float(np.max(target)) * scale, LIMIT_PRESSURE * scale, text)
    if np.any(target < 0):
        raise ComputationError("the membrane theory does not cover suction; give driving pressures from 0")
    if falling:
        low, high = np.full(target.shape, math.log(LIMIT_HEIGHT)), np.full(target.shape, math.log(_HIGHEST))
        return np.exp(bisect(lambda s: target - relative_pressure(np.exp(s)), low, high))
    low, high = np.ones(target.shape), np.full(target.shape, LIMIT_HEIGHT)
    return bisect(lambda x: relative_pressure(x) - target, low, high)


_PRESSURE = (0.0, 0.487184, 0.816153, 1.204673, 1.398748, 1.497427, 1.546655, 1.568785, 1.57537)
_HEIGHT = (1.0, 1.066291, 1.134059, 1.255874, 1.360730, 1.452773, 1.535446, 1.611202, 1.69000)

RISING_BRANCH = np.column_stack([_PRESSURE, _HEIGHT])
"""p R0/(mu t0) and h/R0 from no pressure to the limit point."""


def limit_point_errors() -> tuple[float, float]:
    """Relative errors of the cap's limit pressure and of its apex height there."""
    pressure, height = RISING_BRANCH[-1]
    return float(LIMIT_PRESSURE / pressure - 1), float(LIMIT_HEIGHT / height - 1)


def height_errors(relative_pressures: Array) -> Array:
    """Relative errors of the cap's apex height at p R0/(mu t0) from 0 to the cap's limit.

    Interpolated between the table's rows, where the errors change slowly.
    """
    known = RISING_BRANCH[RISING_BRANCH[:, 0] <= LIMIT_PRESSURE]
    errors = relative_height(known[:, 0], 1.0, 1.0, 1.0) / known[:, 1] - 1
    return np.asarray(np.interp(relative_pressures, known[:, 0], errors))
