"""A measured curve of uniaxial tension, and its slack, which is taken off before a fit."""

from dataclasses import dataclass, field, replace

import numpy as np

from pneutouch.arrays import Array


@dataclass(frozen=True, slots=True)
class TensionCurve:
    """One loading: stretch (n,), rising, and nominal stress (n,) in MPa, force over the undeformed cross-section.

    Attributes:
        file: Its file, for messages.
        notes: Changes made to the numbers when they were read.
        slack: Strain that was taken off: pulled before the specimen carried load.
        facts: Entries of the file on the test, such as its machine or its speed.
    """

    stretch: Array
    stress: Array
    file: str = ""
    notes: tuple[str, ...] = ()
    slack: float = 0.0
    facts: dict[str, str] = field(default_factory=dict)

    def without_slack(self, slack: float) -> "TensionCurve":
        """The curve with its stretch counted from where the specimen begins to carry load, later points alone."""
        stretch = self.stretch / (1.0 + slack)
        kept = stretch > 1.0
        return replace(self, stretch=stretch[kept], stress=self.stress[kept], slack=slack)

    def up_to(self, largest: float) -> "TensionCurve":
        """The points up to a stretch."""
        kept = self.stretch <= largest * (1.0 + 1e-9)
        return replace(self, stretch=self.stretch[kept], stress=self.stress[kept])

    def stress_at(self, stretch: float) -> float:
        """Nominal stress at a stretch, straight between the points and from the origin, MPa."""
        return float(np.interp(stretch, [1.0, *self.stretch], [0.0, *self.stress]))
