"""A gas line: its elements in order from the cavity to the gauge, at one state of the air."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Complex
from pneutouch.mechanics.line.air import AirState
from pneutouch.mechanics.line.elements import Duct, GasVolume, LineEnd, profiles

LineElement = Duct | GasVolume


@dataclass(frozen=True, slots=True)
class GasLine:
    """Ducts and volumes in series, the gauge behind the last one; closed there."""

    elements: tuple[LineElement, ...]
    air: AirState

    @property
    def volume(self) -> float:
        """Gas in it, mm3."""
        return sum(element.volume for element in self.elements)

    @property
    def length(self) -> float:
        """Length of its ducts, mm."""
        return sum(element.length for element in self.elements if isinstance(element, Duct))

    def seen(self, s: Complex) -> LineEnd:
        """Admittance of the line at the cavity, and the pressure at the gauge over that in the cavity, at s (n,)."""
        end = LineEnd(np.zeros_like(s), np.ones_like(s))
        ducts = [element for element in self.elements if isinstance(element, Duct)]
        rows = list(profiles(ducts, s, self.air))
        for element in reversed(self.elements):
            if isinstance(element, Duct):
                end = element.before(end, s, self.air, rows.pop())
            else:
                end = element.before(end, s, self.air)
        return end
