"""Seats: the faces of the connector that hold the flange, and the screws of a clamping ring."""

import math

from pneutouch.body import Bore
from pneutouch.parts.layout import Layout
from pneutouch.parts.trace import TracedPath
from pneutouch.spec.part import AnySeat, ClampedFlange, OnePiece

SEAT = "seat"
"""Faces that the flange rests on or is grown onto: the ones both bodies share."""


def seat_faces(seat: AnySeat, layout: Layout) -> TracedPath:
    """The path from the lower edge of the plate over its top to the inner edge of the seat at the base plane."""
    plate: TracedPath = [("plate edge", (layout.plate_radius, layout.plate_high))]
    inner, flange, high = layout.inner_radius, layout.flange_radius, layout.plate_high
    ring: TracedPath = [("plate top", (layout.ring_radius, high)), ("ring", (layout.ring_radius, 0.0))]
    if isinstance(seat, OnePiece):
        return [
            *plate,
            *ring,
            ("ring top", (flange, 0.0)),
            (SEAT, (flange, high)),
            (SEAT, (inner, high)),
            (SEAT, (inner, 0.0)),
        ]
    # A cast flange leans: at its underside, where it rests, it is that much wider inside too.
    floor: TracedPath = [
        *([("groove floor", (layout.held_radius, high))] if layout.ring is not None else []),
        ("groove floor", (flange, high)),
        (SEAT, (inner + layout.flange_draft, high)),
        ("groove floor", (layout.groove_inner, high)),
        ("groove inner", (layout.groove_inner, 0.0)),
    ]
    if isinstance(seat, ClampedFlange):
        return [*plate, *floor]
    return [
        *plate,
        *ring,
        ("ring top", (layout.groove_outer, 0.0)),
        ("groove outer", (layout.groove_outer, high)),
        *floor,
    ]


def clamping_bores(seat: AnySeat, layout: Layout, undersize: float) -> tuple[Bore, ...]:
    """Blind core holes in the connector for the screws of a clamping ring."""
    if not isinstance(seat, ClampedFlange):
        return ()
    low, high = layout.plate_high - seat.core_depth, layout.plate_high
    radius = 0.5 * (seat.core_diameter + undersize)
    return tuple(Bore(x, y, radius, low, high, closed="low") for x, y in _circle(seat, layout))


def clearing_bores(seat: ClampedFlange, layout: Layout, undersize: float) -> tuple[Bore, ...]:
    """Through holes in the clamping ring."""
    low = layout.plate_high + seat.squeeze * layout.flange_thickness
    radius = 0.5 * (seat.clearance_diameter + undersize)
    return tuple(Bore(x, y, radius, low, seat.ring_thickness) for x, y in _circle(seat, layout))


def _circle(seat: ClampedFlange, layout: Layout) -> list[tuple[float, float]]:
    angles = [2 * math.pi * (k + 0.5) / seat.screw_count for k in range(seat.screw_count)]
    return [(layout.screw_circle * math.cos(angle), layout.screw_circle * math.sin(angle)) for angle in angles]
