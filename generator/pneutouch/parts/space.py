"""Check that a layout has space for its parts, before anything is drawn; errors state the lengths that do not fit."""

import math

from pneutouch.catalogue import ResolvedDesign
from pneutouch.errors import InputError, shown
from pneutouch.parts.cast_ring import FEWEST_HOLES, RingSize
from pneutouch.parts.layout import HEAD_GAP, Layout, finger_radius
from pneutouch.spec.part import BoltCircle, OnePiece, RobotFlange, Sleeve

Lengths = dict[str, tuple[float, float]]
"""Present and required radius, mm, by the name of a length."""


def check_space(scene: ResolvedDesign, layout: Layout) -> None:
    """Raise InputError for a dome too small for its channel, port or holes, or too large for its mount."""
    for what, (has, least) in _least(scene, layout).items():
        if has < least:
            problem = f"too small for {what}: radius {has:.2f} mm, at least {least:.2f} mm"
            raise _no_space(scene, problem, "take a larger dome, another port, mount or printer")
    _check_ring(scene, layout.ring)
    mount = scene.design.connector.mount
    for what, (has, most) in _most(scene, layout).items():
        if has > most:
            problem = (
                f"too large for connector.mount = {shown(mount)}: {what} is {has:.2f} mm in radius, there is space "
                f"for {most:.2f} mm"
            )
            raise _no_space(scene, problem, "take a smaller dome, another seat or mount")


def space_margin(scene: ResolvedDesign, layout: Layout) -> float:
    """Least relative margin of the radii that `check_space` compares; negative if it refuses the layout."""
    small = [has / least - 1.0 for has, least in _least(scene, layout).values() if least > 0]
    large = [most / has - 1.0 for has, most in _most(scene, layout).values()]
    ring, wall = layout.ring, _least_bridge(scene)
    web = [] if ring is None else [ring.bridge / wall - 1.0, ring.rim / wall - 1.0]
    return min([*small, *large, *web], default=math.inf)


def _least_bridge(scene: ResolvedDesign) -> float:
    """Least width of rigid material in mm at a hole of a ring: the wall that the printer can make."""
    wall = scene.connector_printer.smallest.wall("rigid")
    return wall.recommended if wall.least is None else wall.least


def _check_ring(scene: ResolvedDesign, ring: RingSize | None) -> None:
    """Raise InputError for a ring whose holes leave less material between or inside them than the printer can make."""
    least, web = _least_bridge(scene), scene.design.cast_ring
    if ring is not None and ring.rim < least:
        raise InputError(
            f"the holes leave {max(ring.rim, 0.0):.2f} mm of the ring inside them; the connector's printer makes "
            f"{least:g} mm",
            file=scene.where,
            key="cast_ring.width_mm",
            value=web.width_mm,
            remedy=f"give at least {math.ceil(100 * (web.width_mm + least - ring.rim)) / 100:g}, or smaller holes",
        )
    if ring is not None and ring.bridge < least:
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


def _no_space(scene: ResolvedDesign, problem: str, remedy: str) -> InputError:
    radius = scene.design.membrane.inner_radius_mm
    value = int(radius) if radius.is_integer() else radius
    return InputError(problem, file=scene.where, key="membrane.inner_radius_mm", value=value, remedy=remedy)


def _least(scene: ResolvedDesign, layout: Layout) -> Lengths:
    """Radii with a lower limit, and that limit."""
    seat, mount, port, needs = scene.seat, scene.mount, layout.port, {}
    wall = scene.connector_printer.smallest.wall("rigid").recommended
    inner = port.reach if layout.port_axis is None else 0.0
    if isinstance(seat, OnePiece):
        plug = layout.opening_radius - scene.fit_clearance
        needs["the plug around the air channel"] = (plug, layout.channel_radius + wall)
        if layout.port_axis is None:
            needs["the port on the plug"] = (plug + seat.shoulder_width, port.root)
        inner = max(inner, layout.opening_radius + seat.shoulder_width)
    else:
        needs["the spigot around the air channel"] = (layout.groove_inner, layout.channel_radius + wall)
    if isinstance(mount, BoltCircle):
        behind = layout.bolt_circle_radius - 0.5 * mount.hole_diameter
        needs["the holes around the port"] = (behind, inner + wall)
    elif layout.port_axis is None:
        needs["the port on the plate"] = (layout.plate_radius, port.reach)
    return needs


def _most(scene: ResolvedDesign, layout: Layout) -> Lengths:
    """Radii with an upper limit, and that limit."""
    seat, mount = scene.seat, scene.mount
    if isinstance(mount, RobotFlange):
        free = layout.bolt_circle_radius - 0.5 * mount.head_diameter - HEAD_GAP
        return {"the seat between the screw heads": (layout.ring_radius, free)}
    if isinstance(mount, Sleeve) and isinstance(seat, OnePiece):
        return {
            "the plug, which goes in through the sleeve,": (
                layout.opening_radius + seat.shoulder_width,
                finger_radius(scene),
            )
        }
    return {}
