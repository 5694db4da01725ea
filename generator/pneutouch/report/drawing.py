"""The dimensioned drawing: a section and a plan view, lengths in mm with the printers' tolerances."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from pneutouch.body import Solid
from pneutouch.meridian import sample
from pneutouch.parts import Assembly
from pneutouch.parts.port import port_length
from pneutouch.report.dimension import CENTRE, THIN, circle, horizontal, leader, polar, vertical
from pneutouch.report.style import BOLD, INK, MUTED, figure, svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_THICK = 0.9
_HATCHES = {"membrane": "////////", "connector": "\\\\\\\\"}


def section_drawing(assembly: Assembly) -> str:
    """Section through the axis, and the plan from above, as SVG."""
    with figure(180, 76) as drawn:
        left, right = drawn.subplots(1, 2, width_ratios=(1.65, 1.0))
        _section(left, assembly)
        _plan(right, assembly)
        return svg(drawn)


@dataclass(frozen=True, slots=True)
class _Frame:
    """Where the section's dimensions go: ``unit`` is the drawing's step in mm, ``tip`` the port's lower end."""

    unit: float
    tip: float
    left: float
    right: float
    low: float


def _frame(assembly: Assembly) -> _Frame:
    layout = assembly.layout
    tip = layout.plate_low - port_length(assembly.scene.port)
    unit = max(layout.plate_radius / 22, (layout.outer_radius - tip) / 26)
    reach = layout.plate_radius + 4 * unit
    return _Frame(unit, tip, -reach, reach, tip - 4 * unit)


def _section(ax: Axes, assembly: Assembly) -> None:
    layout, frame = assembly.layout, _frame(assembly)
    for solid in assembly.solids:
        _hatched(ax, solid)
    axis = [frame.tip - 2 * frame.unit, layout.outer_radius + 2 * frame.unit]
    ax.plot([0, 0], axis, color=MUTED, lw=THIN, ls=CENTRE)
    _section_lengths(ax, assembly, frame)
    _section_leaders(ax, assembly, frame)
    xs = (frame.left - 21 * frame.unit, frame.right + 13 * frame.unit)
    ys = (frame.low - 7.5 * frame.unit, layout.outer_radius + 5 * frame.unit)
    _finish(ax, "Section A-A", xs, ys)


def _section_lengths(ax: Axes, assembly: Assembly, frame: _Frame) -> None:
    layout, scene = assembly.layout, assembly.scene
    soft, rigid = _tolerances(assembly)
    plate, flange = layout.plate_radius, layout.flange_radius
    barb = 0.5 * scene.port.barb_diameter
    thick, reach = layout.plate_high - layout.plate_low, port_length(scene.port)
    vertical(ax, frame.right, 0, layout.outer_radius, 0.02 * plate, f"{layout.outer_radius:.2f} {soft}")
    vertical(ax, frame.right, layout.plate_low, layout.plate_high, plate, f"{thick:.2f} {rigid}")
    vertical(ax, frame.right, frame.tip, layout.plate_low, barb, f"{reach:.2f} {rigid}")
    vertical(ax, frame.left, layout.plate_high, 0, -flange, f"{layout.flange_thickness:.2f} {soft}")
    outside = frame.left - 12.5 * frame.unit
    vertical(ax, outside, frame.tip, layout.outer_radius, frame.left, f"({layout.outer_radius - frame.tip:.2f})")
    horizontal(ax, frame.low, -flange, flange, layout.plate_high, f"Ø{2 * flange:.2f} {soft}")
    horizontal(ax, frame.low - 4.5 * frame.unit, -plate, plate, layout.plate_low, f"Ø{2 * plate:.2f} {rigid}")


