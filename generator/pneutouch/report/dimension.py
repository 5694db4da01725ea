"""Pieces of a technical drawing: dimensions, leaders, centre lines. Lengths in the drawing's data units (mm)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch.report.style import INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes

THIN = 0.4
CENTRE = (0, (8, 2, 2, 2))
"""Dashes of a centre line."""

NEIGHBOUR = (0, (8, 2, 1.5, 2, 1.5, 2))
"""Dashes of a neighbouring part, which does not belong to the drawn one."""

_SIZE = 6.8


def polar(radius: float, degrees: float) -> tuple[float, float]:
    """A point at a radius and an angle in degrees."""
    return radius * math.cos(math.radians(degrees)), radius * math.sin(math.radians(degrees))


def circle(ax: Axes, x: float, y: float, radius: float, **look: object) -> None:
    """A thin circle."""
    angle = np.linspace(0, 2 * np.pi, 181)
    style: dict[str, Any] = {"color": INK, "lw": 0.7, **look}
    ax.plot(x + radius * np.cos(angle), y + radius * np.sin(angle), **style)


def _arrow(ax: Axes, start: tuple[float, float], end: tuple[float, float]) -> None:
    style = {
        "arrowstyle": "<|-|>,head_width=0.12,head_length=0.3",
        "lw": THIN,
        "color": INK,
        "shrinkA": 0,
        "shrinkB": 0,
    }
    ax.annotate("", end, start, arrowprops=style)


def horizontal(ax: Axes, y: float, x0: float, x1: float, feature: float, text: str) -> None:
    """A horizontal dimension at height ``y`` with extension lines from ``feature``."""
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
    """A vertical dimension at ``x`` with extension lines from ``feature``; the text stands outside."""
    reach = x + math.copysign(0.6, x)
    for y in (y0, y1):
        ax.plot([feature, reach], [y, y], color=INK, lw=0.25)
    _arrow(ax, (x, y0), (x, y1))
    side = "left" if x > 0 else "right"
    place: dict[str, Any] = {"xytext": (3 if x > 0 else -3, 0), "textcoords": "offset points"}
    ax.annotate(text, (x, 0.5 * (y0 + y1)), ha=side, va="center", fontsize=_SIZE, **place)


def leader(ax: Axes, at: tuple[float, float], to: tuple[float, float], text: str, ha: str) -> None:
    """A note with an arrow to the point ``at``."""
    arrow = {"arrowstyle": "-|>,head_width=0.12,head_length=0.3", "lw": THIN, "color": INK, "shrinkA": 1, "shrinkB": 0}
    box = {"fc": "white", "ec": "none", "pad": 0.6}
    look: dict[str, Any] = {"va": "center", "fontsize": _SIZE, "multialignment": "left", "bbox": box}
    ax.annotate(text, at, xytext=to, arrowprops=arrow, ha=ha, **look)
