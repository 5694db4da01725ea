"""Coupons: small prints on which a lab measures its own machine and resins."""

from pneutouch.parts.coupons.coupon import Coupon, CouponContext, Nominal
from pneutouch.parts.coupons.dumbbell import DUMBBELL
from pneutouch.parts.coupons.gauge import GAUGE
from pneutouch.parts.coupons.leak_cap import LEAK_CAP
from pneutouch.parts.coupons.puck import PUCK
from pneutouch.parts.coupons.volume_plug import VOLUME_PLUG

COUPONS: dict[str, Coupon] = {coupon.name: coupon for coupon in (PUCK, DUMBBELL, GAUGE, LEAK_CAP, VOLUME_PLUG)}
"""All coupon families by name, in the order of the sheet."""

__all__ = ["COUPONS", "Coupon", "CouponContext", "Nominal"]
