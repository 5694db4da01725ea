"""Charts of the shapes of a dome: their sections, and what each does at one footprint."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from stored_pages import stored

from pneutouch.report.style import ACCENT, INK, LINES, MARKERS, MUTED, figure, svg
from pneutouch.shape import SHAPES, shape_of, starting_sizes

_RADIUS, _WALL = 9.25, 1.5
_ALONG = np.linspace(0.0, 1.0, 241)


def shapes() -> str:
    """Half sections of every shape as a new design starts with it, on the plane of its flange."""
    with figure(178, 46) as drawn:
        for k, key in enumerate(SHAPES):
            ax = drawn.add_subplot(1, len(SHAPES), k + 1)
            sizes = {name.removesuffix("_mm"): size for name, size in starting_sizes(key, _RADIUS).items()}
            shape = shape_of(key, _RADIUS, _WALL, sizes)
            inner, outer = np.moveaxis(shape.points(_ALONG, np.array([0.0, 1.0])), 1, 0)
            loop = np.concatenate([inner, outer[::-1]])
            ax.fill(*loop.T, facecolor="0.82", edgecolor=INK, lw=0.8)
            ax.plot([0, 14], [0, 0], color=MUTED, lw=0.6)
            ax.plot([0, _RADIUS], [shape.floor] * 2, color=ACCENT, lw=0.9, ls=LINES[1])
            ax.set(xlim=(-0.5, 14), ylim=(-6, 17), aspect="equal", title=key)
            ax.set_axis_off()
        return svg(drawn)


def shape_trade_offs() -> str:
    """Sensitivity over the force at the end of the range, and over the height, by shape and wall."""
    found = stored("shapes")
    rows = [row for row in found["rows"] if "states" in row]
    with figure(178, 84) as drawn:
        axes = [drawn.add_subplot(1, 2, k + 1) for k in range(2)]
        for k, key in enumerate(SHAPES):
            points = [_point(row) for row in rows if row["shape"] == key]
            force, sensitivity, height = np.array([one for one in points if one is not None]).T
            look: dict[str, Any] = {
                "marker": MARKERS[k % len(MARKERS)],
                "ls": LINES[k % len(LINES)],
                "lw": 1.0,
                "ms": 5,
            }
            look |= {"color": ACCENT if key == "hemisphere" else INK, "mfc": "white" if k % 2 else None}
            axes[0].plot(force, sensitivity, label=key, **look)
            axes[1].plot(height, sensitivity, **look)
        pressure = rows[0]["states"][0]["driving_pressure_kPa"]
        axes[0].set(xlabel="force at the end of the range  (N)", ylabel=f"sensitivity at {pressure:g} kPa  (kPa/N)")
        axes[1].set(xlabel="height of the dome over its base  (mm)", ylabel=f"sensitivity at {pressure:g} kPa  (kPa/N)")
        axes[0].legend(fontsize=7)
        return svg(drawn)


def _point(row: dict[str, Any]) -> tuple[float, float, float] | None:
    state = row["states"][0]
    if "sensitivity_kPa_per_N" not in state:
        return None
    return state["force_N"], state["sensitivity_kPa_per_N"], row["height_mm"]


CHARTS: dict[str, Callable[[], str]] = {"shapes": shapes, "shape-trade-offs": shape_trade_offs}
