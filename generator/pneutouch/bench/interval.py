"""Intervals of few measurements: of a mean over specimens by Student's t, of a standard deviation by chi-square.

Three specimens with three runs each are what a lab has. The percentile bootstrap of three values covers far less than
it states (tests/bench/test_interval.py measures about 75 % for 95 %). What Hesterberg (Am. Stat. 69, 371-386, 2015, DOI
10.1080/00031305.2015.1089789, sections 4.5 and 5.3) makes of it for few values is its standard error, widened by
sqrt(n/(n-1)), times t with n - 1 degrees of freedom. Of a mean the bootstrap's standard error is known without a draw,
sqrt((n-1)/n) s/sqrt(n), so that this is s/sqrt(n) times t. Specimens are what is drawn, with all their runs: drawing
runs as well would count their scatter twice (Davison & Hinkley, Bootstrap Methods, 1997, section 3.8). The bootstrap of
a standard deviation of three is no better for being widened; chi-square is exact for normal values."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array

LEVEL = 0.95
"""Probability of every interval."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """A figure with its interval, in the figure's unit.

    Attributes:
        value: Mean over specimens of their means over runs; or a standard deviation.
        low: Lower end of the 95 % interval, None if there is none.
        high: Upper end, likewise.
        specimens: Number of specimens behind it.
        runs: Number of runs behind it.
        over: Source of the scatter: "specimens", "runs", or "" if there is none.
    """

    value: float
    low: float | None
    high: float | None
    specimens: int
    runs: int
    over: str

    def holds(self, truth: float) -> bool:
        """True if the interval holds a value."""
        return self.low is not None and self.high is not None and self.low <= truth <= self.high


def mean_of(groups: Sequence[Array]) -> Estimate:
    """Mean over specimens of their means over runs; ``groups`` has an array of runs a specimen, none of them empty.

    With one specimen the interval is over its runs and does not cover other specimens; with one value there is none.
    """
    runs = sum(len(group) for group in groups)
    if len(groups) > 1:
        drawn, over = np.array([float(np.mean(group)) for group in groups]), "specimens"
    else:
        drawn, over = np.asarray(groups[0], float), "runs"
    value = float(drawn.mean())
    if drawn.size < 2:
        return Estimate(value, None, None, len(groups), runs, "")
    half = _quantile(drawn.size - 1) * float(drawn.std(ddof=1)) / np.sqrt(drawn.size)
    return Estimate(value, value - half, value + half, len(groups), runs, over)


def spread_between(groups: Sequence[Array]) -> Estimate:
    """Standard deviation (ddof 1) of the specimens' means; it holds the runs' scatter over the root of their number."""
    means = np.array([float(np.mean(group)) for group in groups])
    return _spread(float(means.std(ddof=1)) if means.size > 1 else None, means.size - 1, groups, "specimens")


def spread_within(groups: Sequence[Array]) -> Estimate:
    """Standard deviation between the runs of a specimen, pooled over specimens (ddof 1 each)."""
    freedom = sum(len(group) - 1 for group in groups)
    squares = sum(float(((group - np.mean(group)) ** 2).sum()) for group in groups)
    return _spread(float(np.sqrt(squares / freedom)) if freedom else None, freedom, groups, "runs")


def _spread(value: float | None, freedom: int, groups: Sequence[Array], over: str) -> Estimate:
    runs = sum(len(group) for group in groups)
    if value is None:
        return Estimate(float("nan"), None, None, len(groups), runs, "")
    low, high = _chi_square(freedom)
    return Estimate(value, value * low, value * high, len(groups), runs, over)


def _chi_square(freedom: int) -> tuple[float, float]:
    """Ends of the interval of a standard deviation over its estimate."""
    from scipy.special import gammaincinv

    tails = 0.5 * (1 + LEVEL), 0.5 * (1 - LEVEL)
    low, high = (float(np.sqrt(0.5 * freedom / gammaincinv(0.5 * freedom, tail))) for tail in tails)
    return low, high


def widened(estimate: Estimate, reading: float) -> Estimate:
    """The estimate with a relative error of the reading that all runs share, added to its half width as squares."""
    if estimate.low is None or estimate.high is None or reading == 0:
        return estimate
    half = float(np.hypot(0.5 * (estimate.high - estimate.low), reading * estimate.value))
    middle = 0.5 * (estimate.high + estimate.low)
    return replace(estimate, low=middle - half, high=middle + half)


def _quantile(freedom: int) -> float:
    """Student's t."""
    from scipy.special import stdtrit

    return float(stdtrit(freedom, 0.5 * (1 + LEVEL)))
