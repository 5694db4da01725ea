"""The inverse: a target in, designs out.

`problem` says what is wanted in numbers, `search` finds candidates, `pool` holds them with their room to every limit,
`choose` ranks them or says what stands in the way.
"""

from pneutouch.selection.choose import Answer, Choice, Way, choose
from pneutouch.selection.problem import Problem, Resin

__all__ = ["Answer", "Choice", "Problem", "Resin", "Way", "choose"]
