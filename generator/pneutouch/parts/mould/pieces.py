"""The parts of a mould as exact solids: cap, ring, core and base; ring and core are those of one cavity."""

import math

from pneutouch.body import Bore, Feature, Frame, Prism, Solid, Turned
from pneutouch.parts.cast_ring import RingSize
from pneutouch.parts.membrane import around_ring
from pneutouch.parts.mould.size import (
    CORNER,
    FILLET,
    LAND,
    SCREW,
    SHOULDER,
    TAPER,
    VENT_PITCH,
    CavityFaces,
    MouldShape,
    MouldSize,
)
from pneutouch.shape.meridian import Arc, Line, Meridian, Point, Segment, TracedPath, trace
from pneutouch.spec.material import Material

LEAST_GATES = 4
"""Least number of pour channels and vents together, always even: one pour channel, a vent opposite and two beside."""

_RIM = 0.5
"""Distance in mm between a channel and the edge of the window: own choice."""

CLIP_LEDGE = 8.0
"""Width in mm of the ledges for clips: own choice."""


def lay_out_mould(membrane: Meridian, shape: MouldShape, insert: RingSize | None = None) -> MouldSize:
    """Sizes of the mould of a membrane, with or without a ring inside; `assembly.check_mould_space` checks them."""
    faces = CavityFaces.of(membrane, shape.factor)
    if insert is not None:
        cured = CavityFaces.of(membrane, 1.0)
        faces = faces.keeping(cured.underside, cured.edge)
    flange, foot = -faces.underside.start[1], shape.wall
    middle = 0.5 * (faces.rim.end[0] + faces.edge.start[0])
    neck = 0.5 * shape.sprue_diameter - 0.5 * foot * math.tan(shape.draft)
    mouth = neck + 0.5 * foot
    window = middle + max(mouth, 0.5 * shape.vent_diameter) + _RIM
    deep = math.tan(TAPER)
    # At z = 0 the cap's seat needs a land and its fillet; at the foot's underside it needs the base's shoulder.
    turn = FILLET / math.tan(0.5 * (0.5 * math.pi + TAPER))
    around = insert.collar_radius + shape.clearance if insert is not None else 0.0
    at_base = max(faces.edge.end[0], around) + LAND + turn
    at_underside = max(faces.edge.start[0], around) + LAND + shape.clearance - flange * deep
    under_foot = window + SHOULDER + shape.clearance - (flange + foot) * deep
    seat = max(at_base, at_underside, under_foot)
    widest = seat + (flange + foot) * deep
    margin, pitch = 0.0, 2 * widest + shape.wall
    if shape.fastener == "screws":
        margin = SCREW.margin(shape.hole_undersize)
        # A screw stands between four cavities.
        pitch = max(pitch, math.sqrt(2) * (widest + margin))
    columns = math.ceil(math.sqrt(shape.cavities))
    return MouldSize(
        shape=shape,
        faces=faces,
        foot=foot,
        seat_radius=seat,
        channel_radius=middle,
        gates=max(LEAST_GATES, 2 * math.ceil(math.pi * middle / VENT_PITCH)),
        neck=neck,
        mouth=mouth,
        window=window,
        pitch=pitch,
        columns=columns,
        rows=math.ceil(shape.cavities / columns),
        margin=margin,
        insert=insert,
    )


ROLE = "mould"
"""Role of all parts of a mould."""

LEDGE_HEIGHT = 6.0
"""Height in mm of the ledges for clips: own choice."""

_PAST = 1.0
"""Distance in mm by which a tool reaches past an open face, so that no two faces coincide."""

_HANDLE_DEPTH = 8.0
"""Depth in mm of the screw hole by which the core is pulled out: own choice."""


def mould_solids(size: MouldSize, material: Material) -> tuple[Solid, ...]:
    """Cap, ring, core and base; ring and core of the first cavity."""
    return cap(size, material), ring(size, material), core(size, material), base(size, material)


