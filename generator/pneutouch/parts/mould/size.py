r"""Layout of a mould: radii, heights and the places of its cavities. Lengths in mm.

The frame is that of the design: z is the axis of the first cavity, and the membrane's base plane is z = 0. It is poured
upside down, with the flange's underside up: air leaves there, and the sensing face has no vent or parting line.

    cap        ______________________
              |      .-------.      |     outer wall and top of the flange
              |    .' .-----. '.    |
    z = 0     |___|__/       \__|___|     parting line 1
    ring      \ ring |  core  | ring /     edge of the flange
              /__________________\        parting line 2: the core's foot forms the flange's underside
    core     /_____|________|_____\       the foot's cone centres the core in the cap
    base     |______| window |______|     presses the foot; its window holds what runs over

Also open moulds of flat coupons: a tray whose top is the plane along which a straight edge strikes off the silicone.

Their walls are upright, without draft, which would change a measured cross-section; a cured coupon of silicone is
peeled out of the open side.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from pneutouch.body import Feature, Prism, Solid, Turned
from pneutouch.parts.cast_ring import RingSize
from pneutouch.shape.dome import INNER_WALL, OUTER_WALL
from pneutouch.shape.meridian import Arc, Line, Meridian, Point, Segment, lines_around
from pneutouch.spec.material import Material

TAPER = math.radians(10.0)
"""Slope of the cones that centre core and ring in the cap: own choice; above about 7 degrees a cone does not jam."""

LAND = 2.5
"""Least width in mm of the flat faces that close on the cavity: own choice."""

FILLET = 1.0
"""Radius in mm of the fillet at the bottom of the cap's seat: own choice."""

PROUD = 0.3
"""Height in mm by which the core's foot protrudes from the cap, so that the base presses on it: our choice."""

SHOULDER = 2.5
"""Width in mm of the contact between base and foot: own choice."""

VENT_PITCH = 15.0
"""Greatest distance in mm between vents along the flange: own choice."""

CORNER = 3.0
"""Radius in mm of the plates' upright edges: own choice."""


@dataclass(frozen=True, slots=True)
class MouldShape:
    """Shape of a mould as designed; lengths in mm, ``draft`` in rad, ``shrinkage`` as a share of the length."""

    cavities: int
    wall: float
    draft: float
    fastener: str
    vent_diameter: float
    sprue_diameter: float
    clearance: float
    shrinkage: float
    hole_undersize: float = 0.0

    @property
    def factor(self) -> float:
        """Ratio of lengths of the mould to those of the cured membrane."""
        return 1.0 / (1.0 - self.shrinkage)


