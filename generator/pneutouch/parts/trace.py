"""Draw an outline corner by corner: a start, then for each face its tag and where it ends."""

import math
from collections.abc import Iterable

from pneutouch.meridian import Line, Meridian, Point

TracedPath = list[tuple[str, Point]]


def trace(start: Point, path: Iterable[tuple[str, Point]]) -> Meridian:
    """The meridian of straight faces from ``start``; faces without length are left out."""
    faces, here = [], start
    for tag, to in path:
        if math.dist(here, to) > 0.0:
            faces.append(Line(here, to, tag))
            here = to
    return Meridian(tuple(faces))


def cylinder(radius: float, low: float, high: float) -> Meridian:
    """A round rod about the axis."""
    return trace((0.0, low), [("", (radius, low)), ("", (radius, high)), ("", (0.0, high))])
