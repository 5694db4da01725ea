"""The rigid bodies: a connector with its seat, port and mount, and the ring or plug of some seats."""

import math
from dataclasses import replace

from pneutouch.body import Bore, Feature, Frame, Solid, Turned
from pneutouch.catalogue import ResolvedDesign
from pneutouch.parts.air_path import crossing, side_volume
from pneutouch.parts.layout import Layout, finger_radius, plug_neck, plug_radius
from pneutouch.parts.port import CHANNEL
from pneutouch.shape.meridian import Meridian, Point, TracedPath, cylinder, trace
from pneutouch.spec.part import AnySeat, BoltCircle, ClampedFlange, OnePiece, RobotFlange, Sleeve

PLUG_SHOULDER = "shoulder"


def rigid_solids(scene: ResolvedDesign, layout: Layout) -> tuple[Solid, ...]:
    """Rigid bodies: the connector first, then the clamping ring, the ring in the flange or the plug."""
    material, seat = scene.connector_material, scene.seat
    bores = (*_mounting_bores(scene, layout), *_clamping_bores(seat, layout, scene.hole_undersize))
    adds, cuts = [], list(_mount_cuts(scene, layout))
    if layout.port_axis is not None:
        adds += _side_boss(layout)
        cuts.append(_side_bore(layout, layout.opening_radius or layout.channel_radius))
    elif not isinstance(seat, OnePiece):
        adds += _rear_lugs(layout)
    outline = carrier_meridian(scene, layout) if isinstance(seat, OnePiece) else connector_meridian(scene, layout)
    connector = Solid("connector", "connector", material, outline, tuple(bores), tuple(adds), tuple(cuts))
    if isinstance(seat, ClampedFlange):
        holes = _clearing_bores(seat, layout, scene.hole_undersize)
        return connector, Solid("ring", "ring", material, ring_meridian(seat, layout), holes)
    if layout.ring is not None:
        return connector, layout.ring.solid(material)
    if isinstance(seat, OnePiece):
        lugs = () if layout.port_axis is not None else tuple(_rear_lugs(layout))
        return connector, Solid("plug", "plug", material, plug_meridian(scene, layout), adds=lugs)
    return (connector,)


def connector_meridian(scene: ResolvedDesign, layout: Layout) -> Meridian:
    """Connector whose channel leads to the port behind it, or ends blind where the bore of a side port meets it."""
    faces: TracedPath = [
        *underside(scene, layout),
        *_seat_faces(scene.seat, layout),
        ("spigot top", (layout.channel_radius, layout.floor)),
    ]
    if layout.port_axis is not None:
        end = [(CHANNEL, (layout.channel_radius, layout.channel_low)), (CHANNEL, (0.0, layout.channel_low))]
        return trace((0.0, layout.under), [*faces, *end])
    start, port = outward(layout)
    return trace(start, [*port, *faces, *_inward(layout)])


def carrier_meridian(scene: ResolvedDesign, layout: Layout) -> Meridian:
    """The rigid body that a membrane is grown onto: open in the middle, with a counterbore for the plug."""
    assert isinstance(scene.seat, OnePiece)
    seat, opening = scene.seat, layout.opening_radius
    wide, high = opening + seat.shoulder_width, layout.under + seat.shoulder_thickness
    return trace(
        (wide, layout.under),
        [
            *underside(scene, layout),
            *_seat_faces(seat, layout),
            ("lip top", (opening, layout.floor)),
            ("opening", (opening, high)),
            ("counterbore", (wide, high)),
            ("counterbore", (wide, layout.under)),
        ],
    )


