"""The section in the plane y = 0 of the solids as designed, elements of technical drawings, and texts on the port."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.body import Bore, Solid
from pneutouch.body.section import section_outline
from pneutouch.catalogue import ResolvedDesign
from pneutouch.parts import Assembly
from pneutouch.parts.cast_ring import RING
from pneutouch.report.pictures import grade_colours
from pneutouch.report.style import INK, MUTED, figure, svg
from pneutouch.shape.dome import DomeShape
from pneutouch.spec.part import Barb, Luer, Thread

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
TOLERANCE = 5e-3
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

    grading = assembly.scene.membrane_material.along
    for solid in assembly.solids:
        loops = section_outline(solid, TOLERANCE)
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


def draw_loops(ax: Axes, loops: Sequence[Array], role: str, hatches: Mapping[str, str] = _HATCHES) -> None:
    """Draw a section bounded by closed loops, (n, 2) each, mm, with the hatch that bodies of this ``role`` have; gray
    if that is empty."""
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
    return f"Ø{scene.tube.outer_diameter + wider:.4g}\n{port.depth:g} deep"
