"""The connector: a rigid body with a groove for the flange, an air channel, a port and mounting holes."""

from __future__ import annotations

from itertools import pairwise

from pneutouch.meridian import Line, Meridian, Point
from pneutouch.parts.layout import Layout
from pneutouch.parts.port import port_outside
from pneutouch.spec.part import Barb

CHANNEL = "channel"
SEAT = "seat"
"""The part of the groove's floor that the flange rests on: the face both bodies share."""


def connector_meridian(layout: Layout, port: Barb) -> Meridian:
    """Meridian of the connector without its mounting holes, starting at the mouth of the port."""
    outside = port_outside(port, layout.plate_low)
    corners: list[tuple[Point, str]] = [
        (outside[-1].end, "plate underside"),
        ((layout.plate_radius, layout.plate_low), "plate edge"),
        ((layout.plate_radius, layout.plate_high), "plate top"),
        ((layout.ring_radius, layout.plate_high), "ring"),
        ((layout.ring_radius, 0.0), "ring top"),
        ((layout.groove_outer, 0.0), "groove outer"),
        ((layout.groove_outer, layout.plate_high), "groove floor"),
        ((layout.flange_radius, layout.plate_high), SEAT),
        ((layout.inner_radius, layout.plate_high), "groove floor"),
        ((layout.groove_inner, layout.plate_high), "groove inner"),
        ((layout.groove_inner, 0.0), "spigot top"),
        ((layout.channel_radius, 0.0), CHANNEL),
        ((layout.channel_radius, layout.plate_low), CHANNEL),
        ((outside[0].start[0], layout.plate_low), CHANNEL),
        (outside[0].start, ""),
    ]
    inside = [Line(a, b, tag) for (a, tag), (b, _) in pairwise(corners) if a != b]
    return Meridian((*outside, *inside))