def plug_meridian(scene: ResolvedDesign, layout: Layout) -> Meridian:
    """Plug that closes the opening; it also carries the port if that points backwards."""
    assert isinstance(scene.seat, OnePiece)
    seat, body = scene.seat, plug_radius(scene, layout)
    wide, high = body + seat.shoulder_width, layout.under + seat.shoulder_thickness
    faces: TracedPath = [
        ("plug underside", (wide, layout.under)),
        (PLUG_SHOULDER, (wide, high)),
        (PLUG_SHOULDER, (body, high)),
        ("plug", (body, layout.floor)),
    ]
    if layout.port_axis is not None:
        neck, step = plug_neck(scene, layout)
        relief: TracedPath = [
            ("plug", (body, step)),
            ("neck", (neck, step)),
            ("neck", (neck, layout.floor)),
            ("plug top", (0.0, layout.floor)),
        ]
        return trace((0.0, layout.under), [*faces[:-1], *relief])
    start, port = outward(layout)
    return trace(start, [*port, *faces, ("plug top", (layout.channel_radius, layout.floor)), *_inward(layout)])


LIP = 0.3
"""Height in mm of the upright lip under a clamping ring's cone: a cone down to the flange ends in an edge of 45
degrees. Own choice, two layers of a filament printer; a 0.3 mm narrower face presses on the flange."""


def ring_meridian(seat: ClampedFlange, layout: Layout) -> Meridian:
    """Clamping ring as it rests on the flange before the screws apply the squeeze.

    It opens upwards at 45 degrees, so that the dome is free to bulge, above a lip whose edge does not cut the silicone.
    """
    inner, high = layout.ring_inner, seat.ring_thickness
    skirt = layout.plate_high + travel(seat, layout)
    return trace(
        (inner + LIP, 0.0),
        [
            ("clamp face", (layout.groove_outer, 0.0)),
            ("skirt inside", (layout.groove_outer, skirt)),
            ("skirt", (layout.ring_radius, skirt)),
            ("ring", (layout.ring_radius, high)),
            ("ring top", (inner + high, high)),
            ("ring cone", (inner + LIP, LIP)),
            ("lip", (inner + LIP, 0.0)),
        ],
    )


def travel(seat: ClampedFlange, layout: Layout) -> float:
    """Distance in mm by which the screws bring a clamping ring down: the squeeze of the flange and of its gasket."""
    return seat.squeeze * layout.flange_thickness + seat.gasket_squeeze * layout.gasket


def gasket_radii(layout: Layout) -> tuple[float, float]:
    """Inner and outer radius in mm of a gasket under the flange, as wide as the flange."""
    return layout.inner_radius + layout.flange_draft, layout.flange_radius


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


def _mounting_bores(scene: ResolvedDesign, layout: Layout) -> tuple[Bore, ...]:
    """Equally spaced holes, the first half a spacing off the x axis; for a robot flange also a dowel hole on y."""
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


def _mount_cuts(scene: ResolvedDesign, layout: Layout) -> tuple[Feature, ...]:
    """Holes for the set screws in a sleeve, half way along it, turned away from a side port."""
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
"""Tag of the faces that the flange rests on or is grown onto, which both bodies share."""


