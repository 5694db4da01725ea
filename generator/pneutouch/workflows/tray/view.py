"""The tray seen from above: envelope, parts in outline with their labels, axes in mm."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch.parts.lettering.mark import shape_of
from pneutouch.report.style import BOLD, INK, MM, MUTED, figure, halo, svg
from pneutouch.wording import counted
from pneutouch.workflows.tray.lay import TrayJob, TrayLayout, TrayPart, outline

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_WIDTH = 170.0
"""Width of the drawing, mm."""


def tray_svg(layout: TrayLayout, job: TrayJob) -> bytes:
    """SVG of one job."""
    envelope = layout.printer.envelope
    head = layout.order.tray.tray
    with figure(_WIDTH, _WIDTH * envelope.y / envelope.x + 6.0) as drawn:
        ax = drawn.add_subplot()
        _table(ax, envelope.x, envelope.y, head.margin_mm)
        outlines: dict[Any, Any] = {}
        for part in job.parts:
            key = (tuple(map(shape_of, part.solids)), part.marks[0].raised)
            if key not in outlines:
                outlines[key] = outline(part.bodies).to_polygons()
            _part(ax, part, outlines[key], envelope.x)
        ax.set_title(
            f"{layout.printer.title}, seen from above: {layout.name(job)}, {counted(len(job.parts), 'part')}, "
            f"{' + '.join(job.resins)}",
            loc="left",
            fontsize=7.5,
            color=INK,
        )
        return svg(drawn).encode()


def _table(ax: Axes, width: float, depth: float, margin: float) -> None:
    """The envelope's footprint and, dashed, its free border."""
    from matplotlib.patches import Rectangle

    ax.add_patch(Rectangle((0, 0), width, depth, fill=False, edgecolor=INK, linewidth=1.0))
    inner = (width - 2 * margin, depth - 2 * margin)
    ax.add_patch(Rectangle((margin, margin), *inner, fill=False, edgecolor=MUTED, linewidth=0.5, linestyle=(0, (4, 3))))
    ax.set_xlim(-0.02 * width, 1.02 * width)
    ax.set_ylim(-0.02 * depth, 1.02 * depth)
    ax.set_aspect("equal")
    ax.set_xlabel("x, mm")
    ax.set_ylabel("y, mm")


def _part(ax: Axes, part: TrayPart, polygons: list[Any], width: float) -> None:
    """One part: its resin's colour, its outline, its label as large as it fits."""
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    axes, shift = part.transform[:2, :2], part.transform[3, :2]
    moved = [np.vstack([line, line[:1]]) @ axes + shift for line in polygons]
    path = Path.make_compound_path(*(Path(line, closed=True) for line in moved))
    ax.add_patch(PathPatch(path, facecolor=part.solids[0].material.colour, alpha=0.55, edgecolor="none"))
    ax.add_patch(PathPatch(path, fill=False, edgecolor=INK, linewidth=0.7))
    across, along = part.footprint
    middle = (part.place.x + 0.5 * across, part.place.y + 0.5 * along)
    space = min(across, along) * 0.86 * _WIDTH * MM / width * 72  # points
    size = min(9.0, 0.34 * space)
    ax.text(
        *middle,
        part.label,
        ha="center",
        va="bottom",
        fontsize=size,
        color=INK,
        path_effects=halo(),
        gid=part.name,
        **BOLD,
    )
    names = " + ".join(solid.role for solid in part.solids)
    resins = " + ".join(dict.fromkeys(solid.material.title for solid in part.solids))
    small = min(5.5, 1.6 * space / max(len(resins), len(names), 8))
    ax.text(*middle, f"{resins}\n{names}", ha="center", va="top", fontsize=small, color=INK, linespacing=1.15)
