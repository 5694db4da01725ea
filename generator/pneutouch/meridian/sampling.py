"""Sample a meridian to a chord tolerance, keeping the area under it.

An inscribed polygon always errs to the inside and loses volume to first order in the tolerance.
Moving the inner vertices of an arc off it by two thirds of the sagitta makes every chord enclose the
area of its arc. The greatest error falls to two thirds, so fewer chords meet the same tolerance.
"""

import math
from dataclasses import dataclass

from pneutouch.meridian.profile import Meridian
from pneutouch.meridian.segments import Arc, Point, Segment

_ON_AXIS = 1e-9
"""A radius below this (mm) is a pole that rounding moved off the axis."""


@dataclass(frozen=True, slots=True)
class MeridianVertex:
    """A vertex of the sampled meridian: ``lean`` is the radial part of the surface normal there (0 to 1).

    A ring on a face that leans little can be cut into fewer parts at the same error.
    """

    radius: float
    height: float
    lean: float


def chords(arc: Arc, error: float) -> int:
    """Number of chords that keep an arc within ``error`` mm once its area is kept."""
    sagitta = min(1.5 * error, arc.radius)
    widest = 2 * math.acos(1 - sagitta / arc.radius)
    turn = abs(arc.last - arc.first)
    # The two end chords keep one end on the arc; they span 1/sqrt(2) of the others (same mean error).
    return max(2, math.ceil(turn / widest + 2 - math.sqrt(2)))


def sample(meridian: Meridian, error: float) -> list[MeridianVertex]:
    """Rings of a meridian whose arcs stay within ``error`` mm; the last ring does not repeat the first."""
    rings: list[MeridianVertex] = []
    for piece in meridian.pieces:
        rings.append(MeridianVertex(*piece.start, lean=1.0))
        if isinstance(piece, Arc):
            rings += _inner_rings(piece, chords(piece, error))
    if not meridian.is_ring:
        rings.append(MeridianVertex(*meridian.end, lean=1.0))
    return [ring if ring.radius > _ON_AXIS else MeridianVertex(0.0, ring.height, ring.lean) for ring in rings]


def _inner_rings(arc: Arc, count: int) -> list[MeridianVertex]:
    turn = arc.last - arc.first
    step = turn / (count - 2 + math.sqrt(2))
    radius = arc.radius + 2 / 3 * arc.radius * (1 - math.cos(step / 2))
    angles = [arc.first + step / math.sqrt(2) + k * step for k in range(count - 1)]
    return [MeridianVertex(*arc.at(angle, radius), lean=abs(math.cos(angle))) for angle in angles]


def polygon(outline: tuple[Segment, ...], error: float) -> list[Point]:
    """Corners of a closed outline in its plane whose arcs stay within ``error`` mm; the area is kept."""
    corners: list[Point] = []
    for piece in outline:
        corners.append(piece.start)
        if isinstance(piece, Arc):
            corners += [(ring.radius, ring.height) for ring in _inner_rings(piece, chords(piece, error))]
    return corners
