"""Layout of the sensor: the radii and heights that the bodies and the drawing share, and the membrane in it.

The base plane is z = 0 and the dome points up. The membrane's rim continues below the base plane as a
flange, which the seat holds, so the dome is clamped at z = 0.

    membrane          ___
                   .-'   '-.            outer wall  R0 + t0
                  /  .---.  \\           inner wall  R0
    z = 0   ..---|  |     |  |---..     ring | flange | spigot with the channel
            |____|__|_   _|__|____|     mounting plate, its underside at plate_low
                    | | | |             port: behind, or out of the plate's side
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from pneutouch.catalogue import ResolvedDesign
from pneutouch.parts.port import PortShape, port_shape
from pneutouch.shape.dome import DomeShape
from pneutouch.spec.part import BoltCircle, CastRing, ClampedFlange, OnePiece, RobotFlange, Sleeve

if TYPE_CHECKING:
    from pneutouch.parts.cast_ring import RingSize

# The ring is imported only for a flange that is cast around one.

HEAD_GAP = 0.5
"""Space in mm around a screw head, for the driver."""

CLAMPED_SHARE = 0.5
"""Share of the flange's width that a ring presses on; the rest leaves the dome space to bulge."""

_SPIGOT = 1.0
"""Least height in mm of the spigot behind a flat wall, so that it centres the flange: own choice."""

_UNDER_PORT = 0.3
"""Distance in mm below the passage of a side port at which the plug becomes thinner."""


@dataclass(frozen=True, slots=True)
class Layout:
    """Radii and heights of the sensor, in mm. Heights are z coordinates.

    ``under`` is the rearmost face around the axis: ``plate_low``, or lower if the mount has a boss there.
    ``opening_radius`` is the radius of the hole that a plug closes, 0 without a plug. ``port_axis`` is the height of a
    side port, None for a port at the rear. ``flange_draft`` is by how much both sides of a cast flange are wider at its
    underside than at the base plane. ``ring`` is the ring that the flange is cast around, None without one. ``gasket``
    is the thickness of a gasket under the flange, 0 without one.
    """

    shape: DomeShape
    flange_width: float
    flange_thickness: float
    clearance: float
    ring_radius: float
    plate_radius: float
    plate_high: float
    plate_low: float
    under: float
    bolt_circle_radius: float
    channel_radius: float
    opening_radius: float
    port: PortShape
    port_axis: float | None
    flange_draft: float = 0.0
    ring: "RingSize | None" = None
    gasket: float = 0.0

    @property
    def inner_radius(self) -> float:
        """Inner radius of the dome at the base plane."""
        return self.shape.inner_radius

    @property
    def wall(self) -> float:
        """Wall thickness of the dome."""
        return self.shape.wall_thickness

    @property
    def outer_radius(self) -> float:
        """Outer radius of the dome at the base plane."""
        return self.shape.outer_radius

    @property
    def floor(self) -> float:
        """Height of the connector's top inside the dome."""
        return self.shape.floor

    @property
    def flange_radius(self) -> float:
        """Outer radius of the flange."""
        return self.outer_radius + self.flange_width

    @property
    def held_radius(self) -> float:
        """Outer radius of the part that the seat holds: the flange, or the collar of the ring inside a cast flange."""
        return self.flange_radius if self.ring is None else self.ring.collar_radius

    @property
    def groove_inner(self) -> float:
        """Radius of the spigot, which supports the rim from inside."""
        return self.inner_radius - self.clearance

    @property
    def groove_outer(self) -> float:
        """Radius of the wall that supports the flange, or its collar, from outside."""
        return self.held_radius + self.clearance

    @property
    def ring_inner(self) -> float:
        """Inner radius of a clamping ring at the base plane."""
        return self.flange_radius - CLAMPED_SHARE * self.flange_width

    @property
    def screw_circle(self) -> float:
        """Radius of the screw circle of a clamping ring; meaningless without such a ring."""
        return 0.5 * (self.groove_outer + self.ring_radius)

    @property
    def channel_low(self) -> float:
        """Height of the bottom of the channel that the passage of a side port opens into; for a side port only."""
        assert self.port_axis is not None
        return self.port_axis - self.port.passage - 0.5


