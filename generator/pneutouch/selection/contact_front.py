"""The trade-off under a contact that the atlas does not cover: the atlas's fronts corrected by the solid along them.

Each round draws the fronts with the factors found so far (`ContactFactors`) and solves a few places of each front.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Index
from pneutouch.selection.contact_factors import ContactFactors
from pneutouch.selection.contact_trial import ContactTrial, SolveCandidate, tried
from pneutouch.selection.front import TradeOffFront, front
from pneutouch.selection.pool import CandidatePool, evaluated
from pneutouch.selection.problem import SelectionProblem

_SHARES = ((0.0, 0.5, 1.0), (0.25, 0.75), (0.125, 0.375, 0.625, 0.875))
"""Places that each round solves on the front of each resin, from the least sensitive to the most, in even steps of the
logarithms of sensitivity and force."""

_NEAR = 0.01
"""A front that was nearer to the solid than this at all places of a round is not solved in the next one."""


class ContactFronts(NamedTuple):
    """Fronts, and how far those drawn before were off the solid where it was solved next, from the second round on.

    Of each place the larger relative difference of sensitivity and force counts: the median and the greatest of all,
    NaN if there is none. ``presses`` is the number of places solved.
    """

    fronts: list[TradeOffFront]
    median_error: float
    greatest_error: float
    presses: int


def contact_front(problem: SelectionProblem, solve: SolveCandidate) -> ContactFronts:
    """`front` under the contact of the solver: its sensitivities and forces are the atlas's times the solid's factors.

    A place that the solid cannot answer corrects nothing.
    """
    factors, fronts = ContactFactors.none(), _fronts(problem, ContactFactors.none())
    open_, errors, presses = list(range(len(fronts))), [], 0
    for count, shares in enumerate(_SHARES):
        trials, far = [], []
        for number in open_:
            one = fronts[number]
            solved = [(row, tried(problem, place(problem, number, one, row), solve)) for row in _spread(one, shares)]
            off = [_off(one, row, trial) for row, trial in solved if not trial.why]
            trials += [trial for _, trial in solved]
            errors += off if count else []
            if count == 0 or max(off, default=0.0) > _NEAR:
                far.append(number)
        presses += len(trials)
        for trial in trials:
            factors = trial.added_to(factors)
        open_, fronts = far, _fronts(problem, factors)
    median, greatest = (float(np.median(errors)), max(errors)) if errors else (np.nan, np.nan)
    return ContactFronts(fronts, median, greatest, presses)


def _off(one: TradeOffFront, row: int, trial: ContactTrial) -> float:
    """The larger relative difference of sensitivity and force between a place of a front and the solid's answer
    there."""
    exact_kPa_per_N, exact = trial.pool.response.lines.sensitivity_kPa_per_N[0], trial.pool.force[0]
    return float(max(abs(one.sensitivity_kPa_per_N[row] / exact_kPa_per_N - 1.0), abs(one.force[row] / exact - 1.0)))


def _fronts(problem: SelectionProblem, factors: ContactFactors) -> list[TradeOffFront]:
    return front(replace(problem, factors=factors if len(factors.places) else None))


def _spread(one: TradeOffFront, shares: tuple[float, ...]) -> Index:
    """Rows at shares of the length of a front, each once; none of an empty one."""
    if one.force.size == 0:
        return np.zeros(0, dtype=np.intp)
    steps = np.hypot(np.diff(np.log(one.sensitivity_kPa_per_N)), np.diff(np.log(one.force)))
    along = np.concatenate([[0.0], np.cumsum(steps)])
    return np.unique([np.abs(along - share * along[-1]).argmin() for share in shares])


def place(problem: SelectionProblem, number: int, one: TradeOffFront, row: int) -> CandidatePool:
    """A place of a front as a candidate, by the atlas alone."""
    pressure = np.array([problem.driving_pressure or 0.0])
    radius, wall = one.radius[[row]], one.wall[[row]]
    return evaluated(replace(problem, factors=None), np.array([float(number)]), radius, wall, pressure)