@dataclass(frozen=True, slots=True)
class CavityFaces:
    """Faces of the cavity, named by the place on the membrane, in the order of the membrane's meridian."""

    inner: tuple[Segment, ...]
    rim: Line
    underside: Line
    edge: Line
    top: Line
    outer: tuple[Segment, ...]

    @staticmethod
    def of(membrane: Meridian, factor: float) -> "CavityFaces":
        """Faces of a membrane's meridian, with every length multiplied by ``factor``."""
        whole = Meridian(tuple(scaled(piece, factor) for piece in membrane.pieces))
        inner, outer = (tuple(whole.tagged(tag)) for tag in (INNER_WALL, OUTER_WALL))
        flange = whole.pieces[len(inner) : -len(outer)]
        rim, underside, edge, top = (piece for piece in flange if isinstance(piece, Line))
        return CavityFaces(inner, rim, underside, edge, top, outer)

    def keeping(self, underside: Line, edge: Line) -> "CavityFaces":
        """These faces with another underside and edge of the flange, which keep their heights and outer radii."""
        low = underside.start[1]
        foot = self.rim.end[0], low
        return replace(
            self,
            rim=replace(self.rim, end=foot),
            underside=replace(underside, start=foot),
            edge=edge,
            top=replace(self.top, start=edge.end),
        )

    @property
    def meridian(self) -> Meridian:
        """Outline of the cavity, which is filled by the silicone and by the web of a ring in the flange."""
        return Meridian((*self.inner, self.rim, self.underside, self.edge, self.top, *self.outer))

    @property
    def high(self) -> float:
        """Height of the highest point of the outer face."""
        return max(piece.bounds()[3] for piece in self.outer)

    @property
    def halfway(self) -> tuple[Point, Point]:
        """Points of the inner and the outer face, each half way along its middle piece."""
        pieces = self.inner[(len(self.inner) - 1) // 2], self.outer[len(self.outer) // 2]
        one, other = (piece.along(np.array([0.5]))[0].tolist() for piece in pieces)
        return (one[0], one[1]), (other[0], other[1])


def scaled(piece: Segment, factor: float) -> Segment:
    """Piece of a meridian with every length multiplied by ``factor``, about the origin."""

    def moved(point: Point) -> Point:
        return factor * point[0], factor * point[1]

    if isinstance(piece, Arc):
        return Arc(moved(piece.centre), factor * piece.radius, piece.first, piece.last, piece.tag)
    return Line(moved(piece.start), moved(piece.end), piece.tag)


@dataclass(frozen=True, slots=True)
class MouldSize:
    """All lengths of a mould in mm; heights are z coordinates. ``seat_radius`` is that of the cap's seat at z = 0,
    which opens downwards at `TAPER`; ``foot`` the thickness of the core's foot; ``channel_radius`` that of the circle
    of the ``gates``, pour channel and vents; ``neck`` and ``mouth`` radii of the pour channel; ``window`` that of the
    base's windows. The ``columns`` of cavities along x and ``rows`` along y are ``pitch`` apart, the first cavity at
    the origin; ``margin`` is the plate beyond them. ``insert`` is the ring that the flange is cast around: neither it
    nor its filling shrinks."""

    shape: MouldShape
    faces: CavityFaces
    foot: float
    seat_radius: float
    channel_radius: float
    gates: int
    neck: float
    mouth: float
    window: float
    pitch: float
    columns: int
    rows: int
    margin: float
    insert: RingSize | None = None

    @property
    def cavity_volume(self) -> float:
        """Volume of silicone in one membrane, mm3."""
        return self.faces.meridian.volume() - (0.0 if self.insert is None else self.insert.embedded)

    @property
    def bore(self) -> Line:
        """Inside of the mould's ring, upwards: the flange's edge, or with an insert, a clearance outside its collar."""
        if self.insert is None:
            return self.faces.edge
        radius = self.insert.collar_radius + self.shape.clearance
        return Line((radius, self.low), (radius, 0.0), self.faces.edge.tag)

    @property
    def low(self) -> float:
        """Height of the flange's underside, where the core's foot begins."""
        return self.faces.underside.start[1]

    @property
    def foot_low(self) -> float:
        """Height of the underside of the core's foot, where the base begins."""
        return self.low - self.foot

    @property
    def cap_low(self) -> float:
        """Height of the lower face of the cap."""
        return self.foot_low + PROUD

    @property
    def cap_high(self) -> float:
        """Height of the upper face of the cap."""
        return self.faces.high + self.shape.wall

    @property
    def base_low(self) -> float:
        """Height of the lower face of the base."""
        return self.foot_low - self.shape.wall

    def seat(self, z: float) -> float:
        """Radius of the cap's seat at a height."""
        return self.seat_radius - z * math.tan(TAPER)

    @property
    def neck_height(self) -> float:
        """Height of the pour channel's neck, where the sprue is torn off; below it the funnel opens downwards."""
        return self.low - 0.5 * self.foot

    @property
    def places(self) -> tuple[tuple[float, float], ...]:
        """Positions (x, y) of the axes of the cavities, row by row; the last row may be incomplete."""
        grid = [(self.pitch * i, self.pitch * j) for j in range(self.rows) for i in range(self.columns)]
        return tuple(grid[: self.shape.cavities])

    @property
    def gate_angles(self) -> tuple[float, ...]:
        """Angles in rad of the pour channel, the first, and of the vents around the axis."""
        return tuple(2 * math.pi * k / self.gates for k in range(self.gates))

    @property
    def wall_error(self) -> float:
        """Greatest change in mm of the wall, at the rim, if core and cap are displaced by their whole clearance.

        The core moves sideways by the clearance of its cone; the wall at polar angle t from the axis changes by the
        clearance times sin t: most at the rim, and not at all at the pole.
        """
        return self.shape.clearance


@dataclass(frozen=True, slots=True)
class MouldScrew:
    """A screw, by the diameters of its holes and head and the depth of its hole, mm."""

    name: str
    clearance_diameter: float
    core_diameter: float
    head_diameter: float
    depth: float

    def margin(self, undersize: float) -> float:
        """Material in mm needed around a screw's axis: half of its head or hole, plus a millimetre."""
        return 0.5 * (max(self.head_diameter, self.clearance_diameter) + undersize) + 1.0


SCREW = MouldScrew("M3", clearance_diameter=3.4, core_diameter=2.5, head_diameter=5.5, depth=8.0)
"""Clearance hole: ISO 273, medium series; head: ISO 4762; core: M3 tap drill, also used for thread-forming screws;
depth: own choice, above two diameters."""


WALL, FLOOR = 2.5, 2.5
"""Thickness of the wall around the cavity and of the floor under it, mm: own choice."""

_PAST = 1.0
"""Distance in mm by which the cut reaches past the open top, so that no two faces coincide."""


def open_mould(coupon: Solid, material: Material, factor: float) -> Solid:
    """Mould of a coupon that lies on z = 0 and has the same outline at every height. Raises TypeError for another.

    ``factor`` is the ratio of lengths of the mould to those of the cured coupon. The cavity's floor is at z = 0, the
    strike-off plane above it by the coupon's thickness times ``factor``.
    """
    shape, cavity, tool = coupon.base, _scaled(coupon.base, factor, 0.0), _scaled(coupon.base, factor, _PAST)
    if isinstance(shape, Meridian):
        wide, low, high = shape.bounds()
        x, y = (-wide, wide), (-wide, wide)
    else:
        low, high = shape.low, shape.high
        boxes = [piece.bounds() for piece in shape.outline]
        x = (min(box[0] for box in boxes), max(box[1] for box in boxes))
        y = (min(box[2] for box in boxes), max(box[3] for box in boxes))
    if low != 0.0 or coupon.bores or coupon.adds or coupon.cuts:
        raise TypeError(f"{coupon.name} is no plain body on z = 0: an open mould cannot form it")
    (left, right), (near, far) = ((factor * low - WALL, factor * high + WALL) for low, high in (x, y))
    corners = [(left, near), (right, near), (right, far), (left, far)]
    block = Prism(lines_around(corners, "side"), -FLOOR, factor * high)
    return Solid(f"{coupon.name}-mould", coupon.role, material, block, cuts=(Feature(tool, cavity.volume()),))


def _scaled(shape: Meridian | Prism, factor: float, past: float) -> Turned | Prism:
    """A coupon's shape with lengths times ``factor``, its top raised by ``past`` mm."""
    if isinstance(shape, Prism):
        outline = tuple(scaled(piece, factor) for piece in shape.outline)
        return Prism(outline, factor * shape.low, factor * shape.high + past)
    top = shape.bounds()[2]

    def moved(point: Point) -> Point:
        return factor * point[0], factor * point[1] + (past if point[1] == top else 0.0)

    return Turned(Meridian(tuple(Line(moved(piece.start), moved(piece.end), piece.tag) for piece in shape.pieces)))
