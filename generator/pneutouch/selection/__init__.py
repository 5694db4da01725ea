"""The inverse: a target in, designs out.

`problem` says what is wanted in numbers, `search` finds candidates, `pool` holds them with their room to every limit,
`choose` ranks them or says what stands in the way.
"""

from pneutouch.selection.choose import Candidate, DroppedWish, SelectionResult, choose
from pneutouch.selection.problem import CandidateResin, SelectionProblem

__all__ = ["Candidate", "CandidateResin", "DroppedWish", "SelectionProblem", "SelectionResult", "choose"]
