"""The section through the x axis, of the solids as designed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from pneutouch.arrays import Array
from pneutouch.body import Bore, Solid
from pneutouch.body.outline import section_outline
from pneutouch.parts import Assembly
from pneutouch.parts.cast_ring import RING
from pneutouch.report.dimension import THIN, circle
from pneutouch.report.shown import grade_colours
from pneutouch.report.style import INK, MUTED, figure, svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    from pneutouch.spec.material import ArcGrading

_THICK = 0.9
_TOLERANCE = 5e-3
_WEDGES = 60
"""Wedges of one colour on each side of a graded wall."""
_HATCHES = {"membrane": "////////", "connector": "\\\\\\\\", "ring": "----", "plug": "||||"}


def draw_section(ax: Axes, assembly: Assembly) -> None:
    """Hatched sections of all bodies in the plane y = 0, the holes of patterns turned into it; a graded membrane in the
    colours of its grade in place of the hatch."""
    from matplotlib.patches import PathPatch

    grading = assembly.scene.membrane_material.along
    for solid in assembly.solids:
        loops = section_outline(solid, _TOLERANCE)
        if not loops:
            continue
        if grading is not None and solid.role == "membrane":
            shape = _shape(loops)
            _graded(ax, PathPatch(shape, transform=ax.transData), grading, assembly.layout.outer_radius)
            ax.add_patch(PathPatch(shape, facecolor="none", edgecolor=INK, lw=_THICK, joinstyle="miter"))
        else:
            draw_loops(ax, loops, solid.role)
        # The holes of a ring within the flange are full of silicone.
        filled = assembly.layout.ring is not None and solid.role == RING
        for bore in solid.bores:
            _turned_in(ax, bore, both_sides=filled or assembly.layout.port_axis is None, filled=filled)


def draw_loops(ax: Axes, loops: Sequence[Array], role: str) -> None:
    """A section from its loops (n, 2) in mm, hatched as bodies of a ``role`` are."""
    from matplotlib.patches import PathPatch

    shape = _shape(loops)
    hatch = _HATCHES.get(role, "xx")
    ax.add_patch(PathPatch(shape, facecolor="white", edgecolor=MUTED, hatch=hatch, lw=0))
    ax.add_patch(PathPatch(shape, facecolor="none", edgecolor=INK, lw=_THICK, joinstyle="miter"))


def _shape(loops: Sequence[Array]) -> Path:
    """One path of closed loops."""
    from matplotlib.path import Path

    return Path.make_compound_path(*(Path(np.vstack([loop, loop[:1]]), closed=True) for loop in loops))


def _graded(ax: Axes, wall: PathPatch, grading: ArcGrading, radius: float) -> None:
    """Wedges from the axis outwards in the colours of the grade, cut to the wall; below the base that of the rim."""
    from matplotlib.collections import PolyCollection

    edges = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 2 * _WEDGES + 1)
    rim = 2 * radius * np.stack([np.sin(edges), np.cos(edges)], axis=1)
    wedges = [np.array([(0.0, 0.0), a, b]) for a, b in pairwise(rim)]
    below = 2 * radius * np.array([(-1.0, 0.0), (1.0, 0.0), (1.0, -1.0), (-1.0, -1.0)])
    middles = 0.5 * (edges[1:] + edges[:-1])
    points = np.stack([np.sin(middles), 0 * middles, np.cos(middles)], axis=1)
    colours = grade_colours(grading, np.vstack([points, (1.0, 0.0, 0.0)]))
    cells = PolyCollection([*wedges, below], facecolors=colours, edgecolors="face", lw=0.2)
    # The axes are scaled by the outlines alone.
    ax.add_collection(cells, autolim=False)
    cells.set_clip_path(wall)


def section_picture(assembly: Assembly) -> str:
    """The section alone, without dimensions, as SVG."""
    with figure(76, 50) as drawn:
        ax = drawn.subplots()
        draw_section(ax, assembly)
        ax.set_aspect("equal")
        ax.autoscale()
        ax.axis("off")
        return svg(drawn)


def draw_bores(ax: Axes, solid: Solid, but: float | None = None, hidden: bool = False) -> None:
    """The bores of a solid as seen from above; dashed where they are ``hidden`` or closed above, those on the circle
    ``but`` left out."""
    for bore in solid.bores:
        if but is not None and math.isclose(math.hypot(bore.x, bore.y), but):
            continue
        look = {"ls": (0, (3, 1.5))} if hidden or bore.closed == "high" else {}
        circle(ax, bore.x, bore.y, bore.radius, **look)


def _turned_in(ax: Axes, bore: Bore, both_sides: bool, filled: bool = False) -> None:
    """Drawing practice turns the holes of a pattern into the section plane; away from a side port. ``filled``: with the
    membrane's silicone."""
    side = (bore.x if abs(bore.x) > 1e-9 else bore.y) if both_sides else -1.0
    x = math.copysign(math.hypot(bore.x, bore.y), side)
    across = [x - bore.radius, x + bore.radius, x + bore.radius, x - bore.radius]
    height = [bore.low, bore.low, bore.high, bore.high]
    ax.fill(across, height, facecolor="white", edgecolor=INK, lw=THIN)
    if filled:
        ax.fill(across, height, facecolor="none", edgecolor=MUTED, hatch=_HATCHES["membrane"], lw=0)