def cap(size: MouldSize, material: Material) -> Solid:
    """The plate that forms outer wall and flange's top of the membranes, with a pocket for each cavity."""
    low, high = size.cap_low, size.cap_high
    pocket, net = pocket_meridian(size, _PAST), pocket_meridian(size, 0.0).volume()
    cuts = tuple(Feature(Turned(pocket, Frame((x, y, 0.0))), net) for x, y in size.places)
    adds: tuple[Feature, ...] = ()
    body = Prism(plate(size), low, high)
    if size.shape.fastener == "clips":
        body = Prism(plate(size, CLIP_LEDGE), low, low + LEDGE_HEIGHT)
        block = Prism(plate(size), low, high)
        adds = (Feature(block, block.area() * (high - low - LEDGE_HEIGHT)),)
    depth = min(SCREW.depth, high - low - 1.0)
    radius = 0.5 * (SCREW.core_diameter + size.shape.hole_undersize)
    bores = tuple(Bore(x, y, radius, low, low + depth, closed="high") for x, y in screw_places(size))
    return Solid("mould-cap", ROLE, material, body, bores, adds, cuts)


def ring(size: MouldSize, material: Material) -> Solid:
    """Ring that forms the flange's edge, or holds the collar that does, between the cap's face and the core's foot."""
    edge, low, clearance = size.bore, size.low, size.shape.clearance
    rounding = FILLET + clearance
    corner = _corner(size.seat_radius - clearance, rounding)
    wide = size.seat(low) - clearance
    return Solid(
        "mould-ring",
        ROLE,
        material,
        Meridian(
            (
                Line(edge.start, (wide, low), "underside"),
                Line((wide, low), corner.start, "cone"),
                corner,
                Line(corner.end, edge.end, "top"),
                Line(edge.end, edge.start, "edge"),
            )
        ),
    )


def core(size: MouldSize, material: Material) -> Solid:
    """Core that forms the inner wall, the rim inside the flange and, with its foot, the flange's underside."""
    faces, low, bottom, clearance = size.faces, size.low, size.foot_low, size.shape.clearance
    rim = faces.rim
    outline: tuple[Segment, ...] = (
        Line((0.0, bottom), (size.seat(bottom) - clearance, bottom), "foot underside"),
        Line((size.seat(bottom) - clearance, bottom), (size.seat(low) - clearance, low), "cone"),
        Line((size.seat(low) - clearance, low), rim.end, "foot"),
        Line(rim.end, rim.start, "rim"),
        *(piece.reverse() for piece in reversed(faces.inner)),
    )
    drills = zip(channels(size, _PAST), channels(size), strict=True)
    cuts = tuple(Feature(drill, filled.volume()) for drill, filled in drills)
    return Solid("mould-core", ROLE, material, Meridian(outline), _handle(size), cuts=cuts)


def base(size: MouldSize, material: Material) -> Solid:
    """The plate that presses on the feet of the cores; overflowing silicone collects in its windows."""
    low, high = size.base_low, size.foot_low
    ledge = CLIP_LEDGE if size.shape.fastener == "clips" else 0.0
    radius = 0.5 * (SCREW.clearance_diameter + size.shape.hole_undersize)
    windows = [Bore(x, y, size.window, low, high) for x, y in size.places]
    screws = [Bore(x, y, radius, low, high) for x, y in screw_places(size)]
    return Solid("mould-base", ROLE, material, Prism(plate(size, ledge), low, high), (*windows, *screws))


def pocket_meridian(size: MouldSize, past: float) -> Meridian:
    """Meridian of the pocket cut from the cap for one cavity, from ``past`` mm below the cap's lower face upwards."""
    faces, low = size.faces, size.cap_low - past
    corner = _corner(size.seat_radius, FILLET)
    return Meridian(
        (
            Line((0.0, low), (size.seat(low), low), "mouth"),
            Line((size.seat(low), low), corner.start, "cone"),
            corner,
            Line(corner.end, faces.top.end, "face"),
            *faces.outer,
        )
    )


