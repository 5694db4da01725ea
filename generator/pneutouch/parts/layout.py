"""Where everything lies: the radii and heights that membrane, connector and drawing share.

The base plane is z = 0 and the dome points up. The membrane's rim goes on below the base plane as a
flange; the connector's groove holds it there on three faces, so the dome is clamped at z = 0.

    membrane          ___
                   .-'   '-.            outer wall  R0 + t0
                  /  .---.  \\           inner wall  R0
    z = 0   ..---|  |     |  |---..     ring | groove: flange glued in | spigot with the channel
            |____|__|_   _|__|____|     mounting plate
                    | | | |             port
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from pneutouch.catalogue import Scene
from pneutouch.errors import InputError
from pneutouch.spec.part import BoltCircle

_HEAD_GAP = 0.5
"""Room in mm around a screw head, for the driver."""


@dataclass(frozen=True, slots=True)
class Layout:
    """All lengths in mm. Heights are z coordinates; the port hangs down from ``plate_low``."""

    inner_radius: float
    wall: float
    flange_width: float
    flange_thickness: float
    clearance: float
    ring_radius: float
    plate_radius: float
    plate_high: float
    plate_low: float
    bolt_circle_radius: float
    channel_radius: float

    @property
    def outer_radius(self) -> float:
        """Outer radius of the dome."""
        return self.inner_radius + self.wall

    @property
    def flange_radius(self) -> float:
        """Outer radius of the flange."""
        return self.outer_radius + self.flange_width

    @property
    def groove_inner(self) -> float:
        """Radius of the spigot that carries the rim from inside."""
        return self.inner_radius - self.clearance

    @property
    def groove_outer(self) -> float:
        """Radius of the ring that carries the flange from outside."""
        return self.flange_radius + self.clearance


def lay_out(scene: Scene) -> Layout:
    """Derive the layout of a scene from membrane, seat, mount and the printers' fit clearance."""
    membrane, seat, mount = scene.design.membrane, scene.seat, scene.mount
    flange = max(seat.least_flange_mm, seat.flange_over_wall * membrane.wall_thickness_mm)
    flange_radius = membrane.inner_radius_mm + membrane.wall_thickness_mm + flange
    ring = flange_radius + scene.fit_clearance + seat.ring_wall_mm
    outside = mount.family == "through"
    bolt_circle = _bolt_circle(mount, ring)
    layout = Layout(
        inner_radius=membrane.inner_radius_mm,
        wall=membrane.wall_thickness_mm,
        flange_width=flange,
        flange_thickness=flange,
        clearance=scene.fit_clearance,
        ring_radius=ring,
        plate_radius=bolt_circle + mount.head_diameter / 2 + _HEAD_GAP if outside else ring,
        plate_high=-flange,
        plate_low=-flange - mount.plate_thickness,
        bolt_circle_radius=bolt_circle,
        channel_radius=0.5 * seat.channel_diameter_mm,
    )
    _check_room(scene, layout)
    return layout


def _bolt_circle(mount: BoltCircle, ring: float) -> float:
    """Radius of the bolt circle; its diameter is a whole number of mm so that it can be drilled."""
    if mount.family == "through":
        return 0.5 * math.ceil(2 * (ring + mount.head_diameter / 2 + _HEAD_GAP))
    return 0.5 * math.floor(2 * (ring - 1.5 * mount.hole_diameter))


def _check_room(scene: Scene, layout: Layout) -> None:
    """Refuse a dome too small for the channel, the port or the holes behind it."""
    port, mount = scene.port, scene.mount
    behind = layout.bolt_circle_radius - mount.hole_diameter / 2
    wall = scene.connector_printer.smallest.wall_rigid_mm.recommended
    needs = {
        "the spigot around the air channel": (layout.groove_inner, layout.channel_radius + wall),
        "the holes around the port": (behind, port.barb_diameter / 2 + wall),
        "the channel around the port's bore": (layout.channel_radius, port.bore_diameter / 2),
    }
    for what, (has, least) in needs.items():
        if has < least:
            raise InputError(
                f"{scene.where}: membrane.inner_radius_mm = {layout.inner_radius:g}: too small for {what}: "
                f"radius {has:.2f} mm, at least {least:.2f} mm; take a larger dome, another mount or printer"
            )
