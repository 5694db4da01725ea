"""The section through the x axis, cut from the meshes themselves: what is drawn is what is printed."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from pneutouch.arrays import Array
from pneutouch.body import Body, Bore, Solid
from pneutouch.parts import Assembly
from pneutouch.report.dimension import THIN, circle
from pneutouch.report.style import INK, MUTED, figure, svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_THICK = 0.9
_TOLERANCE = 5e-3
_HATCHES = {"membrane": "////////", "connector": "\\\\\\\\", "ring": "----", "plug": "||||"}


def draw_section(ax: Axes, assembly: Assembly) -> None:
    """Hatched sections of all bodies in the plane y = 0, the holes of patterns turned into it."""
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    for solid in assembly.solids:
        paths = [Path(np.vstack([loop, loop[:1]]), closed=True) for loop in section(solid.mesh(_TOLERANCE))]
        if not paths:
            continue
        shape = Path.make_compound_path(*paths)
        ax.add_patch(PathPatch(shape, facecolor="white", edgecolor=MUTED, hatch=_HATCHES.get(solid.role, "xx"), lw=0))
        ax.add_patch(PathPatch(shape, facecolor="none", edgecolor=INK, lw=_THICK, joinstyle="miter"))
        for bore in solid.bores:
            _turned_in(ax, bore, both_sides=assembly.layout.port_axis is None)


def section_picture(assembly: Assembly) -> str:
    """The section alone, without dimensions, as SVG."""
    with figure(76, 50) as drawn:
        ax = drawn.subplots()
        draw_section(ax, assembly)
        ax.set_aspect("equal")
        ax.autoscale()
        ax.axis("off")
        return svg(drawn)


def section(body: Body) -> list[Array]:
    """Loops (n, 2) of (x, z) where the plane y = 0 cuts a body, mm."""
    from manifold3d import Manifold, Mesh64

    # The plane is slightly off, since whole rows of vertices lie on y = 0 itself.
    upright = body.vertices[:, [0, 2, 1]] * np.array([1.0, 1.0, -1.0])
    cut = Manifold(Mesh64(np.ascontiguousarray(upright), body.triangles.astype(np.uint64))).slice(1e-4)
    return [np.asarray(loop) for loop in cut.to_polygons()]


def draw_bores(ax: Axes, solid: Solid, but: float | None = None) -> None:
    """The bores of a solid as seen from above; dashed where they are hidden, those on the circle ``but`` left out."""
    for bore in solid.bores:
        if but is not None and math.isclose(math.hypot(bore.x, bore.y), but):
            continue
        look = {"ls": (0, (3, 1.5))} if bore.closed == "high" else {}
        circle(ax, bore.x, bore.y, bore.radius, **look)


def _turned_in(ax: Axes, bore: Bore, both_sides: bool) -> None:
    """Drawing practice turns the holes of a pattern into the section plane; away from a side port."""
    side = (bore.x if abs(bore.x) > 1e-9 else bore.y) if both_sides else -1.0
    x = math.copysign(math.hypot(bore.x, bore.y), side)
    across = [x - bore.radius, x + bore.radius, x + bore.radius, x - bore.radius]
    ax.fill(across, [bore.low, bore.low, bore.high, bore.high], facecolor="white", edgecolor=INK, lw=THIN)
