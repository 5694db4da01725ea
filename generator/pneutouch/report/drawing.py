"""The dimensioned drawing: a section and a plan view, lengths in mm with the printers' tolerances."""

import math
from typing import TYPE_CHECKING

import numpy as np

from pneutouch.arrays import Array
from pneutouch.catalogue import ResolvedDesign
from pneutouch.parts import Assembly
from pneutouch.parts.cast_ring import RING
from pneutouch.parts.connector import travel
from pneutouch.parts.layout import finger_radius
from pneutouch.report.section import (
    CENTRE,
    HIDDEN,
    NEIGHBOUR,
    THIN,
    circle,
    draw_bores,
    draw_section,
    horizontal,
    leader,
    polar,
    port_note,
    vertical,
)
from pneutouch.report.style import BOLD, INK, MM, MUTED, figure, svg
from pneutouch.shape.hemisphere import no_hemisphere
from pneutouch.spec.part import BoltCircle, ClampedFlange, OnePiece, RobotFlange, Sleeve

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def section_drawing(assembly: Assembly, body: Array | None = None) -> dict[str, str]:
    """Section through the axis, and the plan from above, as SVG: ``drawing`` and ``plan``.

    ``body`` (n, 2), x and z in mm, is the outline of the object that presses the dome; None: no object is drawn.
    """
    with figure(_WIDE, 76) as drawn:
        ax = drawn.add_subplot()
        _Section(ax, assembly).draw(body)
        # As high as the section needs in this width, and its title.
        low, high = ax.get_ylim()
        drawn.set_figheight((6 + min(_WIDE * (high - low) / np.ptp(ax.get_xlim()), 84)) * MM)
        section = svg(drawn)
    with figure(_NARROW, _NARROW + 6) as drawn:
        _plan(drawn.add_subplot(), assembly)
        return {"drawing": section, "plan": svg(drawn)}


_OBJECT = 0.6
"""Height left above the dimensions for the pressing object, divided by the dome's outer radius."""

_WIDE, _NARROW = 112.0, 68.0
"""Widths of section and plan in mm: together the width of a page."""


