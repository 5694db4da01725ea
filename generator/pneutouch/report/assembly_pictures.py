"""Pictures of the steps that put a sensor together: its section, with the part that comes in away from its place."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from pneutouch.body.section import section_outline
from pneutouch.parts import Assembly
from pneutouch.parts.layout import finger_radius
from pneutouch.report.section import NEIGHBOUR, THIN, TOLERANCE, draw_loops
from pneutouch.report.style import BOLD, INK, MM, figure, svg
from pneutouch.spec.part import Barb, BoltCircle, ClampedFlange, OnePiece, RobotFlange, Sleeve

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_WIDE, _HIGH, _TITLE = 45.0, 48.0, 5.0
"""Width and greatest height of a picture, and height of its title, mm."""

_GAP = 0.45
"""Distance of a part from its place over the radius of the plate."""


def assembly_pictures(assembly: Assembly, steps: Sequence[str]) -> str:
    """Pictures of the steps for joining, port, mount and leak test, each under its number, as one SVG."""
    numbered = [(k, text.partition(":")[0]) for k, text in enumerate(steps, 1)]
    shown = [(k, head, _PICTURES[head]) for k, head in numbered if head in _PICTURES]
    with figure(_WIDE * len(shown), _HIGH) as drawn:
        places = [drawn.add_subplot(1, len(shown), place) for place in range(1, len(shown) + 1)]
        for ax, (k, head, draw) in zip(places, shown, strict=True):
            draw(ax, assembly)
            ax.set_title(f"{k} {head}", fontsize=7.5, **BOLD)
            ax.axis("off")
        # One scale for all, so that a part has one size throughout.
        ends = [np.array([ax.dataLim.min, ax.dataLim.max]) for ax in places]
        wide, high = 1.06 * np.max([np.ptp(each, axis=0) for each in ends], axis=0)
        drawn.set_figheight((_TITLE + min(_WIDE * high / wide, _HIGH)) * MM)
        for ax, (x, z) in zip(places, (each.mean(axis=0) for each in ends), strict=True):
            ax.set(xlim=(x - 0.5 * wide, x + 0.5 * wide), ylim=(z - 0.5 * high, z + 0.5 * high), aspect="equal")
        return svg(drawn)


def _sensor(ax: Axes, assembly: Assembly, away: dict[str, float] | None = None) -> None:
    """Draw the section with bodies away from their place by a height in mm, by role."""
    for solid in assembly.solids:
        shift = np.array([0.0, (away or {}).get(solid.role, 0.0)])
        loops = section_outline(solid, TOLERANCE)
        if loops:
            draw_loops(ax, [loop + shift for loop in loops], solid.role)


def _box(ax: Axes, across: tuple[float, float], heights: tuple[float, float], look: object = "white") -> None:
    x, z = [across[0], across[1], across[1], across[0]], [heights[0], heights[0], heights[1], heights[1]]
    ax.fill(x, z, facecolor=look, edgecolor=INK, lw=0.7)


def _arrow(ax: Axes, start: tuple[float, float], end: tuple[float, float]) -> None:
    ax.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": INK, "lw": 1.1, "shrinkA": 0, "shrinkB": 0})


def _screw(ax: Axes, x: float, tip: float, length: float, head: float, wide: float) -> None:
    """Draw a screw with its head above, or below for a negative length, and the arrow of its way."""
    turn = np.sign(length)
    _box(ax, (x - 0.5 * wide, x + 0.5 * wide), (tip, tip + length), "0.85")
    _box(ax, (x - 0.5 * head, x + 0.5 * head), (tip + length, tip + length + 0.6 * wide * turn), "0.85")
    _arrow(ax, (x, tip - 0.15 * length), (x, tip - 0.7 * length))


def _gap(assembly: Assembly) -> float:
    return _GAP * assembly.layout.plate_radius


def _joining(ax: Axes, assembly: Assembly) -> None:
    layout, seat, gap = assembly.layout, assembly.scene.seat, _gap(assembly)
    if isinstance(seat, OnePiece):
        _sensor(ax, assembly, {"plug": -gap})
        _arrow(ax, (0.0, layout.under - 0.7 * gap), (0.0, layout.under - 0.1 * gap))
        return
    over = {"membrane": gap, "ring": 2.0 * gap if isinstance(seat, ClampedFlange) else gap}
    _sensor(ax, assembly, over)
    for x in (-layout.flange_radius, layout.flange_radius):
        _arrow(ax, (x, gap - layout.flange_thickness), (x, 0.1 * gap))
    if isinstance(seat, ClampedFlange):
        for x in (-layout.screw_circle, layout.screw_circle):
            _screw(ax, x, 3.0 * gap + seat.ring_thickness, 0.6 * gap, seat.head_diameter, seat.clearance_diameter)


def _tube(ax: Axes, assembly: Assembly, away: float) -> tuple[float, float]:
    """Draw the tube, away from its seat in the port by a distance; its far end, (x, z)."""
    layout, port, tube = assembly.layout, assembly.layout.port, assembly.scene.tube
    length = 0.7 * _gap(assembly)
    depth = port.length if isinstance(assembly.scene.port, Barb) else max(port.engaged, 1.0)
    near = port.length - depth + away
    for side in (-1.0, 1.0):
        wall = sorted((0.5 * side * tube.inner_diameter, 0.5 * side * tube.outer_diameter))
        along = (near, near + depth + length)
        if layout.port_axis is None:
            _box(ax, (wall[0], wall[1]), (layout.under - along[1], layout.under - along[0]), "0.85")
        else:
            low, high = (layout.port_axis + w for w in wall)
            _box(ax, (layout.plate_radius + along[0], layout.plate_radius + along[1]), (low, high), "0.85")
    if layout.port_axis is None:
        return 0.0, layout.under - near - depth - length
    return layout.plate_radius + near + depth + length, layout.port_axis


def _port(ax: Axes, assembly: Assembly) -> None:
    layout, gap = assembly.layout, _gap(assembly)
    _sensor(ax, assembly)
    x, z = _tube(ax, assembly, gap)
    if layout.port_axis is None:
        aside = layout.port.reach + 0.12 * layout.plate_radius
        _arrow(ax, (aside, z), (aside, layout.lowest - 0.2 * gap))
    else:
        below = layout.port_axis - layout.port.reach - 0.12 * layout.plate_radius
        _arrow(ax, (x, below), (layout.plate_radius + layout.port.length + 0.2 * gap, below))


def _mount(ax: Axes, assembly: Assembly) -> None:
    layout, mount, gap = assembly.layout, assembly.scene.mount, _gap(assembly)
    _sensor(ax, assembly)
    if isinstance(mount, Sleeve):
        finger, end = finger_radius(assembly.scene), layout.plate_low - mount.sleeve_length
        outline = [-finger, -finger, finger, finger], [end - gap, end - 0.1, end - 0.1, end - gap]
        ax.plot(*outline, color=INK, lw=THIN, ls=NEIGHBOUR)
        _arrow(ax, (0.0, end - 0.8 * gap), (0.0, end - 0.2 * gap))
        return
    face, wide = layout.under, 1.15 * layout.plate_radius
    hole = layout.port.reach + 0.5
    for side in (-1.0, 1.0):
        near, far = sorted((side * hole, side * wide))
        _box(ax, (near, far), (face - 0.35 * gap, face), "0.93")
    for side in (-1.0, 1.0):
        x = side * layout.bolt_circle_radius
        if isinstance(mount, BoltCircle) and mount.hole_depth is not None:
            _screw(ax, x, face - 0.8 * gap, -0.6 * gap, mount.head_diameter, mount.hole_diameter)
        elif isinstance(mount, BoltCircle | RobotFlange):
            _screw(ax, x, layout.plate_high + 0.8 * gap, 0.6 * gap, mount.head_diameter, mount.hole_diameter)


def _leak_test(ax: Axes, assembly: Assembly) -> None:
    _sensor(ax, assembly)
    x, z = _tube(ax, assembly, 0.0)
    pitch = 0.42 * assembly.layout.plate_radius
    places = {"gauge": (x + 1.4 * pitch, z - 0.4 * pitch), "valve": (x, z - pitch), "syringe": (x, z - 1.9 * pitch)}
    for text, (right, low) in places.items():
        ax.plot([x, x, right], [z, low, low], color=INK, lw=THIN)
        box = {"boxstyle": "circle" if text == "gauge" else "round", "fc": "white", "ec": INK, "lw": 0.7, "pad": 0.25}
        ax.annotate(text, (right, low), ha="center", va="center", fontsize=5.5, color=INK, bbox=box)


_PICTURES: dict[str, Callable[[Axes, Assembly], None]] = {
    "Joining": _joining,
    "Port": _port,
    "Mount": _mount,
    "Airtightness": _leak_test,
}