def channels(size: MouldSize, past: float = 0.0) -> tuple[Turned, ...]:
    """The pour channel with its funnel, first, and the vents, as solids to cut; they widen towards the cavity.

    They extend ``past`` mm beyond the faces of the foot.
    """
    radius, foot, flange = size.channel_radius, size.foot_low - past, size.low + past
    # A 45 degree funnel, the neck, then up to the flange.
    gate = _taper(size, 0.5 * size.shape.sprue_diameter, flange)
    sprue = _cones([(size.mouth + past, foot), (size.neck, size.neck_height), gate])
    vent = _cones([_taper(size, 0.5 * size.shape.vent_diameter, z) for z in (foot, flange)])
    return tuple(
        Turned(vent if k else sprue, Frame((radius * math.cos(angle), radius * math.sin(angle), 0.0)))
        for k, angle in enumerate(size.gate_angles)
    )


def _taper(size: MouldSize, radius: float, z: float) -> Point:
    """Point of a channel's wall at height z; the wall has ``radius`` at the flange and widens upwards by the draft."""
    return radius + (z - size.low) * math.tan(size.shape.draft), z


def _cones(points: list[Point]) -> Meridian:
    """Solid of revolution through points of its wall, from the lowest up."""
    path: TracedPath = [("channel", point) for point in points]
    return trace((0.0, points[0][1]), [*path, ("channel", (0.0, points[-1][1]))])


def silicone(size: MouldSize, material: Material) -> Solid:
    """Solid of the silicone in the first cavity."""
    outline = size.faces.meridian
    if size.insert is not None:
        return around_ring(size.insert, "silicone", material, outline)
    return Solid("silicone", "membrane", material, outline)


def screw_places(size: MouldSize) -> tuple[tuple[float, float], ...]:
    """Positions of the screws: between the cavities, at every corner of the plates and at every second place inside."""
    if size.shape.fastener != "screws":
        return ()
    columns, rows, half = size.columns, size.rows, 0.5 * size.pitch
    corners = {(0, 0), (columns, 0), (0, rows), (columns, rows)}
    return tuple(
        (size.pitch * i - half, size.pitch * j - half)
        for j in range(rows + 1)
        for i in range(columns + 1)
        if (i + j) % 2 == 0 or (i, j) in corners
    )


def plate(size: MouldSize, ledge: float = 0.0) -> tuple[Segment, ...]:
    """Outline of cap and base: a rectangle with rounded corners, ``ledge`` mm longer at both ends along x."""
    half = 0.5 * size.pitch + size.margin
    low = (-half - ledge, -half)
    high = (size.pitch * (size.columns - 1) + half + ledge, size.pitch * (size.rows - 1) + half)
    return _rounded(low, high, CORNER)


def _rounded(low: Point, high: Point, radius: float) -> tuple[Segment, ...]:
    """Rectangle with rounded corners, counter-clockwise."""
    (x0, y0), (x1, y1), right = low, high, 0.5 * math.pi
    centres = [(x1 - radius, y0 + radius), (x1 - radius, y1 - radius), (x0 + radius, y1 - radius)]
    centres.append((x0 + radius, y0 + radius))
    arcs = [Arc(centre, radius, (k - 1) * right, k * right, "corner") for k, centre in enumerate(centres)]
    pieces: list[Segment] = []
    for k, arc in enumerate(arcs):
        pieces += [arc, Line(arc.end, arcs[(k + 1) % 4].start, "side")]
    return tuple(pieces)


def _corner(radius: float, fillet: float) -> Arc:
    """Fillet between the face z = 0 and a cone that has ``radius`` there and opens downwards at `TAPER`."""
    along = fillet / math.tan(0.5 * (0.5 * math.pi + TAPER))
    return Arc((radius - along, -fillet), fillet, TAPER, 0.5 * math.pi, "fillet")


def _handle(size: MouldSize) -> tuple[Bore, ...]:
    """Blind hole in the foot for a screw by which the core is pulled out; none if the core is too small."""
    radius = 0.5 * (SCREW.core_diameter + size.shape.hole_undersize)
    if size.faces.rim.start[0] < 3 * radius:
        return ()
    return (Bore(0.0, 0.0, radius, size.foot_low, size.foot_low + min(_HANDLE_DEPTH, size.foot), closed="high"),)