class _Section:
    """The section drawing with its dimensions; ``unit`` is the step, mm, by which they are spaced."""

    def __init__(self, ax: "Axes", assembly: Assembly) -> None:
        layout, mount = assembly.layout, assembly.scene.mount
        self.ax, self.assembly, self.layout = ax, assembly, layout
        sleeve = mount.sleeve_length if isinstance(mount, Sleeve) else 0.0
        behind = layout.port.length if layout.port_axis is None else 0.0
        self.bottom = min(layout.under - behind, layout.plate_low - sleeve)
        ring = assembly.scene.seat.ring_thickness if isinstance(assembly.scene.seat, ClampedFlange) else 0.0
        self.top = max(layout.shape.outer_height, ring)
        self.side = layout.plate_radius + (layout.port.length if layout.port_axis is not None else 0.0)
        self.unit = max(layout.plate_radius / 22, (self.top - self.bottom) / 26)
        self.left, self.right = -layout.plate_radius - 4 * self.unit, self.side + 4 * self.unit
        self.low = self.bottom - 4 * self.unit
        soft = assembly.scene.printer.accuracy_mm.nominal
        rigid = assembly.scene.connector_printer.accuracy_mm.nominal
        self.soft, self.rigid = f"±{soft:.2f}", f"±{rigid:.2f}"

    def draw(self, body: Array | None = None) -> None:
        """Draw the section with its dimensions, and ``body`` as in `section_drawing`."""
        draw_section(self.ax, self.assembly)
        axis = [self.bottom - 2 * self.unit, self.top + 2 * self.unit]
        self.ax.plot([0, 0], axis, color=MUTED, lw=THIN, ls=CENTRE)
        self._heights()
        self._widths()
        self._leaders()
        xs = (self.left - 21 * self.unit, self.right + 13 * self.unit)
        high = max(self.top + 5 * self.unit, 9 * self.unit)
        if body is not None:
            high += _OBJECT * self.layout.outer_radius
            self._body(body, high)
        _finish(self.ax, "Section A-A", xs, (self.low - 7.5 * self.unit, high))

    def _body(self, body: Array, high: float) -> None:
        """Draw the pressing object, outline (n, 2), dashed as a neighbouring part, up to the height ``high`` in mm."""
        wide = self.layout.plate_radius
        shown = (body[:, 1] <= high) & (np.abs(body[:, 0]) <= wide)
        self.ax.plot(np.where(shown, body[:, 0], np.nan), body[:, 1], color=INK, lw=THIN, ls=NEIGHBOUR)

    def _heights(self) -> None:
        layout, ax, right, plate = self.layout, self.ax, self.right, self.layout.plate_radius
        top = layout.shape.outer_height
        if top > layout.wall:
            vertical(ax, right, 0, top, 0.02 * plate, f"{top:.2f} {self.soft}")
        thick = layout.plate_high - layout.plate_low
        vertical(ax, right, layout.plate_low, layout.plate_high, plate, f"{thick:.2f} {self.rigid}")
        if self.bottom < layout.plate_low:
            below = layout.plate_low - self.bottom
            vertical(ax, right, self.bottom, layout.plate_low, 0.2 * plate, f"{below:.2f} {self.rigid}")
        flange = layout.flange_thickness
        vertical(ax, self.left, -flange, 0, -layout.flange_radius, f"{flange:.2f} {self.soft}")
        outside = self.left - 14 * self.unit
        whole = top - self.bottom
        vertical(ax, outside, self.bottom, top, self.left, f"({whole:.2f})")

    def _widths(self) -> None:
        layout, ax, low = self.layout, self.ax, self.low
        flange, plate = layout.flange_radius, layout.plate_radius
        horizontal(ax, low, -flange, flange, layout.plate_high, f"flange\nØ{2 * flange:.2f} {self.soft}")
        horizontal(ax, low - 4.5 * self.unit, -plate, plate, layout.plate_low, f"Ø{2 * plate:.2f} {self.rigid}")

    def _leaders(self) -> None:
        layout, unit, ax = self.layout, self.unit, self.ax
        outside, middle = layout.outer_radius + 4.5 * unit, layout.inner_radius + 0.5 * layout.wall
        varies = getattr(layout.shape, "wall_stations", None)
        wall = f"wall {layout.shape.stated_wall if varies else f'{layout.wall:g} {self.soft}'}"
        fillet = self.assembly.scene.design.membrane.root_fillet_mm
        if no_hemisphere(layout.shape.plain) is None:
            note = f"R{layout.inner_radius:g} {self.soft}"
            leader(ax, polar(layout.inner_radius, 140), polar(outside, 140), note, "right")
            leader(ax, polar(middle, 55), polar(outside, 55), wall, "left")
        else:
            high, (r, z) = self.top + 2.5 * unit, layout.shape.points(np.array([0.3]), np.array([0.5]))[0, 0].tolist()
            rounded = "" if fillet is None else f"\nfillet R{fillet:g}"
            leader(ax, (r, z), (0.7 * layout.outer_radius, high), f"{wall}{rounded}", "left")
            (r, z), note = layout.shape.inner[0].start, f"inside Ø{2 * layout.inner_radius:g} {self.soft}"
            leader(ax, (-r, z), (-0.7 * layout.outer_radius, high), f"{note}\n{layout.shape.further}", "right")
        if fillet is not None and no_hemisphere(layout.shape.plain) is None:
            (r, z), text = layout.shape.outer[0].along(np.array([0.5]))[0], f"fillet R{fillet:g}"
            leader(ax, (r, z), polar(outside, 25), text, "left")
        text, port = port_note(self.assembly.scene), layout.port
        if layout.port_axis is None:
            tip = (0.9 * port.outside[0][0][0], layout.under - 0.7 * port.length)
            label_at = (max(6.5 * unit, port.reach + 2 * unit), layout.under - max(0.7 * port.length, 4 * unit))
            leader(ax, tip, label_at, text, "left")
        else:
            tip = (layout.plate_radius + 0.7 * port.length, layout.port_axis + 0.9 * port.root)
            leader(ax, tip, (self.side - unit, layout.outer_radius + 3.5 * unit), text, "left")
        self._extra()

    def _extra(self) -> None:
        """Draw the notes at a ring, a plug, a boss or a sleeve."""
        layout, unit, seat, mount = self.layout, self.unit, self.assembly.scene.seat, self.assembly.scene.mount
        at = (-6.5 * unit, self.bottom - 1.0 * unit)
        if isinstance(seat, ClampedFlange):
            text = f"ring, {seat.screw_count} × {seat.screw}\ncloses {travel(seat, layout):.2f}"
            text += f"\ngasket {layout.gasket:g}" if layout.gasket else ""
            spot = (-layout.ring_radius + unit, 0.9 * seat.ring_thickness)
            leader(self.ax, spot, (self.left - 0.5 * unit, 6.5 * unit), text, "right")
        if layout.ring is not None:
            ring, spot = (
                layout.ring,
                (-0.5 * (layout.flange_radius + layout.held_radius), -0.1 * layout.flange_thickness),
            )
            text = f"ring in the flange,\n{ring.hole_count} × Ø{2 * ring.hole_radius:.4g}"
            leader(self.ax, spot, (self.left - 0.5 * unit, 6.5 * unit), text, "right")
        if isinstance(seat, OnePiece):
            spot = (-layout.opening_radius + 0.6 * unit, layout.under + 0.5 * seat.shoulder_thickness)
            leader(self.ax, spot, at, f"plug, opening Ø{2 * layout.opening_radius:g}", "right")
        if isinstance(mount, Sleeve):
            height, text = layout.plate_low - 0.8 * mount.sleeve_length, f"finger Ø{mount.finger_diameter:g}"
            spot = (-0.5 * mount.finger_diameter, height)
            leader(self.ax, spot, (self.left - 0.5 * unit, height), text, "right")
            self._set_screws(mount)
        if isinstance(mount, RobotFlange):
            text = f"centring Ø{mount.boss_diameter:g}\n{mount.boss_height:g} high"
            spot = (-0.4 * mount.boss_diameter, layout.under)
            leader(self.ax, spot, (self.left - 0.5 * unit, self.bottom - 1.5 * unit), text, "right")

    def _set_screws(self, mount: Sleeve) -> None:
        """Draw a set screw's hole, turned into the section on the side away from the port, and its note."""
        height, radius = self.layout.plate_low - 0.5 * mount.sleeve_length, _screw_radius(self.assembly.scene, mount)
        inner, outer = _sleeve_radii(self.assembly.scene, mount)
        across, along = (
            (-outer, -inner, -inner, -outer),
            (height - radius, height - radius, height + radius, height + radius),
        )
        self.ax.fill(across, along, facecolor="white", edgecolor=INK, lw=THIN)
        text = f"{mount.set_screw_count} × Ø{2 * radius:.4g},\ntap {mount.screw}, set screws"
        leader(self.ax, (-outer, height), (self.left - 0.5 * self.unit, height + 2 * self.unit), text, "right")


