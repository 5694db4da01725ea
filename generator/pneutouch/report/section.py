"""The section in the plane y = 0 of the solids as designed, elements of technical drawings, and texts on the port.

Also pictures of the steps that put a sensor together: its section, with the part that comes in away from its place.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.body import Bore, Solid
from pneutouch.body.section import section_outline
from pneutouch.catalogue import ResolvedDesign
from pneutouch.parts import Assembly
from pneutouch.parts.cast_ring import RING
from pneutouch.parts.connector import gasket_radii
from pneutouch.parts.layout import Layout, finger_radius
from pneutouch.report.pictures import grade_colours
from pneutouch.report.style import BOLD, INK, MM, MUTED, figure, svg
from pneutouch.shape.dome import DomeShape
from pneutouch.spec.part import Barb, BoltCircle, ClampedFlange, Luer, OnePiece, ORingStub, RobotFlange, Sleeve, Thread

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    from pneutouch.spec.material import ArcGrading


THIN = 0.4
CENTRE = (0, (8, 2, 2, 2))
"""Dashes of a centre line."""

HIDDEN = (0, (3, 1.5))
"""Dashes of an edge that is not seen."""

NEIGHBOUR = (0, (8, 2, 1.5, 2, 1.5, 2))
"""Dashes of a neighbouring part, which does not belong to the drawn one."""

_SIZE = 6.8


def polar(radius: float, degrees: float) -> tuple[float, float]:
    """The point (x, y) at a radius and an angle in degrees."""
    return radius * math.cos(math.radians(degrees)), radius * math.sin(math.radians(degrees))


def circle(ax: Axes, x: float, y: float, radius: float, **look: object) -> None:
    """Draw a thin circle."""
    angle = np.linspace(0, 2 * np.pi, 181)
    style: dict[str, Any] = {"color": INK, "lw": 0.7, **look}
    ax.plot(x + radius * np.cos(angle), y + radius * np.sin(angle), **style)


def _arrow_look(arrow: str, gap: int) -> dict[str, object]:
    """Look of an arrow of a style that ends ``gap`` points before its ends."""
    style = f"{arrow},head_width=0.12,head_length=0.3"
    return {"arrowstyle": style, "lw": THIN, "color": INK, "shrinkA": gap, "shrinkB": gap}


def _arrow(ax: Axes, start: tuple[float, float], end: tuple[float, float]) -> None:
    ax.annotate("", end, start, arrowprops=_arrow_look("<|-|>", 0))


def horizontal(ax: Axes, y: float, x0: float, x1: float, feature: float, text: str) -> None:
    """Draw a horizontal dimension at height ``y``, with extension lines from the height ``feature``."""
    for x in (x0, x1):
        ax.plot([x, x], [feature, y - 0.6], color=INK, lw=0.25)
    _arrow(ax, (x0, y), (x1, y))
    ax.text(
        0.5 * (x0 + x1),
        y,
        text,
        ha="center",
        va="center",
        fontsize=_SIZE,
        bbox={"fc": "white", "ec": "none", "pad": 0.8},
    )


def vertical(ax: Axes, x: float, y0: float, y1: float, feature: float, text: str) -> None:
    """Draw a vertical dimension at ``x``, text outside, with extension lines from ``feature``, also an x."""
    reach = x + math.copysign(0.6, x)
    for y in (y0, y1):
        ax.plot([feature, reach], [y, y], color=INK, lw=0.25)
    _arrow(ax, (x, y0), (x, y1))
    side = "left" if x > 0 else "right"
    place: dict[str, Any] = {"xytext": (3 if x > 0 else -3, 0), "textcoords": "offset points"}
    ax.annotate(text, (x, 0.5 * (y0 + y1)), ha=side, va="center", fontsize=_SIZE, **place)


def leader(ax: Axes, at: tuple[float, float], to: tuple[float, float], text: str, ha: str, arrow: str = "-|>") -> None:
    """Draw a note at ``to``, aligned by ``ha``, with an arrow to the point ``at``; from there to it if ``<|-``."""
    box = {"fc": "white", "ec": "none", "pad": 0.6}
    look: dict[str, Any] = {"va": "center", "fontsize": _SIZE, "multialignment": "left", "bbox": box}
    ax.annotate(text, at, xytext=to, arrowprops=_arrow_look(arrow, 1), ha=ha, **look)


_THICK = 0.9
_TOLERANCE = 5e-3
_WEDGES = 60
"""Number of wedges of one colour on each side of a graded wall."""
_BEYOND = 0.1
"""Share of the wall by which wedges reach beyond both faces."""
_HATCHES = {"membrane": "////////", "connector": "\\\\\\\\", "ring": "----", "plug": "||||"}
"""Hatches by role; another role has crosses."""
GRAY = "0.78"
"""Gray of silicone in its mould, which is not hatched as the parts are."""


def draw_section(ax: Axes, assembly: Assembly) -> None:
    """Draw the hatched sections of all bodies in the plane y = 0, with their bores turned into it; a graded membrane in
    the colours of its grade in place of the hatch."""
    from matplotlib.patches import PathPatch

    grading, layout = assembly.scene.membrane_material.along, assembly.layout
    _gasket(ax, layout)
    for solid in assembly.solids:
        loops = section_outline(solid, _TOLERANCE)
        if not loops:
            continue
        if grading is not None and solid.role == "membrane":
            shape = loops_path(loops)
            _graded(ax, PathPatch(shape, transform=ax.transData), grading, assembly.layout.shape)
            ax.add_patch(PathPatch(shape, facecolor="none", edgecolor=INK, lw=_THICK, joinstyle="miter"))
        else:
            draw_loops(ax, loops, solid.role)
        # The holes of a ring within the flange are full of silicone.
        filled = assembly.layout.ring is not None and solid.role == RING
        for bore in solid.bores:
            _turned_in(ax, bore, both_sides=filled or assembly.layout.port_axis is None, filled=filled)


def _gasket(ax: Axes, layout: Layout, lift: float = 0.0) -> None:
    """Draw the gasket under the flange, if there is one, ``lift`` mm above its place."""
    if layout.gasket:
        low, high = layout.plate_high + lift, layout.plate_high + layout.gasket + lift
        sides = [side * np.array(gasket_radii(layout)) for side in (-1.0, 1.0)]
        draw_loops(ax, [np.array([(a, low), (b, low), (b, high), (a, high)]) for a, b in sides], "gasket")


def draw_loops(ax: Axes, loops: Sequence[Array], role: str, hatches: Mapping[str, str] = _HATCHES) -> None:
    """Draw a section bounded by closed loops, (n, 2) each, mm, with the hatch of this ``role``; gray without."""
    from matplotlib.patches import PathPatch

    shape, hatch = loops_path(loops), hatches.get(role, "xx")
    ax.add_patch(PathPatch(shape, facecolor="white" if hatch else GRAY, edgecolor=MUTED, hatch=hatch, lw=0))
    ax.add_patch(PathPatch(shape, facecolor="none", edgecolor=INK, lw=_THICK, joinstyle="miter"))


def loops_path(loops: Sequence[Array]) -> Path:
    """One path made of closed loops, (n, 2) each."""
    from matplotlib.path import Path

    return Path.make_compound_path(*(Path(np.vstack([loop, loop[:1]]), closed=True) for loop in loops))


def _graded(ax: Axes, wall: PathPatch, grading: ArcGrading, shape: DomeShape) -> None:
    """Draw wedges from face to face in the colours of the grade, cut to ``wall``; below the base as at the rim."""
    from matplotlib.collections import PolyCollection

    arc = np.linspace(0.0, 1.0, _WEDGES + 1)
    # The chords of a wedge must not cut into the wall.
    low, high = np.moveaxis(shape.points(arc, np.array([-_BEYOND, 1.0 + _BEYOND])), 1, 0)
    wedges = np.stack([low[:-1], low[1:], high[1:], high[:-1]], axis=1)
    below = 2 * shape.outer_radius * np.array([(-1.0, 0.0), (1.0, 0.0), (1.0, -1.0), (-1.0, -1.0)])
    middles = shape.points(0.5 * (arc[1:] + arc[:-1]), np.array([0.5]))[:, 0] @ np.array([[1.0, 0, 0], [0, 0, 1.0]])
    colours = grade_colours(grading, shape, np.vstack([middles, middles, (shape.inner_radius, 0.0, 0.0)]))
    sides = [*wedges, *(wedges * [-1.0, 1.0])]
    cells = PolyCollection([*sides, below], facecolors=colours, edgecolors="face", lw=0.2)
    # The axes are scaled by the outlines alone.
    ax.add_collection(cells, autolim=False)
    cells.set_clip_path(wall)


def section_picture(assembly: Assembly) -> str:
    """The section without dimensions, as SVG."""
    with figure(76, 50) as drawn:
        ax = drawn.subplots()
        draw_section(ax, assembly)
        ax.set_aspect("equal")
        ax.autoscale()
        ax.axis("off")
        return svg(drawn)


def draw_bores(ax: Axes, solid: Solid, but: float | None = None, hidden: bool = False) -> None:
    """Draw a solid's bores from above, dashed if ``hidden`` or closed above, without those ``but`` mm from the axis."""
    for bore in solid.bores:
        if but is not None and math.isclose(math.hypot(bore.x, bore.y), but):
            continue
        look = {"ls": HIDDEN} if hidden or bore.closed == "high" else {}
        circle(ax, bore.x, bore.y, bore.radius, **look)


