"""The dimensioned drawing: a section and a plan view, lengths in mm with the printers' tolerances."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from pneutouch.body import Solid
from pneutouch.meridian import sample
from pneutouch.parts import Assembly
from pneutouch.parts.port import port_length
from pneutouch.report.style import BOLD, INK, MUTED, figure, svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_THIN, _THICK = 0.4, 0.9
_TEXT = 6.8
_HATCHES = {"membrane": "////////", "connector": "\\\\\\\\"}


def section_drawing(assembly: Assembly) -> str:
    """Section through the axis, and the plan from above, as SVG."""
    with figure(180, 76) as drawn:
        left, right = drawn.subplots(1, 2, width_ratios=(1.65, 1.0))
        _section(left, assembly)
        _plan(right, assembly)
        return svg(drawn)


def _section(ax: Axes, assembly: Assembly) -> None:
    layout, port, scene = assembly.layout, assembly.scene.port, assembly.scene
    soft, rigid = scene.printer.accuracy_mm.nominal, scene.connector_printer.accuracy_mm.nominal
    for solid in assembly.solids:
        _hatched(ax, solid)
    tip = layout.plate_low - port_length(port)
    unit = max(layout.plate_radius / 22, (layout.outer_radius - tip) / 26)
    ax.plot([0, 0], [tip - 2 * unit, layout.outer_radius + 2 * unit], color=MUTED, lw=_THIN, ls=(0, (8, 2, 2, 2)))
    outer = layout.plate_radius
    right = outer + 4 * unit
    _vertical(ax, right, 0, layout.outer_radius, outer * 0.02, f"{layout.outer_radius:.2f} ±{soft:.2f}")
    _vertical(
        ax,
        right,
        layout.plate_low,
        layout.plate_high,
        outer,
        f"{layout.plate_high - layout.plate_low:.2f} ±{rigid:.2f}",
    )
    _vertical(ax, right, tip, layout.plate_low, 0.5 * port.barb_diameter, f"{port_length(port):.2f} ±{rigid:.2f}")
    left = -outer - 4 * unit
    _vertical(ax, left, layout.plate_high, 0, -layout.flange_radius, f"{layout.flange_thickness:.2f} ±{soft:.2f}")
    _vertical(ax, left - 12.5 * unit, tip, layout.outer_radius, left, f"({layout.outer_radius - tip:.2f})")
    low = tip - 4 * unit
    _horizontal(
        ax,
        low,
        -layout.flange_radius,
        layout.flange_radius,
        layout.plate_high,
        f"Ø{2 * layout.flange_radius:.2f} ±{soft:.2f}",
    )
    _horizontal(ax, low - 4.5 * unit, -outer, outer, layout.plate_low, f"Ø{2 * outer:.2f} ±{rigid:.2f}")
    _leader(
        ax,
        _polar(layout.inner_radius, 128),
        _polar(layout.outer_radius + 4.5 * unit, 128),
        f"R{layout.inner_radius:g} ±{soft:.2f}",
        "right",
    )
    middle = layout.inner_radius + 0.5 * layout.wall
    _leader(
        ax,
        _polar(middle, 52),
        _polar(layout.outer_radius + 4.5 * unit, 52),
        f"wall {layout.wall:g} ±{soft:.2f}",
        "left",
    )
    below = layout.plate_low - 0.55 * port.stem_length
    _leader(
        ax,
        (0.5 * port.stem_diameter, below),
        (6.5 * unit, below - 0.5 * unit),
        f"Ø{port.stem_diameter:g}, bore Ø{port.bore_diameter:g}",
        "left",
    )
    barb = layout.plate_low - port.stem_length
    _leader(
        ax,
        (-0.5 * port.barb_diameter, barb),
        (-6.5 * unit, barb - 1.5 * unit),
        f"barb Ø{port.barb_diameter:g}",
        "right",
    )
    _finish(
        ax, "Section A-A", (left - 21 * unit, right + 13 * unit), (low - 7.5 * unit, layout.outer_radius + 5 * unit)
    )


def _plan(ax: Axes, assembly: Assembly) -> None:
    layout, mount = assembly.layout, assembly.scene.mount
    rigid = assembly.scene.connector_printer.accuracy_mm.nominal
    unit = layout.plate_radius / 22
    outlines = [layout.plate_radius, layout.ring_radius, layout.groove_outer, layout.flange_radius, layout.outer_radius]
    for radius in dict.fromkeys(outlines):
        _circle(ax, 0, 0, radius)
    _circle(ax, 0, 0, layout.bolt_circle_radius, color=MUTED, ls=(0, (8, 2, 2, 2)), lw=_THIN)
    hidden = {"ls": (0, (3, 1.5))} if mount.family == "blind" else {}
    for bore in assembly.solids[1].bores:
        _circle(ax, bore.x, bore.y, bore.radius, **hidden)
    reach = layout.plate_radius + 2.5 * unit
    for ends in (([-reach, reach], [0, 0]), ([0, 0], [-reach, reach])):
        ax.plot(*ends, color=MUTED, lw=_THIN, ls=(0, (8, 2, 2, 2)))
    bore = assembly.solids[1].bores[0]
    at = math.atan2(bore.y, bore.x)
    edge = (bore.x + bore.radius * math.cos(at), bore.y + bore.radius * math.sin(at))
    text = f"{mount.count} × Ø{mount.hole_diameter:g} ±{rigid:.2f}, {mount.screw}"
    if mount.hole_depth is not None:
        text += f",\n{mount.hole_depth:g} deep, from behind"
    _leader(ax, edge, (0.35 * layout.plate_radius, layout.plate_radius + 5 * unit), text, "left")
    circle = math.radians(225)
    on_circle = (
        layout.bolt_circle_radius * math.cos(circle * 0.93),
        layout.bolt_circle_radius * math.sin(circle * 0.93),
    )
    _leader(
        ax,
        on_circle,
        (-layout.plate_radius, -layout.plate_radius - 4 * unit),
        f"bolt circle Ø{2 * layout.bolt_circle_radius:g}",
        "left",
    )
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
                [bore.low, bore.low, bore.high, bore.high], facecolor="white", edgecolor=INK, lw=_THIN)  # fmt: skip


def _polar(radius: float, degrees: float) -> tuple[float, float]:
    return radius * math.cos(math.radians(degrees)), radius * math.sin(math.radians(degrees))


def _circle(ax: Axes, x: float, y: float, radius: float, **look: object) -> None:
    angle = np.linspace(0, 2 * np.pi, 181)
    ax.plot(x + radius * np.cos(angle), y + radius * np.sin(angle), **{"color": INK, "lw": 0.7, **look})  # type: ignore[arg-type]


def _arrow(ax: Axes, start: tuple[float, float], end: tuple[float, float]) -> None:
    style = {
        "arrowstyle": "<|-|>,head_width=0.12,head_length=0.3",
        "lw": _THIN,
        "color": INK,
        "shrinkA": 0,
        "shrinkB": 0,
    }
    ax.annotate("", end, start, arrowprops=style)


def _horizontal(ax: Axes, y: float, x0: float, x1: float, feature: float, text: str) -> None:
    for x in (x0, x1):
        ax.plot([x, x], [feature, y - 0.6], color=INK, lw=0.25)
    _arrow(ax, (x0, y), (x1, y))
    ax.text(
        0.5 * (x0 + x1),
        y,
        text,
        ha="center",
        va="center",
        fontsize=_TEXT,
        bbox={"fc": "white", "ec": "none", "pad": 0.8},
    )


def _vertical(ax: Axes, x: float, y0: float, y1: float, feature: float, text: str) -> None:
    reach = x + math.copysign(0.6, x)
    for y in (y0, y1):
        ax.plot([feature, reach], [y, y], color=INK, lw=0.25)
    _arrow(ax, (x, y0), (x, y1))
    ax.annotate(
        text, (x, 0.5 * (y0 + y1)), xytext=(3 if x > 0 else -3, 0), textcoords="offset points",
        ha="left" if x > 0 else "right", va="center", fontsize=_TEXT,
    )  # fmt: skip


def _leader(ax: Axes, at: tuple[float, float], to: tuple[float, float], text: str, ha: str) -> None:
    arrow = {"arrowstyle": "-|>,head_width=0.12,head_length=0.3", "lw": _THIN, "color": INK, "shrinkA": 1, "shrinkB": 0}
    ax.annotate(text, at, xytext=to, arrowprops=arrow, ha=ha, va="center", fontsize=_TEXT, multialignment="left")


def _finish(ax: Axes, title: str, xs: tuple[float, float], ys: tuple[float, float]) -> None:
    ax.set_aspect("equal")
    ax.set_xlim(*xs)
    ax.set_ylim(*ys)
    ax.axis("off")
    ax.set_title(title, fontsize=7.5, loc="left", **BOLD)