def _sleeve_radii(scene: ResolvedDesign, mount: Sleeve) -> tuple[float, float]:
    """Inner and outer radius of a sleeve, mm."""
    inner = finger_radius(scene)
    return inner, inner + mount.sleeve_wall


def _screw_radius(scene: ResolvedDesign, mount: Sleeve) -> float:
    """Radius of the holes for set screws as drawn, mm."""
    return 0.5 * (mount.set_screw_core_diameter + scene.hole_undersize)


def _plan(ax: "Axes", assembly: Assembly) -> None:
    layout, scene = assembly.layout, assembly.scene
    unit = layout.plate_radius / 22
    held = dict.fromkeys([layout.held_radius, layout.flange_radius])
    outlines = [layout.plate_radius, layout.ring_radius, layout.groove_outer, *held, layout.outer_radius]
    if isinstance(scene.seat, ClampedFlange):
        outlines = [layout.plate_radius, layout.ring_radius, layout.outer_radius]
    for radius in dict.fromkeys(outlines):
        circle(ax, 0, 0, radius)
    for solid in assembly.solids:
        if solid.name != "connector" or not isinstance(scene.seat, ClampedFlange):
            draw_bores(ax, solid, hidden=layout.ring is not None and solid.role == RING)
    if isinstance(scene.seat, ClampedFlange) and isinstance(scene.mount, BoltCircle | RobotFlange):
        draw_bores(ax, assembly.solid("connector"), but=layout.screw_circle)
    reach = layout.plate_radius + 2.5 * unit
    for ends in (([-reach, reach], [0, 0]), ([0, 0], [-reach, reach])):
        ax.plot(*ends, color=MUTED, lw=THIN, ls=CENTRE)
    if layout.port_axis is not None:
        _side_port(ax, assembly)
    _holes(ax, assembly, unit)
    far = max(reach, layout.plate_radius + (layout.port.length if layout.port_axis is not None else 0.0))
    for x in (-reach - unit, far + unit):
        # The line of the section, seen in the direction of its arrows.
        ax.plot([x - unit, x + unit], [0, 0], color=INK, lw=1.4)
        leader(ax, (x, 0), (x, 5 * unit), "A", "center", arrow="<|-")
    _finish(ax, "View from above", (-reach - 3 * unit, far + 3 * unit), (-reach - 3 * unit, reach + 5 * unit))


