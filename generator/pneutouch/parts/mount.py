"""Mounts: the rear faces of the connector and its mounting holes.

Seats: the faces of the connector that hold the flange, and the screws of a clamping ring.
"""

import math

from pneutouch.body import Bore, Feature, Frame, Turned, crossing
from pneutouch.catalogue import ResolvedDesign
from pneutouch.parts.layout import Layout, finger_radius
from pneutouch.shape.meridian import TracedPath, cylinder
from pneutouch.spec.part import AnySeat, BoltCircle, ClampedFlange, OnePiece, RobotFlange, Sleeve


def underside(scene: ResolvedDesign, layout: Layout) -> TracedPath:
    """The path from the rear face around the axis outwards to the lower edge of the plate."""
    mount, low = scene.mount, layout.plate_low
    edge = ("plate underside", (layout.plate_radius, low))
    if isinstance(mount, RobotFlange):
        boss = 0.5 * mount.boss_diameter - scene.connector_printer.accuracy_mm.nominal
        return [("boss face", (boss, layout.under)), ("boss", (boss, low)), edge]
    if isinstance(mount, Sleeve):
        finger = finger_radius(scene)
        outer, end = finger + mount.sleeve_wall, low - mount.sleeve_length
        return [
            ("plate underside", (finger, low)),
            ("finger", (finger, end)),
            ("sleeve end", (outer, end)),
            ("sleeve", (outer, low)),
            edge,
        ]
    return [edge]


def mounting_bores(scene: ResolvedDesign, layout: Layout) -> tuple[Bore, ...]:
    """Equally spaced holes, the first half a spacing off the x axis; a robot flange has a dowel hole on the y axis."""
    mount, wider = scene.mount, scene.hole_undersize
    if not isinstance(mount, BoltCircle | RobotFlange):
        return ()
    low, high, circle = layout.plate_low, layout.plate_high, layout.bolt_circle_radius
    depth = mount.hole_depth if isinstance(mount, BoltCircle) else None
    angles = [2 * math.pi * (k + 0.5) / mount.count for k in range(mount.count)]
    radius = 0.5 * (mount.hole_diameter + wider)
    holes = [
        Bore(
            circle * math.cos(angle),
            circle * math.sin(angle),
            radius,
            low,
            high if depth is None else low + depth,
            closed="" if depth is None else "high",
        )
        for angle in angles
    ]
    if isinstance(mount, RobotFlange):
        holes.append(Bore(0.0, circle, 0.5 * (mount.pin_diameter + wider), low, high))
    return tuple(holes)


def mount_cuts(scene: ResolvedDesign, layout: Layout) -> tuple[Feature, ...]:
    """The set screws' holes in a sleeve, half way along it, turned away from a side port."""
    mount = scene.mount
    if not isinstance(mount, Sleeve):
        return ()
    inner = finger_radius(scene)
    outer, radius = inner + mount.sleeve_wall, 0.5 * (mount.set_screw_core_diameter + scene.hole_undersize)
    height = layout.plate_low - 0.5 * mount.sleeve_length
    drill = cylinder(radius, inner - 1.0 - (inner - math.sqrt(inner**2 - radius**2)), outer + 1.0)
    net = crossing(outer, radius) - crossing(inner, radius)
    angles = [0.5 * math.pi + 2 * math.pi * k / mount.set_screw_count for k in range(mount.set_screw_count)]
    return tuple(
        Feature(Turned(drill, Frame((0.0, 0.0, height), (math.cos(a), math.sin(a), 0.0), (0.0, 0.0, 1.0))), net)
        for a in angles
    )


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
