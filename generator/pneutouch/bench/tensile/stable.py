"""Stability of a law over the states that a fit covers: Drucker's condition in tension, shear and two directions.

An incompressible solid is stable where more strain takes more stress in every direction: the second derivatives of its
energy by the logarithms of two principal stretches are positive definite (Drucker 1964; Ogden, Non-linear Elastic
Deformations, 1984, section 6.2).
"""

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.laws import Hyperelastic, hyperelastic
from pneutouch.mechanics.laws.strain import VALUE, Strain
from pneutouch.mechanics.laws.tension import first_invariant

_STATES, _STEP = 60, 1e-3
_POISSON_RATIO = 0.49

_RATIOS = {"uniaxial tension": -0.5, "pure shear": 0.0, "equibiaxial tension": 1.0}
"""Logarithm of the second principal stretch over that of the first."""


def instability(name: str, constants: tuple[float, ...], largest: float) -> str | None:
    """The first state in which a law is unstable, in words; None for a stable law.

    States are those whose first invariant is at most that of uniaxial tension by ``largest``. Raises InputError for
    constants that give no solid at all.
    """
    law = hyperelastic(name, constants, _POISSON_RATIO)
    most = float(first_invariant(largest))
    for kind, ratio in _RATIOS.items():
        logs = np.linspace(_STEP, np.log(largest), _STATES)
        first = sum(np.exp(2.0 * part * logs) for part in (1.0, ratio, -1.0 - ratio))
        logs = logs[first <= most * (1.0 + 1e-9)]
        least = _least_stiffness(law, logs, ratio * logs)
        if (least <= 0.0).any():
            return f"{kind} at a stretch of {np.exp(logs[int(np.argmax(least <= 0.0))]):.2f}"
    return None


def _least_stiffness(law: Hyperelastic, first: Array, second: Array) -> Array:
    """The lesser eigenvalue of the second derivatives by the logarithms of two stretches, (n,), by differences."""

    def energy(one: Array, other: Array) -> Array:
        a, j = np.exp(2.0 * one) + np.exp(2.0 * other), np.exp(one + other)
        return np.asarray(law.energy(Strain(a, j, 1.0 / j)).data[VALUE])

    here = energy(first, second)
    sums = {}
    for key, (x, y) in {"xx": (1, 0), "yy": (0, 1), "xy": (1, 1)}.items():
        there = energy(first + x * _STEP, second + y * _STEP) + energy(first - x * _STEP, second - y * _STEP)
        sums[key] = (there - 2.0 * here) / _STEP**2
    across = 0.5 * (sums["xy"] - sums["xx"] - sums["yy"])
    middle, apart = 0.5 * (sums["xx"] + sums["yy"]), 0.5 * (sums["xx"] - sums["yy"])
    return np.asarray(middle - np.hypot(apart, across))