def _side_port(ax: "Axes", assembly: Assembly) -> None:
    """Draw the outline of a port in the side as seen from above."""
    layout = assembly.layout
    points = [layout.port.hollow[0], *(point for point, _ in layout.port.outside)]
    xs = [layout.plate_radius + height for _, height in points]
    for side in (-1, 1):
        ax.plot(xs, [side * radius for radius, _ in points], color="black", lw=0.7)
    ax.plot([xs[0], xs[0]], [-points[0][0], points[0][0]], color="black", lw=0.7)


def _holes(ax: "Axes", assembly: Assembly, unit: float) -> None:
    """Draw the notes on the mounting holes; for a sleeve the hidden edges of its holes for set screws."""
    layout, scene = assembly.layout, assembly.scene
    mount, rigid = scene.mount, scene.connector_printer.accuracy_mm.nominal
    if isinstance(mount, Sleeve):
        inner, outer = _sleeve_radii(scene, mount)
        side = _screw_radius(scene, mount)
        for k in range(mount.set_screw_count):
            angle = 90.0 + 360.0 * k / mount.set_screw_count
            for off in (-side, side):
                ends = [polar(math.hypot(r, off), angle + math.degrees(math.atan2(off, r))) for r in (inner, outer)]
                ax.plot(*zip(*ends, strict=True), color=INK, lw=THIN, ls=HIDDEN)
        return
    if not isinstance(mount, BoltCircle | RobotFlange):
        return
    circle(ax, 0, 0, layout.bolt_circle_radius, color=MUTED, ls=CENTRE, lw=THIN)
    at = math.pi / mount.count
    across = mount.hole_diameter + scene.hole_undersize
    text = f"{mount.count} × Ø{across:.4g} ±{rigid:.2f}, {mount.screw}"
    if isinstance(mount, BoltCircle) and mount.hole_depth is not None:
        text += f",\n{mount.hole_depth:g} deep, from behind"
    if isinstance(mount, RobotFlange):
        text += f",\ndowel Ø{mount.pin_diameter + scene.hole_undersize:.4g}"
    edge = layout.bolt_circle_radius + 0.5 * across
    spot = (edge * math.cos(at), edge * math.sin(at))
    leader(ax, spot, (0.35 * layout.plate_radius, layout.plate_radius + 5 * unit), text, "left")
    low = (-layout.plate_radius, -layout.plate_radius - 4 * unit)
    leader(ax, polar(layout.bolt_circle_radius, 209), low, f"bolt circle Ø{2 * layout.bolt_circle_radius:g}", "left")


def _finish(ax: "Axes", title: str, xs: tuple[float, float], ys: tuple[float, float]) -> None:
    ax.set_aspect("equal")
    ax.set_xlim(*xs)
    ax.set_ylim(*ys)
    ax.axis("off")
    ax.set_title(title, fontsize=7.5, loc="left", **BOLD)
