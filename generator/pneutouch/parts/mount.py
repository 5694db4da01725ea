"""Mounts: the holes of the connector's bolt circle."""

from __future__ import annotations

import math

from pneutouch.body import Bore
from pneutouch.parts.layout import Layout
from pneutouch.spec.part import BoltCircle


def mounting_bores(mount: BoltCircle, layout: Layout) -> tuple[Bore, ...]:
    """Equally spaced holes; the first lies half a spacing off the x axis."""
    low = layout.plate_low
    high = low + mount.hole_depth if mount.hole_depth is not None else layout.plate_high
    angles = [2 * math.pi * (k + 0.5) / mount.count for k in range(mount.count)]
    radius = layout.bolt_circle_radius
    return tuple(
        Bore(
            radius * math.cos(angle), radius * math.sin(angle),
            0.5 * mount.hole_diameter, low, high, blind=mount.family == "blind",
        )
        for angle in angles
    )  # fmt: skip
