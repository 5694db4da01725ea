"""The tensile dumbbell, die C of ASTM D412.

Overall 115 mm, ends 25 mm wide, narrow part 33 mm x 6 mm, radii 14 and 25 mm, bench marks 25 mm apart: ASTM D412, Fig.
2 (die C), the same outline as type 1 of ISO 37. The places of the two radii are taken from type IV of ASTM D638, which
is die C with narrower ends: its fillet at the narrow part has 14 mm, its outer radius at the end 25 mm (kcafrp.com,
table of D638).
"""

import math

from pneutouch.body import Prism, Solid
from pneutouch.parts.coupons.coupon import CALIPER, ROLE, Coupon, CouponContext, Nominal, instructions
from pneutouch.shape.meridian import Arc, Line, Segment

OVERALL, END_WIDTH, NARROW_LENGTH, NARROW_WIDTH = 115.0, 25.0, 33.0, 6.0
FILLET, OUTER_RADIUS = 14.0, 25.0
BENCH_MARKS = 25.0
THICKNESS = 2.0
"""Thickness, mm; ISO 37 requires 2.0 +-0.2, ASTM D412 1.3 to 3.3."""


def outline() -> tuple[Segment, ...]:
    """Outline about its centre, lengthwise along x, counter-clockwise; every joint is tangent."""
    turn = math.acos(1 - 0.5 * (END_WIDTH - NARROW_WIDTH) / (FILLET + OUTER_RADIUS))
    end, wide = 0.5 * OVERALL, 0.5 * END_WIDTH
    foot = 0.5 * NARROW_LENGTH
    shoulder = foot + (FILLET + OUTER_RADIUS) * math.sin(turn)
    up, down, fillet = 0.5 * math.pi, -0.5 * math.pi, 0.5 * NARROW_WIDTH + FILLET
    pieces: list[Segment] = []
    # Each quarter has a convex arc at the end and a concave one at the narrow part.
    for sign in (1.0, -1.0):
        right = Arc(
            (sign * shoulder, sign * (wide - OUTER_RADIUS)), OUTER_RADIUS, sign * up, sign * up + turn, "shoulder"
        )
        into = Arc((sign * foot, sign * fillet), FILLET, sign * down + turn, sign * down, "fillet")
        out = Arc((-sign * foot, sign * fillet), FILLET, sign * down, sign * down - turn, "fillet")
        left = Arc(
            (-sign * shoulder, sign * (wide - OUTER_RADIUS)), OUTER_RADIUS, sign * up - turn, sign * up, "shoulder"
        )
        corners = [(sign * end, -sign * wide), (sign * end, sign * wide), right.start]
        pieces += [Line(corners[0], corners[1], "end"), Line(corners[1], corners[2], "side"), right, into]
        pieces += [Line(into.end, out.start, "narrow"), out, left, Line(left.end, (-sign * end, sign * wide), "side")]
    return tuple(pieces)


def draw(context: CouponContext) -> tuple[Solid, ...]:
    """The dumbbell, lying on z = 0."""
    return (Solid("dumbbell", ROLE, context.material, Prism(outline(), 0.0, THICKNESS)),)


def nominals(context: CouponContext) -> tuple[Nominal, ...]:
    """Sizes to measure: the cross-section, the bench marks, and then the curve."""
    return (
        Nominal("width_mm", NARROW_WIDTH, "mm", CALIPER),
        Nominal("thickness_mm", THICKNESS, "mm", "thickness gauge, 0.01 mm"),
        Nominal("gauge_length_mm", BENCH_MARKS, "mm", "bench marks, pen and rule or a marker", 1),
        Nominal("extension_mm", None, "mm", "extensometer or camera on the bench marks", 10),
        Nominal("force_N", None, "N", "load cell, 10 N or 50 N", 10),
    )


DUMBBELL = Coupon(
    "dumbbell",
    "tensile dumbbell, ASTM D412 die C",
    "material",
    5,
    draw,
    nominals,
    **instructions(__file__),
    each="specimen",
    kinds=("elastomer",),
)
