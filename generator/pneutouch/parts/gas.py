"""The gas behind the cavity, exactly: channel, port and the gaps that are open to it, less what fills them."""

import math

from pneutouch.catalogue import ResolvedDesign
from pneutouch.parts.connector import plug_neck, plug_radius
from pneutouch.parts.layout import Layout
from pneutouch.parts.side_port import side_volume
from pneutouch.spec.part import CastRing, ClampedFlange, GluedFlange, OnePiece


def internal_volume(scene: ResolvedDesign, layout: Layout) -> float:
    """Volume in mm3 between the base plane and the mouth of the port, with the fitting or tube in place."""
    return channel_volume(layout) + gap_volume(scene, layout) - layout.port.filled_volume()


def channel_volume(layout: Layout) -> float:
    """Volume in mm3 of the channel and the hollow of the port, empty; a side port on an opening has no channel."""
    port, radius = layout.port, layout.channel_radius
    if layout.port_axis is None:
        meeting = layout.under - port.hollow[-1][1]
        return port.hollow_volume(port.hollow[-1][1]) - math.pi * radius**2 * meeting
    if layout.opening_radius:
        return side_volume(layout, layout.opening_radius)
    return side_volume(layout, radius) - math.pi * radius**2 * layout.channel_low


def gap_volume(scene: ResolvedDesign, layout: Layout) -> float:
    """Volume in mm3 of the gap inside a clamped flange or around a plug; other gaps are full of glue."""
    seat = scene.seat
    if isinstance(seat, ClampedFlange):
        return _inside_flange(layout)
    if isinstance(seat, OnePiece):
        bottom, body = layout.under + seat.shoulder_thickness, plug_radius(scene, layout)
        if layout.port_axis is None:
            return _annulus(body, layout.opening_radius, -bottom)
        neck, step = plug_neck(scene, layout)
        return _annulus(body, layout.opening_radius, step - bottom) + _annulus(neck, layout.opening_radius, -step)
    return 0.0


def glue_volume(scene: ResolvedDesign, layout: Layout) -> float:
    """Volume in mm3 of the gaps that glue fills: around a glued flange or a cast one with its ring, or around a plug's
    shoulder."""
    seat = scene.seat
    if isinstance(seat, CastRing):
        return _inside_flange(layout) + _annulus(layout.held_radius, layout.groove_outer, layout.flange_thickness)
    if isinstance(seat, GluedFlange):
        outside = _annulus(layout.flange_radius, layout.groove_outer, layout.flange_thickness)
        return _inside_flange(layout) + outside + _draft(layout.flange_radius, -layout.flange_draft, layout)
    if isinstance(seat, OnePiece):
        wide = layout.opening_radius + seat.shoulder_width
        return _annulus(wide - scene.fit_clearance, wide, seat.shoulder_thickness)
    return 0.0


def _inside_flange(layout: Layout) -> float:
    """The gap between spigot and flange, mm3."""
    upright = _annulus(layout.groove_inner, layout.inner_radius, layout.flange_thickness)
    return upright + _draft(layout.inner_radius, layout.flange_draft, layout)


def _draft(radius: float, draft: float, layout: Layout) -> float:
    """Volume in mm3 between an upright side of the flange and one that leans by ``draft`` to the other radius."""
    return math.pi * layout.flange_thickness * abs(draft) * (radius + draft / 3)


def _annulus(inner: float, outer: float, height: float) -> float:
    return math.pi * (outer**2 - inner**2) * height
