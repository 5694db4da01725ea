"""Failures of a solve that callers handle; users see a ComputationError."""

from pneutouch.errors import BeyondLimitError, ComputationError


class NoConvergenceError(ComputationError):
    """No equilibrium met the tolerances, even after every cutback.

    load:   the load that could not be reached, in words with its unit.
    why:    what the last attempt did.
    advice: what to change.
    """

    def __init__(self, load: str, why: str, advice: str) -> None:
        super().__init__(f"no equilibrium at {load}: {why}", remedy=f"try {advice}")
        self.load, self.why, self.advice = load, why, advice


class UnreachableLoadError(BeyondLimitError):
    """A driving pressure beyond the one that the dome can carry.

    pressure: the requested one.  limit: the largest pressure that has an equilibrium; both gauge, MPa.
    """

    def __init__(self, pressure: float, limit: float, why: str) -> None:
        text = f"a driving pressure of {1e3 * pressure:.4f} kPa cannot be carried: {why} (limit {1e3 * limit:.4f} kPa)"
        super().__init__(pressure, limit, text)
