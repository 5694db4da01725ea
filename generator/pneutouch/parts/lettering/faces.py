"""Flat faces that may carry a part mark: away from seals, glue, screw heads and the dome, with solid behind them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from pneutouch.body import Body, Solid
from pneutouch.parts import Assembly
from pneutouch.spec.part import ClampedFlange

_STEP = 0.01
"""Distance in mm from a face at which its section is taken."""

_TURNS = 24
"""Angles round a face at which a label is tried."""

HEIGHTS = (5.0, 4.5, 4.0, 3.5, 3.0)
"""Heights of capitals in mm that are tried; below 3 mm they are not legible."""


@dataclass(frozen=True, slots=True)
class RingFace:
    """A ring of a horizontal face between two radii (mm) at height ``z``; ``mates``: it must lie flat on something."""

    name: str
    z: float
    up: bool
    inner: float
    outer: float
    mates: bool


@dataclass(frozen=True, slots=True)
class LabelPosition:
    """Position of a label: capitals ``height`` mm tall, centred ``radius`` mm from the axis, foot towards the axis."""

    face: RingFace
    height: float
    radius: float
    angle: float


def lettered_faces(assembly: Assembly, solid: Solid) -> list[RingFace]:
    """Faces of a rigid body in the order they are preferred: faces that can be read once mounted come first."""
    layout, seat = assembly.layout, assembly.scene.seat
    if solid.role == "ring":
        # The other ring, that a flange is cast around, is in the mould: its faces close on the cavity.
        if not isinstance(seat, ClampedFlange):
            return []
        return [RingFace("ring top", seat.ring_thickness, True, 0.0, layout.ring_radius, False)]
    if solid.role == "plug":
        return [RingFace("plug underside", layout.under, False, 0.0, layout.plate_radius, True)]
    if solid.role != "connector":
        return []
    faces = [
        RingFace("plate top", layout.plate_high, True, layout.ring_radius, layout.plate_radius, False),
        RingFace("plate underside", layout.plate_low, False, 0.0, layout.plate_radius, True),
    ]
    if layout.under < layout.plate_low:
        faces.append(RingFace("boss face", layout.under, False, 0.0, layout.plate_radius, True))
    return faces


def free_area(face: RingFace, solid: Solid, body: Body, depth: float, edge: float) -> Any:
    """CrossSection of a face that is bare, has ``depth`` mm of solid behind it and lies ``edge`` mm from any edge.

    Around a bore there is space for a screw head, which is less than twice as wide (ISO 4762).
    """
    from manifold3d import CrossSection

    whole, inwards = body.manifold(), -1.0 if face.up else 1.0
    section = whole.slice(face.z + inwards * _STEP) ^ whole.slice(face.z + inwards * depth)
    section -= whole.slice(face.z - inwards * _STEP)
    section = (section ^ CrossSection.circle(face.outer, 180)).offset(-edge)
    if face.inner:
        section -= CrossSection.circle(face.inner + edge, 180)
    heads = [CrossSection.circle(2 * bore.radius, 48).translate((bore.x, bore.y)) for bore in solid.bores]
    return section - CrossSection.compose(heads) if heads else section


def spot(face: RingFace, area: Any, box: tuple[float, float], heights: Sequence[float]) -> LabelPosition | None:
    """The place for the tallest lettering of ``heights`` (mm), or None; ``box`` is width and height at 1 mm."""
    from manifold3d import CrossSection

    if area.is_empty():
        return None
    reach = max(abs(x) for x in area.bounds())
    for height in heights:
        rectangle = CrossSection.square((box[0] * height, box[1] * height), True)
        for radius in _radii(reach, box[1] * height):
            for turn in range(_TURNS if radius else 1):
                position = LabelPosition(face, height, radius, 0.5 * math.pi + 2 * math.pi * turn / _TURNS)
                if (placed(rectangle, position) - area).area() < 1e-9:
                    return position
    return None


def placed(shape: Any, at: LabelPosition) -> Any:
    """A CrossSection drawn about the origin, put on its spot; mirrored on a face that is read from below."""
    turn = math.degrees(at.angle) - 90.0 if at.radius else 0.0
    turned = (shape if at.face.up else shape.mirror((1.0, 0.0))).rotate(turn)
    return turned.translate((at.radius * math.cos(at.angle), at.radius * math.sin(at.angle)))


def _radii(reach: float, height: float) -> list[float]:
    """Distances from the axis that are tried: from the rim inwards by a quarter millimetre, then the middle."""
    outermost = reach - 0.5 * height
    count = max(0, int((outermost - 0.5 * height) / 0.25) + 1)
    return [*(outermost - 0.25 * k for k in range(count)), 0.0]
