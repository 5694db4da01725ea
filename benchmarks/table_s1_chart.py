"""The chart of docs/background/table-s1.md: every cell of the table by friction, with the span of all assumptions."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from benchmarks.table_s1_cells import FRICTIONS, PRESSURES, Assumptions, CellRow
from pneutouch.report.style import ACCENT, FAINT, INK, figure, legend_above, svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_WIDTH = 0.6
"""Of the five frictions of one resin, in resins."""

_MARKS = ("o", "v", "^", "s", "P")


def draw(rows: list[CellRow], size: tuple[float, float] = (175.0, 80.0)) -> str:
    """SVG of two panels, one for each driving pressure; ``size`` in mm."""
    with figure(*size) as drawn:
        panels = drawn.subplots(1, len(PRESSURES), sharey=True)
        for ax, pressure in zip(panels, PRESSURES, strict=True):
            _panel(ax, [row for row in rows if row.pressure_kPa == pressure], pressure)
        panels[0].set_ylabel("sensitivity  (kPa/N)")
        legend_above(panels[0], columns=len(FRICTIONS) + 2)
        return svg(drawn)


def _panel(ax: Axes, rows: list[CellRow], pressure: float) -> None:
    for k, row in enumerate(rows):
        values = np.array(list(row.sensitivity.values()))
        low, high = float(np.nanmin(values)), float(np.nanmax(values))
        ax.bar(
            k,
            high - low,
            bottom=low,
            width=0.85,
            fc=FAINT,
            ec="none",
            alpha=0.7,
            zorder=1,
            label=_once(k, "all combinations"),
        )
        for friction, mark, place in zip(FRICTIONS, _MARKS, np.linspace(-0.5, 0.5, len(FRICTIONS)), strict=True):
            label = "grip" if friction == np.inf else f"friction {friction:g}"
            here = (k + _WIDTH * place, row.sensitivity[Assumptions(friction=friction)])
            ax.plot(*here, mark, color=INK, mfc="white", mew=0.7, ms=3.6, ls="none", zorder=3, label=_once(k, label))
        ax.plot(k, row.measured, "D", color=ACCENT, ms=4.5, ls="none", zorder=2, label=_once(k, "measured"))
    ax.set_xticks(range(len(rows)), [row.material.removesuffix("-DM") for row in rows], rotation=40, ha="right")
    ax.set(title=f"{pressure:g} kPa", xlabel="resin", ylim=(0, None))


def _once(k: int, label: str) -> str | None:
    return label if k == 0 else None
