"""What can go wrong in a solve, said so that a caller can act on it."""

from __future__ import annotations

from pneutouch.errors import BeyondLimitError, ComputationError


class SolidError(ComputationError):
    """Base of every failure of the solid solver."""


class NoConvergenceError(SolidError):
    """No equilibrium met the tolerances, even after every cutback.

    load:   the load that could not be reached, in words with its unit.
    why:    what the last attempt did.
    advice: what to change.
    """

    def __init__(self, load: str, why: str, advice: str) -> None:
        super().__init__(f"no equilibrium at {load}: {why}; try {advice}")
        self.load = load
        self.why = why
        self.advice = advice


class UnreachableLoadError(BeyondLimitError, SolidError):
    """A driving pressure beyond what the dome can carry.

    pressure: what was asked for.  limit: the largest pressure that has an equilibrium; both gauge, MPa.
    """

    def __init__(self, pressure: float, limit: float, why: str) -> None:
        text = f"a driving pressure of {1e3 * pressure:.4f} kPa cannot be carried: {why} (limit {1e3 * limit:.4f} kPa)"
        super().__init__(pressure, limit, text)
