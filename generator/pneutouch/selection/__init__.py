"""Inverse design: from a target to designs.

`problem` states the target in numbers, `candidates` finds and holds candidates with their margin to every limit,
`choose` ranks them or states which requirement prevents a design.
"""

from pneutouch.selection.choose import Candidate, DroppedRequirement, SelectionResult, choose
from pneutouch.selection.problem import CandidateResin, SelectionProblem

__all__ = ["Candidate", "CandidateResin", "DroppedRequirement", "SelectionProblem", "SelectionResult", "choose"]
