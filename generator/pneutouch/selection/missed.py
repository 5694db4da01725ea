"""Distance of a candidate from its requirements, in percent of the required value."""

import numpy as np

from pneutouch.selection.choose import Candidate
from pneutouch.selection.problem import SelectionProblem

_MOST = ("outer diameter", "footprint", "break strain", "gauge range")
"""Margins to a value that must not be exceeded; the others are to one that must be reached."""


def missed_percent(problem: SelectionProblem, candidate: Candidate) -> dict[str, float | None]:
    """Requirements and limits that are broken, and how far its value is off, in percent of the required one.

    None if its value is not known.
    """
    broken = {name: margin for name, margin in candidate.margins.items() if margin < 0}
    return {
        name: _off(problem, candidate, name, margin) if np.isfinite(margin) else None for name, margin in broken.items()
    }


def _off(problem: SelectionProblem, candidate: Candidate, name: str, margin: float) -> float:
    lines = candidate.pool.response.lines
    if name == "sensitivity":
        assert problem.sensitivity_kPa_per_N is not None
        return 100.0 * abs(float(lines.sensitivity_kPa_per_N[0]) / problem.sensitivity_kPa_per_N - 1.0)
    if name == "stiffness":
        least, most = problem.stiffness
        stiffness = float(lines.stiffness[0])
        bound = least if least is not None and stiffness < least else most
        assert bound is not None
        return 100.0 * abs(stiffness / bound - 1.0)
    # A margin to a greatest value is relative to the candidate's own.
    return 100.0 * (1.0 / (1.0 + margin) - 1.0 if name in _MOST else -margin)