def lay_out(scene: ResolvedDesign) -> Layout:
    """Derive the layout of a scene from membrane, seat, mount, port and fits; `check_space` checks whether it fits."""
    return lay_out_dome(scene, port_shape(scene.port, scene.tube, scene.hole_undersize), scene.design.membrane.dome)


def lay_out_dome(scene: ResolvedDesign, port: PortShape, shape: DomeShape) -> Layout:
    """The layout of a scene around a dome of another shape or size."""
    seat, mount = scene.seat, scene.mount
    flange, deep = _flange(scene, shape)
    clearance, edge = 0.0 if isinstance(seat, OnePiece) else scene.fit_clearance, shape.outer_radius + flange
    inside = None
    if isinstance(seat, CastRing):
        from pneutouch.parts.cast_ring import ring_size

        inside = ring_size(scene, seat, edge, deep)
    groove = (edge if inside is None else inside.collar_radius) + clearance
    ring = _ring_radius(scene, groove, flange)
    bolts = _bolt_circle(scene, ring)
    thickness = _plate_thickness(scene, port)
    gasket = seat.gasket_thickness if isinstance(seat, ClampedFlange) else 0.0
    low = -deep - gasket - thickness
    side = mount.port_side == "side"
    # The sides of a cast flange widen over its thickness; printed ones are upright.
    draft = math.radians(scene.design.mould.draft_deg) if scene.printer.is_casting else 0.0
    # Greater than a passage that crosses it: two equal cylinders meet in a point.
    passage = port.passage + (0.25 if side else 0.0)
    return Layout(
        shape=shape,
        flange_width=flange,
        flange_thickness=deep,
        clearance=clearance,
        ring_radius=ring,
        plate_radius=_plate_radius(scene, ring, bolts),
        plate_high=-deep - gasket,
        plate_low=low,
        under=low - mount.boss_height if isinstance(mount, RobotFlange) else low,
        bolt_circle_radius=bolts,
        channel_radius=max(0.5 * seat.channel_diameter_mm, passage),
        opening_radius=shape.inner_radius - seat.lip_wall_mm if isinstance(seat, OnePiece) else 0.0,
        port=port,
        port_axis=low + _port_height(scene, port) if side else None,
        flange_draft=deep * math.tan(draft),
        ring=inside,
        gasket=gasket,
    )


def _flange(scene: ResolvedDesign, shape: DomeShape) -> tuple[float, float]:
    """Width and thickness of the flange: one length for both, or those of the web of a ring and silicone around it. A
    wall that leans at its rim has the thickness that leaves a spigot behind it."""
    seat, web = scene.seat, scene.design.cast_ring
    least = max(seat.least_flange_mm, seat.flange_over_wall * shape.wall_thickness)
    deep = max(least, _SPIGOT - shape.floor) if shape.floor < 0.0 else least
    if not isinstance(seat, CastRing):
        return least, deep
    return max(least, web.width_mm + seat.lip_mm), max(deep, web.thickness_mm + 2 * seat.lip_mm)


def _ring_radius(scene: ResolvedDesign, groove: float, flange: float) -> float:
    """Outer radius of the rigid ring around the flange; that of a clamping ring leaves a flat face for screw heads."""
    seat = scene.seat
    if isinstance(seat, ClampedFlange):
        least = scene.connector_printer.smallest.wall("rigid").recommended
        hole = 0.5 * (max(seat.clearance_diameter, seat.core_diameter) + scene.hole_undersize) + least
        cone = groove - scene.fit_clearance - CLAMPED_SHARE * flange + seat.ring_thickness
        head = 0.5 * seat.head_diameter
        return groove + 2 * max(seat.ring_wall_mm, head + HEAD_GAP, hole, cone + head - groove)
    return groove + seat.ring_wall_mm


