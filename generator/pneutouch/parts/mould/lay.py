"""Lengths of the mould from a membrane and the mould's entries in a design."""

import math

from pneutouch.meridian import Meridian
from pneutouch.parts.cast_ring import RingSize
from pneutouch.parts.mould.screws import SCREW
from pneutouch.parts.mould.size import FILLET, LAND, SHOULDER, TAPER, VENT_PITCH, CavityFaces, MouldShape, MouldSize

LEAST_GATES = 4
"""Fewest pour channels and vents together: one pour channel, a vent across and one at each side; always even."""

_RIM = 0.5
"""Space in mm between a channel and the edge of the window: own choice."""

CLIP_LEDGE = 8.0
"""Width in mm of the ledges that clips hold: own choice."""


def lay_out_mould(membrane: Meridian, shape: MouldShape, insert: RingSize | None = None) -> MouldSize:
    """All lengths of the mould of a membrane, cast around a ring or not; `space.check_mould_space` judges them."""
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
    # At z = 0 the cap's seat holds a land and its fillet; at the foot's underside the base's shoulder.
    turn = FILLET / math.tan(0.5 * (0.5 * math.pi + TAPER))
    around = insert.collar_radius + shape.clearance if insert is not None else 0.0
    at_base = max(faces.edge.end[0], around) + LAND + turn
    at_underside = max(faces.edge.start[0], around) + LAND + shape.clearance - flange * deep
    under_foot = window + SHOULDER + shape.clearance - (flange + foot) * deep
    seat = max(at_base, at_underside, under_foot)
    widest = seat + (flange + foot) * deep
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
        pitch=_pitch(widest, shape),
        columns=columns,
        rows=math.ceil(shape.cavities / columns),
        margin=SCREW.margin(shape.hole_undersize) if shape.fastener == "screws" else 0.0,
        insert=insert,
    )


def _pitch(widest: float, shape: MouldShape) -> float:
    """Distance of neighbouring cavities: a wall between them, and space for a screw between four."""
    across = 2 * widest + shape.wall
    if shape.fastener != "screws":
        return across
    return max(across, math.sqrt(2) * (widest + SCREW.margin(shape.hole_undersize)))
