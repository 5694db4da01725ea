"""One panel of a map of outcomes over wall ratio and driving pressure."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw_outcomes(
    ax: Axes, rows: list[dict[str, Any]], looks: dict[str, dict[str, Any]], wall_ratios: Sequence[float]
) -> None:
    """Mark the rows by their outcome, each with its look (keywords of a plot), over logarithmic wall ratios."""
    for outcome, look in looks.items():
        points = [(row["wall_ratio"], row["limit_fraction"]) for row in rows if row["outcome"] == outcome]
        x, y = zip(*points, strict=True) if points else ((), ())
        ax.plot(x, y, ls="", label=outcome, clip_on=False, in_layout=False, **look)
    ax.set_xscale("log")
    ax.set_xticks(wall_ratios, [f"{r:g}" for r in wall_ratios], rotation=90, fontsize=6)
    ax.minorticks_off()
