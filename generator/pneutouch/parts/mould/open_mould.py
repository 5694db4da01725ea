"""Open moulds of flat coupons: a tray whose top is the plane that a straight edge strikes the silicone off at.

Walls stand upright, without draft: it would change a cross-section that is measured, and a cured coupon of silicone is
peeled out of the open side.
"""

from pneutouch.body import Feature, Prism, Solid, Turned
from pneutouch.meridian import Line, Meridian, Point, Segment
from pneutouch.parts.mould.size import scaled
from pneutouch.spec.material import Material

WALL, FLOOR = 2.5, 2.5
"""Wall around the cavity and floor under it, mm: own choice."""

_PAST = 1.0
"""Distance in mm by which the cut reaches past the open top, so that no two faces coincide."""


def open_mould(coupon: Solid, material: Material, factor: float) -> Solid:
    """The mould of a coupon that lies on z = 0 and has one outline all over its height.

    ``factor`` is the length of the mould over that of the cured coupon. The cavity's floor is z = 0, the strike-off
    plane the coupon's thickness times ``factor`` above it.
    """
    shape, cavity, tool = coupon.base, _scaled(coupon.base, factor, 0.0), _scaled(coupon.base, factor, _PAST)
    if isinstance(shape, Meridian):
        wide, low, high = shape.bounds()
        x, y = (-wide, wide), (-wide, wide)
    else:
        low, high = shape.low, shape.high
        boxes = [piece.bounds() for piece in shape.outline]
        x = (min(box[0] for box in boxes), max(box[1] for box in boxes))
        y = (min(box[2] for box in boxes), max(box[3] for box in boxes))
    if low != 0.0 or coupon.bores or coupon.adds or coupon.cuts:
        raise TypeError(f"{coupon.name} is no plain body on z = 0: an open mould cannot form it")
    corners = [(factor * x[0] - WALL, factor * y[0] - WALL), (factor * x[1] + WALL, factor * y[1] + WALL)]
    block = Prism(_rectangle(*corners), -FLOOR, factor * high)
    return Solid(f"{coupon.name}-mould", coupon.role, material, block, cuts=(Feature(tool, cavity.volume()),))


def _scaled(shape: Meridian | Prism, factor: float, past: float) -> Turned | Prism:
    """A coupon at the mould's size, its top ``past`` mm higher."""
    if isinstance(shape, Prism):
        outline = tuple(scaled(piece, factor) for piece in shape.outline)
        return Prism(outline, factor * shape.low, factor * shape.high + past)
    top = shape.bounds()[2]

    def moved(point: Point) -> Point:
        return factor * point[0], factor * point[1] + (past if point[1] == top else 0.0)

    return Turned(Meridian(tuple(Line(moved(piece.start), moved(piece.end), piece.tag) for piece in shape.pieces)))


def _rectangle(low: tuple[float, float], high: tuple[float, float]) -> tuple[Segment, ...]:
    corners = [low, (high[0], low[1]), high, (low[0], high[1])]
    return tuple(Line(corners[k], corners[(k + 1) % 4], "side") for k in range(4))