def _bolt_circle(scene: ResolvedDesign, ring: float) -> float:
    """Radius of the circle of mounting holes, 0 without one; in a bolt circle half of a whole diameter in mm."""
    mount = scene.mount
    if isinstance(mount, RobotFlange):
        return 0.5 * mount.pitch_diameter
    if not isinstance(mount, BoltCircle):
        return 0.0
    if mount.family != "blind":
        return 0.5 * math.ceil(2 * (ring + mount.head_diameter / 2 + HEAD_GAP))
    return 0.5 * math.floor(2 * (ring - 1.5 * mount.hole_diameter))


def _plate_radius(scene: ResolvedDesign, ring: float, bolts: float) -> float:
    mount = scene.mount
    if isinstance(mount, RobotFlange):
        return max(ring, 0.5 * mount.plate_diameter)
    if isinstance(mount, Sleeve):
        return max(ring, finger_radius(scene) + mount.sleeve_wall)
    if isinstance(mount, BoltCircle) and mount.family != "blind":
        least = scene.connector_printer.smallest.wall("rigid").recommended
        hole = 0.5 * (mount.hole_diameter + scene.hole_undersize) + least
        return bolts + max(mount.head_diameter / 2 + HEAD_GAP, hole)
    return ring


def finger_radius(scene: ResolvedDesign) -> float:
    """Inner radius of a sleeve: that of the finger plus allowances for printed holes."""
    assert isinstance(scene.mount, Sleeve)
    return 0.5 * (scene.mount.finger_diameter + scene.hole_undersize) + scene.connector_printer.accuracy_mm.nominal


def _plate_thickness(scene: ResolvedDesign, port: PortShape) -> float:
    """Thickness of the plate: at least the mount's; thicker for two blind holes, a plug's shoulder or a side port."""
    seat, mount = scene.seat, scene.mount
    depth = (mount.hole_depth or 0.0) if isinstance(mount, BoltCircle) and mount.family == "blind" else 0.0
    needs, floor = [mount.plate_thickness], scene.connector_printer.smallest.wall("rigid").recommended
    if isinstance(seat, ClampedFlange):
        needs.append(seat.core_depth + depth + floor)
    if isinstance(seat, OnePiece):
        needs.append(seat.shoulder_thickness + floor)
    if mount.port_side == "side":
        needs.append(_port_height(scene, port) + port.root + 0.5)
    inside = -port.hollow[-1][1]
    if mount.port_side == "rear" and inside > 0:
        needs.append(inside + floor)
    return max(needs)


def _port_height(scene: ResolvedDesign, port: PortShape) -> float:
    """Height of a side port's axis above the plate's underside, so that its root stays within the plate's edge."""
    low = port.root + 0.5
    if isinstance(scene.seat, OnePiece):
        low = max(
            low,
            scene.seat.shoulder_thickness + port.passage + scene.connector_printer.smallest.wall("rigid").recommended,
        )
    return low


def plug_radius(scene: ResolvedDesign, layout: Layout) -> float:
    """Radius of the plug: the opening minus the fit clearance of two bodies from one machine."""
    return layout.opening_radius - scene.fit_clearance


def plug_neck(scene: ResolvedDesign, layout: Layout) -> tuple[float, float]:
    """Radius of a plug's neck in front of a side port, and the height from which the plug is that thin.

    The gap is as wide as the radius of the port's passage if that leaves a printable neck, so that an eccentric plug
    does not close it.
    """
    assert layout.port_axis is not None
    least = scene.connector_printer.smallest.wall("rigid").recommended
    gap = max(scene.fit_clearance, min(layout.port.passage, layout.opening_radius - least))
    return layout.opening_radius - gap, layout.port_axis - layout.port.passage - _UNDER_PORT
