"""A flat middle that hangs in a half-round ring: a rolling diaphragm, for large travel at little force."""

from dataclasses import dataclass
from typing import ClassVar

from pneutouch.shape.disc import FlatDome
from pneutouch.shape.even import LEAST_BEND, biarc
from pneutouch.shape.meridian import Arc, Line, Segment

_MIDDLE = 1.0 / 3.0
"""Radius of the flat middle over the inner radius."""


@dataclass(frozen=True, slots=True)
class Torus(FlatDome):
    """A ring of the height ``rise`` mm over rim and middle, level at all three; the middle is a third as wide."""

    rise: float
    key, adjective = "torus", "ring-shaped"
    usual: ClassVar = {"cavity_depth": 0.3, "rise": 0.2}

    @property
    def line(self) -> tuple[Segment, ...]:
        """Two arcs up to the crest, two down to the middle, and the middle."""
        level, middle = (-1.0, 0.0), _MIDDLE * self.inner_radius
        rim, crest, foot = (self.inner_radius, 0.0), (0.5 * (self.inner_radius + middle), self.rise), (middle, 0.0)
        ring = (*biarc(rim, level, crest, level), *biarc(crest, level, foot, level))
        return (*ring, Line(foot, (0.0, 0.0), ""))

    @property
    def fault(self) -> tuple[str, str] | None:
        """The ring is wide enough for the wall to follow it on both faces."""
        bend = min(piece.radius for piece in self.line if isinstance(piece, Arc))
        if bend <= LEAST_BEND * self.thickest:
            least = f"{LEAST_BEND} times the wall, {LEAST_BEND * self.thickest:.3g} mm"
            return "rise", f"the ring bends with a radius of {bend:.3g} mm, less than {least}"
        return None
