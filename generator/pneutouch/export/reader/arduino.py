"""Reading of a gauge by an Arduino: over the bus or with its converter, as far as that is known."""

from __future__ import annotations

from typing import Any

from pneutouch.spec.gauge import Gauge

_BUS = "ABP2"
"""Order codes that begin so have the protocol of the sketch: command AA 00 00, 5 ms, seven bytes with pressure
and temperature of 24 bits (drivers Linux abp2030pa and ESPHome honeywellabp2)."""


def arduino_gauge(gauge: Gauge) -> dict[str, Any] | str:
    """Data of a gauge for the sketch, kPa and its output; or the reason why there is no sketch, in words."""
    if gauge.is_absolute:
        return f"no sketch: the {gauge.title} is absolute, and its reading less a barometer's is the gauge pressure"
    if gauge.transfer.at_low is None or gauge.transfer.at_high is None:
        return f"no sketch: the {gauge.title} has constants in each part, which a driver of its maker reads"
    span = gauge.transfer.at_high - gauge.transfer.at_low
    numbers = {
        "low": gauge.range_kPa.low,
        "at_low": gauge.transfer.at_low,
        "slope": gauge.range_kPa.span / span,
        "volts": gauge.transfer.output == "V",
        "bus": False,
    }
    if gauge.transfer.output != "count":
        return numbers
    if not gauge.order_code.startswith(_BUS) or "I2C" not in gauge.interfaces or gauge.i2c_address is None:
        return f"no sketch: how the {gauge.title} is read over its bus is not covered"
    return {**numbers, "bus": True, "address": gauge.i2c_address}


NO_GAUGE = "no sketch: the design names no gauge, see pneumatics.gauge"
