"""The dead-volume plug: like the leak-test cap, but with a cavity of a known volume.

The same push of air raises the pressure more over the cap than over the plug. With the plug's volume known, the two
pressures give the dead volume behind them, independent of syringe and weather (Boyle).
"""

import math

from pneutouch.body import Solid
from pneutouch.errors import InputError
from pneutouch.parts.coupons.coupon import BALANCE, PRESSURE, ROLE, Coupon, CouponContext, Nominal, instructions
from pneutouch.parts.coupons.leak_cap import cap, rim_radius
from pneutouch.shape.dome import DomeShape
from pneutouch.units import ML

WATER = 0.9982
"""Density of water at 20 °C, g/mL (CRC Handbook of Chemistry and Physics)."""

_LEDGE, _LEDGE_SHARE = 1.0, 0.15
"""Width in mm, and greatest share of R0, of the ledge at the base plane: it rests on the connector as fill mark."""

_SERIES = (5.0, 2.0, 1.0)
"""Round volumes in one decade, descending."""


def cavity_volume(shape: DomeShape) -> float:
    """Greatest volume of the series 1, 2, 5 that does not exceed the unloaded cavity of the dome, mm3.

    A volume near the sensor's own makes the two pressures clearly different; 1 mL for the paper's sensor.
    """
    decade = 10.0 ** math.floor(math.log10(shape.cavity_volume))
    return next(step * decade for step in _SERIES if step * decade <= shape.cavity_volume)


def cavity_size(context: CouponContext) -> tuple[float, float]:
    """Radius and height of the cavity, mm. Raises InputError for a dome too small to leave a wall around the cavity."""
    scene, layout = context.design(), context.layout()
    wall = scene.connector_printer.smallest.wall(scene.connector_material.kind).recommended
    ledge = min(_LEDGE, _LEDGE_SHARE * layout.inner_radius)
    radius = min(layout.inner_radius - ledge, rim_radius(context, layout) - wall)
    if radius <= 0.5 * layout.inner_radius:
        raise InputError(
            f"membrane.inner_radius_mm = {layout.inner_radius:g}: too small for a volume plug, whose wall on "
            f"the {scene.connector_printer.title} must be {wall:g} mm",
            file=scene.where,
            remedy="leave it out with `only`, or take a finer printer",
        )
    return radius, cavity_volume(layout.shape) / (math.pi * radius**2)


def draw(context: CouponContext) -> tuple[Solid, ...]:
    """The plug in the frame of its design. Raises InputError for a dome too small to leave a wall around the cavity."""
    radius, height = cavity_size(context)
    hollow = [("cavity top", (radius, height)), ("cavity", (radius, 0.0))]
    return (Solid("volume-plug", ROLE, context.design().connector_material, cap(context, hollow, height)),)


def nominals(context: CouponContext) -> tuple[Nominal, ...]:
    """Values to measure: pressure after the same push of air as over the cap, and cavity volume by weighed water."""
    volume_mL = cavity_volume(context.design().design.membrane.dome) / ML
    return (Nominal("pressure_kPa", None, "kPa", PRESSURE), Nominal("water_g", WATER * volume_mL, "g", BALANCE))


VOLUME_PLUG = Coupon(
    "volume-plug", "dead-volume plug", "design", 1, draw, nominals, **instructions(__file__), turned_over=True
)
