"""Ports: the shape of each family along its own axis, and the hollow that remains with a fitting in place.

A port is drawn in (radius, height over the plate's face): heights increase away from the plate; below 0 the hollow
continues inside the plate.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from pneutouch.shape.meridian import Arc, Line, Point
from pneutouch.spec.part import Barb, Luer, ORingStub, Port, PushIn, Thread, Tube

if TYPE_CHECKING:
    from pneutouch.body import Prism

CHANNEL = "channel"
"""Tag of the connector's faces that touch the gas."""

TIP_WALL = 0.3
"""Wall thickness in mm left at the tip of a barb: a blunt edge that prints and does not cut the tube."""

_LUG_ROOT = 0.2
"""Depth in mm by which a lug extends into the body, so that the two are joined."""


@dataclass(frozen=True, slots=True)
class PortShape:
    """Shape of a port, mm.

    Attributes:
        outside: End point and tag of each face, from the mouth's inner edge over the outside to the root at height 0.
        hollow: Points from the inner edge of the mouth inwards; the passage begins at the last one.
        length: Height of the mouth.
        engaged: Depth to which a fitting or tube fills the hollow, measured from the mouth.
        fitting_bore: Radius of the bore of that fitting or tube.
        lugs: Prisms joined to the outside, in the frame of the port.
        lug_volume: Volume added by the lugs, mm3.
    """

    outside: tuple[tuple[Point, str], ...]
    hollow: tuple[Point, ...]
    length: float
    engaged: float = 0.0
    fitting_bore: float = 0.0
    lugs: "tuple[Prism, ...]" = ()
    lug_volume: float = 0.0

    @property
    def root(self) -> float:
        """Outer radius of the port at the plate."""
        return self.outside[-1][0][0]

    @property
    def reach(self) -> float:
        """Greatest radius of the port, lugs included."""
        lugs = [piece.bounds()[1] for lug in self.lugs for piece in lug.outline]
        return max([point[0] for point, _ in self.outside] + lugs)

    @property
    def passage(self) -> float:
        """Radius of the bore behind the port."""
        return self.hollow[-1][0]

    def hollow_volume(self, bottom: float) -> float:
        """Volume in mm3 of the hollow from the mouth down to height ``bottom``."""
        points = [*self.hollow, (self.passage, bottom)]
        return sum(-Line(a, b, "").swept() for a, b in pairwise(points))

    def filled_volume(self) -> float:
        """Volume in mm3 of the hollow that a fitting or tube fills, without its own bore."""
        if not self.engaged:
            return 0.0
        end = self.length - self.engaged
        inside = [point for point in self.hollow if point[1] >= end - 1e-9]
        if inside[-1][1] > end + 1e-9:
            after = self.hollow[len(inside)]
            share = (inside[-1][1] - end) / (inside[-1][1] - after[1])
            inside.append((inside[-1][0] + share * (after[0] - inside[-1][0]), end))
        whole = sum(-Line(a, b, "").swept() for a, b in pairwise(inside))
        return whole - math.pi * self.fitting_bore**2 * self.engaged


def port_shape(port: Port, tube: Tube, undersize: float) -> PortShape:
    """The shape of a port for ``tube``; sockets are widened by the printer's ``undersize`` of holes (diameter, mm)."""
    return _FAMILIES[port.family](port, tube, undersize)


def _barb(port: Barb, tube: Tube, undersize: float) -> PortShape:
    stem, barb, bore = (0.5 * d for d in (port.stem_diameter, port.barb_diameter, port.bore_diameter))
    length = port.stem_length + port.barb_length
    # The tip must enter the tube and keep a wall around the bore.
    tip = max(0.5 * tube.inner_diameter, bore + TIP_WALL)
    outside = (
        ((tip, length), "port mouth"),
        ((barb, port.stem_length), "barb"),
        ((stem, port.stem_length), "barb shoulder"),
        ((stem, 0.0), "stem"),
    )
    return PortShape(outside, ((bore, length), (bore, 0.0)), length)