def _section_leaders(ax: Axes, assembly: Assembly, frame: _Frame) -> None:
    layout, port, unit = assembly.layout, assembly.scene.port, frame.unit
    soft, _ = _tolerances(assembly)
    outside = layout.outer_radius + 4.5 * unit
    middle = layout.inner_radius + 0.5 * layout.wall
    below, shoulder = layout.plate_low - 0.55 * port.stem_length, layout.plate_low - port.stem_length
    stem, barb = 0.5 * port.stem_diameter, 0.5 * port.barb_diameter
    leader(ax, polar(layout.inner_radius, 140), polar(outside, 140), f"R{layout.inner_radius:g} {soft}", "right")
    leader(ax, polar(middle, 40), polar(outside, 40), f"wall {layout.wall:g} {soft}", "left")
    text = f"Ø{port.stem_diameter:g}, bore Ø{port.bore_diameter:g}"
    leader(ax, (stem, below), (6.5 * unit, below - 0.5 * unit), text, "left")
    leader(ax, (-barb, shoulder), (-6.5 * unit, shoulder - 1.5 * unit), f"barb Ø{port.barb_diameter:g}", "right")


def _tolerances(assembly: Assembly) -> tuple[str, str]:
    """Tolerances of the membrane and of the connector: the stated accuracies of their printers."""
    scene = assembly.scene
    return f"±{scene.printer.accuracy_mm.nominal:.2f}", f"±{scene.connector_printer.accuracy_mm.nominal:.2f}"


def _plan(ax: Axes, assembly: Assembly) -> None:
    layout, mount = assembly.layout, assembly.scene.mount
    _, rigid = _tolerances(assembly)
    unit = layout.plate_radius / 22
    outlines = [layout.plate_radius, layout.ring_radius, layout.groove_outer, layout.flange_radius, layout.outer_radius]
    for radius in dict.fromkeys(outlines):
        circle(ax, 0, 0, radius)
    circle(ax, 0, 0, layout.bolt_circle_radius, color=MUTED, ls=CENTRE, lw=THIN)
    hidden = {"ls": (0, (3, 1.5))} if mount.family == "blind" else {}
    for bore in assembly.solids[1].bores:
        circle(ax, bore.x, bore.y, bore.radius, **hidden)
    reach = layout.plate_radius + 2.5 * unit
    for ends in (([-reach, reach], [0, 0]), ([0, 0], [-reach, reach])):
        ax.plot(*ends, color=MUTED, lw=THIN, ls=CENTRE)
    bore = assembly.solids[1].bores[0]
    at = math.atan2(bore.y, bore.x)
    edge = (bore.x + bore.radius * math.cos(at), bore.y + bore.radius * math.sin(at))
    text = f"{mount.count} × Ø{mount.hole_diameter:g} {rigid}, {mount.screw}"
    if mount.hole_depth is not None:
        text += f",\n{mount.hole_depth:g} deep, from behind"
    leader(ax, edge, (0.35 * layout.plate_radius, layout.plate_radius + 5 * unit), text, "left")
    low = (-layout.plate_radius, -layout.plate_radius - 4 * unit)
    leader(ax, polar(layout.bolt_circle_radius, 209), low, f"bolt circle Ø{2 * layout.bolt_circle_radius:g}", "left")
    _finish(ax, "View from above", (-reach - 3 * unit, reach + 3 * unit), (-reach - 3 * unit, reach + 5 * unit))


def _hatched(ax: Axes, solid: Solid) -> None:
    rings = np.array([(ring.radius, ring.height) for ring in sample(solid.meridian, 2e-3)])
    for side in (-1, 1):
        ax.fill(side * rings[:, 0], rings[:, 1], facecolor="white", edgecolor=MUTED, hatch=_HATCHES[solid.role], lw=0)
        closed = rings if not solid.meridian.is_ring else np.vstack([rings, rings[:1]])
        ax.plot(side * closed[:, 0], closed[:, 1], color=INK, lw=_THICK, solid_joinstyle="miter")
    for bore in solid.bores:
        # Drawing practice turns the holes of a pattern into the section plane.
        x = math.copysign(math.hypot(bore.x, bore.y), bore.x)
        ax.fill([x - bore.radius, x + bore.radius, x + bore.radius, x - bore.radius],
                [bore.low, bore.low, bore.high, bore.high], facecolor="white", edgecolor=INK, lw=THIN)  # fmt: skip


def _finish(ax: Axes, title: str, xs: tuple[float, float], ys: tuple[float, float]) -> None:
    ax.set_aspect("equal")
    ax.set_xlim(*xs)
    ax.set_ylim(*ys)
    ax.axis("off")
    ax.set_title(title, fontsize=7.5, loc="left", **BOLD)