def _turned_in(ax: Axes, bore: Bore, both_sides: bool, filled: bool = False) -> None:
    """Draw a bore turned into the section, as drawings do; if not ``both_sides`` on the left, away from a side port.
    ``filled``: hatched as the membrane's silicone."""
    side = (bore.x if abs(bore.x) > 1e-9 else bore.y) if both_sides else -1.0
    x = math.copysign(math.hypot(bore.x, bore.y), side)
    across = [x - bore.radius, x + bore.radius, x + bore.radius, x - bore.radius]
    height = [bore.low, bore.low, bore.high, bore.high]
    ax.fill(across, height, facecolor="white", edgecolor=INK, lw=THIN)
    if filled:
        ax.fill(across, height, facecolor="none", edgecolor=MUTED, hatch=_HATCHES["membrane"], lw=0)


def port_note(scene: ResolvedDesign) -> str:
    """Text of the note at the port in the drawing, with diameters as drawn."""
    port, wider = scene.port, scene.hole_undersize
    if isinstance(port, Barb):
        return f"stem Ø{port.stem_diameter:g}\nbore Ø{port.bore_diameter:g}\nbarb Ø{port.barb_diameter:g}"
    if isinstance(port, Thread):
        return f"{port.thread}\ncore Ø{port.core_diameter + wider:.4g}\n{port.depth:g} deep"
    if isinstance(port, Luer):
        return f"Luer lock\nØ{port.opening_diameter + wider:.4g}, {port.taper:.0%}"
    if isinstance(port, ORingStub):
        groove = f"groove Ø{port.groove_diameter:g}\n{port.groove_width:g} wide"
        return f"O-ring {port.ring_diameter:g} × {port.section:g}\n{groove}"
    return f"Ø{scene.tube.outer_diameter + wider:.4g}\n{port.depth:g} deep"


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
    """Draw the section with bodies away from their place by a height in mm, by role; a gasket where all are in it."""
    if away is None:
        _gasket(ax, assembly.layout)
    for solid in assembly.solids:
        shift = np.array([0.0, (away or {}).get(solid.role, 0.0)])
        loops = section_outline(solid, _TOLERANCE)
        if loops:
            draw_loops(ax, [loop + shift for loop in loops], solid.role)


