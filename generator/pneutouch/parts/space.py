"""Check that a layout has space for its parts, before anything is drawn; errors state the lengths that do not fit."""

import math

from pneutouch.catalogue import ResolvedDesign
from pneutouch.errors import InputError, shown
from pneutouch.parts.layout import HEAD_GAP, Layout, finger_radius
from pneutouch.spec.part import BoltCircle, OnePiece, RobotFlange, Sleeve

Lengths = dict[str, tuple[float, float]]
"""Present and required radius, mm, by the name of a length."""


def check_space(scene: ResolvedDesign, layout: Layout) -> None:
    """Raise InputError for a dome too small for its channel, port or holes, or too large for its mount."""
    lengths = least_radii(scene, layout)
    for what, (has, least) in lengths.items():
        if has < least - 1e-9:  # rounding
            # Every one of these lengths grows by as much as the dome's radius, a circle of holes in steps of 0.5 mm.
            enough = scene.design.membrane.inner_radius_mm + max(b - a for a, b in lengths.values())
            enough += 0.5 if isinstance(scene.mount, BoltCircle) else 0.0
            problem = f"too small for {what}: radius {has:.2f} mm, at least {least:.2f} mm"
            remedy = f"take at least {math.ceil(100 * enough) / 100:g}, or another port, mount or printer"
            raise _no_space(scene, problem, remedy)
    if layout.ring is not None:
        from pneutouch.parts.cast_ring import check_ring

        check_ring(scene, layout.ring)
    mount = scene.design.connector.mount
    for what, (has, most) in greatest_radii(scene, layout).items():
        if has > most:
            problem = (
                f"too large for connector.mount = {shown(mount)}: {what} is {has:.2f} mm in radius, there is space "
                f"for {most:.2f} mm"
            )
            raise _no_space(scene, problem, "take a smaller dome, another seat or mount")


def _no_space(scene: ResolvedDesign, problem: str, remedy: str) -> InputError:
    radius = scene.design.membrane.inner_radius_mm
    value = int(radius) if radius.is_integer() else radius
    return InputError(problem, file=scene.where, key="membrane.inner_radius_mm", value=value, remedy=remedy)


def least_radii(scene: ResolvedDesign, layout: Layout) -> Lengths:
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


def greatest_radii(scene: ResolvedDesign, layout: Layout) -> Lengths:
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