def _thread(port: Thread, tube: Tube, undersize: float) -> PortShape:
    core, chamfer = 0.5 * (port.core_diameter + undersize), 0.5 * port.chamfer_diameter
    face, passage, length = 0.5 * port.face_diameter, 0.5 * port.passage_diameter, port.boss_length
    bottom = length - port.depth
    chamfer = max(chamfer, core + 0.1)
    hollow = [(chamfer, length), (core, length - (chamfer - core)), (core, bottom), (passage, bottom)]
    outside = (((face, length), "port face"), ((face, 0.0), "boss"))
    return PortShape(outside, _to_plate(hollow), length, port.fitting_engagement, 0.5 * port.fitting_bore_diameter)


def _luer(port: Luer, tube: Tube, undersize: float) -> PortShape:
    opening, passage, length = 0.5 * (port.opening_diameter + undersize), 0.5 * port.passage_diameter, port.boss_length
    bottom = length - port.depth
    hollow = [(opening, length), (opening - 0.5 * port.taper * port.depth, bottom), (passage, bottom)]
    body = 0.5 * port.body_diameter
    lugs = tuple(_lug(port, turn) for turn in (0.0, math.pi))
    angle = math.radians(port.lug_angle_deg)
    added = 2 * 0.5 * angle * ((0.5 * port.lug_diameter) ** 2 - body**2) * port.lug_thickness
    return PortShape(
        (((body, length), "port mouth"), ((body, 0.0), "boss")),
        _to_plate(hollow),
        length,
        port.fitting_engagement,
        0.5 * port.fitting_bore_diameter,
        lugs,
        added,
    )


def _lug(port: Luer, turn: float) -> "Prism":
    """A sector of a ring below the mouth, centred on the angle ``turn`` (rad)."""
    from pneutouch.body import Prism

    outer, inner = 0.5 * port.lug_diameter, 0.5 * port.body_diameter - _LUG_ROOT
    half = math.radians(0.5 * port.lug_angle_deg)
    over, under = Arc((0, 0), outer, turn - half, turn + half, "lug"), Arc((0, 0), inner, turn + half, turn - half, "")
    outline = (over, Line(over.end, under.start, "lug"), under, Line(under.end, over.start, "lug"))
    return Prism(outline, port.boss_length - port.lug_thickness, port.boss_length)


def _push_in(port: PushIn, tube: Tube, undersize: float) -> PortShape:
    socket, passage, length = 0.5 * (tube.outer_diameter + undersize), 0.5 * tube.inner_diameter, port.boss_length
    hollow = [(socket, length), (socket, length - port.depth), (passage, length - port.depth)]
    outside = (((socket + port.wall, length), "port mouth"), ((socket + port.wall, 0.0), "boss"))
    return PortShape(outside, _to_plate(hollow), length, port.depth, passage)


def _o_ring(port: ORingStub, tube: Tube, undersize: float) -> PortShape:
    stub, floor, passage, length = (
        0.5 * port.stub_diameter,
        0.5 * port.groove_diameter,
        0.5 * port.passage_diameter,
        port.stub_length,
    )
    front = length - port.tip_length
    back, slope = front - port.groove_width, 0.5 * port.tip_length
    outside = (
        ((stub - slope, length), "port mouth"),
        ((stub, length - slope), "tip"),
        ((stub, front), "stub"),
        ((floor, front), "groove"),
        ((floor, back), "groove"),
        ((stub, back), "groove"),
        ((stub, 0.0), "stub"),
    )
    return PortShape(outside, ((passage, length), (passage, 0.0)), length)


def _to_plate(hollow: list[Point]) -> tuple[Point, ...]:
    """Hollow with its passage extended to the plate's face if it ends above the face."""
    radius, height = hollow[-1]
    return (*hollow, (radius, 0.0)) if height > 0 else tuple(hollow)


_FAMILIES: dict[str, Callable[..., PortShape]] = {
    "barb": _barb,
    "thread": _thread,
    "luer": _luer,
    "push-in": _push_in,
    "o-ring": _o_ring,
}
