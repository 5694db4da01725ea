"""The line search on an energy of Newton's methods with and without friction."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, TypeVar

import numpy as np

from pneutouch.arrays import Array

_ARMIJO = 1.0e-4
_SHORTEST = 1.0e-6


class _Balanced(Protocol):
    """A state with the gradient of its energy."""

    @property
    def residual(self) -> Array:
        """Gradient (size,)."""
        ...


State = TypeVar("State", bound=_Balanced)


def line_search(
    trial: Callable[[float], tuple[float, Callable[[], State]] | None], step: Array, slope: float, noise: float
) -> State | None:
    """Backtrack from the full step until the energy falls by Armijo's condition; None if it never does.

    trial: at a share of the step the change of the energy and what completes the state there; None if there is none.
    slope: derivative of the energy along the step (size,), negative.

    Near convergence the change drowns in rounding, ``noise``: there a step is also taken when it lowers the slope.
    """
    share = 1.0
    while share > _SHORTEST:
        tried = trial(share)
        if tried is None:
            share *= 0.4
            continue
        drop, completed = tried
        if drop <= _ARMIJO * share * slope:
            return completed()
        if abs(drop) <= noise:
            after = completed()
            if abs(float(step @ after.residual)) <= 0.9 * abs(slope):
                return after
        curve = 2.0 * (drop - share * slope)
        share = float(np.clip(-slope * share * share / curve, 0.1 * share, 0.5 * share)) if curve > 0.0 else 0.3 * share
    return None
