"""The ring that a flange is cast around: a perforated web in the middle of the flange, and a collar around it.

The collar is as high as the flange and forms its edge: it stands between cap and core of the mould, which hold it
without a further part, and it fills the connector's groove as a glued flange does, rigid on rigid.

    z = 0      _______________________
              | silicone      |       |
              |   ________o o_|       |
    web       |  |________o_o_| collar|      o o: a hole, silicone goes through
              |               |       |
    underside |_______________|_______|
"""

import math
from dataclasses import dataclass

from pneutouch.body import Bore, Solid
from pneutouch.catalogue import ResolvedDesign
from pneutouch.errors import InputError
from pneutouch.shape.meridian import trace
from pneutouch.spec.material import Material
from pneutouch.spec.part import CastRing

RING = "ring"
"""Name and role of the ring among the bodies of a sensor."""

FEWEST_HOLES = 3
"""Least number of holes of a ring."""

_COLLAR_GAP = 0.2
"""Material of the web in mm between a hole and the collar, which serves as wall on that side: own choice."""


@dataclass(frozen=True, slots=True)
class RingSize:
    """Sizes of the ring, mm; heights are z coordinates. The web lies between ``web_low`` and ``web_high``."""

    web_inner: float
    flange_radius: float
    collar_radius: float
    low: float
    web_low: float
    web_high: float
    hole_radius: float
    hole_count: int

    @property
    def hole_circle(self) -> float:
        """Radius of the circle on which the holes lie, next to the collar."""
        return self.flange_radius - _COLLAR_GAP - self.hole_radius

    @property
    def rim(self) -> float:
        """Width of the web between its inner edge and the holes."""
        return self.hole_circle - self.hole_radius - self.web_inner

    @property
    def bridge(self) -> float:
        """Width of the web between two holes."""
        return 2 * self.hole_circle * math.sin(math.pi / self.hole_count) - 2 * self.hole_radius

    def holes(self) -> tuple[Bore, ...]:
        """Holes of the web; the x axis lies between two of them, so that a section shows the whole web."""
        angles = [2 * math.pi * (k + 0.5) / self.hole_count for k in range(self.hole_count)]
        at = [(self.hole_circle * math.cos(angle), self.hole_circle * math.sin(angle)) for angle in angles]
        return tuple(Bore(x, y, self.hole_radius, self.web_low, self.web_high) for x, y in at)

    @property
    def embedded(self) -> float:
        """Volume in mm3 of the web without its holes, which is missing from the flange's material."""
        web = math.pi * (self.flange_radius**2 - self.web_inner**2) * (self.web_high - self.web_low)
        return web - sum(hole.volume() for hole in self.holes())

    @property
    def foot_area(self) -> float:
        """Area in mm2 of the collar's underside, which stands on the connector."""
        return math.pi * (self.collar_radius**2 - self.flange_radius**2)

    def solid(self, material: Material) -> Solid:
        """The ring as a solid."""
        web, edge, collar = self.web_inner, self.flange_radius, self.collar_radius
        outline = trace(
            (web, self.web_low),
            [
                ("web underside", (edge, self.web_low)),
                ("collar inside", (edge, self.low)),
                ("collar underside", (collar, self.low)),
                ("collar", (collar, 0.0)),
                ("collar top", (edge, 0.0)),
                ("collar inside", (edge, self.web_high)),
                ("web top", (web, self.web_high)),
                ("web inside", (web, self.web_low)),
            ],
        )
        return Solid(RING, RING, material, outline, self.holes())


def ring_size(scene: ResolvedDesign, seat: CastRing, flange_radius: float, flange_thickness: float) -> RingSize:
    """Size of the ring in a scene with these flange sizes, mm; `space.check_space` checks it."""
    stated = scene.design.cast_ring
    radius = 0.5 * (stated.hole_diameter_mm + scene.hole_undersize)
    wall = scene.connector_printer.smallest.wall("rigid").recommended
    circle = flange_radius - _COLLAR_GAP - radius
    # The distance of two holes is their own width, or the wall that the printer makes well.
    pitch = 2 * radius + max(2 * radius, wall)
    count = stated.hole_count or max(FEWEST_HOLES, math.floor(2 * math.pi * circle / pitch))
    return RingSize(
        web_inner=flange_radius - stated.width_mm,
        flange_radius=flange_radius,
        collar_radius=flange_radius + max(seat.collar_wall_mm, wall),
        low=-flange_thickness,
        web_low=-0.5 * (flange_thickness + stated.thickness_mm),
        web_high=-0.5 * (flange_thickness - stated.thickness_mm),
        hole_radius=radius,
        hole_count=count,
    )


def least_bridge(scene: ResolvedDesign) -> float:
    """Least width in mm of rigid material next to a hole: the wall that the connector's printer can make."""
    wall = scene.connector_printer.smallest.wall("rigid")
    return wall.recommended if wall.least is None else wall.least


def check_ring(scene: ResolvedDesign, ring: RingSize) -> None:
    """Raise InputError for a ring whose holes leave less material between or inside them than the printer can make."""
    least, web = least_bridge(scene), scene.design.cast_ring
    if ring.rim < least:
        raise InputError(
            f"the holes leave {max(ring.rim, 0.0):.2f} mm of the ring inside them; the connector's printer makes "
            f"{least:g} mm",
            file=scene.where,
            key="cast_ring.width_mm",
            value=web.width_mm,
            remedy=f"give at least {math.ceil(100 * (web.width_mm + least - ring.rim)) / 100:g}, or smaller holes",
        )
    if ring.bridge < least:
        across = (2 * ring.hole_radius + least) / (2 * ring.hole_circle)
        most = 0 if across >= 1 else math.floor(math.pi / math.asin(across))
        stated = web.hole_count is not None and most >= FEWEST_HOLES
        raise InputError(
            f"{ring.hole_count} holes leave {max(ring.bridge, 0.0):.2f} mm of the ring between them; the connector's "
            f"printer makes {least:g} mm",
            file=scene.where,
            key="cast_ring.hole_count" if stated else "cast_ring.hole_diameter_mm",
            value=web.hole_count if stated else web.hole_diameter_mm,
            remedy=f"give at most {most}, or leave it out" if stated else "give smaller holes",
        )
