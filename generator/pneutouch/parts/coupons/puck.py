"""The hardness puck: a plain disc as in the paper; with its mass it also gives the density.

20 mm x 3 mm, four pucks, five readings each: the paper's 20 trials (Supplement A, Table 1). ISO 868 and ASTM D2240
require 6 mm under the durometer, for which two pucks are stacked; the paper does not state whether it did so.
"""

from pneutouch.body import Solid
from pneutouch.parts.coupons.coupon import BALANCE, CALIPER, ROLE, Coupon, CouponContext, Nominal, instructions
from pneutouch.shape.meridian import cylinder
from pneutouch.units import grams

DIAMETER, THICKNESS = 20.0, 3.0
"""Sizes in mm; paper, Supplement A."""


def draw(context: CouponContext) -> tuple[Solid, ...]:
    """The disc, standing on z = 0."""
    return (Solid("puck", ROLE, context.material, cylinder(0.5 * DIAMETER, 0.0, THICKNESS)),)


def nominals(context: CouponContext) -> tuple[Nominal, ...]:
    """Values to measure: hardness on the scale of the material's kind, then the sizes for the density."""
    material = context.material
    soft = material.kind == "elastomer"
    known = material.shore_a if soft else material.shore_d
    scale = "Shore A" if soft else "Shore D"
    mass = grams(draw(context)[0].volume, material.density_g_per_cm3.nominal)
    key, nominal = "shore_a" if soft else "shore_d", None if known is None else known.nominal
    return (
        Nominal(key, nominal, scale, f"{scale} durometer", 5),
        Nominal("mass_g", mass, "g", BALANCE, 1),
        Nominal("diameter_mm", DIAMETER, "mm", CALIPER, 1),
        Nominal("thickness_mm", THICKNESS, "mm", "thickness gauge or caliper, 0.01 mm", 1),
    )


PUCK = Coupon("puck", "hardness puck", "material", 4, draw, nominals, **instructions(__file__))