def _box(ax: Axes, across: tuple[float, float], heights: tuple[float, float], look: object = "white") -> None:
    x, z = [across[0], across[1], across[1], across[0]], [heights[0], heights[0], heights[1], heights[1]]
    ax.fill(x, z, facecolor=look, edgecolor=INK, lw=0.7)


def _way(ax: Axes, start: tuple[float, float], end: tuple[float, float]) -> None:
    ax.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": INK, "lw": 1.1, "shrinkA": 0, "shrinkB": 0})


def _screw(ax: Axes, x: float, tip: float, length: float, head: float, wide: float) -> None:
    """Draw a screw with its head above, or below for a negative length, and the arrow of its way."""
    turn = np.sign(length)
    _box(ax, (x - 0.5 * wide, x + 0.5 * wide), (tip, tip + length), "0.85")
    _box(ax, (x - 0.5 * head, x + 0.5 * head), (tip + length, tip + length + 0.6 * wide * turn), "0.85")
    _way(ax, (x, tip - 0.15 * length), (x, tip - 0.7 * length))


def _gap(assembly: Assembly) -> float:
    return _GAP * assembly.layout.plate_radius


def _joining(ax: Axes, assembly: Assembly) -> None:
    layout, seat, gap = assembly.layout, assembly.scene.seat, _gap(assembly)
    if isinstance(seat, OnePiece):
        _sensor(ax, assembly, {"plug": -gap})
        _way(ax, (0.0, layout.under - 0.7 * gap), (0.0, layout.under - 0.1 * gap))
        return
    _gasket(ax, layout, 0.5 * gap)
    over = {"membrane": gap, "ring": 2.0 * gap if isinstance(seat, ClampedFlange) else gap}
    _sensor(ax, assembly, over)
    for x in (-layout.flange_radius, layout.flange_radius):
        _way(ax, (x, gap - layout.flange_thickness), (x, 0.1 * gap))
    if isinstance(seat, ClampedFlange):
        for x in (-layout.screw_circle, layout.screw_circle):
            _screw(ax, x, 3.0 * gap + seat.ring_thickness, 0.6 * gap, seat.head_diameter, seat.clearance_diameter)


