"""The rigid bodies: a connector with its seat, port and mount, and the ring or plug that some seats add."""

from pneutouch.body import Solid
from pneutouch.catalogue import ResolvedDesign
from pneutouch.parts.channel import inward, outward, rear_lugs, side_bore, side_boss
from pneutouch.parts.layout import Layout
from pneutouch.parts.mount import clamping_bores, clearing_bores, mount_cuts, mounting_bores, seat_faces, underside
from pneutouch.parts.port import CHANNEL
from pneutouch.shape.meridian import Meridian, TracedPath, trace
from pneutouch.spec.part import ClampedFlange, OnePiece

PLUG_SHOULDER = "shoulder"

_UNDER_PORT = 0.3
"""Distance in mm below a side port's passage at which the plug gets thinner."""


def rigid_solids(scene: ResolvedDesign, layout: Layout) -> tuple[Solid, ...]:
    """The connector first, then the clamping ring, the ring in the flange or the plug."""
    material, seat = scene.connector_material, scene.seat
    bores = (*mounting_bores(scene, layout), *clamping_bores(seat, layout, scene.hole_undersize))
    adds, cuts = [], list(mount_cuts(scene, layout))
    if layout.port_axis is not None:
        adds += side_boss(layout)
        cuts.append(side_bore(layout, layout.opening_radius or layout.channel_radius))
    elif not isinstance(seat, OnePiece):
        adds += rear_lugs(layout)
    outline = carrier_meridian(scene, layout) if isinstance(seat, OnePiece) else connector_meridian(scene, layout)
    connector = Solid("connector", "connector", material, outline, tuple(bores), tuple(adds), tuple(cuts))
    if isinstance(seat, ClampedFlange):
        holes = clearing_bores(seat, layout, scene.hole_undersize)
        return connector, Solid("ring", "ring", material, ring_meridian(seat, layout), holes)
    if layout.ring is not None:
        return connector, layout.ring.solid(material)
    if isinstance(seat, OnePiece):
        lugs = () if layout.port_axis is not None else tuple(rear_lugs(layout))
        return connector, Solid("plug", "plug", material, plug_meridian(scene, layout), adds=lugs)
    return (connector,)


def connector_meridian(scene: ResolvedDesign, layout: Layout) -> Meridian:
    """A connector whose channel leads to the port behind it, or ends blind where a side port's bore meets it."""
    faces: TracedPath = [
        *underside(scene, layout),
        *seat_faces(scene.seat, layout),
        ("spigot top", (layout.channel_radius, 0.0)),
    ]
    if layout.port_axis is not None:
        end = [(CHANNEL, (layout.channel_radius, layout.channel_low)), (CHANNEL, (0.0, layout.channel_low))]
        return trace((0.0, layout.under), [*faces, *end])
    start, port = outward(layout)
    return trace(start, [*port, *faces, *inward(layout)])


def carrier_meridian(scene: ResolvedDesign, layout: Layout) -> Meridian:
    """The rigid body that a membrane is grown onto: open in the middle, with a counterbore for the plug."""
    assert isinstance(scene.seat, OnePiece)
    seat, opening = scene.seat, layout.opening_radius
    wide, high = opening + seat.shoulder_width, layout.under + seat.shoulder_thickness
    return trace(
        (wide, layout.under),
        [
            *underside(scene, layout),
            *seat_faces(seat, layout),
            ("lip top", (opening, 0.0)),
            ("opening", (opening, high)),
            ("counterbore", (wide, high)),
            ("counterbore", (wide, layout.under)),
        ],
    )


def plug_meridian(scene: ResolvedDesign, layout: Layout) -> Meridian:
    """The plug that closes the opening; it carries a port that points backwards."""
    assert isinstance(scene.seat, OnePiece)
    seat, body = scene.seat, plug_radius(scene, layout)
    wide, high = body + seat.shoulder_width, layout.under + seat.shoulder_thickness
    faces: TracedPath = [
        ("plug underside", (wide, layout.under)),
        (PLUG_SHOULDER, (wide, high)),
        (PLUG_SHOULDER, (body, high)),
        ("plug", (body, 0.0)),
    ]
    if layout.port_axis is not None:
        neck, step = plug_neck(scene, layout)
        relief: TracedPath = [
            ("plug", (body, step)),
            ("neck", (neck, step)),
            ("neck", (neck, 0.0)),
            ("plug top", (0.0, 0.0)),
        ]
        return trace((0.0, layout.under), [*faces[:-1], *relief])
    start, port = outward(layout)
    return trace(start, [*port, *faces, ("plug top", (layout.channel_radius, 0.0)), *inward(layout)])


def plug_radius(scene: ResolvedDesign, layout: Layout) -> float:
    """Radius of the plug: the opening less the fit of two bodies of one machine."""
    return layout.opening_radius - scene.fit_clearance


def plug_neck(scene: ResolvedDesign, layout: Layout) -> tuple[float, float]:
    """Radius of a plug in front of a side port, and the height from which it is that thin.

    The gap is as wide as the port's passage is in radius where the plug keeps a printable neck, so that a plug out of
    the middle does not close it.
    """
    assert layout.port_axis is not None
    least = scene.connector_printer.smallest.wall("rigid").recommended
    gap = max(scene.fit_clearance, min(layout.port.passage, layout.opening_radius - least))
    return layout.opening_radius - gap, layout.port_axis - layout.port.passage - _UNDER_PORT


def ring_meridian(seat: ClampedFlange, layout: Layout) -> Meridian:
    """The clamping ring as it rests on the flange before the screws take up the squeeze.

    It opens upwards at 45 degrees, so that the dome is free to bulge.
    """
    inner, high = layout.ring_inner, seat.ring_thickness
    skirt = layout.plate_high + seat.squeeze * layout.flange_thickness
    return trace(
        (inner, 0.0),
        [
            ("clamp face", (layout.groove_outer, 0.0)),
            ("skirt inside", (layout.groove_outer, skirt)),
            ("skirt", (layout.ring_radius, skirt)),
            ("ring", (layout.ring_radius, high)),
            ("ring top", (inner + high, high)),
            ("ring cone", (inner, 0.0)),
        ],
    )
