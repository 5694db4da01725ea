"""A part mark for a narrow ring: grooves along the flange, counted like strokes on a slate.

Read counter-clockwise, looking onto the dome. A long groove is the start; then a group of grooves for the value, a
wider gap, and a group for the copy. A narrow groove counts one, a middle one five. A is 1, B is 2 and so on.
"""

import math
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array

FIVE, START = 3.0, 6.0
"""Widths of the groove for five and of the start over that of the groove for one."""

_BETWEEN, _APART = 1.3, 4.0
"""Land between grooves, and between groups, over the width of the groove for one."""

_ASIDE = 0.0137
"""Angle in rad of the start: off the x axis, where every mesh has vertices."""

EXPLAINED = (
    "Look onto the dome and go counter-clockwise from the longest stroke, the start. The first group is the letter "
    "(A is 1, without I and O), the second the copy; a narrow stroke counts one, a middle one five."
)


@dataclass(frozen=True, slots=True)
class TallyRing:
    """Sectors of a ring from radius ``inner`` to ``outer`` (mm): first and last angle of each, rad."""

    inner: float
    outer: float
    sectors: tuple[tuple[float, float], ...]

    @property
    def narrowest(self) -> float:
        """Width in mm of the narrowest groove, straight across its inner end; or its length, where that is less."""
        angle = min(last - first for first, last in self.sectors)
        return min(2 * self.inner * math.sin(0.5 * angle), self.outer - self.inner)

    def polygons(self, error: float = 0.01) -> list[Array]:
        """Outlines (n, 2) in mm, counter-clockwise, arcs within ``error``."""
        return [self._polygon(first, last, error) for first, last in self.sectors]

    def _polygon(self, first: float, last: float, error: float) -> Array:
        steps = 1 + math.ceil((last - first) / math.sqrt(8 * error / self.outer))
        angle = np.linspace(first, last, steps + 1)
        arc = np.column_stack([np.cos(angle), np.sin(angle)])
        return np.concatenate([self.outer * arc, self.inner * arc[::-1]])


def tally(index: int, copy: int, inner: float, outer: float, width: float) -> TallyRing | None:
    """Grooves for a value's ``index`` and a ``copy``, both from 1; ``width`` mm is the narrowest, at ``inner``.

    None if they do not go round the ring with a gap before the start comes again.
    """
    sectors, at = [(0.0, START * width)], START * width
    for number in (index, copy):
        at += _APART * width
        for share in _strokes(number):
            sectors.append((at, at + share * width))
            at += (share + _BETWEEN) * width
        at -= _BETWEEN * width
    if at + _APART * width > 2 * math.pi * inner:
        return None
    return TallyRing(inner, outer, tuple((_ASIDE + first / inner, _ASIDE + last / inner) for first, last in sectors))


def read(sectors: list[tuple[float, float]]) -> tuple[int, int]:
    """Index and copy from the angles (rad) of grooves in any order, anywhere round the ring."""
    start = max(range(len(sectors)), key=lambda k: sectors[k][1] - sectors[k][0])
    unit = (sectors[start][1] - sectors[start][0]) / START
    rest = sorted(((a - sectors[start][1]) % (2 * math.pi), b - a) for k, (a, b) in enumerate(sectors) if k != start)
    counts, end = [0], rest[0][0]
    for at, width in rest:
        if at - end > 0.5 * (_BETWEEN + _APART) * unit:
            counts.append(0)
        counts[-1] += 5 if width > 0.5 * (1 + FIVE) * unit else 1
        end = at + width
    index, copy = counts
    return index, copy


def _strokes(number: int) -> list[float]:
    """Widths of the grooves that count a number: fives first."""
    fives, ones = divmod(number, 5)
    return [FIVE] * fives + [1.0] * ones