def _seat_faces(seat: AnySeat, layout: Layout) -> TracedPath:
    """Path from the plate's lower edge over its top to the inner edge of the seat at the base plane."""
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
            (SEAT, (inner, layout.floor)),
        ]
    # A cast flange leans: at its underside, where it rests, it is wider inside by the draft.
    floor: TracedPath = [
        *([("groove floor", (layout.held_radius, high))] if layout.ring is not None else []),
        ("groove floor", (flange, high)),
        (SEAT, (inner + layout.flange_draft, high)),
        ("groove floor", (layout.groove_inner, high)),
        ("groove inner", (layout.groove_inner, layout.floor)),
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


def seat_area(seat: AnySeat, connector: Solid) -> float:
    """Area in mm2 of the faces shared by membrane and connector; 0 for a clamped flange."""
    return 0.0 if isinstance(seat, ClampedFlange) else sum(piece.area() for piece in connector.meridian.tagged(SEAT))


def _clamping_bores(seat: AnySeat, layout: Layout, undersize: float) -> tuple[Bore, ...]:
    """Blind core holes in the connector for the screws of a clamping ring."""
    if not isinstance(seat, ClampedFlange):
        return ()
    low, high = layout.plate_high - seat.core_depth, layout.plate_high
    radius = 0.5 * (seat.core_diameter + undersize)
    return tuple(Bore(x, y, radius, low, high, closed="low") for x, y in _circle(seat, layout))


def _clearing_bores(seat: ClampedFlange, layout: Layout, undersize: float) -> tuple[Bore, ...]:
    """Through holes in the clamping ring."""
    low = layout.plate_high + travel(seat, layout)
    radius = 0.5 * (seat.clearance_diameter + undersize)
    return tuple(Bore(x, y, radius, low, seat.ring_thickness) for x, y in _circle(seat, layout))


def _circle(seat: ClampedFlange, layout: Layout) -> list[tuple[float, float]]:
    angles = [2 * math.pi * (k + 0.5) / seat.screw_count for k in range(seat.screw_count)]
    return [(layout.screw_circle * math.cos(angle), layout.screw_circle * math.sin(angle)) for angle in angles]


_PAST = 1.0
"""Distance in mm by which a shape extends past a face that it opens, so that no two faces coincide."""


def _side_boss(layout: Layout) -> list[Feature]:
    """Outer body of a side port, which begins inside the plate's edge, and its lugs."""
    port, radius = layout.port, layout.plate_radius
    inside = math.sqrt(radius**2 - port.root**2) - _PAST - radius
    faces = [("", (port.root, inside)), *((tag, point) for point, tag in reversed(_faces(layout)))]
    outline = trace((0.0, inside), [*faces, ("", (0.0, port.length))])
    beyond = outline.volume() + math.pi * port.root**2 * (radius + inside) - crossing(radius, port.root)
    boss = Feature(Turned(outline, _frame(layout)), beyond)
    lugs = [Feature(replace(lug, frame=_frame(layout)), port.lug_volume / len(port.lugs)) for lug in port.lugs]
    return [boss, *lugs]


def _side_bore(layout: Layout, across: float) -> Feature:
    """Bore from a vertical hole of radius ``across`` to the mouth; ``net``: volume removed besides that hole."""
    port = layout.port
    start = math.sqrt(across**2 - port.passage**2)
    low = 0.5 * start - layout.plate_radius
    mouth = (port.hollow[0][0], port.length + _PAST)
    faces = [("", (port.passage, low)), *(("", point) for point in reversed(port.hollow)), ("", mouth)]
    outline = trace((0.0, low), [*faces, ("", (0.0, mouth[1]))])
    return Feature(Turned(outline, _frame(layout)), side_volume(layout, across))


def _faces(layout: Layout) -> list[tuple[tuple[float, float], str]]:
    """Points of the port's outside from mouth to root; the tag is that of the face from the next point to this one."""
    port = layout.port
    points = [port.hollow[0], *(point for point, _ in port.outside)]
    return [(points[k], tag) for k, (_, tag) in enumerate(port.outside)] + [(points[-1], "")]


def _frame(layout: Layout) -> Frame:
    assert layout.port_axis is not None
    return Frame((layout.plate_radius, 0.0, layout.port_axis), axis=(1.0, 0.0, 0.0), across=(0.0, 0.0, 1.0))


def outward(layout: Layout) -> tuple[Point, TracedPath]:
    """Path from the inner edge of the port's mouth over its outside to the rear face."""
    port = layout.port
    return _at(layout, port.hollow[0]), [(tag, _at(layout, point)) for point, tag in port.outside]


def _inward(layout: Layout) -> TracedPath:
    """The path from the upper end of the channel down to the inner edge of the port's mouth."""
    port = layout.port
    meeting = _at(layout, port.hollow[-1])[1]
    points = [(layout.channel_radius, meeting), *(_at(layout, point) for point in reversed(port.hollow))]
    return [(CHANNEL, point) for point in points]


def _rear_lugs(layout: Layout) -> list[Feature]:
    """Lugs of a locking port that points backwards; empty for most ports."""
    frame = Frame((0.0, 0.0, layout.under), axis=(0.0, 0.0, -1.0))
    lugs = layout.port.lugs
    return [Feature(replace(lug, frame=frame), layout.port.lug_volume / len(lugs)) for lug in lugs]


def _at(layout: Layout, point: Point) -> Point:
    return point[0], layout.under - point[1]
