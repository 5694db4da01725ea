"""The leak-test cap: closes the connector in place of the membrane, and leaves no cavity.

It has the membrane's flange and sits in the same seat; a rigid disc replaces the dome, its underside level with the
base plane. The remaining gas is only the dead volume, and a leak cannot be in the membrane.
"""

from pneutouch.body import Solid
from pneutouch.parts.coupons.coupon import PRESSURE, ROLE, Coupon, CouponContext, Nominal, instructions
from pneutouch.parts.layout import Layout
from pneutouch.shape.meridian import Meridian, TracedPath, trace
from pneutouch.spec.part import ClampedFlange

TEST_PRESSURE = 20.0
"""Test pressure, kPa, near the highest driving pressure of the paper's sensor."""

_LEAST_DISC, _DISC_SHARE = 3.0, 1 / 3
"""Thickness of the disc: least value in mm, and share of R0. A clamped ABS disc then takes up less than 1e-4 of the
volume of a hemisphere at 100 kPa (Kirchhoff plate, E = 2.4 GPa)."""


def draw(context: CouponContext) -> tuple[Solid, ...]:
    """The cap in the frame of its design. Raises InputError if a part of the design does not fit."""
    return (Solid("leak-cap", ROLE, context.design().connector_material, cap(context, [], 0.0)),)


def cap(context: CouponContext, hollow: TracedPath, top: float) -> Meridian:
    """Meridian of a flange and a disc above ``top`` (mm); ``hollow`` leads from the axis there to the base plane."""
    scene, layout = context.design(), context.layout()
    # A membrane grown onto its connector leaves no gap for a part that is glued in instead.
    slack = scene.fit_clearance - layout.clearance
    inner, flange, low = layout.inner_radius + slack, layout.held_radius - slack, -layout.flange_thickness
    rim, high = rim_radius(context, layout), top + max(_LEAST_DISC, _DISC_SHARE * layout.inner_radius)
    return trace(
        (0.0, top),
        [
            *hollow,
            ("base plane", (inner, 0.0)),
            ("held", (inner, low)),
            ("held", (flange, low)),
            ("held", (flange, 0.0)),
            ("flange top", (rim, 0.0)),
            ("side", (rim, high)),
            ("top", (0.0, high)),
        ],
    )


def rim_radius(context: CouponContext, layout: Layout) -> float:
    """Radius of the disc, mm: over the whole flange, or inside the ring that clamps the flange."""
    scene = context.design()
    if isinstance(scene.seat, ClampedFlange):
        return layout.outer_radius
    return layout.held_radius - (scene.fit_clearance - layout.clearance)


def nominals(context: CouponContext) -> tuple[Nominal, ...]:
    """Values to measure: the leak, then the pressure after a known push of air."""
    return (
        Nominal("start_kPa", TEST_PRESSURE, "kPa", PRESSURE),
        Nominal("end_kPa", None, "kPa", PRESSURE),
        Nominal("pressure_kPa", None, "kPa", PRESSURE),
    )


LEAK_CAP = Coupon("leak-cap", "leak-test cap", "design", 1, draw, nominals, **instructions(__file__), turned_over=True)
