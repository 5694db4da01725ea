"""Flat walls: discs with and without a boss, and corrugated discs."""

from dataclasses import dataclass
from itertools import pairwise
from typing import ClassVar

from pneutouch.shape.dome import OUTER_WALL
from pneutouch.shape.even import LEAST_BEND, EvenDome, biarc
from pneutouch.shape.meridian import Line, Point, Segment


@dataclass(frozen=True, slots=True)
class FlatDome(EvenDome):
    """A wall that does not rise by itself; the rigid body lies ``cavity_depth`` mm behind its inner rim."""

    cavity_depth: float

    @property
    def floor(self) -> float:
        """Height of the rigid body behind the wall."""
        return self.inner[0].start[1] - self.cavity_depth


@dataclass(frozen=True, slots=True)
class Disc(FlatDome):
    """A flat disc; a boss on it, if any, has a flank of 45 degrees, and on top ``boss_radius`` and ``boss_height``."""

    boss_radius: float = 0.0
    boss_height: float = 0.0
    key, adjective = "disc", "flat"
    usual: ClassVar = {"cavity_depth": 0.3}
    start: ClassVar = {"boss_radius": 0.3, "boss_height": 0.3}

    @property
    def line(self) -> tuple[Line, ...]:
        """The flat face, in pieces opposite those of the outer face."""
        stops = [self.inner_radius, *([self._foot, self.boss_radius] if self.boss_height else []), 0.0]
        return tuple(Line((a, 0.0), (b, 0.0), "") for a, b in pairwise(stops))

    def walls(self) -> tuple[tuple[Segment, ...], tuple[Segment, ...]]:
        """The flat face, and opposite it that around the boss, its flank and its top."""
        inner, outer = EvenDome.walls(self)
        if not self.boss_height:
            return inner, outer
        top = self.boss_height
        corners: list[Point] = [(self.inner_radius, 0.0), (self._foot, 0.0), (self.boss_radius, top), (0.0, top)]
        return inner, tuple(Line(a, b, OUTER_WALL) for a, b in pairwise(corners))

    @property
    def fault(self) -> tuple[str, str] | None:
        """A boss has both sizes, and leaves a free ring of wall around it."""
        if bool(self.boss_radius) != bool(self.boss_height):
            return "boss_height", "a boss has a radius and a height: give boss_radius_mm and boss_height_mm, or neither"
        if self.boss_height and self.wall_stations:
            return "wall_stations", "a disc has a boss or a wall that varies, not both"
        free = self.inner_radius - self._foot
        if self.boss_height and free < self.wall_thickness:
            return "boss_radius", (
                f"the foot of the boss leaves {max(free, 0.0):.3g} mm of wall around it; at least the wall's thickness "
                f"({self.wall_thickness:g} mm) must be free"
            )
        return None

    @property
    def _foot(self) -> float:
        return self.boss_radius + self.boss_height


@dataclass(frozen=True, slots=True)
class CorrugatedDisc(FlatDome):
    """A disc with ``grooves`` round grooves between crests of the height ``rise`` mm, level at rim and pole."""

    rise: float
    grooves: int = 1
    key, adjective = "corrugated", "corrugated"
    usual: ClassVar = {"cavity_depth": 0.3, "rise": 0.1}

    @property
    def line(self) -> tuple[Segment, ...]:
        """Two equal arcs for each rise and fall, from the rim up to the crest at the pole."""
        halves = 2 * self.grooves + 1
        points = [(self.inner_radius * (1 - k / halves), self.rise * (k % 2)) for k in range(halves + 1)]
        level = -1.0, 0.0
        return tuple(piece for start, end in pairwise(points) for piece in biarc(start, level, end, level))

    @property
    def fault(self) -> tuple[str, str] | None:
        """Grooves are wide enough for the wall to follow them on both faces."""
        half = self.inner_radius / (2 * self.grooves + 1)
        bend = 0.25 * (half**2 + self.rise**2) / self.rise
        if bend <= LEAST_BEND * self.wall_thickness:
            return "grooves", (
                f"the grooves bend with a radius of {bend:.3g} mm, less than {LEAST_BEND} times the wall's thickness "
                f"({self.wall_thickness:g} mm): take fewer grooves, a smaller rise or a thinner wall"
            )
        return None