def _tube(ax: Axes, assembly: Assembly, away: float) -> tuple[float, float, float]:
    """Draw the tube, or the bore for a stub, away from its seat by a distance; x and z of its end, half its width."""
    layout, port, part, tube = assembly.layout, assembly.layout.port, assembly.scene.port, assembly.scene.tube
    around = isinstance(part, ORingStub)
    inner, outer = (
        (part.bore, part.bore + 6.0) if isinstance(part, ORingStub) else (tube.inner_diameter, tube.outer_diameter)
    )
    length = 0.7 * _gap(assembly)
    depth = port.length if around or isinstance(part, Barb) else max(port.engaged, 1.0)
    near = port.length - depth + away
    for side in (-1.0, 1.0):
        wall = sorted((0.5 * side * inner, 0.5 * side * outer))
        along = (near, near + depth + length)
        if layout.port_axis is None:
            _box(ax, (wall[0], wall[1]), (layout.under - along[1], layout.under - along[0]), "0.85")
        else:
            low, high = (layout.port_axis + w for w in wall)
            _box(ax, (layout.plate_radius + along[0], layout.plate_radius + along[1]), (low, high), "0.85")
    if layout.port_axis is None:
        return 0.0, layout.under - near - depth - length, 0.5 * outer
    return layout.plate_radius + near + depth + length, layout.port_axis, 0.5 * outer


def _port(ax: Axes, assembly: Assembly) -> None:
    layout, gap = assembly.layout, _gap(assembly)
    _sensor(ax, assembly)
    x, z, half = _tube(ax, assembly, gap)
    aside = max(layout.port.reach, half) + 0.12 * layout.plate_radius
    if layout.port_axis is None:
        _way(ax, (aside, z), (aside, layout.under - layout.port.length - 0.2 * gap))
    else:
        below = layout.port_axis - aside
        _way(ax, (x, below), (layout.plate_radius + layout.port.length + 0.2 * gap, below))


def _mount(ax: Axes, assembly: Assembly) -> None:
    layout, mount, gap = assembly.layout, assembly.scene.mount, _gap(assembly)
    _sensor(ax, assembly)
    if isinstance(mount, Sleeve):
        finger, end = finger_radius(assembly.scene), layout.plate_low - mount.sleeve_length
        outline = [-finger, -finger, finger, finger], [end - gap, end - 0.1, end - 0.1, end - gap]
        ax.plot(*outline, color=INK, lw=THIN, ls=NEIGHBOUR)
        _way(ax, (0.0, end - 0.8 * gap), (0.0, end - 0.2 * gap))
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
    end, z, _ = _tube(ax, assembly, 0.0)
    pitch = 0.42 * assembly.layout.plate_radius
    x = end if assembly.layout.port_axis is None else end + 0.6 * pitch
    places = {"gauge": (x + 1.4 * pitch, z - 0.4 * pitch), "valve": (x, z - pitch), "syringe": (x, z - 1.9 * pitch)}
    for text, (right, low) in places.items():
        ax.plot([end, x, x, right], [z, z, low, low], color=INK, lw=THIN)
        box = {"boxstyle": "circle" if text == "gauge" else "round", "fc": "white", "ec": INK, "lw": 0.7, "pad": 0.25}
        ax.annotate(text, (right, low), ha="center", va="center", fontsize=5.5, color=INK, bbox=box)


_PICTURES: dict[str, Callable[[Axes, Assembly], None]] = {
    "Joining": _joining,
    "Port": _port,
    "Mount": _mount,
    "Airtightness": _leak_test,
}
